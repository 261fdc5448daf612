"""Nomenclature: one symbol per quantity, with its unit, its meaning and how the paper writes it.

Every derivation takes its symbols from here, so that the same word is the same SymPy symbol everywhere and
the generated docstrings, the equation map and the typeset equations agree.
"""

from dataclasses import dataclass, field

import sympy as sp

time = sp.Symbol("t", real=True, nonnegative=True)
"""Time, the independent variable of functions such as v(t)."""


@dataclass(frozen=True, slots=True)
class Quantity:
    """One quantity: SI unit, meaning, and the paper's symbol in plain text and in Typst."""

    unit: str
    meaning: str
    plain: str
    typst: str
    sign: str = "real"


def _table() -> dict[str, Quantity]:
    positive = "positive"
    q = Quantity
    return {
        # contact and adhesion, eqs. (5)-(7)
        "shear_modulus": q("Pa", "shear modulus", "G_s", "G_s", positive),
        "semi_axis_rolling": q(
            "m", "semi-axis of the contact ellipse along the rail", "a_x", "a_x", positive
        ),
        "semi_axis_lateral": q(
            "m", "semi-axis of the contact ellipse across the rail", "b_y", "b_y", positive
        ),
        "kalker_c11": q("-", "longitudinal coefficient of Kalker's linear theory", "c11", "c_11", positive),
        "contact_stiffness": q("N", "contact stiffness pi G a b c11 / 4 of one wheel", "C", "C", positive),
        "wheel_load": q("N", "vertical load of one wheel", "Q", "Q", positive),
        "mu0": q("-", "friction coefficient without sliding", "μ0", "mu_0", positive),
        "friction_ratio": q("-", "friction at infinite sliding speed divided by mu0", "A", "A", positive),
        "friction_decay": q("s/m", "decay of friction with sliding speed", "B", "B", positive),
        "adhesion_reduction": q("-", "reduction factor in the area of adhesion, kA", "k_A", "k_A", positive),
        "slip_reduction": q("-", "reduction factor in the area of slip, kS", "k_S", "k_S", positive),
        "sliding_speed": q("m/s", "magnitude of the sliding speed, |v - R omega|", "w", "w"),
        "friction": q("-", "friction coefficient at the present sliding speed", "μ", "mu", positive),
        "gradient": q("-", "gradient of the tangential stress in the area of adhesion", "ε", "epsilon"),
        "friction_slope": q("s/m", "derivative of friction with respect to the sliding speed", "μ'", "mu'"),
        "shape": q("-", "saturation function of the stress gradient", "h", "h"),
        "shape_slope": q("-", "derivative of the saturation function", "h'", "h'"),
        # motion, eqs. (1)-(4)
        "speed": q("m/s", "train speed", "v", "v", positive),
        "wheel_speed": q("rad/s", "angular speed of the wheelset", "ω", "omega"),
        "wheel_radius": q("m", "wheel radius", "R", "R", positive),
        "wheel_inertia": q("kg m2", "moment of inertia per wheel, half of one wheelset", "I", "I", positive),
        "wheel_damping": q("N m s", "damping torque per wheel speed, B_W", "B_W", "B_W", positive),
        "mass": q("kg", "mass of the train", "m", "m", positive),
        "creep_force": q("N", "creep force of one wheel, positive when it brakes the train", "f", "f"),
        "creep_force_slip_derivative": q(
            "N", "derivative of the creep force with respect to slip at fixed speed", "f_λ", "f_lambda"
        ),
        "resistance": q("N", "running resistance of the train", "f_d", "f_d"),
        "constant": q("N", "constant part of the resistance, a0", "a0", "a_0"),
        "linear": q("N s/m", "linear part of the resistance, a1", "a1", "a_1"),
        "quadratic": q("N s2/m2", "quadratic part of the resistance, a2", "a2", "a_2"),
        "grade_force": q("N", "force of the gradient, positive uphill", "f_r", "f_r"),
        "curve_force": q("N", "resistance of the curve", "f_c", "f_c"),
        "tunnel_force": q("N", "additional resistance in a tunnel", "f_t", "f_t"),
        "time": q("s", "time since the brake was applied", "t", "t"),
        "initial": q("N m s", "damping at t = 0", "B_0", "B_0", positive),
        "decay": q("1/s", "decay rate", "β", "beta", positive),
        # slip, eqs. (3), (19)
        "slip": q("-", "longitudinal slip ratio, positive when braking", "λ", "lambda"),
        "reference_speed": q(
            "m/s", "speed that the slip is referred to, the train speed in eq. (3)", "v_r", "v_r"
        ),
        "deceleration": q("m/s2", "deceleration of the train, -dv/dt", "a", "a"),
        # brake, eqs. (8)-(15)
        "braking_torque": q("N m", "braking torque of one wheelset", "T", "T"),
        "max_torque": q("N m", "braking torque at full pressure", "T_max", 'T_"max"', positive),
        "pressure": q("Pa", "pressure of the brake cylinder", "P_c", "P_c"),
        "supply_pressure": q("Pa", "pressure at the valves, P_cin", "P_in", 'P_"in"'),
        "max_pressure": q("Pa", "full brake pressure", "P_max", 'P_"max"', positive),
        "start_pressure": q("Pa", "pressure at the start of filling or venting", "P_0", "P_0"),
        "start_time": q("s", "time at which the filling starts", "t_0", "t_0"),
        "elapsed": q("s", "time since the venting started", "Δt", "Delta t"),
        "supply_rate": q("1/s", "build-up rate of the supply pressure", "r", "r", positive),
        "fill": q("-", "1 while filling, else 0: 1 - u_BV", "u_F", "u_F"),
        "vent": q("-", "1 while venting, else 0: u_EV", "u_V", "u_V"),
        "fill_time": q("s", "time constant of filling", "T_F", "T_F", positive),
        "vent_time": q("s", "time constant of venting", "T_V", "T_V", positive),
        "time_constant": q("s", "time constant of filling and venting", "τ", "tau", positive),
        "torque": q("N m", "braking torque of one wheelset", "T", "T"),
        "command": q("-", "valve command or duty, 0 to 1", "ū", "overline(u)"),
        "period": q("s", "period of the pulse width modulation", "h", "h", positive),
        # further valves and build-ups of the brake
        "ramp_start": q("s", "time at which the demanded pressure begins to rise", "t_r", "t_r"),
        "ramp_rate": q("Pa/s", "rate at which the demanded pressure rises", "k", "k", positive),
        "vented_for": q("s", "time of venting", "t_V", "t_V"),
        "held_for": q("s", "time of holding after it", "t_H", "t_H"),
        "hold_leak": q("1/s", "rate at which a held cylinder leaks", "k_H", "k_H"),
        "critical_ratio": q("-", "critical pressure ratio of an orifice, ISO 6358", "b", "b", positive),
        "pressure_ratio": q(
            "-", "absolute pressure behind an orifice over that before it", "r", "r", positive
        ),
        "tangent": q("-", "tangent of half the angle of the flow ellipse", "y", "y", positive),
        "half_angle": q("-", "half the angle of the flow ellipse, 0 without flow", "χ", "chi", positive),
        "flow_time": q(
            "s",
            "time in which choked flow would fill the cylinder to the supply pressure",
            "τ_o",
            "tau_o",
            positive,
        ),
        "progress": q("-", "elapsed time over 2 (1 - b) times the time of the orifice", "ξ", "xi", positive),
        "advance": q(
            "-", "how far the tangent falls from 0 on, in the time of the progress", "Y", "Y", positive
        ),
        "root": q("-", "square root of |2 b - 1|", "κ", "kappa", positive),
        # laws that track a wheel speed through the valve
        "sample_time": q("s", "sample time of a law", "h", "h", positive),
        "supply_torque": q(
            "N m", "braking torque of the pressure that the demand allows", "T_in", 'T_"in"', positive
        ),
        "target_torque": q("N m", "braking torque that a law asks for", "T*", "T^*", positive),
        "mean_torque": q("N m", "mean braking torque over a sample", "T_m", "T_m"),
        "wheelset_inertia": q(
            "kg m2", "moment of inertia of all that rotates with one wheelset", "J", "J", positive
        ),
        "friction_torque": q("N m", "torque of the creep forces on one wheelset, 2 R f", "τ_r", "tau_r"),
        "observed_speed": q("rad/s", "wheel speed as observed", "ω^", "hat(omega)"),
        "observed_friction": q("N m", "friction torque as observed", "τ^", "hat(tau)"),
        "observer_pole": q("-", "double pole of an observer, over one sample", "θ", "theta", positive),
        # filter on the wheels
        "friction_torques": q("N m", "sum of the friction torques of all wheelsets", "Στ", "Sigma tau"),
        "torque_scale": q(
            "-", "true over nominal deceleration by the friction torques", "κ", "kappa", positive
        ),
        "creep_factor": q("-", "sum of the reduction factors kA and kS", "k", "k", positive),
        "rim_speed": q("m/s", "speed of a wheel rim as tracked", "u", "u"),
        "rim_rate": q("m/s2", "acceleration of a wheel rim as tracked", "u'", "u'"),
        "shown_speed": q("m/s", "speed of a wheel rim as the sensor shows it", "u_m", "u_m"),
        "acceleration": q("m/s2", "acceleration of the train, negative when braking", "v'", "dot(v)"),
        "slip_slope": q("s/m", "derivative of the desired slip in the train speed", "λ_d,v", "lambda_(d,v)"),
        "reference_acceleration": q(
            "rad/s2", "angular acceleration of the desired wheel speed", "ω_r'", "dot(omega)_r"
        ),
        "speed_error": q("rad/s", "wheel speed minus the desired one", "e_ω", "e_omega"),
        "speed_error_rate": q(
            "rad/s2", "time derivative of the error of the wheel speed", "e_ω'", "dot(e)_omega"
        ),
        "ahead": q("-", "share of a sample by which the error is predicted", "a", "a", positive),
        "approach_rate": q("1/s", "rate at which the error of the wheel speed falls", "k", "k", positive),
        "slew": q("rad/s3", "rate at which the valve can change the pull", "s", "s", positive),
        "rim_error": q("m/s", "rim speed above the desired one", "e_v", "e_v"),
        "rim_error_rate": q("m/s2", "its time derivative", "e_v'", "dot(e)_v"),
        "driving_surface": q("m/s2", "surface reduced by its layer", "σ_D", "sigma_D"),
        "rule_strength": q("-", "normalized strength of a fuzzy rule", "w_r", "w_r", positive),
        "rule_weight": q("-", "weight of a fuzzy rule, a share of the sample", "b_r", "b_r"),
        "share_rate": q("s/m", "rate of adaptation", "α", "alpha", positive),
        "leakage": q("m/s2", "leakage of the adaptation", "κ_b", "kappa_b", positive),
        "pull": q("rad/s2", "rate at which the wheel is asked to approach its reference", "y", "y"),
        # sliding surface, eqs. (21)-(28)
        "slip_reference": q("-", "desired slip ratio", "λ_d", "lambda_d"),
        "error": q("-", "slip error", "e", "e"),
        "error_integral": q("s", "time integral of the slip error", "E", "E"),
        "proportional_gain": q("-", "gain K_P of the sliding surface", "K_P", "K_P", positive),
        "integral_gain": q("1/s", "gain K_I of the sliding surface", "K_I", "K_I", positive),
        "sliding_variable": q("-", "sliding variable s", "s", "s"),
        "surface_rate": q("1/s", "K_I / K_P, rate of the error on the sliding surface", "c", "c", positive),
        "drift": q("1/s", "drift F of the slip, eq. (19)", "F", "F"),
        "gain": q("1/(N m s)", "input gain G of the slip, eq. (19)", "G", "G", positive),
        "gain_rate": q("1/(N m s2)", "time derivative of the input gain G", "G'", "dot(G)"),
        "reference_rate": q("1/s", "time derivative of the desired slip", "λ_d'", "dot(lambda)_d"),
        "uncertainty": q("1/s", "lumped uncertainty of eq. (20)", "δ", "delta"),
        "uncertainty_bound": q("1/s", "bound W of the uncertainty", "W", "W", positive),
        "layer": q("-", "boundary layer Phi, in s", "Φ", "Phi", positive),
        "pole": q("1/s", "open-loop slip pole, dF/d(slip) at fixed speed", "p", "p"),
        "layer_rate": q("1/s", "loop gain inside the boundary layer, W K_P / Phi", "k", "k", positive),
        # adaptive fuzzy law, eqs. (29)-(44)
        "centre": q("-", "centre of the membership function", "c_r", "c^r"),
        "width": q("-", "width of the membership function", "σ_r", "sigma^r", positive),
        "approximation_error": q("N m", "approximation error xi of the fuzzy system", "ξ", "xi"),
        "bound": q("N m", "bound psi of the approximation error", "ψ", "psi", positive),
        "bound_error": q("N m", "error of the estimated bound", "ψ~", "tilde(psi)"),
        "bound_estimate": q("N m", "estimated bound", "ψ^", "hat(psi)"),
        "weight_error_squared": q(
            "N2 m2", "squared norm of the error of the weights", "|b~|²", "abs(tilde(b))^2"
        ),
        "weight_rate": q("N m/s", "adaptation rate alpha_1 of the weights", "α1", "alpha_1", positive),
        "bound_rate": q("N m/s", "adaptation rate alpha_2 of the bound", "α2", "alpha_2", positive),
        "dead_zone_variable": q("-", "s / K_P reduced by the boundary layer (dead zone)", "s_D", "s_D"),
        "gain_times_speed": q("m/(N m s2)", "g = G v = R / (2 I)", "g", "g", positive),
        # track, eq. (49)
        "wavenumber": q("rad/m", "wavenumber of the irregularity", "Ω", "Omega", positive),
        # Their units depend on the row of Table 9: unit_check.py solves eq. (49) for them.
        "beta0": q("", "coefficient of the numerator", "β0", "beta_0"),
        "beta2": q("", "coefficient of the numerator", "β2", "beta_2"),
        "gamma0": q("", "coefficient of the denominator", "γ0", "gamma_0"),
        "gamma2": q("", "coefficient of the denominator", "γ2", "gamma_2"),
        "gamma4": q("", "coefficient of the denominator", "γ4", "gamma_4"),
        "gamma6": q("", "coefficient of the denominator", "γ6", "gamma_6"),
    }


