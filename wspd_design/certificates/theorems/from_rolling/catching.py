"""From where valves may pause for the first time until all wheels of a cell follow the braking curve.

The way passes rows of the slip, so narrow that each sample leads out of its row. In a row, wheels are kept in boxes of
the state (y, z, p, e, x) and of the room of the supply, one for each pair of slices of y and of x: a fast wheel and a
slow one know different things. What holds together within a box cuts it: y = P - x + z + beta p - e.

Boxes of all cells lie in one list, a number for each. See :mod:`filling` for what comes before, and
docs/theory.md#all-ways-in for the map.
"""

from collections import defaultdict
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from itertools import product
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from wspd_design.certificates.kernel.interval import Array, Interval, Where
from wspd_design.certificates.theorems.from_rolling.cells import Cells, sliding
from wspd_design.certificates.theorems.from_rolling.filling import EDGES, FLOOR, SINK, Filled
from wspd_design.certificates.theorems.from_rolling.sample import LawNumbers

Index = NDArray[np.int_]

WIDTH, GROWS, GRAIN = 4e-4, 0.05, 1e-5  # of a row: at most, and over the slip
AHEAD = 60  # rows that a sample leads over at most
STATES = ("y", "z", "p", "error", "way", "room")
SLICE, LEAST, MOST = 0.01, 0.0, 0.4  # rad/s, of y
WAYS = np.array(
    [-np.inf, -0.03, -0.02, -0.01, -0.005, 0.0, 0.005, 0.01, 0.015, 0.02, 0.03, 0.045, 0.07, 0.1, np.inf]
)
SLOWER = 0.05  # of the speed, that a train may have lost when its wheels are caught
WHOLE = 1e-3  # of the full torque, and rad/s: as the inversion of the valve, below which it does not divide
TRIALS = 2  # of cutting a box


class Caught(NamedTuple):
    """Wheels of each cell at the first sample beyond the last row."""

    states: Mapping[str, Interval]  # of STATES [rad/s]
    slip: tuple[float, float]  # -
    speed: Array  # m/s, at least
    supply: Array  # -, of the full pressure at least
    time: Array  # samples since the brake was demanded, at most
    lost: Where


@dataclass(frozen=True, slots=True)
class Boxes:
    """Boxes of states, each with the number of its cell and what the train has at least."""

    cell: Index
    states: dict[str, Interval]
    speed: Array  # m/s

    def kept(self, where: Where) -> "Boxes":
        """Return some of them."""
        return Boxes(
            self.cell[where], {name: each[where] for name, each in self.states.items()}, self.speed[where]
        )


def rows(begin: float, end: float) -> tuple[Array, int]:
    """Return edges of rows, and how many rows begin before the end."""
    edges = [begin]
    while edges[-1] < end:
        edges.append(edges[-1] + min(WIDTH, GROWS * edges[-1] + GRAIN))
    count = len(edges) - 1
    edges += [edges[-1] + WIDTH * (k + 1) for k in range(AHEAD + 1)]
    return np.array(edges), count


def caught(law: LawNumbers, cells: Cells, filled: Filled, fastest: float, until: float) -> Caught:
    """Follow wheels whose valves pause through all rows that begin below a slip, whatever becomes of them."""
    with np.errstate(all="ignore"):
        way = _Way(law, cells, filled, fastest, until)
        found = way.followed()
    # All wheels have to begin to pause within the rows.
    first, last = way.entries
    outside = (EDGES[first] < way.edges[0]) | (EDGES[last + 1] > way.edges[way.count])
    return found._replace(lost=found.lost | outside)


