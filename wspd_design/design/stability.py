"""Whether a law with friction-torque observer is stable on the whole box, as a constraint for the search of its gains.

In doubles, at corners of the box and at two speeds: what a search needs, and no certificate.
"""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from fractions import Fraction
from itertools import product
from typing import Any

from wspd_design.certificates.search.common_quadratic import contraction
from wspd_design.certificates.search.slip_band.search import usual
from wspd_design.certificates.setting.slip_loop import (
    DISTURBANCES,
    STATES,
    LoopLaw,
    LoopRanges,
    Pair,
    Way,
    corners,
    latest_share,
    parts_of,
)
from wspd_design.certificates.theorems.slip_band.loop import Conditions
from wspd_design.certificates.theorems.slip_band.proof import ROOM
from wspd_design.controllers.observer_smc import ObserverSmc
from wspd_design.controllers.protection import Protection
from wspd_design.design.problem import stated_bounds
from wspd_design.model.generated.slip_loop import added_by_supply
from wspd_design.model.number import exp
from wspd_design.model.slip import slip_dynamics
from wspd_design.parameters.bounds import Ends
from wspd_design.parameters.records import Rail, Vehicle

SLIP_AROUND = (
    0.05  # -, on either side of the reference at the lowest speed; the same wheel speed at the others
)
SLIPS = 65  # at which the friction is looked at
NEXT_TO_ZERO = (
    1e-6  # 1/s, in place of a secant of 0, and relative distance of the nearest slip from the reference
)
"""A secant of 0 would be a division by 0; so would a range of secants without width."""


def closes(law: Any, vehicle: Vehicle, rail: Rail, *, speeds: Ends, share: float = 1.0) -> float | None:
    """Look for quadratic functions that fall along the sampled loop, whatever the friction does within its secants.

    One function for each corner of valve times, pads, inertia and friction, at the lowest speed and at the geometric
    mean of both; the valve is not saturated, its pulses begin up to its dead time late and end in their sample, the
    supply is as full as it gets, pressures are measured.
    The functions are found in doubles on sampled friction: a constraint for a search, not a proof.

    Parameters
    ----------
    law : controller
        Anything; only a protection of sliding mode with observer of the friction torque is spoken about.
    vehicle : Vehicle
        Nominal values.
    rail : Rail
        Friction.
    speeds : tuple of float
        Lowest and highest train speed [m/s].
    share : float
        Part of the box: the range of each number is this much of the stated one, around the nominal value.

    Returns
    -------
    float or None
        The largest factor by which the state falls per sample, below 1; None if no function was found for some corner,
        or the law is another one.
    """
    if not isinstance(law, Protection) or not isinstance(law.core, ObserverSmc):
        return None
    conditions = usual(vehicle, Fraction(law.sample_time))
    if conditions.delay >= 1:  # no pulse ends in its sample
        return None
    loop = loop_of(law, law.core)
    box = _box(vehicle, rail, share)
    worst = 0.0
    for speed in (speeds[0], (speeds[0] * speeds[1]) ** 0.5):
        around = SLIP_AROUND * speeds[0] / speed
        for apart in _corners(law, vehicle, rail, box, speed, around, conditions):
            found = _worst_of(loop, apart)
            if found is None:
                return None
            worst = max(worst, found)
    return worst


def _box(vehicle: Vehicle, rail: Rail, share: float) -> dict[str, Ends]:
    """Ranges of what differs between the corners, narrowed around the nominal values."""
    brake, bounds = vehicle.brake, stated_bounds(vehicle, rail)
    nominal = {
        "mass": vehicle.mass,
        "mu0": rail.mu0,
        "wheelset inertia": vehicle.wheelset_inertia,
        "max torque": brake.max_torque,
        "fill time": brake.fill_time,
        "vent time": brake.vent_time,
        "supply rate": brake.supply_rate,
    }
    ends = {name: bounds.around(name, value) for name, value in nominal.items()}
    return {
        name: (value + share * (ends[name][0] - value), value + share * (ends[name][1] - value))
        for name, value in nominal.items()
    }


