"""Sliding mode, eqs. (21)-(28): surface, equivalent control, reaching condition, and the valve lag left out.

Claims: (23), (25), (28) print lambda where lambda_d or the error belongs; with the error, s' = K_P(-delta -
W sgn s) and V' <= 0 for W >= |delta|; u* stays bounded as v -> 0 although F and G do not; a lag tau turns
the loop inside the layer into a cubic that needs p tau < 1.
"""

import sympy as sp

from derivations import slip_equation
from derivations.notation import Generated, symbols, time

slip, slip_d, s, e, E = symbols("slip slip_reference sliding_variable error error_integral")
K_P, K_I, c = symbols("proportional_gain integral_gain surface_rate")
F, G, slip_d_rate, delta, W = symbols("drift gain reference_rate uncertainty uncertainty_bound")
Phi, p, tau, k = symbols("layer pole time_constant layer_rate")

# --- (21), (22): surface ----------------------------------------------------------------------------------
slip_error = slip_d - slip
sliding_variable = K_P * e + K_I * E
sliding_pole = sp.solve(sp.Symbol("q") * K_P + K_I, sp.Symbol("q"))[0]  # of e' + (K_I/K_P) e = 0

# --- (19), (20) as the plant: lambda' = F + G u + delta ---------------------------------------------------
u = sp.Symbol("u", real=True)
slip_rate = F + G * u + delta
error_rate = slip_d_rate - slip_rate
s_rate = K_P * error_rate + K_I * e

# --- (23): the equivalent control solves s' = 0 without uncertainty ---------------------------------------
slip_rate_symbol = sp.Symbol("slip_rate", real=True)
equivalent_printed = (-F + slip_rate_symbol + K_I / K_P * slip) / G
equivalent_derived = sp.solve(s_rate.subs(delta, 0), u)[0]
equivalent_corrected = (-F + slip_d_rate + c * e) / G
equivalent_residual_corrected = sp.simplify(equivalent_corrected.subs(c, K_I / K_P) - equivalent_derived)
equivalent_residual_printed = sp.simplify(equivalent_printed - equivalent_derived)
# Inserted into (19), the printed law demands (K_I/K_P) lambda = 0: no slip at all, instead of s' = 0.
printed_contradiction = sp.simplify(slip_rate.subs(delta, 0).subs(u, equivalent_printed) - slip_rate_symbol)

# --- (24), (25): reaching ---------------------------------------------------------------------------------
lyapunov = s**2 / 2
robust_term = W * sp.sign(s) / G
robust_size = W / G  # largest value of u_ht in (23)
robust_form = sp.Symbol("sat(s/Φ)") * robust_size
s_rate_controlled = sp.simplify(s_rate.subs(u, equivalent_derived + robust_term))
lyapunov_rate = sp.expand(s * s_rate_controlled)
lyapunov_rate_claimed = sp.expand(-K_P * s * delta - K_P * W * sp.Abs(s))
lyapunov_rate_residual = sp.simplify(lyapunov_rate.subs(s * sp.sign(s), sp.Abs(s)) - lyapunov_rate_claimed)
first_line_printed = s * (K_P * slip_rate_symbol + K_I * slip)
first_line_corrected = s * (K_P * (slip_d_rate - slip_rate_symbol) + K_I * e)
first_line_residual = sp.expand(first_line_printed - first_line_corrected)
worst_case_rate = sp.simplify(
    lyapunov_rate.subs(delta, -W * sp.sign(s)).subs(sp.sign(s) ** 2, 1)
)  # |delta| = W
# Inside the layer |s| <= Phi: the largest error that e' + c e = s'/K_P allows is 2 Phi / K_P.
# The impulse response of e over s/K_P, q/(q + c), is delta(t) - c exp(-c t): its L1 norm is the peak gain.
layer_error_bound = Phi / K_P * (1 + sp.integrate(c * sp.exp(-c * time), (time, 0, sp.oo)))

