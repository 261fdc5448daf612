"""What observer, filter and law make of wheels whose valves fill without a pause, at each slip that they pass.

From rolling the law wants more torque than there is, and the valve fills all of each sample. What the observer and the
filter have not yet learned of the friction is followed from part to part of the slip: a sample keeps a part of what it
was where the sample began, which was in parts that are known, and adds what the friction changes by meanwhile
(:mod:`passing`). What the law wants follows from it: docs/theory.md#all-ways-in.
"""

from dataclasses import dataclass

import numpy as np

from wspd_design.certificates.kernel.interval import Array, Interval, Where
from wspd_design.certificates.theorems.from_rolling.cells import Cells
from wspd_design.certificates.theorems.from_rolling.passing import (
    EDGES,
    FIRST,
    Passing,
    Windows,
    lags_of,
    least_over,
    most_over,
    over,
    passed_through,
    rooms_of,
    steepest,
)
from wspd_design.certificates.theorems.from_rolling.sample import LawNumbers, pulls
from wspd_design.certificates.theorems.from_rolling.supply import SPARE

VENTS = 1.1  # times what the law wants to be vented, that a valve takes off in it at most
PASSES = 2  # of bounds of the speed
SLOWER = 0.2  # of what the train loses, by which they are then moved outwards


@dataclass(frozen=True, slots=True, kw_only=True)
class Filled:
    """Wheels at a sample up to which the valve filled, by the part of the slip that they are in."""

    alive: Where  # whether they may be there
    opens: Where  # whether it may not fill all of the sample any more
    z: Interval  # rad/s
    p: Interval
    error: Interval  # e
    fall: Interval  # y [rad/s]
    way: Array  # x, at least [rad/s]
    room: Interval  # rad/s
    motion: Array  # q, at most [rad/s]
    rate: Array  # of the torque so far, at most [rad/s per sample]
    steep: Array  # S q, at most [rad/s]
    speed: Interval  # m/s
    supply: Array  # -, of the full pressure at least
    time: Array  # samples since the brake was demanded, at most
    lost: Where  # of cells


def filled(law: LawNumbers, cells: Cells, fastest: float) -> Filled:
    """Follow wheels that roll at a speed [m/s] when the brake is demanded."""
    count, parts = cells.effect.low.size, EDGES.size - 1
    slow = np.broadcast_to(np.linspace(1.0, 0.97, parts) * fastest - 0.02, (count, parts))
    speed = Interval(slow, np.full(slow.shape, fastest))
    with np.errstate(all="ignore"):
        for _ in range(PASSES):
            found = passed_through(law, cells, fastest, speed).later
            speed = Interval(
                np.minimum(fastest - (1.0 + SLOWER) * (fastest - found.low) - 0.02, fastest),
                np.minimum(fastest - (1.0 - SLOWER) * (fastest - found.high) + 0.02, fastest),
            )
        return _filled(law, cells, passed_through(law, cells, fastest, speed), speed)


