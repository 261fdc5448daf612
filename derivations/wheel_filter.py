"""Train speed from the wheels: what a Kalman filter on the friction torques of the wheelsets predicts and compares.

With tau the friction torques of all wheelsets, 2 R f each, the train slows down by m v' = -(sum tau)/R - f_d - m g i.
Torques that follow from nominal pads and a nominal mass are wrong by one factor kappa; an accelerometer along the
track feels forces but no gravity along it, so that it shows v' + g i and its own bias b. State (v, kappa, b, g i):
v+ = v - h (kappa a_F + d + g i), z = -(kappa a_F + d) + b, with a_F = (sum tau)/(R m), d = f_d/m. What the torques do
not explain, e per sample, enters both v+ and z. A wheel that adheres shows R omega = (1 - s) v, and Kalker's slope of
Polach's creep force, eqs. (5), (6), gives its slip s from its own friction torque.

Claims: the prediction is the motion of the train of eq. (1) over a sample of constant forces; the micro-slip carries
the friction torque in the linear range; the correction that is used is the textbook one, its gain has the least
variance also where process and measurement share a noise, and it keeps the covariance positive; the speed of a rim is
tracked with the double pole theta.
"""

import sympy as sp

from derivations.notation import Generated, numerator, symbols

m, R, C, k_AS, h, f_d = symbols("mass wheel_radius contact_stiffness creep_factor sample_time resistance")
kappa, tau, torques, theta, rim, rate, shown = symbols(
    "torque_scale friction_torque friction_torques observer_pole rim_speed rim_rate shown_speed"
)

# --- prediction -------------------------------------------------------------------------------------------------
per_scale = torques / (R * m)
slowing = kappa * per_scale + f_d / m
force, count, grade = sp.symbols("f n g_i", positive=True)
_all = {torques: count * 2 * R * force, kappa: 1}
motion_residual = sp.simplify(-(slowing.subs(_all) + grade) + (2 * count * force + f_d) / m + grade)

# --- micro-slip ---------------------------------------------------------------------------------------------------
micro_slip = tau / (2 * R) / (2 * C / sp.pi * k_AS)
_s, _mu, _Q, k_A, k_S = sp.symbols("s mu Q k_A k_S", positive=True)
_gradient = C * _s / (_mu * _Q)
_polach = 2 * _mu * _Q / sp.pi * (k_A * _gradient / (1 + (k_A * _gradient) ** 2) + sp.atan(k_S * _gradient))
_slope = sp.limit(sp.diff(_polach, _s), _s, 0)
micro_slip_residual = sp.simplify(2 * R * _slope * micro_slip.subs(k_AS, k_A + k_S) - tau)

# --- one measurement: x+ = x + K r, S = H P H' + 2 H c + V, K = (P H' + c)/S, P+ = P - K (P H' + c)' -------------
_P = sp.Matrix(2, 2, sp.symbols("p_11 p_12 p_12 p_22", real=True))
_H = sp.Matrix([sp.symbols("h_1 h_2", real=True)])
_V = sp.Symbol("V", positive=True)
_c = sp.Matrix(sp.symbols("c_1 c_2", real=True))  # of process and measurement in common
_K = sp.Matrix(sp.symbols("k_1 k_2", real=True))
_A = sp.eye(2) - _K * _H
_joseph = _A * _P * _A.T + _K * _V * _K.T - _A * _c * _K.T - _K * _c.T * _A.T
_S = (_H * _P * _H.T + 2 * _H * _c)[0] + _V
_gain = (_P * _H.T + _c) / _S
_best = {_K[0]: _gain[0], _K[1]: _gain[1]}
gain_residual = sum(numerator(sp.diff(_joseph.trace(), each).subs(_best)) ** 2 for each in _K)
_short = _P - _gain * (_P * _H.T + _c).T
short_form_residual = sum((numerator(entry) ** 2 for entry in _joseph.subs(_best) - _short), sp.S.Zero)
_without = {_c[0]: 0, _c[1]: 0}
positive_residual = numerator((_short.det() - _P.det() * _V / _S).subs(_without))

# --- tracking of a rim --------------------------------------------------------------------------------------------
expected = rim + h * rate
_error = shown - expected
tracked = (expected + (1 - theta**2) * _error, rate + (1 - theta) ** 2 / h * _error)
_z = sp.Symbol("z")
_matrix = sp.Matrix([[sp.diff(row, column) for column in (rim, rate)] for row in tracked])
tracking_residual = sp.simplify((_z * sp.eye(2) - _matrix).det() - (_z - theta) ** 2)

FUNCTIONS = (
    Generated(
        name="slowing_per_scale",
        arguments=(torques, R, m),
        value=per_scale,
        summary="Deceleration of the train by the friction torques of its wheelsets at their nominal scale",
        returns="Deceleration [m/s2]",
        equation="from eq. (1)",
    ),
    Generated(
        name="slowing",
        arguments=(kappa, torques, R, m, f_d),
        value=slowing,
        summary="Deceleration of the train by friction torques and running resistance",
        returns="Deceleration, without that of a grade [m/s2]",
        equation="from eq. (1)",
    ),
    Generated(
        name="micro_slip",
        arguments=(tau, R, C, k_AS),
        value=micro_slip,
        summary="Slip of a wheelset that adheres, by the linear theory",
        returns="Slip [-]",
        equation="from eqs. (5), (6)",
    ),
    Generated(
        name="tracked_rim",
        arguments=(shown, rim, rate, h, theta),
        value=tracked,
        summary="Speed and acceleration of a wheel rim after a measurement",
        returns="Speed [m/s] and acceleration [m/s2]",
        equation="filter with a double pole",
    ),
)