class _Way:
    """The way of all wheels of some cells through the rows."""

    def __init__(self, law: LawNumbers, cells: Cells, filled: Filled, fastest: float, until: float) -> None:
        self.law, self.cells, self.filled, self.fastest = law, cells, filled, fastest
        count = len(filled.lost)
        self.lost = filled.lost.copy()
        some = filled.opens.any(axis=1)
        self.lost |= ~some
        first = np.where(some, np.argmax(filled.opens, axis=1), EDGES.size - 2)
        begin = float(EDGES[first].min())
        self.edges, self.count = rows(max(begin, 1e-4), until)
        last = EDGES.size - 2 - np.argmax(filled.alive[:, ::-1], axis=1)
        self.slow = np.minimum(filled.speed[np.arange(count), last], fastest) * (1.0 - SLOWER)
        self.entries = first, last
        column = cells.at((slice(None), None))
        shape = (count, self.edges.size - 1)
        speed = Interval(np.broadcast_to(self.slow[:, None], shape), np.full(shape, fastest))
        slip = Interval(np.broadcast_to(self.edges[:-1], shape), np.broadcast_to(self.edges[1:], shape))
        self.there = sliding(column, slip, speed)
        self.errors = (column.one.slip - slip) * speed / column.radius
        self.torque = (1.0 + column.share) * self.there.friction + self.there.drag
        self.pending: dict[int, list[Boxes]] = defaultdict(list)
        self.rate = np.zeros(count)
        # S q is no more where wheels are caught first; later its own bound holds.
        self.level = np.where(filled.alive, filled.steep, 0.0).max(axis=1)
        t = self.there
        aside = 1.0 + (cells.one.slip + SINK) / (1.0 - cells.one.slip)
        steep = np.maximum(t.slope.low, FLOOR)
        self.gains = MOST * (t.loss.high / self.slow[:, None]) * (1.0 + t.rises / steep)
        self.gains += MOST**2 * t.bends * (cells.radius.high / self.slow)[:, None] / steep
        self.gains += aside * (t.eases + ((cells.share * cells.damping).high * 2.0 * MOST)[:, None])
        self.gains = np.where(t.slope.low > FLOOR, self.gains, np.inf)

    def followed(self) -> Caught:
        """Go through all rows."""
        for row in range(self.count):
            chunks = self.pending.pop(row, [])
            entering = self._entering(row)
            if entering is not None:
                chunks.append(entering)
            if not chunks:
                continue
            boxes = self._cut(row, _joined(chunks))
            if boxes is not None:
                self._sample(row, boxes)
        return self._end()

    def _entering(self, row: int) -> Boxes | None:
        """Wheels of which the valve fills no whole sample for the first time."""
        filled, (first, last) = self.filled, self.entries
        begin = max(int(np.searchsorted(EDGES, self.edges[row], side="right")) - 1, 0)
        end = max(int(np.searchsorted(EDGES, self.edges[row + 1], side="left")) - 1, begin)
        parts = slice(begin, end + 1)
        there = (begin <= last) & (end >= first) & ~self.lost
        if not there.any():
            return None
        cell = np.flatnonzero(there)

        def over(value: Interval) -> Interval:
            return Interval(value.low[cell, parts].min(axis=1), value.high[cell, parts].max(axis=1))

        states = {
            "y": over(filled.fall),
            "z": over(filled.z),
            "p": over(filled.p),
            "error": over(filled.error),
            "room": over(filled.room),
        }
        whole = states["room"] * self.law.fills
        states["way"] = Interval(
            np.maximum(filled.way[cell, parts].min(axis=1), self._after_whole(row, cell)), whole.high
        )
        speed = filled.speed[cell, parts].min(axis=1)
        self.rate = np.maximum(self.rate, np.where(there, filled.rate[:, parts].max(axis=1), 0.0))
        return _sliced(Boxes(cell, states, speed))

    def _after_whole(self, row: int, cell: Index) -> Array:
        """What is wanted at least after a sample of which all was filled."""
        law, filled = self.law, self.filled
        before = int(np.searchsorted(EDGES, self.edges[row] * 0.5, side="right"))
        parts = slice(max(before - 1, 0), int(np.searchsorted(EDGES, self.edges[row + 1])) + 1)
        room = filled.room.low[cell, parts].min(axis=1)
        z, p, error = (
            Interval(each.low[cell, parts].min(axis=1), each.high[cell, parts].max(axis=1))
            for each in (filled.z, filled.p, filled.error)
        )
        g, steep = self.cells.effect[cell], self._steepest(row)[cell]
        change = filled.rate[cell, parts].max(axis=1)
        unlike = (
            np.maximum(
                g.high * 0.51
                - 0.4 * law.nominal * law.over_fill / (law.over_fill * self.cells.fills[cell].high),
                0.0,
            )
            * change
        )
        known = (1.0 - law.kept) * error - law.a * (z + p * (1.0 / law.theta))
        known = Interval(known.low - law.a * unlike, known.high)
        beside = z + p * ((1.0 - law.theta) / law.theta) - error
        least = law.fills * room - change * (1.0 + steep * (0.51 * g.high + law.ahead))
        least = least + np.minimum(known.low, 0.0) * (1.0 + steep * law.ahead)
        motion = np.where(filled.alive, filled.motion, 0.0)[cell, : parts.stop].max(axis=1)
        way = self.cells.radius.high[cell] / self.slow[cell] * motion
        self.lost[cell[way > 0.5 * self.edges[row]]] = True
        found: Array = least - 1.05 * law.sigma - steep * np.maximum(beside.high, 0.0)
        return found

    def _steepest(self, row: int) -> Array:
        """Slope of the pull at most, of wheels of a row and those a sample before."""
        return _steepness(self.law, Interval(self.errors.low[:, row] - 0.5, self.errors.high[:, row])).high

    def _cut(self, row: int, boxes: Boxes) -> Boxes | None:
        """Cut boxes to what holds together, and leave out what is empty."""
        law, beta = self.law, (1.0 - self.law.theta) / self.law.theta
        unknown = np.logical_or.reduce(
            [np.isnan(each.low) | np.isnan(each.high) for each in boxes.states.values()]
        )
        self.lost[boxes.cell[unknown]] = True
        boxes = boxes.kept(~self.lost[boxes.cell])
        errors = self.errors[boxes.cell, row]
        s = boxes.states
        for _ in range(TRIALS):
            beside = s["z"] + beta * s["p"] - s["error"]  # y + x - P
            pull = _pull(law, errors + law.ahead * (beside - s["y"]))
            s["way"] = s["way"].cut(pull - s["y"] + beside)
            s["y"] = s["y"].cut(pull - s["way"] + beside)
            beside = beside.cut(s["y"] - pull + s["way"])
            s["z"] = s["z"].cut(beside - beta * s["p"] + s["error"])
            s["p"] = s["p"].cut((beside - s["z"] + s["error"]) * (1.0 / beta))
            s["error"] = s["error"].cut(s["z"] + beta * s["p"] - beside)
        some = np.logical_and.reduce([each.holds() for each in s.values()])
        boxes = boxes.kept(some)
        return boxes if boxes.cell.size else None

    def _sample(self, row: int, boxes: Boxes) -> None:
        """Hand on what a sample makes of boxes."""
        law, s, cell = self.law, boxes.states, boxes.cell
        cells = self.cells.at(cell)
        g, kappa = cells.effect, cells.share
        there = self._around(row)
        slides, eases = there["slides"][cell], there["eases"][cell]
        torque = (there["torque"][cell] + s["y"]) / g
        rise = (cells.one.full - torque - s["room"]).at_least(0.0) * cells.supply_rate
        rise = Interval(rise.low * (1.0 - 0.5 * cells.supply_rate.high), rise.high)
        valve = _Valve(law, cells, s["room"], rise, torque)
        ways = valve.parts(s["way"])
        change = valve.change(ways)
        farthest = s["room"].high + 2.0 * rise.high + np.maximum(-change.low, 0.0)
        self.rate = np.maximum(
            self.rate, _of_cells(cells.fills.high * law.over_fill * farthest, cell, len(self.rate))
        )
        beside = s["z"] + ((1.0 - law.theta) / law.theta) * s["p"] - s["error"]
        gained = g * change
        pull = _pull(law, self.errors[cell, row] + law.ahead * (beside - s["y"]))
        z_torque, unlike = valve.learned(g, ways)
        known = (1.0 - law.kept) * s["error"] - law.a * (s["z"] + s["p"] * (1.0 / law.theta) + unlike)
        step = np.maximum(s["y"].high + np.maximum(gained.high, 0.0), 0.0)
        step = step + np.maximum(-s["y"].low - np.minimum(gained.low, 0.0), 0.0)
        step = step + law.ahead * (np.maximum(known.high, -known.low) + np.maximum(change.high, -change.low))
        steep = _steepness(law, self._seen(row, boxes, beside, step))
        way = self._way(boxes, cells, ways, steep, (pull, beside, step)) - self._beyond(
            valve, s["way"], steep
        )
        following = valve.change(valve.parts(way, later=True))
        friction, y = self._friction(row, boxes, cells, (ways, change, following), valve)
        mean = Interval(np.minimum(valve.least_share(ways), 1.0), 1.0)
        moved = s["y"] + gained * mean
        speed = Interval(self.slow[cell], np.full(cell.size, self.fastest))
        least, most_moved = np.maximum(moved.low - slides.high, 0.0), np.maximum(moved.high - slides.low, 0.0)
        length = (
            cells.radius.low / speed.high * least * (1.0 - 1e-12),
            cells.radius.high / speed.low * most_moved * (1.0 + 1e-12),
        )
        bad = length[0] < self.edges[row + 1] - self.edges[row]
        seen = torque.low + s["way"].low - pull.high + s["error"].low - there["falls"][cell].high
        bad |= seen <= 0.0
        least_room = 1.1 * WHOLE * (cells.one.full + 0.1)
        bad |= (s["room"].low <= least_room) | (torque.low <= least_room)
        bad |= (y.low <= LEAST) | (y.high >= MOST) | ~np.isfinite(way.low) | ~np.isfinite(way.high)
        bad |= boxes.speed < self.slow[cell]
        hops = (
            np.searchsorted(self.edges, self.edges[row] + length[0], side="right") - 1 - row,
            np.searchsorted(self.edges, self.edges[row + 1] + length[1], side="left") - 1 - row,
        )
        bad |= hops[1] > AHEAD
        bad |= (pull.low <= 1.5 * law.gain * law.begins + steep.high * step) | (
            steep.high * step >= 0.5 * pull.low
        )
        self.lost[cell[bad]] = True
        kappa_change = kappa * friction
        drag = Interval(-eases.high, 0.0 * eases.high)
        states = {
            "y": y,
            "z": law.theta * s["z"] - friction + z_torque,
            "p": law.theta * s["p"] + law.theta**2 * (s["z"] + unlike),
            "error": law.kept * s["error"] + kappa_change + drag,
            "way": way,
            "room": valve.next_room(ways, s["way"]),
        }
        after = Boxes(cell, states, boxes.speed - there["loss"][cell].high)
        after = after.kept(~self.lost[cell])
        keep = ~self.lost[cell]
        nearest, farthest = hops[0][keep], hops[1][keep]
        sliced = _sliced(after, numbered=True)
        origin = sliced.states.pop("origin").low.astype(int)
        for hop in range(int(nearest.min(initial=AHEAD)), int(farthest.max(initial=0)) + 1):
            there_too = (nearest[origin] <= hop) & (farthest[origin] >= hop)
            if there_too.any():
                self.pending[row + hop].append(sliced.kept(there_too))

    def _around(self, row: int) -> dict[str, Interval]:
        """What wheels find in a row and in all that two samples lead to."""
        t, reach = self.there, slice(row, row + 2 * AHEAD)

        def over(value: Interval) -> Interval:
            return Interval(value.low[:, reach].min(axis=1), value.high[:, reach].max(axis=1))

        eases = t.eases[:, reach].max(axis=1) + (self.cells.share * self.cells.damping).high * 2.0 * MOST
        near = slice(row, row + AHEAD)
        return {
            "slides": over(t.slides),
            "falls": over(t.falls),
            "loss": over(t.loss),
            "eases": Interval(0.0 * eases, eases),
            "torque": Interval(self.torque.low[:, near].min(axis=1), self.torque.high[:, near].max(axis=1)),
        }

    def _limit(self, row: int, boxes: Boxes, end: Index) -> Array:
        """S q at most until the end of the next sample, by its bound, while the friction is steep enough for it."""
        gains = np.maximum.accumulate(self.gains[:, row:], axis=1)[boxes.cell, end - row]
        cells = self.cells.at(boxes.cell)
        level = (cells.effect.high * self.rate[boxes.cell] + gains) / (1.0 + cells.share.low) * (1.0 + 1e-9)
        level = np.maximum(level, self.level[boxes.cell])
        self.level = np.maximum(self.level, _of_cells(level, boxes.cell, len(self.level)))
        return np.asarray(level)

    def _friction(
        self,
        row: int,
        boxes: Boxes,
        cells: Cells,
        changes: tuple["tuple[_Part, _Part]", Interval, Interval],
        valve: "_Valve",
    ) -> tuple[Interval, Interval]:
        """Return what the friction changes by and the next y.

        The change weighs S q over two samples, with a weight that rises in the first one and falls in the second.
        """
        cell, s, t = boxes.cell, boxes.states, self.there
        ways, change, after = changes
        g, kappa = cells.effect, cells.share
        around = self._around(row)
        slides, eases = around["slides"][cell], around["eases"][cell].high
        gained = g * change
        slope = t.slope.high[cell, row]
        lowest = np.minimum.accumulate(t.slope.low[:, row:], axis=1)
        highest = np.maximum.accumulate(t.slope.high[:, ::-1], axis=1)[:, ::-1]
        length, last = cells.radius.high / self.slow[cell], self.edges.size - 2

        def row_of(slip: Array) -> Index:
            return np.clip(np.searchsorted(self.edges, slip, side="right") - 1, row, last)

        # Within a sample the friction differs from its mean by half of what it changes by at most.
        base = s["y"].high + np.maximum(gained.high, 0.0) + g.high * np.maximum(after.high, 0.0) + eases
        swing = np.maximum(
            highest[cell, row], -lowest[cell, row_of(self.edges[row + 1] + 4.0 * length * base) - row]
        )
        swing = 0.5 * (1.0 + kappa.high) * np.maximum(swing, 0.0)
        fastest = np.where(swing < 0.4, base / (1.0 - np.minimum(swing, 0.4)), np.inf)
        end = row_of(self.edges[row + 1] + 2.0 * length * np.minimum(fastest, 1.0))
        falling = np.maximum(-lowest[cell, end - row], 0.0) * fastest
        limit = self._limit(row, boxes, end)
        steep = np.minimum(limit, np.maximum(highest[cell, row], 0.0) * fastest)
        sixth = (1.0 + kappa.high) * np.maximum(steep, falling) / 6.0
        first = s["y"] + Interval(
            np.minimum(gained.low, 0.0) + 0.6 * g.low * np.maximum(change.low, 0.0) - sixth,
            np.where(gained.high > 0.0, g.high * valve.in_first(ways), gained.high * 0.0)
            + np.where(falling > 0.0, sixth, 0.0),
        )
        second = (
            s["y"].low
            + gained.low
            + g.high * np.minimum(after.low, 0.0)
            - np.where(falling > 0.0, sixth, 0.0),
            s["y"].high + gained.high + g.high * valve.in_second(after) + sixth + eases,
        )
        moved = (cells.radius.low / self.fastest) * np.maximum(
            s["y"].low
            + np.minimum(gained.low, 0.0)
            - slides.high
            - (1.0 + kappa.high) * np.maximum(steep, falling),
            0.0,
        )
        begin_second = row_of(self.edges[row] + moved)
        end_first = row_of(self.edges[row + 1] + length * np.minimum(fastest, 1.0))
        high = np.maximum(slope, highest[cell, row]), highest[cell, begin_second]
        low = lowest[cell, end_first - row], lowest[cell, end - row]
        fading = t.fading[cell, row : row + 2 * AHEAD].max(axis=1) if cell.size else slope
        sinks = s["y"].low + np.minimum(gained.low, 0.0) - slides.high
        self.lost[
            cell[(sinks <= 0.5 * (1.0 + kappa.high) * np.maximum(steep, falling)) | ~np.isfinite(fastest)]
        ] = True
        more = 1.0 + kappa
        q = (
            Interval(np.maximum(first.low - slides.high, 0.0), np.maximum(first.high - slides.low, 0.0)),
            Interval(np.maximum(second[0] - slides.high, 0.0), np.maximum(second[1] - slides.low, 0.0)),
        )
        most = 0.5 * (
            np.where(high[0] > 0.0, high[0] * q[0].high, high[0] * q[0].low)
            + np.where(high[1] > 0.0, high[1] * q[1].high, high[1] * q[1].low)
        )
        least = 0.5 * (
            np.where(low[0] > 0.0, low[0] * q[0].low, low[0] * q[0].high)
            + np.where(low[1] > 0.0, low[1] * q[1].low, low[1] * q[1].high)
        )
        most = np.where(
            high[1] > 0.0,
            most / (1.0 + 0.5 * np.maximum(high[1], 0.0) * np.where(most > 0.0, more.low, 0.0)),
            np.where(most > 0.0, most / (1.0 - 0.5 * more.high * np.maximum(-high[1], 0.0)), most),
        )
        least = np.where(
            least > 0.0,
            least / (1.0 + 0.5 * np.maximum(low[1], 0.0) * more.high),
            least / (1.0 - 0.5 * more.high * np.maximum(-low[1], 0.0)),
        )
        spare = 1e-12
        found = Interval(
            least * (1.0 - spare) - 1e-15, np.minimum(limit, most) * (1.0 + spare) + fading + 1e-15
        )
        found = Interval(np.where(least < 0.0, least * (1.0 + spare), found.low) - 1e-15, found.high)
        # The next y with one and the same y and change in both terms: it rises with either.
        a, b = np.maximum(high[0], 0.0), np.maximum(high[1], 0.0)
        share_first = np.where(gained.low > 0.0, 1.0, 0.0)
        added = 0.5 * a * (s["y"].low + share_first * gained.low - slides.low) + 0.5 * b * (
            s["y"].low + gained.low + (second[1] - s["y"].high - gained.high) - slides.low
        )
        together = (
            s["y"].low + gained.low - more.high * added / (1.0 + 0.5 * b * more.high) - more.high * fading
        )
        apart = (
            s["y"].low
            + gained.low
            - more.high * np.maximum(found.high, 0.0)
            - more.low * np.minimum(found.high, 0.0)
        )
        lower = np.where((added > 0.0) & (a < 0.5) & (b < 0.5), np.maximum(together, apart), apart)
        upper = s["y"].high + gained.high - np.where(found.low > 0.0, more.low, more.high) * found.low
        return found, Interval(lower - 1e-14, upper + eases + 1e-14)

    def _seen(self, row: int, boxes: Boxes, beside: Interval, step: Array) -> Interval:
        """Predicted errors of a sample and the next one."""
        law, s = self.law, boxes.states
        errors = self.errors[boxes.cell, row]
        return Interval(
            errors.low - law.ahead * (s["y"].high - beside.low) - step,
            errors.high + law.ahead * np.maximum(beside.high - s["y"].low, 0.0) + step,
        )

    def _way(
        self,
        boxes: Boxes,
        cells: Cells,
        ways: "tuple[_Part, _Part]",
        steep: Interval,
        seen: tuple[Interval, Interval, Array],
    ) -> Interval:
        """What is wanted in the next sample."""
        law, s = self.law, boxes.states
        pull, beside, most = seen
        known = (1.0 - law.kept) * s["error"] - law.a * (s["z"] + s["p"] * (1.0 / law.theta))
        ratio = steep.high * most / (2.0 * pull.low)
        curve = Interval(law.sigma / (1.0 + ratio) * (1.0 - 1e-12), law.sigma / (1.0 - ratio) * (1.0 + 1e-12))
        found = known * (1.0 + law.ahead * steep) - curve - steep * beside

        def of_way(g: Array, rho: Array, share: Array, k: Array) -> Array:
            unlike = share * (g * rho - law.nominal)
            return (
                1.0 + k - rho * (1.0 + k * (g * share + law.ahead)) - law.a * unlike * (1.0 + k * law.ahead)
            )

        for part in ways:
            found = found + part.way * _corners(of_way, cells.effect, part.rho, part.share, steep)
            found = found - law.a * part.unlike * (1.0 + law.ahead * steep)
        return found

    @staticmethod
    def _beyond(valve: "_Valve", way: Interval, steep: Interval) -> Interval:
        """What is wanted beyond what a whole sample does, and goes on to be wanted, with its sign turned."""
        up = Interval(
            np.maximum(way.low - valve.whole[0].high, 0.0), np.maximum(way.high - valve.whole[0].low, 0.0)
        )
        down = Interval(
            np.minimum(way.low + valve.whole[1].low, 0.0), np.minimum(way.high + valve.whole[1].high, 0.0)
        )
        return -((up + down) * (1.0 + steep))

    def _end(self) -> Caught:
        """Put together what came beyond the last row."""
        count = len(self.lost)
        boxes = _joined([each for row in sorted(self.pending) for each in self.pending[row]])
        found = {name: Interval(np.full(count, np.inf), np.full(count, -np.inf)) for name in STATES}
        speed = np.full(count, np.inf)
        for name in STATES:
            np.minimum.at(found[name].low, boxes.cell, boxes.states[name].low)
            np.maximum.at(found[name].high, boxes.cell, boxes.states[name].high)
        np.minimum.at(speed, boxes.cell, boxes.speed)
        last = max(self.pending, default=self.count)
        missing = ~np.isfinite(speed)
        torque = (
            self.torque[:, self.count : self.count + AHEAD].low.min(axis=1) + found["y"].low
        ) / self.cells.effect.high
        return Caught(
            states=found,
            slip=(float(self.edges[self.count]), float(self.edges[last + 1])),
            speed=speed,
            supply=(torque + found["room"].low) / self.cells.one.full * (1.0 - 1e-9),
            # Each sample leads out of its row.
            time=self.filled.time[np.arange(count), self.entries[1]] + float(last + 1),
            lost=self.lost | missing,
        )


