"""Wheel and train within a sample, in affine forms: Picard's iteration over parts of the sample.

The torque in between lies on its way from one sample to the next.
"""

from collections.abc import Callable, Iterable
from typing import NamedTuple, TypeAlias

import numpy as np

from wspd_design.certificates.kernel.affine import ROUNDING, Affine, Array, Where, between, chosen
from wspd_design.certificates.theorems.slip_band.followed_law import Decided, apart, moved, went
from wspd_design.certificates.theorems.slip_band.followed_plant import Plant, State
from wspd_design.controllers.protection import Protection
from wspd_design.model.generated import adhesion
from wspd_design.model.slip import resistance
from wspd_design.parameters.records import Rail

STEP = 0.005  # s, parts of a sample
TRIALS, GROWTH = 6, 0.05  # of the iteration, and what a range grows by in each [-, and m/s2]
_FLAT = 1e-12  # slope below which a curve counts as level


class Moved(NamedTuple):
    """Wheel and train at the end of a sample."""

    speed: Affine
    sliding: Affine
    torque: Affine
    supply: Affine
    top: Array  # -, slip that was not exceeded


def motion(
    plant: Plant,
    law: Protection,
    state: State,
    decided: Decided,
    time: int,
    fresh: Callable[[Affine], Affine],
) -> Moved:
    """Follow wheel and train through the sample; ``time`` is the symbol of the time within a part of it."""
    h, full, effect = law.sample_time, law.valve.brake.max_torque, plant.effect
    filling, venting = plant.fill_rate * h, plant.vent_rate * h
    count = max(1, round(h / STEP))
    step = h / count
    after = 1.0 - (1.0 - state.supply) * (plant.supply_rate * -h).exp()
    # The supply that counts is the mean over the pulse, later instants a little more, of one that rises ever slower.
    growth = (after - state.supply) * full
    most = np.maximum(growth.high, 0.0)
    unsure = most * (filling.high / 12.0 + plant.supply_rate.high * h / 8.0)
    supply = (state.supply * full + growth * (decided.fill * 0.5)).widened(unsure, unsure)
    way = supply, state.torque, decided.fill, decided.vent
    rise, fall = moved(*way, filling, venting)
    lengths = [
        law.valve.time_share * each / h for each in (law.valve.brake.fill_time, law.valve.brake.vent_time)
    ]
    powers = [filling * lengths[0], venting * lengths[1]]
    rooms = state.supply * full - state.torque, state.torque
    change = went(decided.way, rooms, powers, lengths, 0.5 * most * decided.fill.high + unsure)
    rise, fall = (fresh(each) for each in apart(change, rise, fall, decided.even, decided.filling))
    # A change within a pulse is even but for 1/8 of the largest second derivative, times the square of its length.
    steepest = most * (1.0 + plant.supply_rate.high * h)
    quick = np.maximum(steepest, ((supply - state.torque).high + most) * filling.high) * filling.high
    bend = quick * np.clip(decided.fill.high, 0.0, 1.0) ** 2
    bend = bend + (state.torque + rise).high * (venting.high * np.clip(decided.vent.high, 0.0, 1.0)) ** 2
    bend = 0.125 * np.maximum(bend, 0.0)
    speed, sliding = state.speed, state.sliding
    top = sliding.high / speed.low
    ahead = _with_brake(plant, (speed, sliding), state.torque * effect)
    for part in range(count):
        gone = (_gone(each, part, count, time) for each in (decided.fill, decided.vent))
        pulled = _on_the_way(state.torque, rise, fall, decided.across, *gone).widened(bend, bend) * effect
        ahead = _enclosed(plant, (speed, sliding), ahead, pulled, step)
        at_any_time = (
            _over_time(x, rate, step, time) for x, rate in zip((speed, sliding), ahead, strict=True)
        )
        ahead = _with_brake(plant, at_any_time, pulled)
        highest = sliding.high + step * np.maximum(ahead[1].high, 0.0)
        at_any_time = (
            _over_time(x, rate, step, time) for x, rate in zip((speed, sliding), ahead, strict=True)
        )
        gone = (_gone_in_the_mean(each, part, count) for each in (decided.fill, decided.vent))
        pulled = _on_the_way(state.torque, rise, fall, decided.across, *gone).widened(bend, bend) * effect
        means = [rate.without(time) for rate in _with_brake(plant, at_any_time, pulled)]
        speed, sliding = fresh(speed + means[0] * step), fresh(sliding + means[1] * step)
        top = np.maximum(top, np.maximum(highest, sliding.high) / speed.low)
    return Moved(speed, sliding, state.torque + rise - fall, after, top)