def _filled(law: LawNumbers, cells: Cells, passing: Passing, assumed: Interval) -> Filled:
    """Follow what observer and filter have learned, and see what the law wants."""
    windows = Windows(passing)
    wheels, there, motion = passing.wheels, passing.there, passing.motion
    own, parts = windows.own, EDGES.size - 1
    theta, kept, beta = law.theta, law.kept, (1.0 - law.theta) / law.theta
    steep, fading = steepest(wheels, passing), np.maximum.accumulate(there.fading, axis=1)
    rooms = rooms_of(law, cells, passing)
    nominal = law.over_fill * law.nominal  # of the room, that the law takes a sample to fill
    rolls = 2.0 * there.drag.high * (EDGES[:-1] <= FIRST)  # what a wheel that rolls may go back by
    slope = there.slope
    level = Interval(np.where(slope.low > 0.0, slope.low * motion.low, slope.low * motion.high), steep)
    rises = over(level, windows.far, own) + Interval(0.0, fading)  # S q and more in the last sample
    # --- what the torque does beyond what the law takes it for
    ratio = np.minimum(
        cells.supply_rate.high[:, None] * cells.one.full / least_over(rooms.low, windows.far, own), 1.0
    )
    tau = wheels.fills * law.over_fill
    goes = (1.0 - (-tau).exp()) * Interval(1.0, 1.0 + 0.506 * ratio)
    own_mean = Interval(0.5 * nominal * (1.0 - nominal / 3.0), 0.5 * nominal) / goes
    aside = 0.506 * ratio / 6.0
    unlike = wheels.effect * Interval(0.5 - aside, 0.5056) - own_mean
    least = np.where(windows.far == 0, 0.0, np.maximum(least_over(passing.least_rate, windows.far, own), 0.0))
    change = Interval(least, passing.rate)
    learned = ((wheels.effect - 1.0) - (1.0 - theta) * unlike) * change
    unlike = unlike * change
    fastest = np.maximum.accumulate(motion.high, axis=1) + there.drag.high
    eases = there.eases + (wheels.share * wheels.damping).high * fastest
    drag = there.drag.high.max(axis=1, keepdims=True)
    # A wheel that rolls back before there is a torque loses a little friction: no more than this.
    rolls_back, grown = 1.2 * drag, np.maximum(there.friction.high, 0.0) + 3.6 * drag
    share = wheels.share.high
    # x - P is as well what the observer has of the torque and of the motion, less the torque.
    seven = windows.far
    for _ in range(6):
        seven = np.take_along_axis(windows.far, seven, axis=1)
    known = 0.93 * 0.5 * nominal * (1.0 - nominal / 3.0) * least_over(rooms.low, seven, own)
    known = (
        known
        - lags_of(law, cells, passing)
        - _observed(law, windows, there.slides.high + motion.high)
        - 0.5 * drag
    )

    def learned_of(cut: Array) -> tuple[Interval, Interval, Interval, Interval]:
        """Return z, p and e at an instant, and x - P, if no more than something was cut off."""
        at, p, at_error = _learned(
            law,
            windows,
            starts=((2.4 * drag, 0.0 * drag), (0.0 * drag, 0.0 * drag), (1.2 * drag, share * rolls_back)),
            totals=(
                grown + np.maximum.accumulate(np.maximum(-learned.low, 0.0), axis=1) / (1.0 - theta),
                share * grown + 1.2 * drag,
            ),
            of_z=learned - (0.5 * (1.0 + theta)) * rises + Interval(0.0 * cut, (1.0 - theta) * cut),
            of_p=unlike - Interval(np.minimum(0.5 * rises.low, 0.0), 0.5 * rises.high),
            of_error=(0.5 * (1.0 + kept)) * (wheels.share * rises) + Interval(-eases, rolls),
        )
        # What comes in the next sample has no part in what is wanted.
        asked = at + beta * p - at_error - (there.slides + motion + Interval(0.0, there.eases))
        asked = asked.at_least(known - at_error.high)  # x - P
        return at, p, at_error, asked

    cut = _cut(passing, unlike.high)
    *_, asked = learned_of(0.0 * cut)
    observed = passing.torque.low + asked.low - np.maximum.accumulate(there.falls.high, axis=1)
    enough = observed > (1.0 - theta) / theta * cut
    # From this part on nothing is cut.
    first = np.where(enough.all(axis=1), 0, parts - np.argmin(enough[:, ::-1], axis=1))
    at, p, at_error, asked = learned_of(np.where(windows.far < first[:, None], cut, 0.0))
    errors = (cells.one.slip - Interval(EDGES[:-1], EDGES[1:])) * passing.speed / wheels.radius
    seen = errors + law.ahead * asked
    way = Interval(pulls(law, seen.low), pulls(law, seen.high)) + asked
    vents = VENTS * np.maximum(wheels.vents.high, 1.0) * np.maximum(-way.low, 0.0)
    coming = _coming(passing, windows, steep, fading, vents)
    z, error = at - coming, at_error + wheels.share * coming
    fall = there.slides + motion - (1.0 + wheels.share) * coming
    fall = Interval(np.maximum(fall.low, 0.0), fall.high + there.eases)
    whole = law.fills * rooms
    alive = way.high >= whole.low
    ended = parts - np.argmax(alive[:, ::-1], axis=1)
    # A sample that fills leads beyond the part in which it began.
    ended = np.maximum(ended, windows.next[np.arange(len(ended)), ended - 1])
    here = np.arange(parts) < ended[:, None]
    steady = cells.effect.low[:, None] * passing.least_rate > (1.0 + wheels.share.high * 1.2) * there.fading
    sound = (
        np.isfinite(way.low)
        & np.isfinite(way.high)
        & np.isfinite(passing.rate)
        & (passing.later.low >= assumed.low)
        & (passing.later.high <= assumed.high)
    )
    for each in (z, p, error, rooms):
        sound &= np.isfinite(each.low) & np.isfinite(each.high)
    sound &= steady | (np.arange(parts) == 0)
    lost = ~(sound | ~here).all(axis=1) | (ended >= parts) | (tau.high[:, 0] > 1.0)
    return Filled(
        alive=here,
        opens=here & (way.low < whole.high),
        z=z,
        p=p,
        error=error,
        fall=fall,
        way=way.low,
        room=rooms,
        motion=motion.high,
        rate=passing.rate,
        steep=steep,
        speed=passing.later,
        supply=(passing.torque.low + rooms.low) / cells.one.full * (1.0 - SPARE),
        time=passing.passed,
        lost=lost,
    )