# --- (26): unit of u --------------------------------------------------------------------------------------
# The printed law starts with |b| <= 1 and psi = 1 and adapts both with alpha_1 + alpha_2 = 10.85 times |s|. While
# the slip is not negative s <= K_P .14 + K_I .14 t, so that u never exceeds u_most; a lag only delays it.
u_start, duty_at_start = 2, sp.Rational(2, 60_000)
u_most = u_start + (10 + sp.Rational("0.85")) * sp.integrate(
    (1800 + 550 * time) * sp.Rational("0.14"), (time, 0, time)
)
# If u is in N m: speed by (1), (2) of a train that rolls, without running resistance; mass and speed as printed.
_rolling_mass = 76841 + 8 * 331 / sp.Rational("0.55") ** 2
speed_in_newton_metres = sp.Rational(120) / sp.Rational("3.6") - 4 / (
    sp.Rational("0.55") * _rolling_mass
) * sp.integrate(u_most, (time, 0, time))
_stop = next(root for root in sp.Poly(speed_in_newton_metres, time).nroots() if root.is_real and root > 0)
distance_in_newton_metres = float(sp.integrate(speed_in_newton_metres, (time, 0, _stop)))  # m, at least
printed_distance = 184.03  # m, Table 10, AFSMC, dry

# --- T_brake = u: (23) sets the torque, (26) makes a duty of it; by (15) the torque lags behind ---------------
torque_rate = sp.Symbol("torque_rate", real=True)
torque_of_duty = u - tau * torque_rate  # tau T' + T = T_max dc with dc = u/T_max
torque_residual = sp.expand(torque_of_duty - u)
unmodeled_rate = sp.expand((F + G * torque_of_duty + delta) - slip_rate)  # of the slip
torque_rate_of_surface = sp.expand(-s * K_P * unmodeled_rate)  # of V = s^2/2
ideal_torque_residual = -unmodeled_rate  # of e' + c e

# --- (27), (28): ideal control ----------------------------------------------------------------------------
ideal_residual = sp.simplify(error_rate.subs(delta, 0).subs(u, equivalent_derived) + K_I / K_P * e)
ideal_slip_rate = sp.simplify(slip_rate.subs(delta, 0).subs(u, equivalent_derived))
ideal_residual_printed = sp.simplify(ideal_slip_rate + K_I / K_P * e)  # (28) prints lambda' for e'
ideal_control = equivalent_corrected.subs({F: slip_equation.drift, G: slip_equation.slip_gain})
ideal_at_standstill = sp.simplify(sp.limit(ideal_control, slip_equation.v, 0, "+"))
drift_at_standstill = sp.limit(
    sp.expand(slip_equation.drift.subs(slip, sp.Rational("0.14"))), slip_equation.v, 0
)

# --- lag: tau T' + T = u, error e' = p e - G dT, u from (23) inside the layer -----------------------------
q = sp.Symbol("q")
# du/de: -F gives p, (K_I/K_P) e gives c, the layer k (e + c int e).
control_per_error = (p + c + k + k * c / q) / G
loop = sp.numer(sp.together((q - p) + G * control_per_error / (tau * q + 1)))
characteristic_derived = sp.Poly(sp.expand(loop), q).all_coeffs()
characteristic = (tau, 1 - p * tau, c + k, k * c)
characteristic_residual = tuple(
    sp.simplify(found - stated) for found, stated in zip(characteristic_derived, characteristic, strict=True)
)
routh = sp.factor(characteristic[1] * characteristic[2] - characteristic[0] * characteristic[3])

FUNCTIONS = (
    Generated(
        name="slip_error",
        arguments=(slip_d, slip),
        value=slip_error,
        summary="Slip error",
        returns="Slip error, positive when the slip is too small [-]",
        equation="21",
    ),
    Generated(
        name="sliding_variable",
        arguments=(e, E, K_P, K_I),
        value=sliding_variable,
        summary="Sliding variable: proportional and integral of the slip error",
        returns="Sliding variable s [-]",
        equation="22",
    ),
    Generated(
        name="equivalent_torque",
        arguments=(F, G, slip_d_rate, e, c),
        value=equivalent_corrected,
        summary="Equivalent control: the braking torque that keeps the sliding variable constant",
        returns="Braking torque of one wheelset [N m]",
        equation="23",
        notes="Corrected: the printed equation has the slip in place of the desired slip and of the error.",
    ),
    Generated(
        name="lyapunov_surface",
        arguments=(s,),
        value=lyapunov,
        summary="Lyapunov function of the sliding variable",
        returns="V = s^2 / 2 [-]",
        equation="24",
    ),
    Generated(
        name="lag_characteristic",
        arguments=(p, tau, c, k),
        value=characteristic,
        summary="Characteristic polynomial of the sliding-mode loop inside the boundary layer with valve lag",
        returns="Coefficients of q^3, q^2, q and 1",
        equation="23",
        notes="tau q^3 + (1 - p tau) q^2 + (c + k) q + k c, with the speed frozen. Stable (Routh) for\n"
        "p tau < 1 and (1 - p tau)(c + k) > tau k c.",
    ),
)
