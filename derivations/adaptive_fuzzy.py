"""Adaptive fuzzy law, eqs. (29)-(44): V2 of (43) rises where (44) says that it falls, and how to repair it.

Claims: (39), (41) are misprinted; (44) omits (G'/2)(|b~|^2/alpha_1 + psi~^2/alpha_2), with G' = G a/v > 0
while braking; dividing by G gives V = v s_D^2/(2 g) + |b~|^2/(2 alpha_1) + psi~^2/(2 alpha_2), where it
helps.
"""

import sympy as sp

from derivations import slip_equation
from derivations.notation import Generated, symbols, time

s, center, width, K_P, K_I = symbols("sliding_variable centre width proportional_gain integral_gain")
G, G_rate, F, e, slip_d_rate = symbols("gain gain_rate drift error reference_rate")
xi, psi, psi_error, psi_hat = symbols("approximation_error bound bound_error bound_estimate")
b_squared, alpha1, alpha2 = symbols("weight_error_squared weight_rate bound_rate")
s_D, v, a, g = symbols("dead_zone_variable speed deceleration gain_times_speed")
b_w = sp.Symbol("b_error_times_w", real=True)  # b~' w
sgn = sp.Symbol("sgn_s", real=True)  # sgn(s), with s sgn(s) = |s|

# --- (29)-(32): fuzzy system with n = 3 rules -------------------------------------------------------------
membership = sp.exp(-(((s - center) / width) ** 2))
_rules = range(3)
mu = [sp.Symbol(f"mu_{r}", positive=True) for r in _rules]
b = [sp.Symbol(f"b_{r}", real=True) for r in _rules]
basis = [m / sum(mu) for m in mu]
mu_sum = sum(sp.Symbol("mu_A", positive=True) for _ in _rules)
partition_residual = sp.simplify(sum(basis) - 1)
output_residual = sp.simplify(
    sum(b[r] * mu[r] for r in _rules) / sum(mu) - sum(b[r] * basis[r] for r in _rules)
)

# --- (33), (34): u* depends on speed, the fuzzy system on s only ------------------------------------------
ideal_control = ((-F + slip_d_rate + K_I / K_P * e) / G).subs(
    {F: slip_equation.drift, G: slip_equation.slip_gain}
)
_force, _resistance = sp.Function("f")(slip_equation.v), sp.Function("f_d")(slip_equation.v)
force_slope, resistance_slope = sp.symbols("force_slope resistance_slope", real=True)  # df/dv, df_d/dv
_ideal_of_speed = ideal_control.subs({slip_equation.f: _force, slip_equation.f_d: _resistance})
ideal_speed_dependence = (
    sp.expand(  # at fixed slip and e, hence at fixed s; friction and resistance move with v
        sp.diff(_ideal_of_speed, slip_equation.v)
        .subs(
            {
                sp.diff(_force, slip_equation.v): force_slope,
                sp.diff(_resistance, slip_equation.v): resistance_slope,
            }
        )
        .subs({_force: slip_equation.f, _resistance: slip_equation.f_d})
    )
)
# u* has no negative power of v: it is bounded wherever slip, speed, f and f_d are.
ideal_singular_part = sum(
    term
    for term in sp.Add.make_args(sp.expand(ideal_control))
    if sp.degree(sp.denom(sp.together(term)), slip_equation.v) > 0
)

# --- (37): sat(s) has a layer of 1 in s, which is 1/K_P in slip -------------------------------------------
layer_in_slip = sp.Rational(1, 1800)

# --- (38), (39): error dynamics ---------------------------------------------------------------------------
u, u_ideal, slip_rate = sp.symbols("u u_ideal slip_rate", real=True)
error_rate = slip_d_rate - (F + G * u)
error_dynamics_left = error_rate + K_I / K_P * e
ideal_torque = (-F + slip_d_rate + K_I / K_P * e) / G
error_dynamics_residual = sp.simplify(error_dynamics_left - G * (ideal_torque - u))
error_dynamics_left_printed = slip_rate + K_I / K_P * e
error_dynamics_residual_printed = sp.simplify(
    error_dynamics_left_printed.subs(slip_rate, F + G * u) - G * (ideal_torque - u)
)

# What T_brake = u leaves out: with T = u + (T - u) in (19) the error moves by another G (u - T).
torque = sp.Symbol("torque", real=True)
torque_residual = sp.simplify((slip_d_rate - (F + G * torque) + K_I / K_P * e) - G * (ideal_torque - u))

