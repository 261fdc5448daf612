"""What the protection makes of a sample of a wheelset that is followed from rolling, in affine forms."""

from collections.abc import Callable, Sequence
from functools import partial
from typing import NamedTuple

import numpy as np

from wspd_design.certificates.kernel.affine import Affine, Array, Where, between, chosen, constant
from wspd_design.certificates.theorems.slip_band.followed_plant import Plant, State
from wspd_design.controllers.observer_smc import approach
from wspd_design.controllers.protection import Protection
from wspd_design.model.generated import slip_tracking

LEAST = 1e-3  # of the full torque, and in N m: as the inversion of the valve


class Decided(NamedTuple):
    """What the law makes of a sample."""

    fill: Affine  # -, share of the sample
    vent: Affine  # -
    friction: Affine  # N m
    acceleration: Affine  # m/s2
    innovation: Affine  # m/s, of the next sample, but for the way of the wheel
    way: Affine  # N m, that is asked of the valve, at most what it can go in a sample
    even: Where  # whether the torque goes that way nearly in proportion
    filling: Where  # whether it may be upwards
    across: Where  # whether it is open that the valve fills or vents


def decide(law: Protection, plant: Plant, state: State, fresh: Callable[[Affine], Affine]) -> Decided:
    """What the protection computes and commands, for one of its wheelsets, all of them alike."""
    tracking, valve, h = law.core.tracking, law.valve, law.sample_time  # type: ignore[attr-defined]
    inertia, over_radius = law.wheelset_inertia, plant.curvature
    slip = law.reference.slip  # type: ignore[attr-defined]
    pole, full = float(np.exp(-law.observer_rate * h)), valve.brake.max_torque
    acceleration = known_acceleration(law, state)
    friction = fresh(observed_friction(law, plant, state).positive_part())
    rate = acceleration * over_radius * (1.0 - slip)
    error = slip_tracking.predicted_error(
        (state.speed * slip - state.sliding) * over_radius,
        friction,
        state.torque,
        rate,
        inertia,
        h,
        tracking.ahead,
    )
    pull = _pull(error, tracking.approach_rate, law.core.torque_slew / inertia)  # type: ignore[attr-defined]
    available, least = state.supply * full, LEAST * full + LEAST
    wanted = slip_tracking.target_torque(friction, rate, pull, inertia)
    target = fresh(wanted.positive_part().at_most(available))
    way = target - state.torque
    up = fresh(way.positive_part())
    down = up - way  # written so that what filling and venting have in common cancels
    left_out, pulse = tracking.dead_band, valve.least_pulse / h
    share = partial(_share, left_out=left_out, pulse=pulse)
    room = (available - state.torque).at_least(least)
    lengths = [valve.time_share * each / h for each in (valve.brake.fill_time, valve.brake.vent_time)]
    speeds = [h / each for each in (valve.brake.fill_time, valve.brake.vent_time)]
    fill = share(up, room, lengths[0], least)
    vent = share(down, state.torque.at_least(least), lengths[1], least)
    rooms = available - state.torque, state.torque
    asked = fresh(_asked(way, rooms, lengths))
    even = _even(way, rooms, lengths, least)
    if left_out or pulse:  # some of the way is left out
        even = np.zeros_like(even)
    filling = way.high > 0.0
    across = even & filling & (way.low < 0.0)
    parts = _shares(asked, rooms, lengths, least)
    fill, vent = (fresh(chosen(even, one, other)) for one, other in zip(parts, (fill, vent), strict=True))
    powers = [constant(length * speed, way) for length, speed in zip(lengths, speeds, strict=True)]
    change = went(asked, rooms, powers, lengths, 0.0)
    rise, fall = moved(available, state.torque, fill, vent, *speeds)
    rise, fall = apart(change, rise, fall, even, filling)
    mean = state.torque + rise - _missed(rise, fill, speeds[0]) - fall + _missed(fall, vent, speeds[1])
    late = (
        0.5 * np.maximum(end, 0.0) * share.high
        for end, share in zip((change.high, -change.low), parts, strict=True)
    )
    mean = chosen(across, (state.torque + change).widened(*late), mean)
    innovation = (
        state.sliding
        - state.speed
        + state.innovation * pole**2
        - (friction - mean) * plant.radius * (h / inertia)
    )
    return Decided(fill, vent, friction, acceleration, innovation, asked, even, filling, across)


