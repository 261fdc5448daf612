"""What wheels of a cell can be while their valves fill without a pause, at each slip that they pass.

From rolling the law wants more torque than there is, and the valve fills all of each sample. Nothing that the law
measures changes that: the torque is a function of time alone. So the motion q = Y - w of a wheel can be bounded over
the slip that it passes, and from how far it moves in a sample at least and at most, where it was some samples ago. The
observer and the filter of the law are sums over those samples: docs/theory.md#all-ways-in.

The slip is divided at :data:`EDGES`; arrays have a row for each cell and a column for each part of the slip. Ends are
moved outwards by :data:`SPARE` of them, far more than they are rounded by.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from wspd_design.certificates.kernel.interval import Array, Interval, Where
from wspd_design.certificates.theorems.from_rolling.cells import Cells, Sliding, sliding
from wspd_design.certificates.theorems.from_rolling.sample import LawNumbers
from wspd_design.certificates.theorems.from_rolling.supply import SPARE, Filling

Index = NDArray[np.int_]

SINK = 1e-4  # slip below 0 that a wheel that rolls does not exceed
FIRST, GROWS, GRAIN, STRIDE, LAST = 2e-5, 1.02, 8e-6, 7e-4, 0.125  # parts of the slip, narrow ones first
TAPERED = 0.03  # slip from which on they have one width
INNER = 2  # steps of the motion within a part
BACK = 24  # samples that are looked back on
WEIGHED = 14  # of them, that the observer weighs one by one
FLOOR = 0.02  # slope of the friction, below which its own bound is used
SLOWER = 0.2  # of what the train loses by a first bound, that it may lose more
CREEP = 0.002  # rad/s, motion that is enough at first


def _edges() -> Array:
    found = [-SINK, FIRST]
    while found[-1] < LAST:
        found.append(found[-1] * GROWS + GRAIN if found[-1] < TAPERED else found[-1] + STRIDE)
    return np.array(found)


EDGES = _edges()


@dataclass(frozen=True, slots=True, kw_only=True)
class Filled:
    """Wheels at a sample up to which the valve filled, by the part of the slip that they are in."""

    alive: Where  # whether the valve may go on filling there
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
    speed: Array  # m/s, at least
    time: Array  # samples since the brake was demanded, at most
    lost: Where  # of cells


@dataclass(frozen=True, slots=True, kw_only=True)
class _Passing:
    """How wheels pass the parts of the slip."""

    wheels: Cells  # a column
    speed: Interval  # m/s
    there: Sliding
    motion: Interval  # q [rad/s]
    rate: Array  # of the torque so far, at most [rad/s per sample]
    least_rate: Array  # at the torques of the part
    soonest: Array  # samples, since the brake was demanded at least
    latest: Array  # on the fastest filling, when its torque is that of the part at most
    slow: tuple[Array, Array]  # on the slowest one, when its torque is that of the part at least and at most
    torque: Interval  # rad/s
    slowest: Array  # m/s, that the train has at the end of a part
    passed: Array  # samples since the brake was demanded, when wheels have passed a part


def filled(law: LawNumbers, cells: Cells, fastest: float) -> Filled:
    """Follow wheels that roll at a speed [m/s] when the brake is demanded."""
    count, parts = cells.effect.low.size, EDGES.size - 1
    slow = np.broadcast_to(np.linspace(1.0, 0.97, parts) * fastest - 0.02, (count, parts))
    with np.errstate(all="ignore"):
        slow = _passing(law, cells, fastest, slow).slowest
        slow = np.minimum(fastest - (1.0 + SLOWER) * (fastest - slow) - 0.02, fastest)
        return _filled(law, cells, _passing(law, cells, fastest, slow), slow)


def _passing(law: LawNumbers, cells: Cells, fastest: float, slow: Array) -> _Passing:
    """Bound how fast wheels move through each part, if the train has no less than ``slow`` there."""
    count, parts = slow.shape
    wheels = cells.at((slice(None), None))
    slip = Interval(np.broadcast_to(EDGES[:-1], slow.shape), np.broadcast_to(EDGES[1:], slow.shape))
    speed = Interval(slow, np.full(slow.shape, fastest))
    there = sliding(wheels, slip, speed)
    tau = cells.fills * law.over_fill
    fast = Filling(cells.one.full, cells.supply_rate.high, tau.high)
    late = Filling(cells.one.full, cells.supply_rate.low, tau.low)
    torque_of = (1.0 + wheels.share) * there.friction + there.drag
    reference = cells.one.slip
    aside = (reference + SINK) / (1.0 - reference)
    faster, slower = (fastest / wheels.radius).high[:, 0], (speed / wheels.radius).low
    width = np.diff(EDGES)
    share = cells.share
    found = {
        name: np.empty((count, parts)) for name in ("q", "least", "rate", "slow rate", "T low", "T high")
    }
    times = {name: np.empty((count, parts)) for name in ("soon", "fast", "since", "until")}
    crossing = np.empty((count, parts))
    q, least, rate, lowest = (np.zeros(count) for _ in range(4))
    begun = np.full(count, 1.5)
    when = dict.fromkeys(times, begun)
    peak = fast.peak
    for k in range(parts):
        slope, loses = there.slope[:, k], (there.loss / speed).high[:, k]
        damped = share.high * cells.damping.high
        slides = np.maximum(there.slides.high[:, k], 0.0)
        lowest = np.maximum(lowest, (torque_of.low[:, k] + least) / cells.effect.high)
        assumed = 1.1 * q + 0.004
        for _ in range(2):
            most = np.maximum((torque_of.high[:, k] + slides + assumed) / cells.effect.low, lowest)
            when["fast"] = fast.until(most, when["fast"])
            rate_there = fast.rate(np.minimum(when["fast"], peak)) * (1.0 + SPARE) + SPARE
            beside = loses * assumed + (1.0 + aside) * (there.eases[:, k] + damped * assumed)
            drive = cells.effect.high * np.maximum(rate, rate_there) + beside
            held = np.where(slope.low > 0.0, 1.0 + share.low, 1.0 + share.high * (1.0 + aside)) * slope.low
            after = _faster(q, drive, held, 2.0 * faster * width[k])
            assumed = np.where(after <= assumed, assumed, 1.3 * after)
        moved = np.where(after <= assumed, after, np.inf)
        rate = np.maximum(rate, rate_there)
        when["soon"] = fast.since(lowest, when["soon"])
        when["since"], when["until"] = late.since(lowest, when["since"]), late.until(most, when["until"])
        slow_rate = np.minimum(late.rate(when["since"]), late.rate(when["until"])) * (1.0 - SPARE) - SPARE
        drive = cells.effect.low * slow_rate - (1.0 + share.high * (1.0 + aside)) * there.fading[:, k]
        held = np.maximum(slope.high, 0.0) * (1.0 + share.high * (1.0 + aside))
        slower_after = _slower(least, drive, held, width[k] * slower[:, k], width[k] * faster)
        crossing[:, k] = width[k] * faster / np.maximum(np.minimum(least, slower_after), 1e-9)
        for name, value in zip(
            found,
            (np.maximum(q, moved), np.minimum(least, slower_after), rate, slow_rate, lowest, most),
            strict=True,
        ):
            found[name][:, k] = value
        for name in times:
            times[name][:, k] = when[name]
        q, least = moved, slower_after
    passed = _passed(cells, there, torque_of, late, crossing, fastest)
    spent = np.diff(passed, axis=1, prepend=0.0)
    return _Passing(
        wheels=wheels,
        speed=speed,
        there=there,
        motion=Interval(found["least"], found["q"]),
        rate=found["rate"],
        least_rate=found["slow rate"],
        soonest=times["soon"],
        latest=times["fast"],
        slow=(times["since"], times["until"]),
        torque=Interval(found["T low"], found["T high"]),
        slowest=fastest - np.cumsum(spent * there.loss.high, axis=1) * (1.0 + SPARE),
        passed=passed,
    )


def _faster(q: Array, drive: Array, held: Array, length: Array) -> Array:
    """Return the motion at the end of a part at most: d(q^2)/ds = 2 (v/R) (drive - held q)."""
    most = np.where(held > 0.0, drive / np.maximum(held, 1e-12), np.inf)
    for _ in range(INNER):
        push = drive - held * q
        moved = np.sqrt(q * q + length / INNER * np.maximum(push, 0.0)) * (1.0 + SPARE)
        q = np.where(push > 0.0, np.minimum(moved, np.maximum(most, q)), q)
    return q


def _slower(q: Array, drive: Array, held: Array, length: Array, longest: Array) -> Array:
    """Return the motion at the end of a part at least; where it rises, with what holds it at the end."""
    level = np.where(held > 0.0, drive / np.maximum(held, 1e-12), np.inf)
    for _ in range(INNER):
        k = length / INNER
        rising = -k * held + np.sqrt((k * held) ** 2 + q * q + 2.0 * k * np.maximum(drive, 0.0))
        falling = np.sqrt(np.maximum(q * q + 2.0 * longest / INNER * np.minimum(drive - held * q, 0.0), 0.0))
        q = np.where(q <= level, np.minimum(rising, level), np.maximum(falling, level))
        q = np.maximum(q * (1.0 - SPARE) - 1e-15, 0.0)
    return q


def _passed(
    cells: Cells, there: Sliding, torque_of: Interval, late: Filling, crossing: Array, fastest: float
) -> Array:
    """Return when wheels have passed each part at the latest.

    That is as long after they come to it as they take with the least motion; or as they take with a motion of
    :data:`CREEP` from when the torque is enough for that at all slips so far.
    """
    torque = (torque_of.high + np.maximum(there.slides.high, 0.0) + CREEP) / cells.effect.low[:, None]
    most = np.maximum.accumulate(torque, axis=1)
    passed = np.empty_like(crossing)
    time, enough = np.zeros(len(crossing)), np.full(len(crossing), 1.5)
    for k in range(crossing.shape[1]):
        enough = late.until(most[:, k], np.where(np.isfinite(enough), enough, 1.5))
        creeping = enough + (EDGES[k + 1] + SINK) * fastest / cells.radius.low / CREEP
        time = np.minimum(time + crossing[:, k], np.maximum(creeping, time))
        passed[:, k] = time
    return passed


class _Windows:
    """Where wheels that are in a part of the slip were some samples ago, as numbers of edges."""

    def __init__(self, passing: _Passing) -> None:
        speed, wheels = passing.speed, passing.wheels
        count, parts = speed.low.shape
        self.own: Index = np.tile(np.arange(parts), (count, 1))
        slow = np.minimum.accumulate(passing.motion.low[:, ::-1], axis=1)[:, ::-1]
        most = np.maximum.accumulate(passing.motion.high, axis=1)
        least_way = (wheels.radius.low / speed.high) * slow * (1.0 - SPARE)
        way = (wheels.radius.high / speed.low) * most * (1.0 + SPARE)
        ahead = (wheels.radius.high / speed.low) * (most + 2.0 * wheels.effect.high * passing.rate)
        self._near, self._near_half = (self._begin(least_way * part) for part in (1.0, 0.5))
        self._far, self._far_half = (self._end(way * part) for part in (1.0, 0.5))
        self.next = np.minimum(
            np.array([np.searchsorted(EDGES, row) for row in EDGES[1:] + ahead * (1.0 + SPARE)]), parts
        )
        self.near, self.far = [self.own], [self.own]
        for _ in range(BACK + 1):
            self.near.append(self._at(self._near, self.near[-1]))
            self.far.append(self._at(self._far, self.far[-1]))

    def _begin(self, way: Array) -> Index:
        """Last part from which a part is reached with the least way."""
        reached = np.minimum.accumulate((EDGES[:-1] + way)[:, ::-1], axis=1)[:, ::-1]
        found = np.array([np.searchsorted(row, EDGES[1:], side="right") - 1 for row in reached])
        clipped: Index = np.minimum(np.maximum(found, 0), self.own)
        return clipped

    def _end(self, way: Array) -> Index:
        """First part from which a part is reached with the longest way."""
        found = np.array([np.searchsorted(EDGES, row, side="right") - 1 for row in EDGES[:-1] - way])
        clipped: Index = np.minimum(np.maximum(found, 0), self.own)
        return clipped

    @staticmethod
    def _at(table: Index, index: Index) -> Index:
        return np.take_along_axis(table, index, axis=1)

    def last_middle(self, back: int) -> Index:
        """Last part in which the middle of the sample before some others was."""
        return self._at(self._near_half, self.near[back])

    def first_middle(self, back: int) -> Index:
        """First part in which it was."""
        return self._at(self._far_half, self.far[back])


class _Growth:
    """What the friction has more at a later part of the slip than at an earlier one."""

    def __init__(self, passing: _Passing, windows: _Windows) -> None:
        slope, speed, wheels = passing.there.slope, passing.speed, passing.wheels
        length = (np.diff(EDGES) * speed) / wheels.radius
        steps = slope * length
        zero = np.zeros((len(steps.low), 1))

        def summed(ends: Array) -> Array:
            return np.concatenate([zero, np.cumsum(ends, axis=1)], axis=1)

        # Where it rises and where it falls, one by one: at an edge both are known to no more than a part.
        self._rise = tuple(summed(np.maximum(ends, 0.0)) for ends in (steps.low, steps.high))
        self._fall = tuple(summed(np.minimum(ends, 0.0)) for ends in (steps.low, steps.high))
        spare = SPARE * np.abs(summed(np.abs(steps.high)))[:, 1:]
        self.faded = np.maximum.accumulate(passing.there.fading, axis=1) + spare
        # A wheel that had not begun to slide had a little less than none.
        self._before = np.where(EDGES[1:] > 0.0, 1.2 * passing.there.drag.high, 0.0)
        self._windows = windows

    def between(self, late: tuple[Index, Index], early: tuple[Index, Index]) -> Interval:
        """Growth from an edge between two to one between two others, not counting the fall of the speed."""
        inner = late[0], np.minimum(early[1], late[0])
        outer = late[1], np.minimum(early[0], late[1])

        def over(sums: Array, ends: tuple[Index, Index]) -> Array:
            return np.take_along_axis(sums, ends[0], 1) - np.take_along_axis(sums, ends[1], 1)

        least = over(self._rise[0], inner) + over(self._fall[0], outer)
        most = over(self._rise[1], outer) + over(self._fall[1], inner)
        return Interval(least, most + np.where(early[0] == 0, self._before, 0.0))

    def over_mean(self, late: tuple[Index, Index], back: int) -> Interval:
        """What the friction there has more than its mean over the sample that began back + 1 samples ago."""
        w = self._windows
        second = self.between(late, (w.first_middle(back), w.near[back] + 1))
        first = self.between(late, (w.far[back + 1], w.last_middle(back) + 1))
        both = (first + second) * 0.5
        return Interval(both.low, both.high + (back + 1.5) * self.faded)


def _filled(law: LawNumbers, cells: Cells, passing: _Passing, assumed: Array) -> Filled:
    """Add up what observer and filter have learned, and see what the law wants."""
    windows = _Windows(passing)
    growth = _Growth(passing, windows)
    wheels, there, motion = passing.wheels, passing.there, passing.motion
    own, parts = windows.own, EDGES.size - 1
    theta, kept, beta = law.theta, law.kept, (1.0 - law.theta) / law.theta
    observed = (1.0 - theta) ** 2 * (np.arange(BACK) + 1.0) * theta ** np.arange(BACK)
    filtered = (1.0 - kept) * kept ** np.arange(BACK)
    steep = _steepest(wheels, passing)
    coming, since = _since(growth, windows, steep)
    rooms = _rooms(law, cells, passing)
    nominal = law.over_fill * law.nominal  # of the room, that the law takes a sample to fill
    # --- the friction that is not yet observed, and that the filter has not yet followed
    most_before = growth.between((own, np.minimum(windows.next, parts)), (0 * own, 0 * own + 1))
    z = p = error = Interval(0.0 * steep, 0.0 * steep)
    rest = [1.0, 1.0]
    for back in range(BACK):
        weights = (1.0 - theta) * theta**back, filtered[back]
        z = z - weights[0] * since[back]
        error = error + weights[1] * (wheels.share * since[back])
        rest = [left - weight for left, weight in zip(rest, weights, strict=True)]
    older = since[-1].hull(Interval(since[-1].low, most_before.high + BACK * there.fading))
    z, error = z - rest[0] * older, error + rest[1] * (wheels.share * older)
    for back in range(1, BACK):
        weight = theta**2 * (theta**back - (1.0 - theta) * back * theta ** (back - 1))
        one = growth.over_mean((windows.first_middle(0), own + 1), back)
        other = growth.over_mean((windows.far[1], windows.last_middle(0) + 1), back)
        before = (one + other) * 0.5
        p = p + weight * Interval(before.low, np.minimum(before.high, since[back].high - 0.0 * coming.low))
    # --- what the torque does beyond what the law takes it for
    ratio = np.minimum(cells.supply_rate.high[:, None] * cells.one.full / _least(rooms.low, windows, 6), 1.0)
    tau = wheels.fills * law.over_fill
    goes = (1.0 - (-tau).exp()) * Interval(1.0, 1.0 + 0.506 * ratio)
    own_mean = Interval(0.5 * nominal * (1.0 - nominal / 3.0), 0.5 * nominal) / goes
    aside = 0.506 * ratio / 6.0
    unlike = wheels.effect * Interval(0.5 - aside, 0.5056) - own_mean
    change = Interval(0.97 * _least(passing.least_rate, windows, 6), passing.rate)
    change = Interval(np.where(windows.far[6] == 0, 0.0, np.maximum(change.low, 0.0)), change.high)
    spare = 0.03 * 0.2 * passing.rate
    unlike, learned = unlike * change, ((wheels.effect - 1.0) - (1.0 - theta) * unlike) * change
    z_torque = learned * (1.0 / (1.0 - theta))
    p_torque = (z_torque + unlike) * (theta**2 / (1.0 - theta))
    z = z + z_torque + Interval(-spare, spare)
    p = p + p_torque + Interval(-spare, spare)
    drags = np.maximum.accumulate(there.drag.high, axis=1) - np.minimum.accumulate(there.drag.low, axis=1)
    started = np.maximum.accumulate(there.drag.high, axis=1) * kept ** np.maximum(passing.soonest - 1.0, 0.0)
    error = error + Interval(-drags, drags + started)
    # --- what the law wants
    moves = np.maximum.accumulate(there.slides.high + motion.high, axis=1)
    rests = np.minimum.accumulate(motion.low[:, ::-1], axis=1)[:, ::-1] - 2.0 * there.drag.high * (
        EDGES[:-1] <= FIRST
    )
    lags = _lags(law, cells, passing, observed[:WEIGHED])
    falls = np.maximum.accumulate(there.falls.high, axis=1), np.maximum(there.falls.low, 0.0)
    at = np.take_along_axis
    past_high = past_low = turned_high = turned_low = 0.0 * steep
    for back in range(BACK):
        weight = observed[back] if back < BACK - 1 else 1.0 - observed[:-1].sum()
        past_high = past_high + 0.5 * weight * (
            at(moves, windows.near[back], 1) + at(moves, windows.last_middle(back), 1)
        )
        past_low = past_low + 0.5 * observed[back] * (
            at(rests, windows.far[back + 1], 1) + at(rests, windows.first_middle(back), 1)
        )
        more = weight - (filtered[back] if back < BACK - 1 else 1.0 - filtered[:-1].sum())
        high, low = at(falls[0], windows.near[back], 1), at(falls[1], windows.far[back + 1], 1)
        turned_high = turned_high + (max(more, 0.0) * high + min(more, 0.0) * 0.0)
        turned_low = turned_low + (max(more, 0.0) * low + min(more, 0.0) * high)
    half = Interval(
        0.93 * 0.5 * nominal * (1.0 - nominal / 3.0) * _least(rooms.low, windows, 7),
        0.5 * nominal * np.maximum.accumulate(rooms.high, axis=1),
    )
    asked = Interval(
        -lags.high + half.low - past_high - turned_high,
        -np.maximum(lags.low, 0.0) + half.high - past_low - turned_low,
    )  # x - P
    cut_z, cut_p = _cut(law, passing, windows, passing.torque.low + asked.low - falls[0])
    z, p = z + Interval(0.0, cut_z), p + Interval(0.0, cut_p)
    asked = asked + Interval(0.0, cut_z + beta * cut_p)
    errors = (cells.one.slip - Interval(EDGES[:-1], EDGES[1:])) * passing.speed / wheels.radius
    seen = errors + law.ahead * asked
    way = Interval(_pulls(law, seen.low), _pulls(law, seen.high)) + asked
    whole = law.fills * rooms
    alive = way.high >= whole.low
    ended = parts - np.argmax(alive[:, ::-1], axis=1)
    known = np.arange(parts) < ended[:, None]
    steady = cells.effect.low[:, None] * passing.least_rate > (1.0 + wheels.share.high * 1.2) * there.fading
    sound = (
        np.isfinite(way.low)
        & np.isfinite(way.high)
        & np.isfinite(passing.rate)
        & (passing.slowest >= assumed)
    )
    for each in (z, p, error, rooms):
        sound &= np.isfinite(each.low) & np.isfinite(each.high)
    sound &= steady | (np.arange(parts) == 0)
    lost = ~(sound | ~known).all(axis=1) | (ended == parts) | (tau.high[:, 0] > 1.0)
    return Filled(
        alive=known,
        opens=known & (way.low < whole.high),
        z=z,
        p=p,
        error=error,
        fall=Interval(
            np.maximum(there.slides.low, 0.0)
            + motion.low
            - (1.0 + wheels.share.high) * np.maximum(coming.high, 0.0),
            there.slides.high
            + motion.high
            - (1.0 + wheels.share.high) * np.minimum(coming.low, 0.0)
            + there.eases,
        ),
        way=way.low,
        room=rooms,
        motion=motion.high,
        rate=passing.rate,
        steep=steep,
        speed=passing.slowest,
        time=passing.passed,
        lost=lost,
    )


def _cut(law: LawNumbers, passing: _Passing, windows: _Windows, observed: Array) -> tuple[Array, Array]:
    """Bound what z and p have more because the law takes no observed friction below 0.

    The observer is shown the torque less the motion of the wheel, which at first may be a little below 0: by m. The law
    then takes more for friction, and z and p are larger by at most m/(1 + theta) and theta^2 m/(1 - theta^2). Where
    enough is observed it does so no more, and both fade: docs/theory.md#bounds-of-ways-in.
    """
    theta, wheels, there = law.theta, passing.wheels, passing.there
    share = 1.0 - wheels.effect + wheels.effect / (1.0 + wheels.share)  # of the torque, that is shown at rest
    hidden = (np.maximum(there.slides.high, 0.0) + passing.motion.high + there.drag.high) / (
        1.0 + wheels.share.low
    )
    shown = share.low * passing.torque.low - hidden
    begins = np.maximum.accumulate(np.maximum(-shown, 0.0), axis=1)
    enough = observed > (1.0 - theta) / theta * begins
    first = observed.shape[1] - np.argmin(enough[:, ::-1], axis=1)  # from here on nothing is cut
    since = np.zeros(observed.shape)
    for back in range(1, BACK + 1):
        since = np.where(windows.far[back] >= first[:, None], float(back), since)
    most = begins[np.arange(len(first)), np.maximum(first - 1, 0)][:, None]
    z, p = most / (1.0 + theta), theta**2 * most / (1.0 - theta**2)
    return theta**since * z, theta**since * (p + since * theta * z)


def _steepest(wheels: Cells, passing: _Passing) -> Array:
    """Return S q at most: by its bound while the slope is large, and by the largest slope and motion."""
    there, motion, speed = passing.there, passing.motion.high, passing.speed
    slope = there.slope
    loses = (there.loss / speed).high
    aside = 1.0 + (wheels.one.slip + SINK) / (1.0 - wheels.one.slip)
    gains = motion * (loses * (1.0 + there.rises / np.maximum(slope.low, FLOOR)))
    gains = gains + motion**2 * there.bends * (wheels.radius / speed).high / np.maximum(slope.low, FLOOR)
    gains = gains + aside * (there.eases + (wheels.share * wheels.damping).high * motion)
    level = (wheels.effect.high * passing.rate + gains) / (1.0 + wheels.share.low)
    level = np.where(slope.low > FLOOR, np.maximum.accumulate(level, axis=1), np.inf)
    level = np.where(np.logical_and.accumulate(slope.low > FLOOR, axis=1), level, np.inf)
    return np.minimum(level, np.maximum(slope.high, 0.0) * motion) * (1.0 + SPARE)


def _since(growth: _Growth, windows: _Windows, steep: Array) -> tuple[Interval, list[Interval]]:
    """What the friction gains from a sample to its mean over it, and what that is more than the means before."""
    own = windows.own
    within = growth.between((own, windows.next), (own, own + 1))
    ahead = _most(steep, own, np.minimum(windows.next, own.shape[1] - 1))
    coming = Interval(np.minimum(within.low, 0.0), np.minimum(np.maximum(within.high, 0.0), 0.5 * ahead))
    found, total = [], 0.0 * steep
    for back in range(BACK):
        late = ahead if back == 0 else _most(steep, windows.far[back], windows.near[back - 1])
        total = total + 0.5 * _most(steep, windows.far[back + 1], windows.near[back]) + 0.5 * late
        total = total + growth.faded
        far = growth.over_mean((own, own + 1), back)
        found.append(Interval(far.low + coming.low, np.minimum(far.high + coming.high, total)))
    return coming, found


def _most(values: Array, first: Index, last: Index) -> Array:
    """Largest of values from a part to another, by a table of the largest of 1, 2, 4, ... of them."""
    table, step = [values], 1
    while step < values.shape[1]:
        wider = table[-1].copy()
        wider[:, :-step] = np.maximum(wider[:, :-step], table[-1][:, step:])
        table.append(wider)
        step *= 2
    size = np.log2(np.maximum(last - first + 1, 1)).astype(int)
    found = np.empty_like(values)
    for k in np.unique(size):
        there = np.maximum(
            np.take_along_axis(table[k], first, 1),
            np.take_along_axis(table[k], np.maximum(last - 2**k + 1, 0), 1),
        )
        found = np.where(size == k, there, found)
    return found


def _least(values: Array, windows: _Windows, back: int) -> Array:
    """Return the smallest of values from where a wheel was some samples ago to where it is."""
    return -_most(-values, windows.far[back], windows.own)


def _rooms(law: LawNumbers, cells: Cells, passing: _Passing) -> Interval:
    """Room of the supply at the torques of each part."""
    tau = cells.fills * law.over_fill
    wide = Filling(cells.one.full, cells.supply_rate.high, tau.low)
    narrow = Filling(cells.one.full, cells.supply_rate.low, tau.high)
    low, high = passing.torque.low, passing.torque.high
    found = Interval(np.empty_like(low), np.empty_like(low))
    guesses = [np.full(len(low), 1.5) for _ in range(4)]
    for k in range(low.shape[1]):
        guesses[0] = wide.since(low[:, k], guesses[0])
        guesses[1] = wide.until(high[:, k], guesses[1])
        guesses[2] = narrow.since(low[:, k], guesses[2])
        guesses[3] = narrow.until(high[:, k], guesses[3])
        found.high[:, k] = wide.room(np.clip(wide.peak, guesses[0], guesses[1]))
        found.low[:, k] = np.minimum(narrow.room(guesses[2]), narrow.room(guesses[3]))
        found.low[:, k] = np.where(np.isfinite(guesses[3]), found.low[:, k], 0.0)
    return Interval(found.low * (1.0 - SPARE) - SPARE, found.high * (1.0 + SPARE) + SPARE)


def _lags(law: LawNumbers, cells: Cells, passing: _Passing, weights: Array) -> Interval:
    """What the torque has more than the observer's mean of the torques before."""
    tau = cells.fills * law.over_fill
    fast = Filling(cells.one.full, cells.supply_rate.high, tau.high).column()
    late = Filling(cells.one.full, cells.supply_rate.low, tau.low).column()

    def lag(filling: Filling, time: Array) -> Array:
        now, found = filling.torque(time), 0.0 * time
        for back, weight in enumerate([*weights, 1.0 - weights.sum()]):
            found = found + weight * (now - filling.torque(np.maximum(time - 1.0 - back, 1.0)))
        return found

    apart = np.diff(passing.latest, axis=1, prepend=passing.latest[:, :1])
    # Between two of these times the lag is at most that at one of them, or at a maximum between: it bends by no more.
    bent = 0.25 * np.maximum(apart, 1.0) ** 2 * fast.fill_rate * fast.full * fast.supply_rate
    high = np.maximum.accumulate(lag(fast, passing.latest), axis=1) + bent + 0.01 * passing.rate
    low = np.minimum(lag(late, passing.slow[0]), lag(late, passing.slow[1])) * (1.0 - SPARE)
    return Interval(low - bent, high)


def _pulls(law: LawNumbers, seen: Array) -> Array:
    """Pull at predicted errors."""
    curve = np.sqrt(np.maximum(2.0 * law.sigma * (seen - 0.5 * law.begins), 0.0))
    return np.where(seen > law.begins, curve, law.gain * seen)