class _Part(NamedTuple):
    """Ways of one sign that a sample does, and what it makes of them."""

    way: Interval  # rad/s
    rho: Interval  # -, part that the valve goes
    share: Interval  # -, lambda
    unlike: Interval  # rad/s, of d beside what these numbers say
    length: Interval  # -, of the pulse


class _Valve:
    """What the valves do in a sample: they fill in a room, and vent from a torque."""

    def __init__(
        self, law: LawNumbers, cells: Cells, room: Interval, rise: Interval, torque: Interval
    ) -> None:
        self.law, self.cells, self.room, self.rise = law, cells, room, rise
        self.ratio = np.minimum(rise.high / np.maximum(room.low, 1e-9), 1.0)
        self.over = cells.fills * law.over_fill, cells.vents * law.over_fill
        # Later the room may be larger by what the supply rises, or what is vented, and the torque by what fills.
        self.whole = room.at_least(0.0) * law.fills, torque.at_least(0.0) * law.vents
        farther = self.over[0].high * (room.high + rise.high), self.over[1].high * torque.high
        self.whole_later = (
            Interval(0.0 * room.low, law.fills * (room.high + rise.high + farther[1])),
            Interval(
                law.vents * np.maximum(torque.low - farther[1], 0.0), law.vents * (torque.high + farther[0])
            ),
        )
        self.fills = _powers(cells.fills, law.fills) * Interval(1.0, 1.0 + 0.5056 * self.ratio)
        self.vents = _powers(cells.vents, law.vents)

    def parts(self, way: Interval, later: bool = False) -> tuple[_Part, _Part]:
        """Return what fills and what vents."""
        law = self.law
        filling, venting = self.whole_later if later else self.whole
        up = Interval(
            np.minimum(np.maximum(way.low, 0.0), filling.low),
            np.minimum(np.maximum(way.high, 0.0), filling.high),
        )
        down = Interval(
            np.maximum(np.minimum(way.low, 0.0), -venting.high),
            np.maximum(np.minimum(way.high, 0.0), -venting.low),
        )
        found = []
        for size, whole, rho, over, ratio in (
            (up, filling, self.fills, self.over[0], self.ratio),
            (-down, venting, self.vents, self.over[1], 0.0 * self.ratio),
        ):
            shortest = 0.9727 * np.where(size.low > 0.0, size.low / whole.high, 0.0)
            longest = np.where(
                size.high > 0.0, np.minimum(size.high / np.maximum(whole.low, 1e-300), 1.0), 0.0
            )
            length = Interval(np.clip(shortest * (1.0 - 1e-12), 0.0, 1.0), longest)
            late = 0.506 * ratio / 6.0
            share = Interval(
                1.0 - 0.5 * length.high - late * length.high,
                1.0 - 0.5 * length.low + over.high * length.high**2 / 12.0,
            )
            unlike = size.high * law.nominal
            beside = Interval(-unlike * (0.0139 + late), unlike * over.high / 12.0)
            found.append((size, rho, share, beside, length))
        (a, *filled), (b, rho, share, beside, length) = found
        return _Part(a, *filled), _Part(-b, rho, share, -beside, length)

    @staticmethod
    def change(parts: tuple[_Part, _Part]) -> Interval:
        """Change of the torque."""
        up, down = parts
        return up.way * up.rho + down.way * down.rho

    @staticmethod
    def least_share(parts: tuple[_Part, _Part]) -> Array:
        """Least share of a change in the mean."""
        return np.minimum(parts[0].share.low, parts[1].share.low)

    def learned(self, g: Interval, parts: tuple[_Part, _Part]) -> tuple[Interval, Interval]:
        """What z gains by the change of the torque, and d."""
        theta, nominal = self.law.theta, self.law.nominal

        def z_of(g: Array, rho: Array, share: Array) -> Array:
            return (g - 1.0) * rho - (1.0 - theta) * share * (g * rho - nominal)

        def d_of(g: Array, rho: Array, share: Array) -> Array:
            return share * (g * rho - nominal)

        z = unlike = Interval(0.0, 0.0)
        for part in parts:
            z = z + part.way * _corners(z_of, g, part.rho, part.share) - (1.0 - theta) * part.unlike
            unlike = unlike + part.way * _corners(d_of, g, part.rho, part.share) + part.unlike
        return z, unlike

    def in_first(self, parts: tuple[_Part, _Part]) -> Array:
        """Change of the torque upwards as a weight that rises over its sample counts it, at most."""
        up = parts[0]
        part = np.minimum(up.way.high / np.maximum(self.whole[0].high, 1e-300), 1.0)
        return up.rho.high * up.way.high * (1.0 - part**2 / 3.0) * (1.0 + 0.5 * self.over[0].high)

    def in_second(self, change: Interval) -> Array:
        """Change of the torque upwards in the next sample, as a weight that falls counts it, at most."""
        most = np.maximum(self.fills.high * self.whole_later[0].high, 1e-300)
        part = np.minimum(np.maximum(change.high, 0.0) / most, 1.0)
        return np.maximum(change.high, 0.0) * (1.0 - part + part**2 / 3.0) * (1.0 + 0.5 * self.over[0].high)

    def next_room(self, parts: tuple[_Part, _Part], way: Interval) -> Interval:
        """Room of the supply in the next sample."""
        change, tau = self.change(parts), self.over[0]
        left = (-tau).exp()
        filled_all = self.room * left + self.rise * Interval(1.0 - 0.5 * tau.high, 1.0 + 0.0 * tau.high)
        found = self.room + self.rise - change
        whole = way.low >= self.whole[0].high
        return Interval(
            np.maximum(found.low, np.where(change.low >= 0.0, filled_all.low, found.low)),
            np.where(whole, np.minimum(found.high, filled_all.high), found.high),
        )


