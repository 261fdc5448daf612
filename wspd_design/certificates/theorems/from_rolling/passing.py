"""How wheels whose valves fill without a pause pass the slip: how fast, and under which torque.

While a valve fills, the torque is a function of time alone, so that the motion q = Y - w of a wheel can be bounded over
the slip that it passes, and with it how long each part takes and where the wheel was a sample ago.

The slip is divided at :data:`EDGES`; arrays have a row for each cell and a column for each part of the slip. Ends are
moved outwards by :data:`SPARE` of them, far more than they are rounded by. See docs/theory.md#bounds-of-ways-in.
"""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from wspd_design.certificates.kernel.interval import Array, Index, Interval
from wspd_design.certificates.theorems.from_rolling.cells import Cells, Sliding, sliding
from wspd_design.certificates.theorems.from_rolling.sample import LawNumbers
from wspd_design.certificates.theorems.from_rolling.supply import SPARE, Filling

SINK = 1e-4  # slip below 0 that a wheel that rolls does not exceed
FIRST, GROWS, GRAIN, STRIDE, LAST = 2e-5, 1.02, 8e-6, 7e-4, 0.125  # parts of the slip, narrow ones first
TAPERED = 0.03  # slip from which on they have one width
INNER = 2  # steps of the motion within a part
WEIGHED = 14  # samples before, that the observer weighs one by one
FLOOR = 0.02  # slope of the friction, below which its own bound is used
CREEP = 0.002  # rad/s, motion that is enough at first
LONGEST = 1e3  # samples in a part, that count as no more


def _edges() -> Array:
    found = [-SINK, FIRST]
    while found[-1] < LAST:
        found.append(found[-1] * GROWS + GRAIN if found[-1] < TAPERED else found[-1] + STRIDE)
    return np.array(found)


EDGES = _edges()


@dataclass(frozen=True, slots=True, kw_only=True)
class Passing:
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
    later: Interval  # m/s, that the train has at the end of a part at least, and at its beginning at most
    crossing: Interval  # samples, that a part takes
    passed: Array  # samples since the brake was demanded, when wheels have passed a part


def passed_through(law: LawNumbers, cells: Cells, fastest: float, speed: Interval) -> Passing:
    """Bound how fast wheels move through each part, if the train has the speed there that is assumed."""
    count, parts = speed.shape
    wheels = cells.at((slice(None), None))
    slip = Interval(np.broadcast_to(EDGES[:-1], speed.shape), np.broadcast_to(EDGES[1:], speed.shape))
    there = sliding(wheels, slip, speed)
    tau = cells.fills * law.over_fill
    fast = Filling(cells.one.full, cells.supply_rate.high, tau.high)
    late = Filling(cells.one.full, cells.supply_rate.low, tau.low)
    torque_of = (1.0 + wheels.share) * there.friction + there.drag
    reference = cells.one.slip
    aside = (reference + SINK) / (1.0 - reference)
    faster, slower = (speed / wheels.radius).high, (speed / wheels.radius).low
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
            after = _faster(q, drive, held, 2.0 * faster[:, k] * width[k])
            assumed = np.where(after <= assumed, assumed, 1.3 * after)
        moved = np.where(after <= assumed, after, np.inf)
        rate = np.maximum(rate, rate_there)
        when["soon"] = fast.since(lowest, when["soon"])
        when["since"], when["until"] = late.since(lowest, when["since"]), late.until(most, when["until"])
        slow_rate = np.minimum(late.rate(when["since"]), late.rate(when["until"])) * (1.0 - SPARE) - SPARE
        drive = cells.effect.low * slow_rate - (1.0 + share.high * (1.0 + aside)) * there.fading[:, k]
        held = np.maximum(slope.high, 0.0) * (1.0 + share.high * (1.0 + aside))
        slower_after = _slower(least, drive, held, width[k] * slower[:, k], width[k] * faster[:, k])
        crossing[:, k] = width[k] * faster[:, k] / np.maximum(np.minimum(least, slower_after), 1e-9)
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
    quick = width * slower / np.maximum(found["q"], 1e-9)
    spent = np.diff(passed, axis=1, prepend=0.0)
    return Passing(
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
        later=Interval(
            fastest - np.cumsum(spent * there.loss.high, axis=1) * (1.0 + SPARE),
            fastest - _lost(there.loss.low, passed, times["soon"]) * (1.0 - SPARE),
        ),
        crossing=Interval(quick * (1.0 - SPARE), np.minimum(crossing, LONGEST) * (1.0 + SPARE)),
        passed=passed,
    )


