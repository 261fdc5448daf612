"""What wheels on the braking curve have at a sample, and bounds of all that enters it.

See :mod:`sample` for the map; what the friction does within a sample is bounded here.
"""

from dataclasses import dataclass
from math import exp

import numpy as np

from wspd_design.certificates.kernel.checker import Refused
from wspd_design.certificates.theorems.from_rolling.braked_wheel import Between, Friction, Wheels
from wspd_design.certificates.theorems.from_rolling.sample import (
    PULL,
    UNLIKE,
    WAY,
    LawNumbers,
    Pulse,
    Ranges,
    image,
    pulses_of,
)
from wspd_design.certificates.theorems.from_rolling.support import Array, Polytope

SPARES = 12  # trials of what the friction adds to the change of the error within two samples
NONE = Between(0.0, 0.0)
HALF = (
    0.07,
    0.53,
)  # of a rate, that a mean over two samples has of what it adds until their middle and from there on
MORE = 1.03  # times rho, that a valve goes of a way at most
FARTHER = 0.1  # rad/s, that a wheel may fall behind in a sample beside y
SLOWER = 0.8  # m/s, that a train may lose within the samples that a bound speaks about


@dataclass(frozen=True, slots=True, kw_only=True)
class State:
    """All wheels at a sample."""

    states: Polytope
    error: Between  # e [rad/s]
    speed: Between  # m/s
    room: float  # rad/s, at the first sample
    left: float  # rad/s, of the room now at least, by what was filled since
    begun: float  # rad/s, y at the first sample at least
    risen: float  # rad/s, by which the friction rose since then at most
    supply: float  # -, at least
    top: float  # -, slip that was not exceeded
    samples: float  # that went by at most


@dataclass(frozen=True, slots=True, kw_only=True)
class Sample:
    """The sample that begins with a state."""

    law: LawNumbers
    wheels: Wheels
    state: State
    ranges: Ranges
    pulses: list[Pulse]
    friction: Friction
    falling: Between  # y [rad/s]
    errors: Between  # of the wheel speed, E [rad/s]
    next_error: Between  # e of the next sample
    left: float  # rad/s, of the room in the next sample at least
    added: float  # what a rising supply adds to what is filled at most, over it
    way: Between  # rad/s, that the valve may go in the next sample
    reach: Between  # rad/s, that the error falls by within a sample, at least and at most
    farthest: float  # -, slip in this sample and the next

    def most(self, rows: Array, before: Array | None = None) -> Array:
        """Return what functions of the next state, and of this one, do not exceed."""
        return image(self.law, self.wheels, self.state.states, self.ranges, self.pulses, rows, before)

    def ends(self, rows: Array) -> tuple[Array, Array]:
        """Return the bounds of the next state."""
        found = self.most(np.vstack([rows, -rows]))
        return -found[len(rows) :], found[: len(rows)]

    @property
    def change(self) -> Between:
        """What the pull changes by."""
        found = self.most(np.vstack([PULL, -PULL]), np.vstack([-PULL, PULL]))
        return Between(-float(found[1]), float(found[0]))

    @property
    def moves(self) -> float:
        """Most of what the error changes by [rad/s]."""
        return self.reach.size

    @property
    def rises(self) -> float:
        """Rise of the friction at most."""
        return max((self.ranges.slope * self.falling + self.ranges.friction).high, 0.0)