def _on_the_way(
    torque: Affine, rise: Affine, fall: Affine, across: Where, filled: Affine, vented: Affine
) -> Affine:
    """Torque when parts of its changes are done; where it is open which it is, the rise holds both with their sign."""
    lacking = (
        np.maximum(end, 0.0) * np.maximum(1.0 - part.low, 0.0)
        for end, part in ((rise.high, filled), (-rise.low, vented))
    )
    return chosen(across, (torque + rise).widened(*lacking), torque + rise * filled - fall * vented)


def rates(plant: Plant, speed: Affine, sliding: Affine) -> tuple[Affine, Affine]:
    """Acceleration of the train, and the rate of the sliding speed without brake [m/s2]."""
    rail = plant.rail
    # The force over mu0 times the load is that of a wheel with both 1, and falls with the sliding as the friction does.
    friction = adhesion.friction_coefficient(sliding, 1.0, rail.friction_ratio, rail.friction_decay)
    slip = sliding / speed
    gradient = adhesion.creep_gradient(slip, 1.0, friction, plant.gradient)
    straight = [_adhesion_part(rail, gradient), _slip_part(rail, gradient)]
    line = tuple(np.add(*each) for each in zip(*straight, strict=True))
    slowing = -(
        _along(line, slip * plant.train_stiffness, plant.gripping * friction)
        + resistance(plant.vehicle, speed) * plant.mass
    )
    used = _along(line, slip * plant.rim_stiffness, plant.turning * friction)
    damped = (speed - sliding) * plant.inertia * (2.0 * plant.vehicle.wheel_damping)
    return slowing, slowing - (used - damped)


def _along(line: tuple[Array, ...], adhering: Affine, sliding: Affine) -> Affine:
    """Force of a contact by a line near its shape: what adheres counts with the slope, all of the friction beside it.

    The force is F S(z), with z what it is while all adheres over F, and S no farther from slope z + offset than the
    distance. Written like this F drops out while nearly all adheres, and the products of what is unsure with it.
    """
    slope, offset, distance = line
    beside = np.maximum(np.abs(sliding.low), np.abs(sliding.high)) * distance
    return (adhering.line(slope, 0.0, 0.0) + sliding.line(offset, 0.0, 0.0)).widened(beside, beside)


def _part(adhesion_reduction: float, slip_reduction: float) -> Callable[[Array], Array]:
    """Force of a wheel with load and friction 1 over its gradient, with one of the reduction factors."""
    return lambda x: np.asarray(
        adhesion.creep_force(x, 0.0, 1.0, 1.0, 1.0, 0.0, adhesion_reduction, slip_reduction, 1.0)
    )


def _adhesion_part(rail: Rail, gradient: Affine) -> tuple[Array, Array, Array]:
    """Line near what the area of adhesion adds, (2/pi) z/(1 + z^2) with z the gradient times its factor."""
    factor = rail.adhesion_reduction

    def touching(slope: Array) -> tuple[Array, ...]:
        wanted = slope * (0.5 * np.pi / factor)  # (1 - z^2)/(1 + z^2)^2, a quadratic equation for z^2
        safe = np.where(np.abs(wanted) < _FLAT, _FLAT, wanted)
        root = np.sqrt(np.maximum(1.0 + 8.0 * safe, 0.0))
        squares = [(-(2.0 * safe + 1.0) + sign * root) / (2.0 * safe) for sign in (1.0, -1.0)]
        roots = [np.sqrt(np.maximum(each, 0.0)) / factor for each in squares]
        return (*roots, *(-each for each in roots))

    return gradient.secant(_part(factor, 0.0), touching)


def _slip_part(rail: Rail, gradient: Affine) -> tuple[Array, Array, Array]:
    """Line near what the area of slip adds, (2/pi) atan(z) with z the gradient times its factor."""
    factor = rail.slip_reduction

    def touching(slope: Array) -> tuple[Array, ...]:
        wanted = np.maximum(slope * (0.5 * np.pi / factor), 1e-300)
        root = np.sqrt(np.maximum(1.0 / wanted - 1.0, 0.0)) / factor
        return root, -root

    return gradient.secant(_part(0.0, factor), touching)


