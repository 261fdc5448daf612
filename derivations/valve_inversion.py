"""Inversion of the valve: the pulses that bring the braking torque to a wanted value within a sample, and its mean.

A sample of length h fills for the share a, then vents for the share b, and holds for the rest. In torques, T_in being
that of the demanded pressure, (9) gives T_a = T_in - (T_in - T) exp(-a h/T_F) and T+ = T_a exp(-b h/T_V).

Claims: the shares a = (T_F/h) ln((T_in - T)/(T_in - T*)) and b = (T_V/h) ln(T/T*) reach T* at the end of their pulse;
the mean over the sample is exact. Shares that were worked out with other times than those of the valve leave
T+ = T + rho (T* - T): to first order rho is the assumed time over the true one, and full steps have rho <= 1 where the
valve is not faster than assumed.
"""

import sympy as sp

from derivations.notation import Generated, symbols, time
from derivations.valve_map import filled, sampled

T, T_in, T_star, T_F, T_V, h = symbols("torque supply_torque target_torque fill_time vent_time sample_time")
fill, vent = symbols("fill vent")
_a, _b = sp.symbols("a b", nonnegative=True)  # as valve_map has them
_names = {sp.Symbol("T_in", positive=True): T_in, sp.Symbol("period", positive=True): h, _a: fill, _b: vent}

# --- a sample of pulses: torque after filling, at the end, and its mean ---------------------------------------
after_filling = filled.subs(_names)
after = sampled.subs(_names)
_filling = T_in - (T_in - T) * sp.exp(-time / T_F)
_area_filling = sp.integrate(_filling, (time, 0, fill * h))
_area_venting = sp.integrate(after_filling * sp.exp(-time / T_V), (time, 0, vent * h))
mean = (
    fill * T_in
    - (T_in - T) * T_F * (1 - sp.exp(-fill * h / T_F)) / h
    + after_filling * T_V * (1 - sp.exp(-vent * h / T_V)) / h
    + (1 - fill - vent) * after
)
mean_residual = sp.simplify(
    sp.expand(h * mean - _area_filling - _area_venting - (1 - fill - vent) * h * after)
)

# --- inversion ------------------------------------------------------------------------------------------------
fill_share = T_F / h * sp.log((T_in - T) / (T_in - T_star))
vent_share = T_V / h * sp.log(T / T_star)
filled_residual = sp.simplify(after.subs({vent: 0}).subs(fill, fill_share) - T_star)
vented_residual = sp.simplify(after.subs({fill: 0}).subs(vent, vent_share) - T_star)

# --- inversion with another time than that of the valve: x = T*/T or (T_in - T*)/(T_in - T), c = assumed/true ---
x, c = sp.symbols("x c", positive=True)
part = (1 - sp.exp(c * sp.log(x))) / (1 - x)  # rho, the part of the way that is gone, 1 - x^c over 1 - x


def _way(reached: sp.Expr, ratio: sp.Expr) -> sp.Expr:
    """What T + rho (T* - T) leaves over of a torque that was reached, where the ratio is x."""
    gone = (reached - T) / (T_star - T)
    return sp.simplify(sp.expand_log((gone - part.subs(x, ratio)), force=True))


part_residual = _way(after.subs({fill: 0}).subs(vent, c * vent_share), T_star / T)
part_fill_residual = _way(after.subs({vent: 0}).subs(fill, c * fill_share), (T_in - T_star) / (T_in - T))
small_step_residual = sp.simplify(sp.limit(part, x, 1) - c)
full_step_residual = sp.simplify(sp.limit(part.subs(c, sp.Rational(3, 5)), x, 0) - 1)

FUNCTIONS = (
    Generated(
        name="torque_after",
        arguments=(T, T_in, fill, vent, h, T_F, T_V),
        value=(after, mean),
        summary="Braking torque after a sample of filling, venting and holding, and its mean",
        returns="Torque at the end and mean torque [N m]",
        equation="solution of eq. (9)",
        meanings={"fill": "Share of the sample that fills [-]", "vent": "Share of it that vents [-]"},
    ),
    Generated(
        name="fill_share",
        arguments=(T, T_star, T_in, h, T_F),
        value=fill_share,
        summary="Share of a sample that fills to a wanted torque",
        returns="Above 1 where a sample does not suffice [-]",
        equation="solution of eq. (9)",
    ),
    Generated(
        name="vent_share",
        arguments=(T, T_star, h, T_V),
        value=vent_share,
        summary="Share of a sample that vents to a wanted torque",
        returns="Above 1 where a sample does not suffice [-]",
        equation="solution of eq. (9)",
    ),
)