def _powers(rho: Interval, share: float) -> Interval:
    """Part of ways up to a share of the room that a valve goes, with times over assumed ones."""
    whole = rho.rising(lambda x: (1.0 - (1.0 - share) ** x) / share)
    return rho.hull(whole)


def _pull(law: LawNumbers, seen: Interval) -> Interval:
    def pull(x: Array) -> Array:
        curve = np.sqrt(np.maximum(2.0 * law.sigma * (x - 0.5 * law.begins), 0.0))
        return np.where(x > law.begins, curve, law.gain * x)

    return seen.rising(pull)


def _steepness(law: LawNumbers, seen: Interval) -> Interval:
    """Slope of the pull."""

    def slope(x: Array) -> Array:
        curve = np.sqrt(np.maximum(2.0 * law.sigma * (x - 0.5 * law.begins), 1e-300))
        return np.where(x > law.begins, law.sigma / curve, law.gain)

    return seen.falling(slope)


def _corners(function: Callable[..., Array], *ranges: Interval) -> Interval:
    """Values of a function that is affine in each of its arguments."""
    low, high = np.asarray(np.inf), np.asarray(-np.inf)
    for ends in product(*((each.low, each.high) for each in ranges)):
        value = function(*ends)
        low, high = np.minimum(low, value), np.maximum(high, value)
    return Interval(low - 1e-14, high + 1e-14)