NOMENCLATURE = _table()


def _auxiliary() -> dict[str, Quantity]:
    q = Quantity
    return {
        "slip_rate": q("1/s", "rate of the slip", "λ'", "dot(lambda)"),
        "error_rate": q("1/s", "rate of the slip error", "e'", "dot(e)"),
        "speed_rate": q("m/s2", "acceleration of the train", "v'", "dot(v)"),
        "wheel_speed_rate": q("rad/s2", "angular acceleration of the wheelset", "ω'", "dot(omega)"),
        "torque_rate": q("N m/s", "rate of the braking torque", "T'", "dot(T)"),
        "pressure_rate": q("Pa/s", "rate of the cylinder pressure", "P_c'", "dot(P)_c"),
        "command_rate": q("1/s", "rate of the valve command", "ū'", "dot(overline(u))"),
        "b_hat_rate": q("N m/s", "rate of an estimated weight", "b^'", "dot(hat(b))"),
        "psi_hat_rate": q("N m/s", "rate of the estimated bound", "ψ^'", "dot(hat(psi))"),
        "lyapunov": q("", "a Lyapunov function", "V", "V"),
        "lyapunov_rate": q("1/s", "rate of the Lyapunov function of the surface", "V'", "dot(V)"),
        "lyapunov2": q("-", "Lyapunov function V2 of the adaptive law", "V2", "V_2"),
        "lyapunov2_rate": q("1/s", "rate of V2", "V2'", "dot(V)_2"),
        "gamma": q("1/s", "Gamma of eq. (45)", "Γ", "Gamma"),
        "u": q("N m", "control input, a torque", "u", "u"),
        "u_ideal": q("N m", "ideal control", "u*", "u^*"),
        "u_eq": q("N m", "equivalent control", "u_eq", 'u_"eq"'),
        "u_ht": q("N m", "robust control", "u_ht", 'u_"ht"'),
        "duty_cycle": q("-", "duty of the valves", "dc", "d c"),
        "rho": q("-", "assumed over true inertia", "ρ", "rho"),
        "sgn_G": q("-", "sign of G", "sgn(G)", 'op("sgn") (G)'),
        "sgn_s": q("-", "sign of s", "sgn(s)", 'op("sgn") (s)'),
        "b_error_times_w": q("N m", "error of the weights times the basis", "b~ᵀw", "tilde(b)^top w"),
        "weight": q("N m", "weight of a rule", "b", "b"),
        "basis": q("-", "fuzzy basis function", "w", "w"),
        "v_0": q("m/s", "speed at the start", "v0", "v_0"),
        "omega_0": q("rad/s", "wheel speed at the start", "ω0", "omega_0"),
        "t_stop": q("s", "stopping time", "t_stop", 't_"stop"'),
        "force_slope": q("N s/m", "derivative of the creep force in speed at fixed slip", "∂f/∂v", "f_v"),
        "resistance_slope": q("N s/m", "derivative of the running resistance in speed", "f_d'", "dot(f)_d"),
        "q": q("-", "relative uncertainty of the gain", "q", "q"),
        "D": q("1/s", "bounds of Delta F and Delta G u_eq", "D", "D"),
        "W": q("1/s", "bound on the uncertainty", "W", "W"),
        "torque_integral": q(
            "N m s", "sum of the torque integrals of the wheelsets", "Σ∫T dt", "sum integral T dif t"
        ),
        "A_eff": q("m2", "effective area of the brake cylinders", "A_eff", 'A_"eff"'),
        "E_b": q("-", "magnification of the brake rigging", "E_b", "E_b"),
        "eta_b": q("-", "efficiency of the brake rigging", "η_b", "eta_b"),
        "r_b": q("m", "radius at which the pads act, printed R", "r_b", "r_b"),
        "mu_brake": q("-", "friction coefficient of the pads", "μ_b", "mu_b"),
        "P_c": q("Pa", "pressure of the brake cylinder over time", "P_c", "P_c"),
        "f": q("N", "creep force of one wheel over time", "f", "f"),
        "f_d": q("N", "running resistance over time", "f_d", "f_d"),
        "T": q("N m", "braking torque over time", "T", "T"),
        "v": q("m/s", "train speed over time", "v", "v"),
        "omega": q("rad/s", "wheel speed over time", "ω", "omega"),
        "B_W": q("N m s", "damping over time", "B_W", "B_W"),
        "u_EV": q("-", "command of the vent valve", "u_EV", 'u_"EV"'),
        "u_BV": q("-", "command of the fill valve", "u_BV", 'u_"BV"'),
        "mu_A": q("-", "degree of membership", "μ_A", "mu_(A^r)"),
        "spectral_density": q("m2/(rad/m)", "power spectral density", "S", "S"),
        "cross_level_density": q("m/rad", "spectral density of the roll angle, a pure number", "S", "S"),
        "slide": q("m/s", "absolute slide", "σ", "sigma"),
        "slide_rate": q("m/s2", "rate of the absolute slide", "σ'", "dot(sigma)"),
        "slide_limit": q("m/s", "limit of a slide region", "Δσ", "Delta sigma"),
        "kmh": q("m/s", "one kilometre per hour", "km/h", '"km/h"'),
        "disturbing_torque": q("N m", "disturbing torque of the pads", "T_d", "T_d"),
        "disturbance_gain": q("-", "disturbing torque over braking torque", "k_d", "k_d"),
        "disturbance_decay": q("1/s", "decay of the disturbance", "δ_d", "delta_d"),
        "disturbance_frequency": q("rad/s", "frequency of the disturbance", "ω_d", "omega_d"),
        # of statements about a closed loop
        "reserve": q("m/s2", "reserve: rate at which the surface is approached at least", "η", "eta"),
        "model_error": q(
            "m/s2", "error of the friction model of a law, v times that of the slip rate", "r", "r"
        ),
        "most_deceleration": q("m/s2", "largest deceleration of the train", "a_max", 'a_"max"'),
        "switching_gain": q("m/s2", "switching gain, W times the train speed", "W0", "W_0"),
        "surface_in_slip": q("-", "s / K_P, the sliding variable as a slip", "s̄", "overline(s)"),
        "entry_integral": q("s", "integral of the slip error where the layer is entered", "E1", "E_1"),
        "path_time": q("-", "integral of dt/v, in which the sliding motion is uniform", "σ", "sigma"),
        "weight_ideal": q("N m", "ideal weights of the rules, or torques", "b*", "b^*"),
        "weight_error": q("N m", "error of the weights", "b~", "tilde(b)"),
        "weight_estimate": q("N m", "estimated weights of the rules", "b^", "hat(b)"),
        "holding_torque": q("N m", "braking torque that holds the reference", "T*", "T^*"),
        "most_pole": q(
            "1/s", "largest slip pole that a gain on the sampled slip stabilizes", "p_max", 'p_"max"'
        ),
        "decay_rate": q("1/s", "rate at which the torque decays through the averaged valve", "a", "a"),
        "command_gain": q(
            "1/s", "rate with which the command moves the torque through the averaged valve", "b", "b"
        ),
        "feedback_torque": q("-", "gain of a law on the torque near its equilibrium", "K", "K"),
        "feedback_slip": q("N m", "gain of a law on the slip error near its equilibrium", "P", "P"),
        "feedback_integral": q("N m/s", "gain of a law on the integral of the slip error", "I", "I"),
        "feedback_twice": q("N m/s2", "gain of a law on the double integral of the slip error", "J", "J"),
        "third_coefficient": q("1/s", "coefficient of the characteristic polynomial", "a3", "a_3"),
        "second_coefficient": q("1/s", "coefficient of the characteristic polynomial", "a2", "a_2"),
        "first_coefficient": q("1/s2", "coefficient of the characteristic polynomial", "a1", "a_1"),
        "sensitivity": q("-", "sensitivity function of the loop", "S", "S"),
    }