Rates: TypeAlias = tuple[Affine, Affine]
"""Of the speed of the train and of the sliding speed [m/s2]."""


def _with_brake(plant: Plant, begin: Iterable[Affine], pulled: Affine) -> Rates:
    slowing, gliding = rates(plant, *begin)
    return slowing, gliding + pulled


def _enclosed(plant: Plant, begin: Rates, guess: Rates, pulled: Affine, step: float) -> Rates:
    """Rates that hold at every instant of a part of the sample, by Picard's iteration; infinite where it fails."""
    ends, found = [(rate.low, rate.high) for rate in guess], guess
    inside = np.zeros(pulled.center.shape, dtype=bool)
    for _ in range(TRIALS):
        wider = [
            (low - GROWTH * (1.0 + high - low), high + GROWTH * (1.0 + high - low)) for low, high in ends
        ]
        reached = (
            x.widened(np.maximum(-low * step, 0.0), np.maximum(high * step, 0.0))
            for x, (low, high) in zip(begin, wider, strict=True)
        )
        found = _with_brake(plant, reached, pulled)
        inside = np.ones(pulled.center.shape, dtype=bool)
        for rate, (low, high) in zip(found, wider, strict=True):
            inside &= (rate.low >= low) & (rate.high <= high)
        if inside.all():
            break
        ends = [
            (np.minimum(rate.low, low), np.maximum(rate.high, high))
            for rate, (low, high) in zip(found, wider, strict=True)
        ]
    slowing, gliding = (Affine(x.center, x.slopes, np.where(inside, x.error, np.inf)) for x in found)
    return slowing, gliding


def _over_time(begin: Affine, rate: Affine, step: float, time: int) -> Affine:
    """Value at any time within a part of the sample, with the symbol of time from -1 at its begin to 1."""
    half, turning, steady = 0.5 * step, rate.slopes[:, time], rate.without(time)
    slopes = begin.slopes + half * steady.slopes
    slopes[:, time] += half * rate.center
    # The integral of the symbol is (z^2 - 1)/2; what the other symbols do grows with the time.
    bowed = 0.25 * half * np.abs(turning)
    error = begin.error + half * steady.radius + half * rate.error + bowed
    center = begin.center + half * rate.center - 0.25 * half * turning
    made = np.abs(begin.center) + begin.radius + half * (np.abs(rate.center) + rate.radius)
    return Affine(center, slopes, error + ROUNDING * made)


def _done(share: Array, time: float) -> Array:
    """Part of a change that is done at a time, both over the sample, if it is even and takes this share of it."""
    found: Array = np.minimum(time / np.maximum(share, 1e-12), 1.0)
    return found


def _gone(share: Affine, part: int, count: int, time: int) -> Affine:
    """Part of a change that is done at any time within a part of the sample."""
    low, high = np.clip(share.low, 0.0, 1.0), np.clip(share.high, 0.0, 1.0)
    begin, end = part / count, (part + 1) / count
    first, last = _done(high, begin), _done(high, end)
    first_most, last_most = _done(low, begin), _done(low, end)
    # A change that ends within this part is anything between; one that goes on, or is over, follows a straight line.
    straight = (low >= end) | (high <= begin)
    middle, middle_last = 0.5 * (first + first_most), 0.5 * (last + last_most)
    spread = 0.5 * np.maximum(first_most - first, last_most - last)
    found = between(
        np.where(straight, 0.5 * (middle + middle_last) - spread, first),
        np.where(straight, 0.5 * (middle + middle_last) + spread, last_most),
        share,
    )
    slopes = found.slopes.copy()
    slopes[:, time] += np.where(straight, 0.5 * (middle_last - middle), 0.0)
    return Affine(found.center, slopes, found.error)


def _gone_in_the_mean(share: Affine, part: int, count: int) -> Affine:
    """Mean over a part of the sample of what is done of a change; it falls with the share that the change takes."""
    begin, end = part / count, (part + 1) / count

    def mean(share: Array) -> Array:
        stop = np.clip(share, begin, end)  # there the change ends, if it does in this part
        going = (stop**2 - begin**2) / (2.0 * np.maximum(share, 1e-12))
        found: Array = np.where(share <= begin, 1.0, (going + (end - stop)) * count)
        return found

    low, high = np.clip(share.low, 0.0, 1.0), np.clip(share.high, 0.0, 1.0)
    return between(mean(high), mean(low), share)