def _of_cells(values: Array, cell: Index, count: int) -> Array:
    """Largest value of each cell."""
    found = np.zeros(count)
    np.maximum.at(found, cell, values)
    return found


def _sliced(boxes: Boxes, numbered: bool = False) -> Boxes:
    """Divide boxes at the edges of the slices of y and of the way."""
    s, cell = boxes.states, boxes.cell
    first_y = np.clip(np.floor((s["y"].low - LEAST) / SLICE), 0, None).astype(int)
    last_y = np.clip(np.floor((s["y"].high - LEAST) / SLICE), 0, None).astype(int)
    first_x = np.clip(np.searchsorted(WAYS, s["way"].low, side="right") - 1, 0, WAYS.size - 2)
    last_x = np.clip(np.searchsorted(WAYS, s["way"].high, side="left") - 1, 0, WAYS.size - 2)
    last_x = np.maximum(last_x, first_x)
    found: list[tuple[Index, Index, Index]] = []
    number = np.arange(cell.size)
    for dy in range(int((last_y - first_y).max(initial=0)) + 1):
        for dx in range(int((last_x - first_x).max(initial=0)) + 1):
            some = (first_y + dy <= last_y) & (first_x + dx <= last_x)
            found.append((number[some], first_y[some] + dy, first_x[some] + dx))
    origin, slice_y, slice_x = (np.concatenate(each) for each in zip(*found, strict=True))
    states = {name: each[origin] for name, each in s.items()}
    states["y"] = states["y"].cut(Interval(LEAST + SLICE * slice_y, LEAST + SLICE * (slice_y + 1)))
    states["way"] = states["way"].cut(Interval(WAYS[slice_x], WAYS[slice_x + 1]))
    if numbered:
        states["origin"] = Interval(origin.astype(float), origin.astype(float))
    return Boxes(cell[origin], states, boxes.speed[origin])


