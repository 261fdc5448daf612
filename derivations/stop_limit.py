"""The shortest stop of any controller: the momentum that a filling brake has taken, and the adhesion peak.

Claims: (1) and (2) of all wheels add up to a momentum balance without creep force; a wheel that outruns the train is
slowed down by its creep force; the creep force grows with the friction. That load transfer lowers the sum of the peaks
is not among them: there are rails on which it raises it. The least wheel load bounds the sum on every rail.
"""

import sympy as sp

from derivations import adhesion, motion
from derivations.notation import symbol, symbols

v, m, R, inertia, f, f_d, T, B = symbols(
    "speed mass wheel_radius wheel_inertia creep_force resistance braking_torque wheel_damping"
)
v0, s, grip, eps, k_A, k_S = sp.symbols("v_0 s f_s epsilon k_A k_S", positive=True)

# --- momentum of the train and of eight wheels ------------------------------------------------------------
momentum_residual = sp.simplify(
    R * m * motion.train_acceleration
    + 8 * inertia * motion.wheel_acceleration
    - (-R * f_d - 4 * T - 8 * B * motion.omega)
)

# With R omega <= (1 + s) v at the end, over R; J = 8 inertia/R^2 is what the wheels add to the mass.
_wheels = 8 * inertia / R**2
_lost = m * (v0 - v) + _wheels * (v0 - (1 + s) * v)
overspeed_residual = sp.simplify((m + _wheels) * (v0 - v) - (_lost + _wheels * s * v))

# --- a wheel at the slip -s, whose creep force pulls the train ahead ----------------------------------------
_omega = (1 + s) * v / R
_at = {f: -grip, motion.omega: _omega}
_slip_rate = (-R * motion.wheel_acceleration / v + R * motion.omega / v**2 * motion.train_acceleration).subs(
    _at
)
_least = grip * (8 / m + R**2 / inertia) - (1 + s) * f_d / m
_helps = 8 * s * grip / m + (1 + s) * v * B / inertia + R * T / (2 * inertia)  # not negative
outrun_residual = sp.simplify(v * _slip_rate - (_least + _helps))

# --- the same wheel if the others differ: only the deceleration D of the train connects them -----------------
D = sp.Symbol("D", positive=True)
_other_rate = (-R * motion.wheel_acceleration / v - R * motion.omega / v**2 * D).subs(_at)
_held = grip * R**2 / inertia - (1 + s) * D
outrun_others_residual = sp.simplify(
    v * _other_rate - (_held + (1 + s) * v * B / inertia + R * T / (2 * inertia))
)

# --- the creep force over 2 Q/pi is mu S(c/mu); its derivative in mu is S - eps S', eps = c/mu ---------------
_x, _y = k_A * eps, k_S * eps
shape = _x / (1 + _x**2) + sp.atan(_y)
_surplus = 2 * _x**3 / (1 + _x**2) ** 2 + sp.atan(_y) - _y / (1 + _y**2)
friction_residual = sp.simplify(shape - eps * sp.diff(shape, eps) - _surplus)
_t = sp.Symbol("t", positive=True)
surplus_rate_residual = sp.simplify(
    sp.diff(sp.atan(_t) - _t / (1 + _t**2), _t) - 2 * _t**2 / (1 + _t**2) ** 2
)


# --- load transfer: the contact stiffness grows with the load to the power 2/3 (Hertz) -------------------------
_LOAD, _STIFFNESS = 94_226.0, 1.107e7  # N: mean wheel load, and the contact stiffness under it


def largest_force(load: float, speed: float, **rail: float) -> float:
    """Largest creep force [N] of any slip up to 1 at a load [N] and a speed [m/s], by sampling (5-7)."""
    laws = adhesion.force_of_gradient.subs(adhesion.gradient, adhesion.gradient_of_slip)
    numbers = {symbol(name): value for name, value in rail.items()}
    numbers |= {adhesion.Q: load, adhesion.C: _STIFFNESS * (load / _LOAD) ** (2 / 3)}
    force = laws.subs(adhesion.mu, adhesion.friction_printed).subs(adhesion.w, speed * adhesion.slip)
    of_slip = sp.lambdify(adhesion.slip, force.subs(numbers), "math")
    return max(of_slip(1.005**-n) for n in range(1500))


_rail = {
    "mu0": 0.42,
    "friction_ratio": 0.15,
    "friction_decay": 0.6,
    "adhesion_reduction": 0.2,
    "slip_reduction": 0.04,
}
_heavy, _light, _mean = (largest_force(share * _LOAD, 57 / 3.6, **_rail) for share in (1.3, 0.7, 1.0))
load_transfer_example = (_heavy + _light) / (2 * _mean) - 1  # relative gain of the sum of the peaks
