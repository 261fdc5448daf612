"""Filling and venting of a cylinder through one orifice, ISO 6358, from choked flow to equal pressures.

The air keeps its temperature and the cylinder its volume; all pressures here are absolute. The time of an orifice is
that in which choked flow would fill the cylinder from nothing to the supply pressure.
"""

from wspd_design.model.generated import valve_flow as generated
from wspd_design.model.number import Number, atan, exp, maximum, minimum, sqrt, where

ATMOSPHERE = 101325.0
"""Standard atmosphere, ISO 2533 [Pa]; normal litres are counted at this pressure."""
_NEAR_HALF = 1e-8  # distance of 2 b - 1 from 0 up to which the series is exact to the last digit


def flow_share(ratio: Number, critical_ratio: Number) -> Number:
    """Flow of an orifice over the choked one, by the absolute pressure behind it over that before it [-]."""
    beyond = (maximum(ratio, critical_ratio) - critical_ratio) / (1.0 - critical_ratio)
    return where(ratio <= critical_ratio, 1.0, sqrt(maximum(1.0 - beyond * beyond, 0.0)))


def orifice_filled(
    elapsed: Number, start: Number, supply: Number, flow_time: Number, critical_ratio: Number
) -> Number:
    """Pressure of a cylinder that an orifice fills from a constant supply.

    Parameters
    ----------
    elapsed : number
        Time since the filling started, not negative [s].
    start, supply : number
        Absolute pressures [Pa]; a cylinder above the supply keeps its pressure.
    flow_time : number
        Time of the orifice [s].
    critical_ratio : number
        Critical pressure ratio, in (0, 1) [-].

    Returns
    -------
    number
        Absolute pressure [Pa]; the supply is reached in finite time.
    """
    ratio = start / supply
    choked_for = flow_time * maximum(critical_ratio - ratio, 0.0)
    begin = minimum(maximum(ratio, critical_ratio), 1.0)
    angle = atan(sqrt(generated.tangent_squared(begin, critical_ratio)))
    later = maximum(elapsed - choked_for, 0.0) / (2.0 * (1.0 - critical_ratio) * flow_time)
    subsonic = generated.filled_ratio(maximum(angle - later, 0.0), critical_ratio)
    reached = where(elapsed < choked_for, ratio + elapsed / flow_time, subsonic)
    return maximum(supply * reached, start)


def orifice_vented(elapsed: Number, start: Number, flow_time: Number, critical_ratio: Number) -> Number:
    """Pressure of a cylinder that an orifice vents into the atmosphere.

    Parameters
    ----------
    elapsed : number
        Time since the venting started, not negative [s].
    start : number
        Absolute pressure, not below that of the atmosphere [Pa].
    flow_time : number
        Time of the orifice [s].
    critical_ratio : number
        Critical pressure ratio, in (0, 1) [-].

    Returns
    -------
    number
        Absolute pressure [Pa]; that of the atmosphere is reached in finite time.
    """
    ratio = minimum(ATMOSPHERE / start, 1.0)
    choked_for = maximum(generated.choked_vent_time(ratio, critical_ratio, flow_time), 0.0)
    tangent = sqrt(generated.tangent_squared(maximum(ratio, critical_ratio), critical_ratio))
    later = maximum(elapsed - choked_for, 0.0) / (2.0 * (1.0 - critical_ratio) * flow_time)
    left = maximum(generated.falling_tangent(tangent, _advance(later, critical_ratio), critical_ratio), 0.0)
    subsonic = ATMOSPHERE * generated.vented_ratio(left, critical_ratio)
    return where(elapsed < choked_for, start * exp(-elapsed / flow_time), subsonic)


def _advance(progress: Number, critical_ratio: Number) -> Number:
    """Solution of Y' = 1 + (2 b - 1) Y^2 from 0 on, up to values at which every cylinder is empty."""
    bend = 2.0 * critical_ratio - 1.0
    root = sqrt(maximum(abs(bend), _NEAR_HALF))
    near = generated.advance_near_half(minimum(progress, 2.0), critical_ratio)
    above = generated.advance_above_half(minimum(progress, 1.0 / root), root)
    below = generated.advance_below_half(progress, root)
    return where(abs(bend) < _NEAR_HALF, near, where(bend > 0.0, above, below))