torque_residual_of_slip = sp.expand((F + G * torque) - (F + G * u))

# --- (41), (42): adaptation -------------------------------------------------------------------------------
w_r = sp.Symbol("w", real=True)
b_hat_rate = sp.Symbol("b_hat_rate", real=True)
adaptation_printed = sp.solve(sp.Eq(b_hat_rate, -b_hat_rate), b_hat_rate)[0]  # b^' = -b^' leaves only zero
adaptation_corrected = alpha1 * s * w_r
adaptation_residual = adaptation_printed - adaptation_corrected
sgn_G = sp.Symbol("sgn_G", real=True)
bound_rate_printed = alpha2 * sp.Abs(s) * sgn_G
bound_rate = alpha2 * sp.Abs(s)
sign_of_gain = sp.sign(slip_equation.slip_gain)  # 1 by (19)
bound_rate_residual = bound_rate_printed.subs(sgn_G, sign_of_gain) - bound_rate


# --- (43), (44): V2 as printed ----------------------------------------------------------------------------
lyapunov_printed = s**2 / (2 * K_P) + G * b_squared / (2 * alpha1) + G * psi_error**2 / (2 * alpha2)
rate_claimed = s * G * xi - sp.Abs(s) * G * psi


def _rate(candidate: sp.Expr, rates: dict[sp.Symbol, sp.Expr]) -> sp.Expr:
    """Derivative of a candidate along the closed loop: chain rule over all that moves."""
    return sp.expand(sum(sp.diff(candidate, x) * rate for x, rate in rates.items()))


_closed_loop = {
    s: K_P * G * (b_w + xi - psi_hat * sgn),  # (39) with (36), (37), (40)
    b_squared: 2 * (-alpha1 * s * b_w),  # d|b~|^2/dt with (41)
    psi_error: -alpha2 * s * sgn,  # (42), |s| = s sgn(s)
    G: G_rate,
}
_signed = {psi_hat: psi - psi_error}
rate_true = sp.expand(_rate(lyapunov_printed, _closed_loop).subs(_signed).subs(s * sgn, sp.Abs(s)))
omitted = sp.factor(rate_true - sp.expand(rate_claimed))
rate_omitted = G_rate / 2 * (b_squared / alpha1 + psi_error**2 / alpha2)
omitted_residual = sp.simplify(omitted - rate_omitted)
frozen_gain_residual = sp.simplify(rate_true.subs(G_rate, 0) - rate_claimed)  # (44) holds if G' = 0
# G = R/(2 I v) with v' = -a: G' = G a/v is positive while braking.
v_t = sp.Function("v", positive=True)(time)
gain_growth = sp.simplify(
    sp.diff(slip_equation.slip_gain.subs(slip_equation.v, v_t), time)
    .subs(sp.diff(v_t, time), -a)
    .subs(v_t, v)
    / slip_equation.slip_gain
)
# With sat(s) in place of sgn(s), a second term is left inside the layer |s| < 1: G psi_hat |s| (1 - |s|).
rate_with_sat = sp.expand(_rate(lyapunov_printed, {**_closed_loop, s: K_P * G * (b_w + xi - psi_hat * s)}))
layer_excess = sp.factor(
    (
        rate_with_sat.subs(s * sgn, sp.Abs(s)).subs(psi_error, psi - psi_hat)
        - rate_true.subs(psi_error, psi - psi_hat)
    )
    .expand()
    .subs(s**2, sp.Abs(s) ** 2)
)
layer_excess_at_edge = layer_excess.subs(s, 1)
last_line_printed = -sp.Abs(s) * G * psi - sp.Abs(xi)
last_line_corrected = -sp.Abs(s) * G * (psi - sp.Abs(xi))
last_line_residual = sp.expand(last_line_printed - last_line_corrected)