def loop_of(law: Protection, core: ObserverSmc) -> LoopLaw:
    """Return the numbers of a law that its sampled loop depends on."""
    return LoopLaw(
        sample_time=law.sample_time,
        gain=core.tracking.approach_rate * law.sample_time,
        ahead=core.tracking.ahead,
        pole=exp(-law.observer_rate * law.sample_time),
        kept=0.0,  # the filter of the acceleration has settled
    )


def _worst_of(loop: LoopLaw, apart: tuple[LoopRanges, LoopRanges]) -> float | None:
    """Try one function for all friction, then one each for the most and the least."""
    secants = [end for each in apart for end in each.secants]
    together = replace(apart[0], secants=(min(secants), max(secants)))
    found = _contraction(loop, together)
    if found is not None:
        return found
    alone = [_contraction(loop, each) for each in apart]
    return None if None in alone else max(each for each in alone if each is not None)


def _contraction(loop: LoopLaw, ranges: LoopRanges) -> float | None:
    import numpy as np

    units = list(np.eye(STATES + len(DISTURBANCES)))
    return contraction(rest for rest, _ in corners(loop, ranges, units))


def _corners(
    law: Protection,
    vehicle: Vehicle,
    rail: Rail,
    box: Mapping[str, Ends],
    speed: float,
    around: float,
    conditions: Conditions,
) -> Iterator[tuple[LoopRanges, LoopRanges]]:
    """Ranges of the loop at the corners of pads, inertia and valve, with the least and the most friction."""
    inertias, torques = box["wheelset inertia"], box["max torque"]
    fills, vents = box["fill time"], box["vent time"]
    share, modeled = law.valve.time_share, law.valve.brake
    assumed = share * modeled.fill_time, share * modeled.vent_time
    delay, pulse = float(conditions.delay), float(1 - conditions.delay)
    longest = pulse * law.sample_time / min(assumed)
    seen = parts_of((share, share), longest)
    times = ((fills[0], vents[0]), (fills[1], vents[1]), (fills[0], vents[1]), (fills[1], vents[0]))
    slip = float(law.reference.at(speed, 1.0).slip)
    for (inertia, torque), (fill, vent) in product(zip(inertias, reversed(torques), strict=True), times):
        effect = torque / vehicle.brake.max_torque * law.wheelset_inertia / inertia
        added = 0.0
        if conditions.supply < 1:
            rate = box["supply rate"][1]
            added = added_by_supply(rate, fill, law.sample_time, pulse, delay, float(ROOM))
        filling, venting = (
            parts_of((each, each), longest) for each in (assumed[0] / fill, assumed[1] / vent)
        )
        parts = min(filling[0], venting[0]), max(filling[1] * (1.0 + added), venting[1])
        ranges = []
        for mass, mu0 in zip(box["mass"], box["mu0"], strict=True):
            secants = _secants(
                replace(vehicle, mass=mass, wheelset_inertia=inertia),
                replace(rail, mu0=mu0),
                slip,
                speed,
                around,
            )
            late = latest_share(secants[1] * law.sample_time, pulse, delay, added)
            mean = (1.0 - 0.5 * pulse) * seen[0], seen[1]
            ranges.append(
                LoopRanges(
                    secants=secants,
                    effects=(effect, effect),
                    ways=tuple(
                        Way(part, part, *shares) for part, *shares in product(parts, (0.0, late), mean)
                    ),
                    shares_center=(0.0, seen[1]),  # nothing is asked about what disturbs
                )
            )
        yield ranges[0], ranges[1]


def _secants(vehicle: Vehicle, rail: Rail, slip: float, speed: float, around: float) -> Pair:
    """Range of the secants of the friction torque over the wheel speed, over the inertia [1/s]."""
    import numpy as np

    slips = np.linspace(max(slip - around, 0.0), slip + around, SLIPS)
    slips = slips[abs(slips - slip) > NEXT_TO_ZERO]
    force = slip_dynamics(vehicle, rail, slips, speed).creep_force
    held = slip_dynamics(vehicle, rail, slip, speed).creep_force
    per_wheel_speed = -vehicle.wheel_radius / speed  # of the slip
    secants = (
        2.0
        * vehicle.wheel_radius
        * (force - held)
        / (slips - slip)
        * per_wheel_speed
        / vehicle.wheelset_inertia
    )
    low, high = float(secants.min()), float(secants.max())
    return low - NEXT_TO_ZERO, high + NEXT_TO_ZERO
