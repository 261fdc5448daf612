"""Mended adaptive fuzzy law: a surface that the valve moves at once, and an adaptation that stays bounded.

On sigma = e' + k e, e the rim speed above the desired one, the valve acts in the first derivative: filling for the
share u of the time changes the torque by T' = u (T_in - T)/T_F, so that sigma' = g (u* - u) with
g = R (T_in - T)/(J T_F) and u* the command that keeps sigma. The law is u = sum b_r w_r + psi sat(sigma/Phi), its
weights adapt with b_r' = alpha (sigma_D w_r - leakage b_r), sigma_D = sigma - Phi sat(sigma/Phi).

Claims: outside the layer V = sigma_D^2/(2 g) + sum (b_r - b*_r)^2/(2 alpha) has, for weights b* that make u* up to an
error below psi, no term of sigma_D and b_r - b*_r together, so that V' <= -leakage sum b_r (b_r - b*_r); that is
negative where the weights are larger than the ideal ones. Neither g nor anything of the friction stands in the law.
"""

import sympy as sp

from derivations.notation import Generated, symbols

e, e_rate, k = symbols("rim_error rim_error_rate approach_rate")
sigma, strength, b, alpha, leak = symbols("driving_surface rule_strength rule_weight share_rate leakage")

surface = e_rate + k * e
weight_rate = alpha * (sigma * strength - leak * b)

# --- relative degree: e' = R (tau - T)/J - v_r', T' = u (T_in - T)/T_F ---------------------------------------------
u, g, ideal, psi, xi = sp.symbols("u g b_ideal psi xi", real=True)
R, T, T_in, T_F, J, T_rate, rest = sp.symbols("R T T_in T_F J T_rate r", positive=True)
_torque_rate = u * (T_in - T) / T_F
_error_acceleration = rest - R / J * T_rate
surface_rate = (_error_acceleration + k * e_rate).subs(T_rate, _torque_rate)
degree_residual = sp.simplify(sp.diff(surface_rate, u) + R * (T_in - T) / (J * T_F))

# --- Lyapunov function outside the layer, sigma > Phi, for one rule ------------------------------------------------
_command = b * strength + psi  # sat = 1
_needed = ideal * strength + xi  # u*, with an error xi that no weights make
_V_rate = sigma * (_needed - _command) + (b - ideal) * weight_rate / alpha  # sigma_D sigma'/g + ...
lyapunov_residual = sp.expand(_V_rate - (sigma * (xi - psi) - leak * b * (b - ideal)))
leak_residual = sp.expand(-b * (b - ideal) - (-((b - ideal / 2) ** 2) + ideal**2 / 4))

FUNCTIONS = (
    Generated(
        name="surface",
        arguments=(e, e_rate, k),
        value=surface,
        summary="Surface of relative degree one in the valve",
        returns="Surface [m/s2]",
        equation="mended eq. (22)",
    ),
    Generated(
        name="weight_rate",
        arguments=(sigma, strength, b, alpha, leak),
        value=weight_rate,
        summary="Rate at which the weight of a rule adapts",
        returns="Rate [1/s]",
        equation="mended eq. (41)",
    ),
)
