"""What wheels on the braking curve have at a sample, and bounds of all that enters it.

See :mod:`sample` for the map; what the friction does within a sample is bounded here.
"""

from dataclasses import dataclass

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

SPARES = 6  # trials of what the friction adds to the change of the error within two samples
NONE = Between(0.0, 0.0)
MORE = 1.03  # times rho, that a valve goes of a way at most
SLOWER = 0.3  # m/s, that a train may lose within the samples that a bound speaks about


@dataclass(frozen=True, slots=True, kw_only=True)
class State:
    """All wheels at a sample."""

    states: Polytope
    error: Between  # e [rad/s]
    speed: Between  # m/s
    room: float  # rad/s, at the first sample
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
    if room <= 0.0:
        raise Refused("there may be no room in the supply")
    added = 0.52 * rise / room
    gone = goes(wheels, way, added)
    # Within two samples the torque changes by what the valve goes in both; the mean of both, weighted as the friction
    # is, has all of the first way and half of the second at most.
    then = gone + Between(-gone.size, gone.size) * farther
    twice = (wheels.effect * (gone + then)).union(NONE)
    mean = (wheels.effect * (gone + 0.5 * then)).union(NONE)
    moves, slip, friction, spare = _within_two(wheels, state, errors, falling + twice)
    slope, drag = friction.slope, friction.drag_change
    slides = friction.falls * (wheels.slip - slip) / (1.0 - wheels.slip)  # w
    beside = slope * (mean + Between(-spare, spare) - slides) + Between(0.0, friction.fading)
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
        added=added,
        way=then,
        reach=moves,
        farthest=slip.high,
    )


def _within_two(
    wheels: Wheels, state: State, errors: Between, falls: Between
) -> tuple[Between, Between, Friction, float]:
    """Bound what the error falls by in this sample as in the next, the slip, the friction, and what that adds to it."""
    speed, spare = Between(state.speed.low - SLOWER, state.speed.high), 0.0
    for _ in range(SPARES):
        moves = Between(min(falls.low - spare, 0.0), max(falls.high + spare, 0.0))
        turned = Between(errors.low - 2.0 * moves.high, errors.high - 2.0 * moves.low)
        slip = wheels.slip - turned * wheels.radius / speed
        friction = wheels.friction(slip, speed, moves.size)
        changes = 2.0 * friction.slope.size * moves.size + 2.0 * friction.fading
        left = (1.0 + wheels.share.high) * changes + 2.0 * friction.drag_change.size
        if not 4.0 * friction.loss.high <= SLOWER:
            raise Refused("a train may lose more speed in a sample than is assumed")
        if left <= spare:
            return moves, slip, friction, spare
        spare = 1.2 * left
    raise Refused("the friction may change without bound within two samples")


def goes(wheels: Wheels, way: Between, added: float) -> Between:
    """Return what the valve may go; a part of a way differs little from that of a short one."""
    fills, vents = wheels.fills.high * (1.0 + added) * MORE, wheels.vents.high * MORE
    return Between(vents * min(way.low, 0.0), fills * max(way.high, 0.0))
