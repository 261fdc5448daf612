"""The adaptive loop near its reference, with valve lag: the polynomial with the adaptation (41) and without.

Claims: with b_hat moving as in (41) the poles are the roots of tau q^4 + (1 - p tau) q^3 + (G K_P k_s - p) q^2 +
G (K_I k_s + K_P kappa) q + G K_I kappa, kappa = alpha_1 w'w, k_s = du/ds, and zeros of directions in which the
equilibrium is free; psi_hat does not enter, because abs(s) s is of second order. With b_hat and psi_hat frozen
kappa is 0. A law with dead zone does not adapt inside its layer: for it the frozen loop is the loop.
"""

import sympy as sp

from derivations.notation import symbols

p, G, tau, K_P, K_I = symbols("pole gain time_constant proportional_gain integral_gain")
alpha1, alpha2, Phi = symbols("weight_rate bound_rate layer")
k_s, kappa, q = sp.symbols("k_s kappa q", real=True)

# --- (22), (36), (37), (41), (42) with two rules, inside the layer; deviations from slip_d, T*, int e of rest ----
e, torque, E, psi, size = sp.symbols("e T E psi_hat abs_s", real=True)
weights = sp.Matrix(sp.symbols("b_1 b_2", real=True))
_basis = [sp.Function(f"w_{n}", real=True) for n in (1, 2)]
_s = K_P * e + K_I * E
_w = sp.Matrix([basis(_s) for basis in _basis])
law = (weights.T * _w)[0] + psi * _s / Phi
state = (e, torque, E, *weights, psi)
rates = sp.Matrix(  # e' = p e - G T of (19), the lag (14), E' = e, the adaptation
    [p * e - G * torque, (law - torque) / tau, e, *(alpha1 * _s * _w), alpha2 * size]
)
# abs(s) has no derivative at 0, but psi_hat only multiplies s, which vanishes there: its column decides nothing.
_rest = {e: 0, E: 0}
jacobian = rates.jacobian(state).subs(_rest).doit()
_at_rest = sp.Matrix([basis(0) for basis in _basis])
slope = sp.diff(law, e).subs(_rest).doit() / K_P  # du/ds
_named = sp.symbols("w_1 w_2", real=True)
_derivative = sp.Symbol("k_b", real=True)


def _simple(expression: sp.Expr) -> sp.Expr:
    """Write w'w and du/ds by their names; ``w_n(0)`` become symbols."""
    return sp.expand(expression.subs(dict(zip(_at_rest, _named, strict=True))))


characteristic = (
    tau,
    1 - p * tau,
    G * K_P * k_s - p,
    G * (K_I * k_s + K_P * kappa),
    G * K_I * kappa,
)
_stated = sum(each * q**n for n, each in zip(range(4, -1, -1), characteristic, strict=True))
_meant = {k_s: slope, kappa: alpha1 * (_at_rest.T * _at_rest)[0]}
_found = tau * (q * sp.eye(len(state)) - jacobian).det(method="berkowitz")
characteristic_residual = sp.simplify(_simple(sp.expand(_found - q**2 * _stated.subs(_meant))))
frozen_residual = sp.expand(
    _stated.subs(kappa, 0) - q * (tau * q**3 + (1 - p * tau) * q**2 + (G * K_P * k_s - p) * q + G * K_I * k_s)
)