def _joined(chunks: list[Boxes]) -> Boxes:
    """Put boxes of one cell and one pair of slices together."""
    if not chunks:
        empty = np.zeros(0)
        return Boxes(empty.astype(int), {name: Interval(empty, empty) for name in STATES}, empty)
    cell = np.concatenate([each.cell for each in chunks])
    states = {
        name: Interval(
            np.concatenate([each.states[name].low for each in chunks]),
            np.concatenate([each.states[name].high for each in chunks]),
        )
        for name in STATES
    }
    speed = np.concatenate([each.speed for each in chunks])
    middle_y = 0.5 * (states["y"].low + states["y"].high)
    slice_y = np.floor((middle_y - LEAST) / SLICE).astype(int)
    ends = np.clip(states["way"].low, -1e9, 1e9), np.clip(states["way"].high, -1e9, 1e9)
    slice_x = np.searchsorted(WAYS, 0.5 * (ends[0] + ends[1]), side="right")
    key = (cell * 4096 + slice_y) * 64 + slice_x
    order = np.argsort(key, kind="stable")
    starts = np.flatnonzero(np.diff(key[order], prepend=-1))
    joined = {
        name: Interval(
            np.minimum.reduceat(each.low[order], starts), np.maximum.reduceat(each.high[order], starts)
        )
        for name, each in states.items()
    }
    return Boxes(cell[order][starts], joined, np.minimum.reduceat(speed[order], starts))