def _cut(passing: Passing, unlike: Array) -> Array:
    """By how much less than 0 may have been put into the observer, which the law takes for none.

    That is the torque less the motion of the wheel, and as well the friction less what the torque does beyond what the
    law takes it for: docs/theory.md#bounds-of-ways-in.
    """
    wheels, there = passing.wheels, passing.there
    share = 1.0 - wheels.effect + wheels.effect / (1.0 + wheels.share)  # of the torque, that is shown at rest
    hidden = (np.maximum(there.slides.high, 0.0) + passing.motion.high + there.drag.high) / (
        1.0 + wheels.share.low
    )
    shown = share.low * passing.torque.low - hidden
    beside = np.maximum(wheels.effect.high - 1.0, 0.0) * passing.torque.high + np.maximum(unlike, 0.0)
    shown = np.maximum(shown, there.friction.low - 1.2 * there.drag.high * (EDGES[:-1] <= FIRST) - beside)
    found: Array = np.maximum.accumulate(np.maximum(-shown, 0.0), axis=1)
    return found


def _learned(
    law: LawNumbers,
    windows: Windows,
    starts: tuple[tuple[Array, Array], ...],
    totals: tuple[Array, Array],
    of_z: Interval,
    of_p: Interval,
    of_error: Interval,
) -> tuple[Interval, Interval, Interval]:
    """Follow z, p and e from part to part: what a sample keeps of them where it began, and what it adds.

    Largest values are followed: of each state the upper end, and the lower one with its sign turned. ``starts`` are
    those at rest, ``totals`` more than all that may be added to the lower end of z and to the upper one of e.
    """
    shape, (theta, kept) = windows.own.shape, (law.theta, law.kept)
    added = np.stack([np.stack([each.high, -each.low]) for each in (of_z, of_p, of_error)])
    found = np.empty((3, 2, *shape))
    rest = np.array([[end[:, 0] for end in each] for each in starts])
    for k in range(shape[1]):
        z, p, error = _before(found, windows, k, rest)
        same = windows.near[:, k] == k
        found[0, :, :, k] = _kept(theta, z, added[0, :, :, k], same)
        found[0, 1, :, k] = np.minimum(found[0, 1, :, k], totals[0][:, k])
        z = np.where(same, np.maximum(z, found[0, :, :, k]), z)
        found[1, :, :, k] = _kept(theta, p, theta**2 * (z + added[1, :, :, k]), same)
        found[2, :, :, k] = _kept(kept, error, added[2, :, :, k], same)
        found[2, 0, :, k] = np.minimum(found[2, 0, :, k], totals[1][:, k])
    found = found + SPARE * np.abs(found) + 1e-15
    z, p, error = (Interval(-each[1], each[0]) for each in found)
    return z, p, error


def _observed(law: LawNumbers, windows: Windows, values: Array) -> Array:
    """What the observer makes at most of something that has these values in the parts, and was 0 at rest."""
    found, share = most_over(values, windows.far, windows.own), 1.0 - law.theta
    for _ in range(2):
        once = np.empty(found.shape)
        for k in range(found.shape[1]):
            before = _before(once, windows, k, np.zeros(len(found)))
            once[:, k] = _kept(law.theta, before, share * found[:, k], windows.near[:, k] == k)
        found = once
    return found


def _before(found: Array, windows: Windows, k: int, rest: Array) -> Array:
    """Return the largest values where wheels of part k may have been a sample ago, at rest too, but in that part."""
    first, last = windows.far[:, k], np.minimum(windows.near[:, k], k - 1)
    before = np.full(rest.shape, -np.inf)
    wide = int((last - first).max(initial=-1)) + 1
    if wide > 0:
        index = np.minimum(first[:, None] + np.arange(wide), last[:, None])
        index = np.maximum(index, 0).reshape((1,) * (found.ndim - 2) + index.shape)
        before = np.take_along_axis(found, index, axis=-1).max(axis=-1)
    return np.where(first == 0, np.maximum(before, rest), before)


def _kept(factor: float, before: Array, more: Array, same: Where) -> Array:
    """What a sample makes of values before it; for wheels that may stay in a part as well what adds up in the end."""
    after: Array = factor * before + more
    return np.where(same, np.maximum(after, more / (1.0 - factor)), after)


def _coming(passing: Passing, windows: Windows, steep: Array, fading: Array, vents: Array) -> Interval:
    """What the mean over the next sample has more than the friction at its beginning.

    In it the valve goes on to fill, or vents no more than ``vents``.
    """
    wheels, motion, slope = passing.wheels, passing.motion, passing.there.slope
    last = np.minimum(windows.next, windows.own.shape[1] - 1)
    most = np.maximum(most_over(steep, windows.own, last), 0.0) + fading
    g, slower = wheels.effect.high, (1.0 + 1.2 * wheels.share.high) * most
    # Friction that rises slows a wheel down to rest and no further.
    moved = Interval(np.maximum(motion.low - slower, 0.0) - g * vents, 1.1 * (motion.high + g * passing.rate))
    rises = over(slope, windows.own, last) * moved
    # One that turns round where the friction falls gains some as well.
    back = np.minimum(slope.low, 0.0) * np.minimum(moved.low, 0.0)
    return Interval(0.5 * rises.low, 0.5 * (most + back))