def known_acceleration(law: Protection, state: State) -> Affine:
    """Acceleration of the train that the filter of the law has after a measurement [m/s2]."""
    h = law.sample_time
    new = float(-np.expm1(-h / law.source.acceleration_time))  # type: ignore[attr-defined]
    return state.acceleration + (state.change * (1.0 / h) - state.acceleration) * new


def observed_friction(law: Protection, plant: Plant, state: State) -> Affine:
    """Friction torque that the observer has after a measurement [N m]; the law takes none below 0."""
    h, pole = law.sample_time, float(np.exp(-law.observer_rate * law.sample_time))
    learned = law.wheelset_inertia * (1.0 - pole) ** 2 / h
    return state.friction + state.innovation * plant.curvature * learned


def _pull(error: Affine, rate: float, slew: float) -> Affine:
    """Pull to the reference, a concave function of the error."""

    def touching(slope: Array) -> tuple[Array, ...]:
        return (
            np.where(slope > 0.0, (slew / np.maximum(slope, 1e-9)) ** 2, 0.0) / (2.0 * slew)
            + slew / (2.0 * rate**2),
        )

    return error.along(lambda e: np.asarray(approach(e, rate, slew)), touching)


def _share(
    way: Affine, room: Affine, length: float, least: float, *, left_out: float, pulse: float
) -> Affine:
    """Share of the sample that goes a way in a room, at most all of it; dead band and shortest pulse leave some out."""
    longest = float(-np.expm1(-1.0 / length))
    part = (way * room.inverse(least=least)).at_most(longest)

    def touching(slope: Array) -> tuple[Array, ...]:
        return (1.0 - length / np.maximum(slope, length),)

    # Beyond the longest part the logarithm is not asked, and below 0 there is nothing but the width of the form.
    share = part.along(lambda y: -length * np.log1p(-np.minimum(y, 0.999)), touching)
    skipped = np.maximum(
        pulse, -length * np.log1p(-np.minimum(left_out / np.maximum(room.low, least), 0.999))
    )
    below = np.minimum(skipped, 1.0) if left_out or pulse else np.zeros_like(share.center)
    # In so little room the law takes its logarithm of another ratio, and may command less.
    below = np.where(room.low < least * np.exp(1.0 / length), np.maximum(share.high, below), below)
    return share.widened(below, 0.0)


def moved(
    supply: Affine,
    torque: Affine,
    fill: Affine,
    vent: Affine,
    filling: Affine | float,
    venting: Affine | float,
) -> tuple[Affine, Affine]:
    """What filling adds and what venting then takes off; sample time over the times of the valve."""
    rise = (supply - torque) * (1.0 - (-(fill * filling)).exp())
    fall = (torque + rise) * (1.0 - (-(vent * venting)).exp())
    return rise, fall


def _asked(way: Affine, rooms: Sequence[Affine], lengths: Sequence[float]) -> Affine:
    """Way to the target, at most what fills or vents over the whole sample."""
    longest, least = (_longest(room, length) for room, length in zip(rooms, lengths, strict=True))
    return way.at_most(longest).at_least(-least)


def _even(way: Affine, rooms: Sequence[Affine], lengths: Sequence[float], least: float) -> Where:
    """Whether a way is taken as one number, whose change is nearly in proportion to it.

    Not where the valve fills or vents all of the sample for sure, and not where there is too little room.
    """
    found = (_longest(rooms[0], lengths[0]) - way).high > 0.0
    found &= (way + _longest(rooms[1], lengths[1])).high > 0.0
    for each, length in zip(rooms, lengths, strict=True):
        found &= each.low > least * np.exp(1.0 / length)
    return found