AUXILIARY = _auxiliary()
"""Symbols that occur in derivations only: rates, integrals, functions of time."""


STATEMENTS = {
    # symbol of a statement in Typst: what it stands for; the second meaning is that of the checks of the linear loop
    "v": ("speed",),
    "v_0": ("v_0",),
    "dot(v)": ("acceleration",),
    "omega": ("wheel_speed",),
    "lambda": ("slip",),
    "dot(lambda)": ("slip_rate",),
    "e": ("error",),
    "dot(e)": ("error_rate",),
    "E_1": ("entry_integral",),
    "a": ("deceleration", "decay_rate"),
    'a_"max"': ("most_deceleration",),
    "R": ("wheel_radius",),
    "I": ("wheel_inertia", "feedback_integral"),
    "m": ("mass",),
    "f": ("creep_force",),
    "f_d": ("resistance",),
    "mu_0": ("mu0",),
    "F": ("drift",),
    "G": ("gain",),
    "dot(G)": ("gain_rate",),
    "g": ("gain_times_speed",),
    "p": ("pole",),
    'p_"max"': ("most_pole",),
    "T": ("torque",),
    "T^*": ("holding_torque",),
    'T_"max"': ("max_torque",),
    "T_F": ("fill_time",),
    "T_V": ("vent_time",),
    "tau": ("time_constant",),
    "h": ("sample_time",),
    "t": ("time",),
    "sigma": ("path_time",),
    "u": ("u",),
    "u^*": ("u_ideal",),
    "s": ("sliding_variable",),
    "overline(s)": ("surface_in_slip",),
    "s_D": ("dead_zone_variable",),
    "K_P": ("proportional_gain",),
    "K_I": ("integral_gain",),
    "c": ("surface_rate",),
    "k": ("layer_rate",),
    "Phi": ("layer",),
    "W": ("uncertainty_bound",),
    "W_0": ("switching_gain",),
    "eta": ("reserve",),
    "r": ("model_error",),
    "rho": ("rho",),
    "V": ("lyapunov",),
    "dot(V)": ("lyapunov_rate",),
    "V_2": ("lyapunov2",),
    "dot(V)_2": ("lyapunov2_rate",),
    "b": ("weight", "command_gain"),
    "b^*": ("weight_ideal",),
    "tilde(b)": ("weight_error",),
    "hat(b)": ("weight_estimate",),
    "w": ("basis",),
    "xi": ("approximation_error",),
    "psi": ("bound",),
    "hat(psi)": ("bound_estimate",),
    "tilde(psi)": ("bound_error",),
    "alpha_1": ("weight_rate",),
    "alpha_2": ("bound_rate",),
    "K": ("feedback_torque",),
    "P": ("feedback_slip",),
    "J": ("feedback_twice",),
    "a_1": ("first_coefficient",),
    "a_2": ("second_coefficient",),
    "a_3": ("third_coefficient",),
    "S": ("sensitivity",),
}
"""The symbols in which certificates speak, in the order of a list of symbols."""


