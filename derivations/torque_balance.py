"""Table 10: the torque integral is a momentum balance, hence nearly the same for every controller.

Claim: integrating R times (1) plus 8 times (2) over the stop leaves sum int T dt = R m v0 + 8 I omega0 - R
int f_d dt - 8 int B_W omega dt: initial momentum less what others took, as long as no wheel is locked (the brake
then holds with less than T). The eight printed integrals spread by 1.35 % while the stopping times spread by 29 %:
not a measure of air consumption.
"""

import sympy as sp

from derivations import motion
from derivations.notation import symbols, time

f, f_d, m, R, inertia, T, damping = symbols(
    "creep_force resistance mass wheel_radius wheel_inertia braking_torque wheel_damping"
)
v0, omega0, t_stop = sp.symbols("v_0 omega_0 t_stop", positive=True)
f_t, f_d_t, T_t, omega_t, B_W = (
    sp.Function(name, real=True)(time) for name in ("f", "f_d", "T", "omega", "B_W")
)

# --- momentum over the stop: v and omega fall from v0 and omega0 to zero ----------------------------------
_of_time = {f: f_t, f_d: f_d_t, T: T_t, motion.omega: omega_t, damping: B_W}
momentum_rate = sp.expand(
    (R * m * motion.train_acceleration + 8 * inertia * motion.wheel_acceleration).subs(_of_time)
)
momentum_change = -(R * m * v0 + 8 * inertia * omega0)


def _over_stop(integrand: sp.Expr) -> sp.Integral:
    return sp.Integral(integrand, (time, 0, t_stop))


# The integrals of the rate and the change of momentum are equal; solve for the torque of the four wheelsets.
torque_symbol = sp.Symbol("torque_integral")
_integrated = sum(
    coefficient * _over_stop(part)
    for part in (f_t, f_d_t, B_W * omega_t)
    if (coefficient := momentum_rate.coeff(part)) != 0
)
torque_integral_derived = sp.solve(sp.Eq(_integrated - torque_symbol, momentum_change), torque_symbol)[0]
torque_integral = R * m * v0 + 8 * inertia * omega0 - R * _over_stop(f_d_t) - 8 * _over_stop(B_W * omega_t)
torque_coefficient = momentum_rate.coeff(T_t)  # -4: one torque per wheelset
identity_residual = sp.simplify(torque_integral_derived - torque_integral)

# --- Table 10 as printed: stopping time in s, sum of the torque integrals in kN m s -----------------------
TABLE_10 = {
    ("Trenitalia", "dry"): ("9.9", "1572.48"),
    ("Trenitalia", "wet"): ("12.3", "1564.66"),
    ("Knorr-Bremse", "dry"): ("10.5", "1570.26"),
    ("Knorr-Bremse", "wet"): ("13.1", "1576.44"),
    ("Mitsubishi", "dry"): ("10.5", "1556.8"),
    ("Mitsubishi", "wet"): ("12.8", "1570.31"),
    ("AFSMC", "dry"): ("9.8", "1578.03"),
    ("AFSMC", "wet"): ("12.2", "1565.84"),
}


def spread(column: int) -> sp.Rational:
    """Largest less smallest value of a column of Table 10, relative to its mean [-]."""
    values = [sp.Rational(row[column]) for row in TABLE_10.values()]
    return (max(values) - min(values)) * len(values) / sum(values)


def wheelset_inertias() -> dict[tuple[str, str], float]:
    """Wheelset inertia that each row implies without running resistance, 2 I of the identity [kg m2]."""
    mass, radius, speed = sp.Rational(76841), sp.Rational("0.55"), sp.Rational(120) / sp.Rational("3.6")
    per_wheel = sp.solve(sp.Eq(torque_symbol, radius * mass * speed + 8 * inertia * speed / radius), inertia)[
        0
    ]
    return {
        key: float(2 * per_wheel.subs(torque_symbol, sp.Rational(row[1]) * 1000))
        for key, row in TABLE_10.items()
    }
