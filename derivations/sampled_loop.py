"""The loop with sampling and lag: slip poles that a gain stabilizes, quadratic functions, the one-sample map.

Claims: with proportional feedback of the sampled slip one root of the loop lies at z = 1 for the gain K = p, where
the other one decides; in errors of sliding speed and torque the loop is affine in p - a/v, so that vertices decide;
the slip obeys a scalar equation that rises with the torque.
"""

import sympy as sp

from derivations import slip_equation
from derivations.notation import symbols, time

p, tau, h, K, z = sp.symbols("p tau h K z", positive=True)
alpha, beta = sp.symbols("alpha beta", positive=True)  # exp(p h), exp(-h/tau)

# --- sampling: the plant 1/((s - p)(tau s + 1)) behind a hold, from its step response -----------------------
_fast = (alpha - 1) / (p * (1 + p * tau))
_slow = (beta - 1) * tau / (1 + p * tau)
b1, b0 = _fast + _slow, -_fast * beta - _slow * alpha
_step = (sp.exp(p * time) - 1) / (p * (1 + p * tau)) + tau * (sp.exp(-time / tau) - 1) / (1 + p * tau)
step_residual = sp.simplify(  # (d/dt - p)(tau d/dt + 1) of the step response is the step
    tau * sp.diff(_step, time, 2) + (1 - p * tau) * sp.diff(_step, time) - p * _step - 1
)
static_residual = sp.simplify((b1 + b0) / ((1 - alpha) * (1 - beta)) + 1 / p)
polynomial = z**2 - (alpha + beta) * z + alpha * beta + K * (b1 * z + b0)
other_root = (beta + p * tau * alpha) / (1 + p * tau)
roots_residual = sp.simplify(sp.expand(polynomial.subs(K, p) - (z - 1) * (z - other_root)))
product_residual = sp.simplify(
    b0 * p * (1 + p * tau) / (alpha * beta) - (p * tau * (1 / beta - 1) - (1 - 1 / alpha))
)
condition_residual = sp.simplify((1 - other_root) * (1 + p * tau) - (1 - beta - p * tau * (alpha - 1)))

# --- quadratic function: y = v e, w = gamma (T - T*)/T_max what the torque changes of y' -----------------------
q, gamma, kappa, back, decay, kept = sp.symbols("q gamma kappa K_T alpha_V c_V", real=True)
y, w, v, a, R, I_w, T_max = sp.symbols("y w v a R I_w T_max", positive=True)
_error_rate = p * (y / v) - w / v  # of e = y/v, from (19) near the reference: w = R (T - T*)/I_w
sliding_residual = sp.simplify((v * _error_rate - a * (y / v)) - (q * y - w).subs(q, p - a / v))
fill, vent, duty, torque_share = sp.symbols("T_F T_V u_0 theta_0", positive=True)
forgetting, driving = sp.symbols("a_V b_V", positive=True)
_duty = duty + kappa * y - back * w / gamma  # of the law, gamma = R T_max/I_w
_share = torque_share + w / gamma
_averaged = gamma * (
    _duty * (1 - _share) / fill - (1 - _duty) * _share / vent
)  # w' of the valve (9), averaged
_still = {w: 0, y: 0}
forgetting_of_valve = duty / fill + (1 - duty) / vent
driving_of_valve = (1 - torque_share) / fill + torque_share / vent
rates = sp.Matrix([[q, -1], [driving * gamma * kappa, -(forgetting + driving * back)]])
_of_valve = {forgetting: forgetting_of_valve, driving: driving_of_valve}
loop_residual = sum(
    sp.simplify(sp.diff(_averaged, state).subs(_still) - entry.subs(_of_valve)) ** 2
    for state, entry in zip((y, w), rates.row(1), strict=True)
)
entries = sp.symbols("P_11 P_12 P_22", real=True)
_P = sp.Matrix([entries[:2], entries[1:]])
any_matrix = sp.Matrix(2, 2, sp.symbols("A_11 A_12 A_21 A_22", real=True))
_a11, _a12, _a21, _a22 = any_matrix
_p11, _p12, _p22 = entries


def _difference(written: tuple[sp.Expr, ...], matrix: sp.Matrix) -> sp.Expr:
    """Sum of squares of what differs from the entries 11, 12, 22: zero only if every entry agrees."""
    upper = matrix[0, 0], matrix[0, 1], matrix[1, 1]
    return sp.expand(
        sum(sp.expand(one - other) ** 2 for one, other in zip(written, upper, strict=True))
        + sp.expand(matrix[0, 1] - matrix[1, 0]) ** 2
    )


# The entries 11, 12, 22 as a program evaluates them; tests compare the checker's functions with these.
decrease = (
    -2 * (_p11 * _a11 + _p12 * _a21) - 2 * decay * _p11,
    -(_p11 * _a12 + _p12 * (_a11 + _a22) + _p22 * _a21) - 2 * decay * _p12,
    -2 * (_p12 * _a12 + _p22 * _a22) - 2 * decay * _p22,
)
decrease_residual = _difference(decrease, -(any_matrix.T * _P + _P * any_matrix) - 2 * decay * _P)
contraction = (
    kept**2 * _p11 - (_p11 * _a11**2 + 2 * _p12 * _a11 * _a21 + _p22 * _a21**2),
    kept**2 * _p12 - (_p11 * _a11 * _a12 + _p12 * (_a11 * _a22 + _a12 * _a21) + _p22 * _a21 * _a22),
    kept**2 * _p22 - (_p11 * _a12**2 + 2 * _p12 * _a12 * _a22 + _p22 * _a22**2),
)
contraction_residual = _difference(contraction, kept**2 * _P - any_matrix.T * _P * any_matrix)
affine_residual = sp.expand(
    sum(
        entry.diff(*twice) ** 2
        for entry in rates
        for twice in ((q, q), (forgetting, forgetting), (driving, driving), (q, driving), (q, forgetting))
    )
)
_pivot = _p22 - _p12**2 / _p11
pivots_residual = sp.simplify(
    (sp.Matrix([[y, w]]) * _P * sp.Matrix([y, w]))[0] - (_p11 * (y + _p12 / _p11 * w) ** 2 + _pivot * w**2)
)
_theta = sp.Symbol("theta", positive=True)
_one, _two = sp.Matrix(sp.symbols("a_1 a_2", real=True)), sp.Matrix(sp.symbols("b_1 b_2", real=True))


def _square(vector: sp.Matrix) -> sp.Expr:
    return (vector.T * _P * vector)[0]


convex_residual = sp.expand(
    _theta * _square(_one)
    + (1 - _theta) * _square(_two)
    - _square(_theta * _one + (1 - _theta) * _two)
    - _theta * (1 - _theta) * _square(_one - _two)
)

# --- one-sample map: the rate of the slip, and that it rises with the torque ----------------------------------
slip, speed, f, f_d, mass, inertia, radius, torque, damping = symbols(
    "slip speed creep_force resistance mass wheel_inertia wheel_radius braking_torque wheel_damping"
)
_force = torque / 2 - radius * f
_rate = (radius * _force / inertia - (1 - slip) * (f_d + 8 * f) / mass) / speed + (
    1 - slip
) * damping / inertia
map_residual = sp.simplify(_rate - (slip_equation.drift + slip_equation.slip_gain * torque))
torque_slope_residual = sp.simplify(sp.diff(_rate, torque) - radius / (2 * inertia * speed))
