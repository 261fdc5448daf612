"""Whether all wheels of a cell that are on the braking curve come into the ellipsoid of a band.

The state of a wheel at a sample is the pull P, z, p and x; all wheels of a cell stay in a polytope, whose bounds are
worked out from sample to sample. The first samples are followed in time. Then the pull falls through rows: each is as
wide as the largest fall in a sample, so that every wheel has a sample in each, and the polytope of a row holds what a
sample makes of it, too. At last the samples are followed in time again until the polytope lies in the ellipsoid.

See :mod:`braked_sample` for what bounds a sample.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import reduce
from typing import NamedTuple, TypeAlias

import numpy as np

from wspd_design.certificates.kernel.checker import Refused
from wspd_design.certificates.records import Problem
from wspd_design.certificates.theorems.from_rolling.braked_sample import (
    SLOWER,
    Sample,
    State,
    goes,
    sample_of,
)
from wspd_design.certificates.theorems.from_rolling.braked_wheel import (
    SUPPLY,
    Between,
    Wheels,
    wheels_of,
)
from wspd_design.certificates.theorems.from_rolling.reached import arrived
from wspd_design.certificates.theorems.from_rolling.sample import (
    PULL,
    WAY,
    LawNumbers,
    law_numbers,
)
from wspd_design.certificates.theorems.from_rolling.support import Array, Polytope, directions
from wspd_design.certificates.theorems.slip_band.arrival import Asked
from wspd_design.certificates.theorems.slip_band.statement import LETTERS, NAMES, law_of

Numbers: TypeAlias = Mapping[str, tuple[float, float]]
"""Ranges of the eight numbers of a cell."""

FALLING = np.array([1.0, 1.0, 0.8, -1.0])  # about y, for an observer as fast as is usual
IN_TIME = np.vstack([directions(1, (1.0, 2.0, 2.0, 1.0)), FALLING, FALLING - PULL])
IN_ROWS = np.vstack([PULL, np.pad(directions(2, (2.0, 2.0, 1.0)), ((0, 0), (1, 0))), FALLING - PULL])
FARTHER = (0.02, 0.1, 0.3, 0.8)  # of what the valve may go in a sample, that it may go more in the next one
TRIALS, GROWTH = 60, (0.3, 1.0)  # of a row, and by how much more than needed it grows at first, and later
ROOMY = 1.002  # of the width of a row over the largest fall
ROWS, STEPS = 1_000, 1_000  # at most


class Start(NamedTuple):
    """What all wheels of a cell have at the first sample, after the valve left saturation."""

    z: Between  # rad/s
    p: Between
    error: Between  # e
    way: Between  # x
    slip: Between  # -
    speed: Between  # m/s
    room: float  # rad/s, of the supply above the torque, at least
    supply: float  # -, at least


class Plan(NamedTuple):
    """What the proof says of how to follow the wheels."""

    first: int  # samples that are followed in time
    until: float  # rad/s, pull at which the rows end
    last: int  # samples that are followed in time then, at most
    halved: str = ""  # letters of the ranges that are halved then


class Settled(NamedTuple):
    """What is shown of the wheels when they are there."""

    slip: float  # -, that was not exceeded
    speed: float  # m/s, at least
    fastest: float  # m/s, at most
    samples: float  # at most
    supply: float  # -, at least
    errors: Between  # rad/s, of the wheel speed


def _after(sample: Sample, states: Polytope) -> State:
    """Return the state of the next sample with its bounds."""
    state, loss = sample.state, sample.friction.loss
    return replace(
        state,
        states=states,
        error=sample.next_error,
        speed=Between(state.speed.low - loss.high, state.speed.high - loss.low),
        risen=state.risen + sample.rises,
        top=max(state.top, sample.farthest),
        samples=state.samples + 1.0,
        left=sample.left,
        supply=_supply(sample.wheels, state, 1.0),
    )


def _supply(wheels: Wheels, state: State, samples: float) -> float:
    """Return the least supply some samples later."""
    lacks = (1.0 - state.supply) * float(np.exp(-wheels.supply_rate.low * samples))
    return 1.0 - lacks * (1.0 + 1e-12)


def in_time(law: LawNumbers, wheels: Wheels, state: State, count: int) -> Iterator[Sample]:
    """Follow samples in time; the one after the last is there to be looked at."""
    for _ in range(count + 1):
        sample, after = _next(law, wheels, state)
        yield sample
        state = after


def _next(law: LawNumbers, wheels: Wheels, state: State) -> tuple[Sample, State]:
    """Return the sample of a state, and the state after it."""
    for farther in FARTHER:
        sample = sample_of(law, wheels, state, farther)
        states = Polytope(IN_TIME, *sample.ends(IN_TIME))
        if _near(sample, states):
            return sample, _after(sample, states)
    raise Refused("the way of the valve may grow faster than is assumed")


def _near(sample: Sample, states: Polytope) -> bool:
    """Whether the valve goes no farther in the next sample than was assumed."""
    gone = goes(sample.wheels, Between(*map(float, states.ends(WAY[None])[0])), sample.added)
    return sample.way.low <= gone.low and gone.high <= sample.way.high


def begun(law: LawNumbers, wheels: Wheels, start: Start) -> State:
    """Return the first state."""
    errors = (wheels.slip - start.slip) * start.speed / wheels.radius
    # P = pull(E + ahead (x - P)), which rises with E and x.
    pull = Between(
        _pull(law, errors.low + law.ahead * start.way.low),
        _pull(law, errors.high + law.ahead * start.way.high),
    )
    box = [pull, start.z, start.p, start.way]
    middle, half = (np.array([f(each) for each in box]) for f in (_middle, _half))
    at, reach = IN_TIME @ middle, np.abs(IN_TIME) @ half
    states = Polytope(IN_TIME, at - reach - 1e-12, at + reach + 1e-12)
    y = float(-states.most(-law.falling[None])[0]) - start.error.high
    return State(
        states=states,
        error=start.error,
        speed=start.speed,
        room=start.room,
        left=start.room,
        begun=y,
        risen=0.0,
        supply=start.supply,
        top=start.slip.high,
        samples=0.0,
    )


def _middle(x: Between) -> float:
    return 0.5 * (x.low + x.high)


def _half(x: Between) -> float:
    return 0.5 * (x.high - x.low)


def _pull(law: LawNumbers, seen: float) -> float:
    """Solve P = pull(seen - ahead P) by bisection."""
    low, high = 0.0, law.pull(max(seen, 0.0))
    for _ in range(80):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if law.pull(seen - law.ahead * middle) > middle else (low, middle)
    return 0.5 * (low + high)


class Row(NamedTuple):
    """Bounds of the states in a row, in the order of :data:`IN_ROWS`, and of e."""

    low: Array
    high: Array
    error: Between

    def joined(self, other: "Row") -> "Row":
        """Enclose both."""
        return Row(
            np.minimum(self.low, other.low), np.maximum(self.high, other.high), self.error.union(other.error)
        )

    def holds(self, other: "Row") -> bool:
        """Whether another one lies in it, whatever its pull."""
        inside = (self.low <= other.low)[1:].all() and (self.high >= other.high)[1:].all()
        return bool(inside) and self.error.low <= other.error.low and other.error.high <= self.error.high

    def grown(self, other: "Row", by: float, kept: float) -> "Row":
        """Return a row that may hold another one, to which it leads: it goes on beyond it."""
        low = np.where(other.low < self.low, other.low - by * (self.low - other.low) - 1e-9, self.low)
        high = np.where(other.high > self.high, other.high + by * (other.high - self.high) + 1e-9, self.high)
        # The error fades by itself, so that what comes in leaves it at that over what fades.
        ends = [
            mine + (his - mine) / (1.0 - kept) * 1.01 if beyond else mine
            for mine, his, beyond in (
                (self.error.low, other.error.low, other.error.low < self.error.low),
                (self.error.high, other.error.high, other.error.high > self.error.high),
            )
        ]
        return Row(low, high, Between(*ends))


def through_rows(
    law: LawNumbers, wheels: Wheels, state: State, until: float, rows: list[Sample] | None = None
) -> State:
    """Follow the pull down through rows until it is below a value in all wheels; what a row holds goes to ``rows``."""
    state = replace(state, left=-np.inf)  # the valves fill and vent many times
    ends = state.states.ends(IN_ROWS)
    begins = Row(ends[:, 0], ends[:, 1], state.error)
    (lowest, top), row = map(float, ends[0]), begins
    if lowest <= until:
        raise Refused("the rows end above where wheels begin")
    width, slowest, fastest, rises, passed = 1.1 * law.sigma, np.inf, 0.0, 0.0, False
    for _ in range(ROWS):
        if top <= until:
            return replace(
                state,
                states=Polytope(IN_ROWS, *_with_pull(row, top - fastest, top)),
                error=row.error,
                samples=state.samples + 1.0,
                left=-np.inf,
            )
        sample, row, image_of, width, rises = _row(
            law, wheels, state, row, begins if lowest < top else None, (top, width, rises)
        )
        if rows is not None:
            rows.append(sample)
        change, loss = sample.change, sample.friction.loss
        slowest, fastest = min(slowest, -change.high), max(fastest, -change.low)
        count = width / slowest
        if not (count + 4.0) * loss.high <= SLOWER:
            raise Refused("a train may lose more speed in a row than is assumed")
        if top <= lowest:  # all wheels begin above the row
            least = max(width / fastest - (0.0 if passed else 1.0), 0.0)
            passed = True
        else:
            least = 0.0
        state = replace(
            state,
            speed=Between(state.speed.low - count * loss.high, state.speed.high - least * loss.low),
            risen=state.risen + count * sample.rises,
            top=max(state.top, sample.farthest),
            samples=state.samples + count,
            supply=_supply(wheels, state, least),
        )
        top, row, width = top - width, image_of, max(ROOMY * -change.low, 1e-9)
    raise Refused("there are too many rows")


def _with_pull(row: Row, bottom: float, top: float) -> tuple[Array, Array]:
    low, high = row.low.copy(), row.high.copy()
    low[0], high[0] = bottom, top
    return low, high


def _row(
    law: LawNumbers,
    wheels: Wheels,
    state: State,
    row: Row,
    begins: Row | None,
    guess: tuple[float, float, float],
) -> tuple[Sample, Row, Row, float, float]:
    """Find bounds of a row that its samples do not leave; with what they lead to, its width, and what friction rises.

    ``guess`` are the top of the row, its width, and by how much the friction may rise while a wheel is in it.
    """
    top, width, rises = guess
    for trial in range(TRIALS):
        here = replace(
            state,
            states=Polytope(IN_ROWS, *_with_pull(row, top - width, top)),
            error=row.error,
            risen=state.risen + rises,
        )
        sample = sample_of(law, wheels, here, FARTHER[1])
        change = sample.change
        if change.high >= 0.0:
            raise Refused("the pull may not fall")
        if -change.low > width:
            width = -change.low * ROOMY
            continue
        if width / -change.high * sample.rises > rises:
            rises = 1.5 * width / -change.high * sample.rises
            continue
        leads = Row(*sample.ends(IN_ROWS), sample.next_error)
        if begins is not None:
            leads = leads.joined(begins)
        if row.holds(leads):
            if not _near(sample, Polytope(IN_ROWS, *_with_pull(leads, top - width, top))):
                raise Refused("the way of the valve may grow faster than is assumed")
            return sample, row, leads, width, rises
        row = row.grown(leads, GROWTH[trial > 5], law.kept)
    raise Refused("the states of a row do not stay in it")


def settles(
    problem: Problem,
    numbers: Numbers,
    start: Start,
    asked: Sequence[Asked],
    plan: Plan,
) -> Settled:
    """Return what is shown of the wheels of a cell at a sample at which they are in all ellipsoids, or refuse it.

    Parameters
    ----------
    problem : Problem
        Loop of a law with a braking curve, and the box.
    numbers : mapping
        Range of each of the eight numbers in the cell.
    start : Start
        What its wheels have at the first sample.
    asked : sequence of Asked
        Of the ellipsoids of all cells of the band that the cell meets.
    plan : Plan
        How the wheels are followed.
    """
    exact = law_of(problem.controller)
    if not asked:
        raise Refused("there is no band to come to")
    if exact.torque_slew is None or exact.falls or exact.dead_band or exact.least_pulse:
        raise Refused("the law has no braking curve, or a slip that changes, or it leaves ways out")
    if not 0 <= plan.first <= STEPS or not 0 <= plan.last <= STEPS:
        raise Refused("the plan follows too many samples")
    law, wheels = law_numbers(exact), wheels_of(problem, exact, numbers)
    state = begun(law, wheels, start)
    for sample in in_time(law, wheels, state, plan.first):
        state = sample.state
    state = through_rows(law, wheels, state, plan.until)
    parts = [(wheels_of(problem, exact, part), part) for part in _halves(numbers, plan.halved)]
    return reduce(_either, (_settled(law, *part, state, asked, plan.last) for part in parts))


def _halves(numbers: Numbers, letters: str) -> list[Numbers]:
    """Return parts that cover a cell, with some ranges halved."""
    found = [numbers]
    for letter in letters:
        name = (*NAMES, SUPPLY)[(LETTERS + "s").index(letter)]
        found = [
            {**each, name: half}
            for each in found
            for (low, high), middle in [(each[name], 0.5 * (each[name][0] + each[name][1]))]
            for half in ((low, middle), (middle, high))
        ]
    return found


def _either(one: Settled, other: Settled) -> Settled:
    """Return what holds of both."""
    return Settled(
        slip=max(one.slip, other.slip),
        speed=min(one.speed, other.speed),
        fastest=max(one.fastest, other.fastest),
        samples=max(one.samples, other.samples),
        supply=min(one.supply, other.supply),
        errors=one.errors.union(other.errors),
    )


def _settled(
    law: LawNumbers, wheels: Wheels, numbers: Numbers, state: State, asked: Sequence[Asked], count: int
) -> Settled:
    """Follow wheels in time until they are in all ellipsoids, or refuse it."""
    for sample in in_time(law, wheels, state, count):
        if arrived(sample, asked, numbers):
            return Settled(
                slip=max(sample.state.top, sample.farthest),
                speed=sample.state.speed.low,
                fastest=sample.state.speed.high,
                samples=sample.state.samples,
                supply=sample.state.supply,
                errors=sample.errors,
            )
    raise Refused("wheels may not be in the ellipsoid at the end")
