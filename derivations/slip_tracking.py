"""Tracking of a wheel speed: surface, braking curve and the torque that they ask for.

With e = w - w_r the wheelset obeys J e' = tau_r - T - J w_r', and the valve changes T. The law asks for the torque
T* = tau_r - J (w_r' - y), at which e' = -y; y is the pull towards the reference.

Claims: w_r = (1 - lambda_d) v/R moves with (v'/R)(1 - lambda_d - v dlambda_d/dv), for lambda_d = c/sqrt(v) with
(v'/R)(1 - lambda_d/2). T* gives e' = -y. The valve enters e only in its second derivative, e' + k e and every other
sum of e and e' in its first: relative degrees 2 and 1. On the braking curve y^2 = 2 s (e - s/(2 k^2)) the pull falls
evenly with the slew s until it meets y = k e with the same slope, at e = s/k^2. With super-twisting,
y = k_1 e/sqrt(abs(e)) + z, z' = k_2 sgn(e), a quadratic function of (e/sqrt(abs(e)), z) decreases while the error of
the observed friction changes slowly. With y = k e + W sat(s/Phi), s = e + k int e dt, the surface is reached from
outside its layer for a disturbance below W, and begins at s = e.
"""

import sympy as sp

from derivations.notation import Generated, symbols, time

v, v_rate, R, slip, slope = symbols("speed acceleration wheel_radius slip_reference slip_slope")
e, e_rate, k, s, y = symbols("speed_error speed_error_rate approach_rate slew pull")
tau, T, J, h, a, w_rate = symbols(
    "observed_friction torque wheelset_inertia sample_time ahead reference_acceleration"
)

# --- reference ------------------------------------------------------------------------------------------------
reference_acceleration = v_rate / R * (1 - slip - v * slope)
_speed = sp.Function("v", positive=True)(time)
c = sp.Symbol("c", positive=True)


def _of(shape: sp.Expr) -> sp.Expr:
    """What the claim leaves over for a reference of a given shape over speed."""
    moves = sp.diff((1 - shape.subs(v, _speed)) * _speed / R, time)
    told = reference_acceleration.subs({slip: shape, slope: sp.diff(shape, v)})
    return sp.simplify(moves - told.subs({v_rate: sp.diff(_speed, time)}).subs(v, _speed))


reference_residual = _of(sp.Symbol("a_0") + sp.Symbol("a_1") * v + sp.Symbol("a_2") * v**2)
falling_slope = -slip / (2 * v)  # of c/sqrt(v)
falling_residual = sp.simplify((falling_slope - sp.diff(c / sp.sqrt(v), v)).subs(slip, c / sp.sqrt(v)))
falling_rate_residual = sp.simplify(
    reference_acceleration.subs(slope, falling_slope) - v_rate / R * (1 - slip / 2)
)

# --- torque ---------------------------------------------------------------------------------------------------
error_rate = (tau - T) / J - w_rate  # e' with the observed friction
target_torque = tau - J * (w_rate - y)
target_residual = sp.simplify(error_rate.subs(T, target_torque) + y)
predicted_error = e + a * h * error_rate

# --- relative degree: T' through the valve (9), fill and vent as commands -----------------------------------------
_valve = sp.Symbol("u", real=True)
_filling = (sp.Symbol("T_in") - T) / sp.Symbol("T_F")
_second = -_filling * _valve / J  # of e, the part that the valve makes
degree_residual = sp.simplify(sp.diff(error_rate, _valve)) ** 2  # e' does not know the valve
surface_rate_residual = sp.simplify(
    sp.diff(_second + k * error_rate, _valve) + _filling / J
)  # e'' + k e' does

# --- braking curve ----------------------------------------------------------------------------------------------
curve_square = 2 * s * (e - s / (2 * k**2))
_curve = sp.sqrt(curve_square)
curve_slew_residual = sp.simplify(sp.diff(_curve, e) * (-_curve) + s)  # y' = (dy/de) e', e' = -y
_meeting = s / k**2
meeting_residual = sp.simplify(_curve.subs(e, _meeting) - k * _meeting)
meeting_slope_residual = sp.simplify(sp.diff(_curve, e).subs(e, _meeting) - k)
below_line_residual = sp.expand((k * e) ** 2 - curve_square - (k * e - s / k) ** 2)  # never above k e

# --- super-twisting: x_1 = e/sqrt(abs(e)), e' = -k_1 x_1 - z + d, z' = k_2 sgn(e), for e > 0 --------------------------
k1, k2, x1, z = sp.symbols("k_1 k_2 x_1 z", positive=True)
_rates = sp.Matrix([(-k1 * x1 - z) / (2 * x1), k2])  # of (x_1, z); x_1' = e'/(2 sqrt(e))
_P = sp.Matrix([[4 * k2 + k1**2, k1], [k1, 2]]) / 2  # with zeta = (x_1, z): V = zeta' P zeta
_zeta = sp.Matrix([x1, z])
_V_rate = (2 * _zeta.T * _P * _rates)[0]
_Q = k1 / 2 * sp.Matrix([[2 * k2 + k1**2, k1], [k1, 1]])
twisting_residual = sp.simplify(_V_rate + (_zeta.T * _Q * _zeta)[0] / x1)
definite_residual = sp.simplify(_Q.det() - k1**2 / 4 * (2 * k2))

# --- integral sliding mode ------------------------------------------------------------------------------------------
E, W, d = sp.symbols("E W d", real=True)
surface = e + k * E
_pull_outside = k * e + W * sp.sign(surface)
reaching_residual = sp.simplify((-_pull_outside + d) + k * e - (d - W * sp.sign(surface)))  # s' = e' + k e

FUNCTIONS = (
    Generated(
        name="reference_acceleration",
        arguments=(v, v_rate, slip, slope, R),
        value=reference_acceleration,
        summary="Angular acceleration of the wheel speed at the desired slip",
        returns="Acceleration of the reference [rad/s2]",
        equation="derivative of eq. (3)",
    ),
    Generated(
        name="falling_slope",
        arguments=(v, slip),
        value=falling_slope,
        summary="Derivative in the train speed of a desired slip that falls as 1/sqrt(v)",
        returns="Derivative [s/m]",
        equation="derivative of c/sqrt(v)",
    ),
    Generated(
        name="predicted_error",
        arguments=(e, tau, T, w_rate, J, h, a),
        value=predicted_error,
        summary="Error of the wheel speed a share of a sample later",
        returns="Error [rad/s]",
        equation="eq. (2) about the reference",
    ),
    Generated(
        name="target_torque",
        arguments=(tau, w_rate, y, J),
        value=target_torque,
        summary="Braking torque at which the wheel approaches its reference at the rate of the pull",
        returns="Torque, before the limits of the brake [N m]",
        equation="eq. (2) about the reference",
    ),
    Generated(
        name="curve_square",
        arguments=(e, k, s),
        value=curve_square,
        summary="Square of the pull on the braking curve, where the pull falls evenly with the slew",
        returns="Square of the pull, meant for errors above s/k^2 [rad2/s4]",
        equation="braking curve",
    ),
)