def _longest(room: Affine, length: float) -> Affine:
    """Way that is asked of a valve that does all of the sample what it does."""
    return room * float(-np.expm1(-1.0 / length))


def _shares(
    asked: Affine, rooms: Sequence[Affine], lengths: Sequence[float], least: float
) -> tuple[Affine, ...]:
    """Shares of the sample that go the way, for filling and for venting, as nothing but ranges."""
    found = []
    for way, room, length in zip((asked, -asked), rooms, lengths, strict=True):
        longest = float(-np.expm1(-1.0 / length))
        ends = way.low / np.maximum(room.high, least), way.high / np.maximum(room.low, least)
        low, high = (-length * np.log1p(-np.clip(end, 0.0, longest)) for end in ends)
        found.append(between(low, high, asked))
    return tuple(found)


def apart(change: Affine, rise: Affine, fall: Affine, even: Where, filling: Where) -> tuple[Affine, Affine]:
    """What filling adds and venting takes off, where they are even; all of it by filling where that is open."""
    none = constant(0.0, change)
    return (
        chosen(even, chosen(filling, change, none), rise),
        chosen(even, chosen(filling, none, -change), fall),
    )


def went(
    asked: Affine,
    rooms: Sequence[Affine],
    powers: Sequence[Affine],
    lengths: Sequence[float],
    more: Array | float,
) -> Affine:
    """Change of the torque over a sample for a way that is asked, up or down, by filling and by venting.

    Of a room the pulse goes 1 - (1 - y)^p for y that is asked, with the power p the times of the inversion over those
    of the valve: p y, but for a factor that lies between 1 and its value at the largest y. With the sign of the way
    that is the mean of both powers times it, and half of their difference times its size.

    Parameters
    ----------
    asked : form
        Way, with its sign [N m].
    rooms : sequence of form
        To the full torque, and to none.
    powers : sequence of form
        p of filling and venting.
    lengths : sequence of float
        Times of the inversion over the sample.
    more : array or float
        What the supply may have more or less than the room says [N m].
    """
    ends = np.maximum(asked.high, 0.0), np.maximum(-asked.low, 0.0)
    outward = []
    for end, room, power, length, extra in zip(ends, rooms, powers, lengths, (more, 0.0), strict=True):
        narrowest = np.maximum(room.low, 1.0)  # less than any room in which this counts
        y = np.clip(end / narrowest, 1e-9, -np.expm1(-1.0 / length))
        factors = [-np.expm1(p * np.log1p(-y)) / (p * y) for p in (power.low, power.high)]
        beside = extra / narrowest
        lowest = np.minimum(np.minimum(*factors), 1.0) * (1.0 - beside)
        highest = np.maximum(np.maximum(*factors), 1.0) * (1.0 + beside)
        outward.append((power.high * end * (1.0 - lowest), power.high * end * (highest - 1.0)))
    (short, far), (short_down, far_down) = outward
    mean = (powers[0] + powers[1]) * 0.5
    unlike = (powers[0] - powers[1]) * 0.5
    change = asked * mean + _size(asked) * unlike
    return change.widened(np.maximum(short, far_down), np.maximum(far, short_down))


def _size(way: Affine) -> Affine:
    """Size of a way that may be up or down."""
    return way.positive_part() * 2.0 - way


def _missed(whole: Affine, share: Affine, speed: float) -> Affine:
    """What the mean over the sample lacks of a change that goes exponentially and ends with the pulse."""
    # Over the pulse the mean lacks 1 + 1/x - 1/(1 - exp(-x)) of the change, 1/2 - x/12 to 1/2 for x up to the speed.
    return (whole * share) * constant(0.5, whole).widened(speed / 12.0, 0.0)
