"""Numbers of the loop in one cell and one window: ranges, bounds of what disturbs it, and limits of the state.

All of them are worked out in balls from the box and from the proved bounds of the friction, and rounded outwards.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import product
from math import isfinite
from typing import NamedTuple

from wspd_design.certificates.kernel.arb import (
    Ball,
    above,
    ball,
    below,
    ends_of,
    hull_of,
    least_of,
    most_of,
    point,
)
from wspd_design.certificates.kernel.checker import Refused
from wspd_design.certificates.records import Problem
from wspd_design.certificates.setting.creep_slope import along_speed, fading_beside, steepness_of
from wspd_design.certificates.setting.slip_loop import LoopRanges, Pair, Way, latest_share
from wspd_design.certificates.theorems.slip_band.friction import (
    FADINGS,
    Parts,
    Strip,
    bounds_for,
    fading_at,
    mean_slope,
    reached,
    slope_at,
)
from wspd_design.certificates.theorems.slip_band.lag import Fading, lag_of
from wspd_design.certificates.theorems.slip_band.limits import Limit, below_curve, room_left, within_pulses
from wspd_design.certificates.theorems.slip_band.proof import Choice
from wspd_design.certificates.theorems.slip_band.pulses import Pulses, loop_law, pulses_of, seen_of
from wspd_design.certificates.theorems.slip_band.reference import held_in
from wspd_design.certificates.theorems.slip_band.statement import (
    JERK_FACTORS,
    NAMES,
    BandLaw,
    Cell,
    fastest_loss,
)
from wspd_design.certificates.theorems.slip_band.turning import brought_along
from wspd_design.certificates.theorems.slip_band.wants import Curve, Wants, curve_of, dead_band_of, wants_of
from wspd_design.model.generated.slip_loop import added_by_supply, lateness
from wspd_design.model.slip import wheels
from wspd_design.parameters.bounds import Bounds, Ends
from wspd_design.parameters.loading import constants

RADIUS = NAMES.index("wheel radius")


class Conditions(NamedTuple):
    """What a stop has beside friction and parameters."""

    supply: Fraction  # -, of the full pressure, at least
    delay: Fraction  # -, of the sample, until a pulse begins at the latest
    noise: Fraction  # m/s, by which measured speeds of rims and train differ from the true ones at most
    reserve: Fraction = Fraction(
        1
    )  # -, of the full pressure, beyond which nothing is claimed; 1: no such share


class Steady(NamedTuple):
    """Drift of the torque that comes from the fading friction: hardly another one in the next sample."""

    low: Ball  # rad/s, over a sample
    high: Ball
    change: Pair  # rad/s, that it rises by from one sample to the next, at least and at most
    share: Ball  # -, of the drift, that its mean over a sample counts
    lag: Ball  # -, of the drift, that the reference drifts by

    @property
    def rise(self) -> Ball:
        """Middle of what it rises by [rad/s]."""
        return (self.change[0] + self.change[1]) / 2

    def away(self, drift: Ball) -> Ball:
        """Return the largest distance of the drift from one [rad/s]."""
        return most_of([abs(self.low - drift), abs(self.high - drift)])


@dataclass(frozen=True, slots=True, kw_only=True)
class Loop:
    """The loop in one cell and one window."""

    ranges: LoopRanges
    disturbances: tuple[Pair, ...]  # lowest and highest, beside the steady drift of the torque [rad/s]
    steady: Steady
    within: tuple[Limit, ...]  # what keeps pulses to their lengths
    others: tuple[Limit, ...]
    widest: Pair  # rad/s, errors between which the slope is bounded
    settles: Pair  # rad/s, errors between which the fading is bounded
    settled: Fraction  # rad/s, E
    holding: float  # -, share of the full pressure that holds the reference, at least
    pulse: Ball  # -, longest pulse over the sample time
    delay: Ball  # -, latest beginning of a pulse over the sample time
    added: Ball  # -, what a rising supply adds to a way at most, over the way
    pulses: tuple[Pulses, Pulses]  # that fill and that vent
    wants: tuple[Wants, ...]  # for the pull k e, and for the least share of it that the braking curve leaves
    dead_band: Ball  # rad/s, of what it wants, that it leaves out
    beyond: Ball  # -, times what the longest pulse does, that is wanted at most
    curve: Curve | None  # none for a law that has none

    @property
    def limits(self) -> tuple[Limit, ...]:
        """All that the state is kept to."""
        return (*self.within, *self.others)


def loop_of(
    problem: Problem,
    law: BandLaw,
    cell: Cell,
    window: tuple[float, float],
    bounds: Parts,
    choice: Choice,
    conditions: Conditions,
) -> Loop:
    """Work out the loop of a cell in a window of speed, with bounds of the friction there."""
    inside = replace(problem, bounds=_bounds(problem, cell))
    friction = bounds_for(bounds, steepness_of(inside))
    pulse = choice.pulse
    if pulse + conditions.delay > 1:
        raise Refused("a pulse may go on into the next sample")
    if choice.beyond > 1 and pulse < 1:
        raise Refused("more may be wanted than the longest pulse does, which is shorter than the sample")
    if choice.curve > 1 and law.torque_slew is None:
        raise Refused("the law has no braking curve")
    if 2 * conditions.noise > window[0]:
        raise Refused("the noise is more than half of a speed")
    mass, inertia, radius, mu0, torque, fill, vent = (ball(*each) for each in cell)
    if law.largest_scale_error is not None and not (
        abs(point(law.radius) / radius - 1) < point(law.largest_scale_error)
    ):
        raise Refused(
            "wheels of this radius roll so fast or slowly that the law does not take its scale from them"
        )
    speed, h, reference = ball(*window), point(law.sample_time), held_in(law, window, cell[RADIUS])
    slip = reference.slip
    vehicle = problem.vehicle
    damping = 2 * point(vehicle.wheel_damping)
    normal = mass * point(constants().gravity) / wheels(vehicle) * mu0  # mu0 Q
    rolling, turned = (1 - slip) / radius, reference.turning / radius
    drag = _resistance(problem, speed) / mass
    # Errors e R over the lowest speed of the range: of the reference, where errors are counted from, that are reached.
    slowest, apart, none = point(problem.speeds[0]), point(choice.settled), point(0)
    settled = apart * radius / slowest
    fades, fades_there = fading_at(friction, none), fading_at(friction, settled)
    # All axles are within their bands, and from the reference to their slip the force follows the slope.
    used = ball(*friction.level)
    used += mean_slope(friction, none, choice.near) * slowest * ball(*reached(choice.near))
    pulled = point(constants().gravity) * mu0  # deceleration by a friction of mu0 Q
    braking = pulled * used + drag
    if not braking < point(fastest_loss(problem)) or not braking > 0:
        raise Refused("the train may lose more speed in a sample than the windows overlap, or gain some")
    pads = torque / point(law.full_torque)
    seen_inertia = pads * point(law.inertia)  # true torque over the number Y h counts it in
    effect, full = seen_inertia / inertia, point(law.full_torque) / point(law.inertia)
    damped = damping * rolling * speed / seen_inertia
    weight = 2 * radius * normal / seen_inertia  # torque of a friction of mu0 Q
    holding = below((weight * ball(*friction.level) - damped) / full)  # of a train that does not slow down
    rolled = 2 * radius * normal / inertia
    if conditions.reserve < 1 and friction.level[0] > 0:
        # Nothing is claimed of numbers and speeds at which more is held.
        weight = weight.min((point(conditions.reserve) * full + damped) / point(friction.level[0]))
        rolled = rolled.min(ends_of(weight)[1] * ends_of(effect)[1])
    held = weight * ball(*friction.level) - damped + inertia * turned * braking / seen_inertia
    if conditions.reserve < 1:
        held = held.min(point(conditions.reserve) * full)
    # At the speed w_r + E; its sliding speed is E R less.
    held += (weight * mean_slope(friction, none, choice.near) * radius - damping / seen_inertia) * apart
    # Friction over mu0 Q that a wheel at the reference gains in time: by its speed, and by the slip it holds.
    fading, moving = slip * fades, speed * reference.fall * braking + reference.drift
    constant, part = not (law.falls or law.slip_error or law.slip_drift), replace(inside, speeds=window)
    if constant:
        fading = _closer(fading, _along(part, law, none)[0])
    moved, moved_there = (slope_at(friction, error) * moving for error in (none, settled))
    secants = radius * rolled * mean_slope(friction, settled, choice.near) - damping / inertia
    # While the train slows down the friction at the reference rises, and with it the deceleration.
    rising = -pulled * fading - _resistance(problem, speed, 1) / mass
    jerk = ball(*JERK_FACTORS) * (braking * rising - pulled * moved)
    # The rims take part in less or more of the deceleration as the slip changes.
    bending, slipping = (
        h * h * each / radius * braking for each in (reference.bend * braking, reference.drift / speed)
    )
    slowly = -h * h * turned * jerk
    turning = bending + slipping + slowly
    # By how much a wheel and its reference seem to turn faster or slower. The filter shows an error of the train speed
    # at most twice, its first step over the sample time; a wrong speed also asks for another share of the deceleration.
    turns = point(conditions.noise) / radius * ball(Fraction(-1), Fraction(1))
    rolls = turns * (1 + point(law.slip_error))
    misread = turns + rolls
    share = -(-h / point(law.acceleration_time)).expm1()
    misread_rate = 2 * share * rolls + 3 * reference.bend * point(fastest_loss(problem)) * h * turns
    sliding = h * reference.drift / radius
    # The slip at w_r + E is E R/v less, and falls with the speed.
    there = (slip - apart * radius / speed) * fades_there
    there -= slope_at(friction, settled) * apart * radius / speed
    less = apart * radius  # m/s, that the wheel slides slower
    if constant:
        own, bent_force = _along(part, law, less)
        there = _closer(there, own)
    # The share of a steady drift that a sample has seen; a later weight sees more of it.
    low, high = ends_of(secants)
    half_way = (1 - lateness(high * h, 1, 0)).union(1 - lateness(low * h, 1, 0))
    drift = -h * h * weight * moved_there + h * damping * sliding / seen_inertia
    fading_torque = weight * there - damping * turned / seen_inertia  # of the reference, over the train speed
    steadily, share_seen = -h * h * fading_torque * braking, point(Fraction(float(half_way.mid())))
    beside = turning
    if not constant:
        steady = Steady(none, none, (none, none), share_seen, none)
        drift += steadily
        mean_drift = drift * half_way
    else:
        # Of two enclosures the closer one takes longer.
        more = fading - there
        if choice.lag:
            more = ball(*_enclosed(fading_beside(part, float(law.slip), (below(less), above(less)))))
        # The speed falls by the braking, which itself rises with the jerk.
        change = h**3 * (weight * bent_force * braking**2 - fading_torque * jerk)
        fades_with = Fading(
            pulled=pulled,
            weight=2 * radius * mass / wheels(vehicle) / seen_inertia,
            along=there,
            at_reference=fading,
            beside=more,
            damping=damping * turned / seen_inertia,
            resistance=_resistance(problem, speed, 1) / mass,
        )
        lagging, beside = lag_of(fades_with, choice.lag, turned, h * h * braking, change)
        steady = Steady(*ends_of(steadily), ends_of(change), share_seen, lagging)
        mean_drift = drift * half_way + steadily * (half_way - share_seen)
        # It is the one with which the sample begins; what it changes by within it adds half of that until its end.
        drift += change / 2
        mean_drift += change / 2 * ball(Fraction(0), Fraction(1))
    # The part of the change of the speed that the rims take part in falls with the speed where the slip does, by a part
    # bent of it in a sample, and D as much: before that it is at most (1 - share) D + drift, settled drift/share. Where
    # the slip moves beside that, D is at most what all of the deceleration makes. Neither moves D as it moves w_r'.
    bent = reference.bend * h * braking / reference.turning
    lag_drift = (bent * slowly / share * ball(-1, 1) - bending - slipping) * (1 - share / 2) + slipping
    brought = brought_along(turning, beside, inertia / seen_inertia, (half_way, share_seen), share)
    known = sliding + misread_rate
    dead_band = (
        h
        / point(law.inertia)
        * dead_band_of(law, slip * (speed + point(conditions.noise)) / radius)
        * ball(Fraction(-1), Fraction(1))
    )
    uneven = sliding * most_of([(high * h).exp() - 1, 1 - (low * h).exp(), point(0)])
    added = _added(problem, law, fill, choice, conditions)
    left_out = dead_band + loop_law(law).gain * (misread + apart)
    disturbed = (
        known,
        left_out,
        drift + brought.torque,
        mean_drift + brought.mean_torque,
        beside,
        brought.mean_reference,
        sliding,
        uneven,
        turns,
        lag_drift + brought.lag,
    )
    turnings = [slowest / point(each) for each in problem.span("wheel radius")]
    pulses = pulses_of(law, (fill, vent), pulse, added, (point(conditions.supply) * full).union(full), held)
    late = point(0).union(latest_share(high * h, point(pulse), point(conditions.delay), added))
    seen = seen_of(law, pulse)
    curve = curve_of(law, choice, known, misread + apart)
    wants, beyond = wants_of(law, curve, known, misread + apart), point(choice.beyond)
    limits = room_left(law, choice, conditions.supply, held, turned * braking)
    return Loop(
        ranges=LoopRanges(
            secants=(low, high),
            effects=ends_of(effect),
            ways=tuple(
                Way(part, part, *shares)
                for part, *shares in product(
                    ends_of(hull_of([end for each in pulses for end in each.parts])), ends_of(late), seen
                )
            ),
            shares_center=(late, hull_of(seen)),
            brought=brought.shares,
        ),
        disturbances=tuple(map(ends_of, disturbed)),
        steady=steady,
        within=within_pulses(pulses, (point(pulse),) * 2, wants, beyond),
        others=(*below_curve(law, curve), *limits),
        widest=_errors(reached(choice.near), turnings),
        settled=choice.settled,
        settles=_errors((FADINGS[0][0], FADINGS[-1][1]), turnings),
        holding=holding,
        pulse=point(pulse),
        delay=point(conditions.delay),
        added=added,
        pulses=pulses,
        wants=wants,
        dead_band=dead_band,
        beyond=beyond,
        curve=curve,
    )


def _along(problem: Problem, law: BandLaw, less: Ball) -> tuple[Ball, Ball]:
    """Both derivatives of the friction over mu0 Q in the train speed, of wheels that slide slower by less [m/s]."""
    first, second = along_speed(problem, float(law.slip), (below(less), above(less)))
    return ball(*_enclosed(first)), ball(*_enclosed(second))


def _closer(one: Ball, other: Ball) -> Ball:
    """Return what both balls enclose of one number."""
    if not one.overlaps(other):
        raise Refused("the friction does not fade as the numbers of the box say")
    return one.intersection(other)


def _enclosed(ends: Ends) -> Ends:
    if not all(map(isfinite, ends)):
        raise Refused("a derivative of the friction is not enclosed")
    return ends


def spread_of(ends: Pair) -> Ball:
    """Return by how much an end differs from the middle."""
    low, high = ends
    return (high - low) / 2


def _bounds(problem: Problem, cell: Cell) -> Bounds:
    """Ranges of the box, those that a cell divides no wider than there."""
    ends = {
        name: (below(point(low)), above(point(high))) for name, (low, high) in zip(NAMES, cell, strict=True)
    }
    return Bounds.of({**dict(problem.bounds.items()), **ends})


def _errors(strip: Strip, turnings: Sequence[Ball]) -> Pair:
    """Errors of the wheel speed that are in a strip for all wheel speeds of the lowest train speed."""
    lows, highs = ([point(end) * each for each in turnings] for end in strip)
    return most_of(lows), least_of(highs)


def _added(problem: Problem, law: BandLaw, fill: Ball, choice: Choice, conditions: Conditions) -> Ball:
    """Return what a rising supply adds to a way that fills, over the way."""
    if conditions.supply == 1:
        return point(0)
    if problem.vehicle.brake.build_up != "main-pipe":
        raise Refused("the supply is that of the full pressure alone")
    rate = point(problem.span("supply rate")[1])
    fastest, h = ends_of(fill)[0], point(law.sample_time)
    added = added_by_supply(
        rate, fastest, h, point(choice.pulse), point(conditions.delay), point(choice.room)
    )
    return ends_of(added)[1]


def _resistance(problem: Problem, speed: Ball, order: int = 0) -> Ball:
    """Running resistance, or its derivative in the train speed."""
    constant, linear, square = (
        ball(*map(Fraction, problem.span(f"resistance {name}")))
        for name in ("constant", "linear", "quadratic")
    )
    return linear + 2 * square * speed if order else constant + linear * speed + square * speed**2