def quantity(name: str) -> Quantity | None:
    """Return what a symbol of a derivation stands for, or None where the tables do not name it."""
    return NOMENCLATURE.get(name) or AUXILIARY.get(name)


def symbol(name: str) -> sp.Symbol:
    """Return the SymPy symbol of a quantity of the nomenclature."""
    return sp.Symbol(name, **{NOMENCLATURE[name].sign: True})


def symbols(names: str) -> tuple[sp.Symbol, ...]:
    """Return the symbols of several quantities, separated by spaces."""
    return tuple(symbol(name) for name in names.split())


@dataclass(frozen=True, slots=True, kw_only=True)
class Generated:
    """One function of the generated model: what is computed from what.

    ``steps`` are named intermediate results, in the order in which they are computed; ``value`` may use
    them. A tuple as ``value`` makes a function that returns a tuple.
    """

    name: str
    arguments: tuple[sp.Symbol, ...]
    value: sp.Expr | tuple[sp.Expr, ...]
    summary: str
    returns: str
    equation: str
    steps: tuple[tuple[sp.Symbol, sp.Expr], ...] = ()
    notes: str = ""
    meanings: dict[str, str] = field(default_factory=dict)
    """Argument descriptions ``meaning [unit]`` where the nomenclature's is too general."""

    @property
    def expressions(self) -> tuple[sp.Expr, ...]:
        """The results as expressions of the arguments alone, the steps substituted."""
        values = self.value if isinstance(self.value, tuple) else (self.value,)
        known: dict[sp.Symbol, sp.Expr] = {}
        for name, expression in self.steps:
            known[name] = expression.xreplace(known)
        return tuple(sp.sympify(value).xreplace(known) for value in values)


def described(
    name: str,
    arguments: tuple[sp.Symbol, ...],
    value: sp.Expr | tuple[sp.Expr, ...],
    summary: str,
    returns: str,
    steps: tuple[tuple[sp.Symbol, sp.Expr], ...] = (),
    *,
    equation: str,
    meanings: dict[str, str],
) -> Generated:
    """Return a function whose arguments a table of its module describes."""
    return Generated(
        name=name,
        arguments=arguments,
        value=value,
        summary=summary,
        returns=returns,
        steps=steps,
        equation=equation,
        meanings={each.name: meanings[each.name] for each in arguments},
    )


def numerator(fraction: sp.Expr) -> sp.Expr:
    """Return the expanded numerator of a fraction of polynomials or of powers of e, which is 0 exactly where it is 0.

    It shows that a residual vanishes without the search for a short form that ``simplify`` is.
    """
    return sp.expand(sp.numer(sp.together(fraction)))