def _lost(loss: Array, passed: Array, time: Array) -> Array:
    """Return what the train has lost at least until some times: it is beyond the parts that it has passed by then."""
    least = np.maximum(np.minimum.accumulate(loss[:, ::-1], axis=1)[:, ::-1], 0.0)
    begins = np.concatenate([np.zeros((len(loss), 1)), passed[:, :-1]], axis=1)
    sums = np.concatenate([np.zeros((len(loss), 1)), np.cumsum(least * (passed - begins), axis=1)], axis=1)
    times = np.concatenate([np.zeros((len(loss), 1)), passed], axis=1)
    found = np.array([np.interp(*each) for each in zip(time, times, sums, strict=True)])
    return np.where(np.isfinite(found), found, 0.0)


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


class Windows:
    """Where wheels that are in a part of the slip were a sample ago, and will be in a sample, as numbers of parts."""

    def __init__(self, passing: Passing) -> None:
        speed, wheels = passing.speed, passing.wheels
        count, parts = speed.low.shape
        self.own: Index = np.tile(np.arange(parts), (count, 1))
        zero = np.zeros((count, 1))
        fast, slow = (
            np.concatenate([zero, np.cumsum(each, axis=1)], axis=1)
            for each in (passing.crossing.low, passing.crossing.high)
        )
        self.far = self._found(fast, fast[:, :-1] - 1.0, "left")
        self.near = self._found(slow, slow[:, 1:] - 1.0, "right")
        most = np.maximum.accumulate(passing.motion.high, axis=1)
        ahead = (wheels.radius.high / speed.low) * (most + 2.0 * wheels.effect.high * passing.rate)
        self.next = np.minimum(
            np.array([np.searchsorted(EDGES, row) for row in EDGES[1:] + ahead * (1.0 + SPARE)]), parts
        )

    def _found(self, times: Array, then: Array, side: Literal["left", "right"]) -> Index:
        """Parts that are passed at some times."""
        found = np.array([np.searchsorted(*each, side=side) - 1 for each in zip(times, then, strict=True)])
        clipped: Index = np.minimum(np.maximum(found, 0), self.own)
        return clipped


def steepest(wheels: Cells, passing: Passing) -> Array:
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


def most_over(values: Array, first: Index, last: Index) -> Array:
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


def over(values: Interval, first: Index, last: Index) -> Interval:
    """Return what holds the values from a part to another."""
    return Interval(least_over(values.low, first, last), most_over(values.high, first, last))


def least_over(values: Array, first: Index, last: Index) -> Array:
    """Smallest of values from a part to another."""
    return -most_over(-values, first, last)


def rooms_of(law: LawNumbers, cells: Cells, passing: Passing) -> Interval:
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


def lags_of(law: LawNumbers, cells: Cells, passing: Passing) -> Array:
    """What the torque has more than the observer's mean of the torques before, at most."""
    weights = law.a * (np.arange(WEIGHED) + 1.0) * law.theta ** np.arange(WEIGHED)
    tau = cells.fills * law.over_fill
    fast = Filling(cells.one.full, cells.supply_rate.high, tau.high).column()
    now, lag = fast.torque(passing.latest), 0.0 * passing.latest
    for back, weight in enumerate([*weights, 1.0 - weights.sum()]):
        lag = lag + weight * (now - fast.torque(np.maximum(passing.latest - 1.0 - back, 1.0)))
    apart = np.diff(passing.latest, axis=1, prepend=passing.latest[:, :1])
    # Between two of these times the lag is at most that at one of them, or at a maximum between: it bends by no more.
    bent = 0.25 * np.maximum(apart, 1.0) ** 2 * fast.fill_rate * fast.full * fast.supply_rate
    found: Array = np.maximum.accumulate(lag, axis=1) + bent + 0.01 * passing.rate
    return found
