"""The way from rolling to the slip reference, one sample after the other, in affine forms over boxes of the rail.

The state is written in the sliding speed, in which rolling is 0 for every train speed, and in the innovation of the
observer, so that what belongs together cancels. Between samples the motion is enclosed by Picard's iteration over
parts of the sample; the torque in between lies on its way from one sample to the next.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from typing import NamedTuple, TypeAlias

import numpy as np

from wspd_design.certificates.kernel.affine import ROUNDING, Affine, Array, constant
from wspd_design.certificates.theorems.slip_band.statement import NAMES as STATED
from wspd_design.controllers.observer_smc import approach
from wspd_design.controllers.protection import Protection
from wspd_design.model.adhesion import contact_stiffness
from wspd_design.model.generated import adhesion, slip_tracking
from wspd_design.model.slip import resistance, wheels
from wspd_design.parameters.loading import constants
from wspd_design.parameters.records import Rail, Vehicle

STEP = 0.005  # s, parts of a sample
PARAMETERS = 16  # symbols that stand for the numbers of a box and their combinations, and are kept
STATES = 8
KEPT = 48  # symbols at the beginning of a sample
TRIALS, GROWTH = 6, 0.05  # of the iteration, and what a range grows by in each [-, and m/s2]
_FLAT = 1e-12  # slope below which a curve counts as level
LEAST = 1e-3  # of the full torque, and in N m: as the inversion of the valve


class State(NamedTuple):
    """State of the loop at a sample, before the law computes."""

    speed: Affine  # m/s
    sliding: Affine  # m/s, of the rim against the rail
    innovation: Affine  # m/s, wheel speed less what the observer expects, times the radius
    friction: Affine  # N m, observed torque
    torque: Affine  # N m
    acceleration: Affine  # m/s2, of the train as the law has it
    change: Affine  # m/s, of the train speed over the last sample
    supply: Affine  # -, demanded pressure over the full one


SCALES = np.array([1.0, 1.0, 0.3, 1e3, 1e3, 0.1, 0.02, 0.05])  # of the states, to compare symbols


class Decided(NamedTuple):
    """What the law makes of a sample."""

    fill: Affine  # -, share of the sample
    vent: Affine  # -
    friction: Affine  # N m
    acceleration: Affine  # m/s2
    innovation: Affine  # m/s, of the next sample, but for the way of the wheel


@dataclass(frozen=True, slots=True, kw_only=True)
class Plant:
    """The numbers of wheel, train and brake in the combinations that count, each with an uncertainty of its own."""

    vehicle: Vehicle  # what is held at its nominal value
    rail: Rail
    radius: Affine  # m
    curvature: Affine  # 1/m, over the radius
    mass: Affine  # 1/kg, one over it
    inertia: Affine  # 1/(kg m2), one over that of a wheelset
    gripping: Affine  # m/s2, of the train by friction alone, over the force that is used
    turning: Affine  # m/s2, of the rim
    gradient: Affine  # -, initial slope of the force over mu0 times the load
    effect: Affine  # m/s2 of the rim for a N m of the nominal torque
    fill_rate: Affine  # 1/s
    vent_rate: Affine  # 1/s
    supply_rate: Affine  # 1/s


NUMBERS = (*STATED, "supply rate")
"""Numbers that differ from box to box; those of the band, and the rate of the supply."""


def plant_of(vehicle: Vehicle, rail: Rail, full: float, numbers: Mapping[str, Affine], first: int) -> Plant:
    """Return the plant.

    Parameters
    ----------
    vehicle, rail : Vehicle, Rail
        What the names do not say.
    full : float
        Nominal torque at full pressure, in which the law counts [N m].
    numbers : mapping of str to form
        Of :data:`NUMBERS`.
    first : int
        First of the symbols that stand for the errors of combinations.
    """
    mass, inertia, radius, mu0, torque, fill, vent, supply = (numbers[name] for name in NUMBERS)
    named = (
        combined.named(first + k)
        for k, combined in enumerate(_combined(vehicle, full, mass, inertia, radius, mu0, torque))
    )
    curvature, over_mass, over_inertia, turning, gradient, effect = named
    return Plant(
        vehicle=vehicle,
        rail=rail,
        radius=radius,
        curvature=curvature,
        mass=over_mass,
        inertia=over_inertia,
        gripping=mu0 * constants().gravity,
        turning=turning,
        gradient=gradient,
        effect=effect,
        fill_rate=fill.inverse().named(first + 6),
        vent_rate=vent.inverse().named(first + 7),
        supply_rate=supply,
    )


def _combined(
    vehicle: Vehicle, full: float, mass: Affine, inertia: Affine, radius: Affine, mu0: Affine, torque: Affine
) -> tuple[Affine, ...]:
    over_inertia = inertia.inverse()
    load = mass * (constants().gravity / wheels(vehicle))
    stiffness = float(contact_stiffness(vehicle.contact, 1.0))  # of a load of 1 N, and with its power 2/3
    return (
        radius.inverse(),
        mass.inverse(),
        over_inertia,
        (radius**2 * over_inertia) * (load * mu0) * 2.0,
        load.power(-1.0 / 3.0) * mu0.inverse() * stiffness,
        (radius * over_inertia) * (torque * (1.0 / full)),
    )


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
    fill = fresh(share(up, room, valve.time_share * valve.brake.fill_time / h, least))
    vent = fresh(
        share(down, state.torque.at_least(least), valve.time_share * valve.brake.vent_time / h, least)
    )
    rise, fall = _moved(
        available, state.torque, fill, vent, h / valve.brake.fill_time, h / valve.brake.vent_time
    )
    mean = state.torque + rise - _missed(rise, fill, h / valve.brake.fill_time)
    mean = mean - fall + _missed(fall, vent, h / valve.brake.vent_time)
    innovation = (
        state.sliding
        - state.speed
        + state.innovation * pole**2
        - (friction - mean) * plant.radius * (h / inertia)
    )
    return Decided(fill, vent, friction, acceleration, innovation)


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


def _moved(
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


def _missed(whole: Affine, share: Affine, speed: float) -> Affine:
    """What the mean over the sample lacks of a change that goes exponentially and ends with the pulse."""
    # Over the pulse the mean lacks 1 + 1/x - 1/(1 - exp(-x)) of the change, 1/2 - x/12 to 1/2 for x up to the speed.
    return (whole * share) * constant(0.5, whole).widened(speed / 12.0, 0.0)


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
    rise, fall = (fresh(each) for each in _moved(*way, filling, venting))
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
        filled, vented = (_gone(each, part, count, time) for each in (decided.fill, decided.vent))
        pulled = (state.torque + rise * filled - fall * vented).widened(bend, bend) * effect
        ahead = _enclosed(plant, (speed, sliding), ahead, pulled, step)
        at_any_time = (
            _over_time(x, rate, step, time) for x, rate in zip((speed, sliding), ahead, strict=True)
        )
        ahead = _with_brake(plant, at_any_time, pulled)
        highest = sliding.high + step * np.maximum(ahead[1].high, 0.0)
        at_any_time = (
            _over_time(x, rate, step, time) for x, rate in zip((speed, sliding), ahead, strict=True)
        )
        filled, vented = (_gone_in_the_mean(each, part, count) for each in (decided.fill, decided.vent))
        pulled = (state.torque + rise * filled - fall * vented).widened(bend, bend) * effect
        means = [rate.without(time) for rate in _with_brake(plant, at_any_time, pulled)]
        speed, sliding = fresh(speed + means[0] * step), fresh(sliding + means[1] * step)
        top = np.maximum(top, np.maximum(highest, sliding.high) / speed.low)
    return Moved(speed, sliding, state.torque + rise - fall, after, top)


def rates(plant: Plant, speed: Affine, sliding: Affine) -> tuple[Affine, Affine]:
    """Acceleration of the train, and the rate of the sliding speed without brake [m/s2]."""
    rail = plant.rail
    # The force over mu0 times the load is that of a wheel with both 1, and falls with the sliding as the friction does.
    friction = adhesion.friction_coefficient(sliding, 1.0, rail.friction_ratio, rail.friction_decay)
    gradient = adhesion.creep_gradient(sliding / speed, 1.0, friction, plant.gradient)
    used = friction * (_adhesion_part(rail, gradient) + _slip_part(rail, gradient))
    resisting = resistance(plant.vehicle, speed) * plant.mass
    slowing = -(used * plant.gripping + resisting)
    damped = (speed - sliding) * plant.inertia * (2.0 * plant.vehicle.wheel_damping)
    return slowing, slowing - (used * plant.turning - damped)


def _part(adhesion_reduction: float, slip_reduction: float) -> Callable[[Array], Array]:
    """Force of a wheel with load and friction 1 over its gradient, with one of the reduction factors."""
    return lambda x: np.asarray(
        adhesion.creep_force(x, 0.0, 1.0, 1.0, 1.0, 0.0, adhesion_reduction, slip_reduction, 1.0)
    )


def _adhesion_part(rail: Rail, gradient: Affine) -> Affine:
    """What the area of adhesion adds, (2/pi) z/(1 + z^2) with z the gradient times its factor."""
    factor = rail.adhesion_reduction

    def touching(slope: Array) -> tuple[Array, ...]:
        wanted = slope * (0.5 * np.pi / factor)  # (1 - z^2)/(1 + z^2)^2, a quadratic equation for z^2
        safe = np.where(np.abs(wanted) < _FLAT, _FLAT, wanted)
        root = np.sqrt(np.maximum(1.0 + 8.0 * safe, 0.0))
        squares = [(-(2.0 * safe + 1.0) + sign * root) / (2.0 * safe) for sign in (1.0, -1.0)]
        roots = [np.sqrt(np.maximum(each, 0.0)) / factor for each in squares]
        return (*roots, *(-each for each in roots))

    return gradient.along(_part(factor, 0.0), touching)


def _slip_part(rail: Rail, gradient: Affine) -> Affine:
    """What the area of slip adds, (2/pi) atan(z) with z the gradient times its factor."""
    factor = rail.slip_reduction

    def touching(slope: Array) -> tuple[Array, ...]:
        wanted = np.maximum(slope * (0.5 * np.pi / factor), 1e-300)
        root = np.sqrt(np.maximum(1.0 / wanted - 1.0, 0.0)) / factor
        return root, -root

    return gradient.along(_part(0.0, factor), touching)


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
    found = _between(
        share,
        np.where(straight, 0.5 * (middle + middle_last) - spread, first),
        np.where(straight, 0.5 * (middle + middle_last) + spread, last_most),
    )
    found.slopes[:, time] += np.where(straight, 0.5 * (middle_last - middle), 0.0)
    return found


def _gone_in_the_mean(share: Affine, part: int, count: int) -> Affine:
    """Mean over a part of the sample of what is done of a change; it falls with the share that the change takes."""
    begin, end = part / count, (part + 1) / count

    def mean(share: Array) -> Array:
        stop = np.clip(share, begin, end)  # there the change ends, if it does in this part
        going = (stop**2 - begin**2) / (2.0 * np.maximum(share, 1e-12))
        found: Array = np.where(share <= begin, 1.0, (going + (end - stop)) * count)
        return found

    low, high = np.clip(share.low, 0.0, 1.0), np.clip(share.high, 0.0, 1.0)
    return _between(share, mean(high), mean(low))


def _between(like: Affine, low: Array, high: Array) -> Affine:
    return constant(0.0, like).line(0.0, 0.5 * (low + high), 0.5 * (high - low))


def start(speed: float, boxes: int) -> tuple[Array, Array]:
    """Return centers and symbols of a train that rolls, its brake just demanded."""
    centers = np.zeros((boxes, STATES))
    centers[:, State._fields.index("speed")] = speed
    return centers, np.zeros((boxes, STATES, KEPT))


def follow(
    law: Protection,
    vehicle: Vehicle,
    rail: Rail,
    boxes: tuple[Array, Array],
    speed: float,
) -> Iterator[tuple[Array, State, Plant]]:
    """Follow the loop from rolling, sample by sample, for many boxes.

    Parameters
    ----------
    law : Protection
        Sliding mode of relative degree two with told speed and constant reference.
    vehicle, rail : Vehicle, Rail
        Nominal numbers.
    boxes : tuple of two arrays
        Centers and half widths (boxes, 2, symbols 2) of friction and supply rate: the rows say how each of them
        depends on the two symbols.
    speed : float
        At the beginning [m/s].

    Yields
    ------
    tuple of ndarray, State and Plant
        Largest slip within the sample, the state at its end, and the plant in the same symbols.
    """
    middle, spread = boxes
    count = len(middle)
    centers, symbols = start(speed, count)
    fresh_ones = 5 + 2 + 2 * max(1, round(law.sample_time / STEP))
    full = law.valve.brake.max_torque
    while True:
        columns = np.concatenate([symbols, np.zeros((count, STATES, 1 + fresh_ones))], axis=2)
        size = columns.shape[2]
        free = iter(range(KEPT + 1, size))

        def fresh(form: Affine, free: Iterator[int] = free) -> Affine:
            return form.named(next(free))

        state = State(*(Affine(centers[:, k], columns[:, k], np.zeros(count)) for k in range(STATES)))
        rows = np.zeros((count, len(NUMBERS), size))
        rows[:, :, : len(NUMBERS)] = spread
        numbers = {name: Affine(middle[:, k], rows[:, k], np.zeros(count)) for k, name in enumerate(NUMBERS)}
        plant = plant_of(vehicle, rail, full, numbers, len(NUMBERS))
        decided = decide(law, plant, state, fresh)
        moved = motion(plant, law, state, decided, KEPT, fresh)
        following = State(
            speed=moved.speed,
            sliding=moved.sliding,
            innovation=decided.innovation + moved.speed - moved.sliding,
            friction=decided.friction,
            torque=moved.torque,
            acceleration=decided.acceleration,
            change=moved.speed - state.speed,
            supply=moved.supply,
        )
        yield moved.top, following, plant
        centers = np.stack([each.center for each in following], axis=1)
        symbols = _fewer(following)


def _fewer(state: State) -> Array:
    """Symbols of a state, the errors among them; what matters least is put into one symbol for each number."""
    slopes = np.stack([each.slopes for each in state], axis=1)
    errors = np.zeros((*slopes.shape[:2], STATES))
    for k, each in enumerate(state):
        errors[:, k, k] = each.error
    kept, rest = slopes[:, :, :PARAMETERS], slopes[:, :, PARAMETERS:]
    rest = np.concatenate([rest, errors], axis=2)
    sizes = np.abs(rest) / SCALES[None, :, None]
    order = np.argsort(sizes.max(axis=1) - sizes.sum(axis=1), axis=1, kind="stable")
    rest = np.take_along_axis(rest, order[:, None, :], axis=2)
    most = KEPT - PARAMETERS - STATES
    boxed = np.zeros((len(rest), STATES, STATES))
    boxed[:, range(STATES), range(STATES)] = np.abs(rest[:, :, most:]).sum(axis=2) * (1.0 + ROUNDING)
    return np.concatenate([kept, rest[:, :, :most], boxed], axis=2)