def sample_of(law: LawNumbers, wheels: Wheels, state: State, farther: float) -> Sample:
    """Bound all that enters a sample, or refuse it.

    Within it and the next one the error changes at most by what its falling does now, what both ways of the valve add,
    of which the next has ``farther`` of this one more at most, and a spare for the friction.
    """
    rows = np.vstack(
        [PULL, WAY, law.falling, law.innovation, WAY - PULL, PULL / law.gain - law.ahead * (WAY - PULL)]
    )
    pull, way, falling, innovation, ahead, straight = (
        Between(*map(float, each)) for each in state.states.ends(rows)
    )
    falling = falling - state.error
    errors = Between(law.predicted(pull.low), law.predicted(pull.high)) - law.ahead * ahead
    if pull.high <= law.gain * law.begins:
        errors = Between(max(errors.low, straight.low), min(errors.high, straight.high))
    rise = wheels.full * wheels.supply_rate.high * (1.0 - state.supply)
    room = (
        state.room
        - ((1.0 + wheels.share.high) * state.risen + falling.high - state.begun) / wheels.effect.low
    )
    # The torque is what holds friction and drag, and makes the wheel fall behind.
    ahead_of = Between(min(falling.low, 0.0) - FARTHER, max(falling.high, 0.0) + FARTHER)
    now = wheels.friction(wheels.slip - (errors - ahead_of) * wheels.radius / state.speed, state.speed, 0.0)
    seen = now.seen.high + (now.falls.high + falling.high) / wheels.effect.low
    room = max(room, state.left, wheels.full * state.supply - seen)
    if room <= 0.0:
        raise Refused("there may be no room in the supply")
    added = 0.52 * rise / room
    gone = goes(wheels, way, added)
    # Within two samples the torque changes by what the valve goes in both; the mean of both, weighted as the friction
    # is, has all of the first way and half of the second at most.
    then = gone + Between(-gone.size, gone.size) * farther
    twice = (wheels.effect * (gone + then)).union(NONE)
    mean = (wheels.effect * (gone + 0.5 * then)).union(NONE)
    moves, slip, friction, rises = _within_two(wheels, state, errors, falling, twice)
    if moves.low < ahead_of.low or moves.high > ahead_of.high:
        raise Refused("a wheel may move farther in a sample than is assumed")
    slope, drag = friction.slope, friction.drag_change
    slides = friction.falls * (wheels.slip - slip) / (1.0 - wheels.slip)  # w
    # What the friction rises by slows the wheel down, as the weights of the mean count it: half of it at most.
    more = 1.0 + wheels.share.high
    spare = Between(
        -more * (HALF[1] * rises.high - HALF[0] * rises.low),
        more * (HALF[0] * rises.high - HALF[1] * rises.low),
    ) + Between(-1.0, 1.0) * (2.0 * drag.size)
    beside = slope * (mean + spare - slides) + Between(0.0, friction.fading)
    if (
        falling.low + twice.low + spare.low - slides.high
        < 0.0
        < falling.high + twice.high + spare.high - slides.low
    ):
        # A wheel that turns round within the samples may have another slope on the way back.
        apart = 0.25 * (slope.high - slope.low) * (twice.high - twice.low + spare.high - spare.low)
        beside += Between(-apart, apart)
    torque = friction.seen.low + min(falling.low / wheels.effect.low, falling.low / wheels.effect.high)
    if torque <= 0.0:
        raise Refused("there may be no torque to be vented")
    unlike = (UNLIKE + added) * law.nominal * way.size
    off = (wheels.effect * wheels.fills.union(wheels.vents) - law.nominal).size * (
        1.0 + added
    ) + law.nominal * 0.1
    known = (1.0 - law.kept) * state.error.size + law.a * (innovation.size + off * way.size + unlike)
    step = wheels.effect.high * gone.size + law.ahead * (known + gone.size)
    lowest = law.pull(law.predicted(pull.low) - max(falling.high, 0.0) - step)
    highest = law.pull(law.predicted(pull.high) + max(-falling.low, 0.0) + step)
    steepness = Between(law.steepness(highest) * (1.0 - 1e-9), law.steepness(lowest) * (1.0 + 1e-9))
    change = slope * falling + beside
    return Sample(
        law=law,
        wheels=wheels,
        state=state,
        ranges=Ranges(slope, steepness, state.error, beside, Between(-unlike, unlike)),
        pulses=pulses_of(law, wheels, way, room, torque, added),
        friction=friction,
        falling=falling,
        errors=errors,
        next_error=law.kept * state.error + wheels.share * change + drag,
        left=max(room - gone.high, room * exp(-law.over_fill * wheels.fills.high) * (1.0 - 1e-12)),
        added=added,
        way=then,
        reach=moves,
        farthest=slip.high,
    )


def _within_two(
    wheels: Wheels, state: State, errors: Between, falling: Between, twice: Between
) -> tuple[Between, Between, Friction, Between]:
    """Bound what the error falls by in this sample as in the next, the slip, the friction, and its rate in between."""
    speed, spare, back = Between(state.speed.low - SLOWER, state.speed.high), NONE, -np.inf
    more, falls = 1.0 + wheels.share.high, falling + twice
    for _ in range(SPARES):
        moves = Between(min(max(falls.low + spare.low, back), 0.0), max(falls.high + spare.high, 0.0))
        turned = Between(errors.low - 2.0 * moves.high, errors.high - 2.0 * moves.low)
        slip = wheels.slip - turned * wheels.radius / speed
        friction = wheels.friction(slip, speed, moves.size)
        slides = friction.falls * (wheels.slip - slip) / (1.0 - wheels.slip)
        rates = friction.slope * (moves - slides)
        rises = Between(min(rates.low, 0.0), max(rates.high, 0.0) + friction.fading)
        # The mean of a sample differs by half of that from either end, and by one and a half from the end of the next.
        aside = 2.0 * friction.drag_change.size
        left = Between(
            -more * (1.5 * rises.high - 0.5 * rises.low) - aside,
            more * (0.5 * rises.high - 1.5 * rises.low) + aside,
        )
        # A wheel that slides on is turned back by what is vented alone: friction only holds it.
        turns = 1.3 * (2.0 * more * friction.fading + aside - twice.low)
        next_back = -turns if falling.low > slides.high and friction.slope.low > -0.05 else -np.inf
        if not 4.0 * friction.loss.high <= SLOWER:
            raise Refused("a train may lose more speed in a sample than is assumed")
        if spare.low <= left.low and left.high <= spare.high and back <= next_back:
            return moves, slip, friction, rises
        spare, back = 1.2 * left, 1.2 * next_back
    raise Refused("the friction may change without bound within two samples")


def goes(wheels: Wheels, way: Between, added: float) -> Between:
    """Return what the valve may go; a part of a way differs little from that of a short one."""
    fills, vents = wheels.fills.high * (1.0 + added) * MORE, wheels.vents.high * MORE
    return Between(vents * min(way.low, 0.0), fills * max(way.high, 0.0))