# --- the repair: divide by G, and adapt on the dead zone s_D of s/K_P outside the layer -------------------
lyapunov_repaired = v * s_D**2 / (2 * g) + b_squared / (2 * alpha1) + psi_error**2 / (2 * alpha2)
repaired_loop = {
    s_D: g / v * (b_w + xi - psi_hat * sgn),  # outside the layer: s_D' = s'/K_P = G (u* - u), sat = sgn
    b_squared: 2 * (-alpha1 * s_D * b_w),
    psi_error: -alpha2 * s_D * sgn,
    v: -a,
}
repaired_rate = s_D * xi - psi * sp.Abs(s_D) - a * s_D**2 / (2 * g)
repaired_rate_derived = sp.expand(
    sp.expand(_rate(lyapunov_repaired, repaired_loop).subs(_signed)).subs(s_D * sgn, sp.Abs(s_D))
)
repaired_rate_residual = sp.simplify(repaired_rate_derived - repaired_rate)
# Without the dead zone it is V2/(G K_P), with the rates alpha K_P in V2.
repaired_scale_residual = sp.simplify(
    (lyapunov_printed / (G * K_P)).subs({alpha1: alpha1 / K_P, alpha2: alpha2 / K_P})
    - lyapunov_repaired.subs({s_D: s / K_P, g: G * v})
)
# Adaptation held at a limit of the brake: V' = s_D (u* - T) - a s_D^2/(2 g) for any torque T.
held_rate = s_D * (u_ideal - torque) - a * s_D**2 / (2 * g)
held_rate_residual = sp.simplify(
    _rate(lyapunov_repaired, {s_D: g / v * (u_ideal - torque), v: -a}) - held_rate
)
held_margin = sp.Symbol("eta", positive=True)
_full = sp.Symbol("T_max", positive=True)
held_full_residual = sp.expand(  # s_D > 0, T = T_max, u* = T_max - eta
    held_rate.subs({torque: _full, u_ideal: _full - held_margin}) + s_D * held_margin + a * s_D**2 / (2 * g)
)
held_empty_residual = sp.expand(  # s_D < 0, T = 0, u* = eta
    held_rate.subs({torque: 0, u_ideal: held_margin}) - s_D * held_margin + a * s_D**2 / (2 * g)
)
# u* of 65 kN m against a brake of 60: V rises at s_D = .05, g of R .55 m and I 331 kg m2, a 3 m/s2.
held_counterexample = held_rate.subs(
    {
        s_D: sp.Rational(1, 20),
        u_ideal: 65_000,
        torque: 60_000,
        a: 3,
        g: sp.Rational("0.55") / (2 * 331),
    }
)

_KEEPS = "Holds for the law (36), (37) with sgn(s) and the adaptation (41), (42)."
FUNCTIONS = (
    Generated(
        name="membership",
        arguments=(s, center, width),
        value=membership,
        summary="Gaussian membership of the sliding variable in a fuzzy set",
        returns="Degree of membership, 0 to 1 [-]",
        equation="29",
    ),
    Generated(
        name="lyapunov_printed",
        arguments=(s, G, b_squared, psi_error, K_P, alpha1, alpha2),
        value=lyapunov_printed,
        summary="Lyapunov function V2 of the adaptive fuzzy law as printed",
        returns="V2 [-]",
        equation="43",
        notes="Not a Lyapunov function: it rises while the train brakes, see ``lyapunov_printed_rate_true``.",
    ),
    Generated(
        name="lyapunov_printed_rate_claimed",
        arguments=(s, G, xi, psi),
        value=rate_claimed,
        summary="Rate of change of V2 as the paper claims it",
        returns="Claimed dV2/dt [1/s]",
        equation="44",
        notes=_KEEPS + " Wrong unless G is constant.",
    ),
    Generated(
        name="lyapunov_printed_rate_true",
        arguments=(s, G, G_rate, xi, psi, b_squared, psi_error, alpha1, alpha2),
        value=rate_claimed + rate_omitted,
        summary="Rate of change of V2 with the terms of dG/dt that the paper omits",
        returns="dV2/dt [1/s]",
        equation="44",
        notes=_KEEPS + "\nThe gain rate is G times deceleration over speed.",
    ),
    Generated(
        name="lyapunov_repaired",
        arguments=(s_D, v, g, b_squared, psi_error, alpha1, alpha2),
        value=lyapunov_repaired,
        summary="Lyapunov function that falls: V2 divided by the gain, with a dead zone",
        returns="V [N m s]",
        equation="43",
        notes="For u_r = psi_hat sat(s/(K_P Phi)), b_hat' = alpha_1 s_D w and psi_hat' = alpha_2 |s_D|.",
    ),
    Generated(
        name="lyapunov_repaired_rate",
        arguments=(s_D, a, g, xi, psi),
        value=repaired_rate,
        summary="Rate of change of the repaired Lyapunov function",
        returns="dV/dt [N m]",
        equation="44",
        notes="Not positive while the train decelerates and the bound exceeds the approximation error.",
    ),
)
