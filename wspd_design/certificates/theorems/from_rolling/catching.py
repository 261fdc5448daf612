"""From where valves may pause for the first time until all wheels of a cell follow the braking curve.

The way passes rows of the slip, so narrow that each sample leads out of its row. In a row, wheels are kept in boxes of
the state (y, z, p, e, x) and of the room of the supply, one for each pair of slices of y and of x: a fast wheel and a
slow one know different things. What holds together within a box cuts it: y = P - x + z + beta p - e.

Boxes of all cells lie in one list, a number for each. See :mod:`filling` for what comes before, and
docs/theory.md#all-ways-in for the map.
"""

from collections import defaultdict
from collections.abc import Mapping
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from wspd_design.certificates.kernel.interval import Array, Index, Interval, Where
from wspd_design.certificates.theorems.from_rolling.boxes import (
    LEAST,
    STATES,
    Boxes,
    joined,
    sliced,
    together,
)
from wspd_design.certificates.theorems.from_rolling.cells import Cells, Sliding, sliding
from wspd_design.certificates.theorems.from_rolling.filling import Filled
from wspd_design.certificates.theorems.from_rolling.passing import EDGES, FLOOR, SINK
from wspd_design.certificates.theorems.from_rolling.sample import LawNumbers, pulls
from wspd_design.certificates.theorems.from_rolling.valve import Part, Valve, corners

WIDTH, GROWS, GRAIN = 4e-4, 0.03, 1e-5  # of a row: at most, and over the slip
BEGIN = 1e-3  # slip of the first row
AHEAD = 30  # rows that a sample leads over at most
MOST = 0.4  # rad/s, y at most
BLOCK, LINGER = 10, 15.0  # rows that speeds are found for at a time, and samples in which they are passed
SHARED = 8  # parts of the slip that a row may have beside those that it begins to pause in
REACH = BLOCK + 2 * AHEAD
LEAST_SPEED = 0.7  # of the speed of rolling, that the train never falls below
WHOLE = 1e-3  # of the full torque, and rad/s: as the inversion of the valve, below which it does not divide
SPARE = 1e-12  # relative, that is far more than what is rounded
TRIALS = 2  # of cutting a box


class Caught(NamedTuple):
    """Wheels of each cell at the first sample beyond the last row."""

    states: Mapping[str, Interval]  # of STATES [rad/s]
    slip: tuple[float, float]  # -
    speed: Interval  # m/s
    supply: Array  # -, of the full pressure at least
    time: Array  # samples since the brake was demanded, at most
    lost: Where


def rows(until: float) -> tuple[Array, int]:
    """Return edges of rows, the same for all cells, and how many rows begin below a slip."""
    edges = [BEGIN]
    while edges[-1] < until:
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
        self.edges, self.count = rows(until)
        last = EDGES.size - 2 - np.argmax(filled.alive[:, ::-1], axis=1)
        self.entries = first, last
        self.pending: dict[int, list[Boxes]] = defaultdict(list)
        self.rate = np.zeros(count)
        # S q is no more where wheels are caught first; later its own bound holds.
        self.level = np.where(filled.alive, filled.steep, 0.0).max(axis=1)
        shape = count, self.edges.size - 1
        self.slip = Interval(np.broadcast_to(self.edges[:-1], shape), np.broadcast_to(self.edges[1:], shape))
        self.speed = Interval(np.full(count, LEAST_SPEED * fastest), np.full(count, fastest))
        self.there, self.torque = self._bounds(slice(None))
        self.gains = self._gains(self.there)

    def _bounds(self, part: slice) -> tuple[Sliding, Interval]:
        """Bound the friction in some rows, and the torque that holds it and the drag."""
        column = self.cells.at((slice(None), None))
        there = sliding(column, self.slip[:, part], self.speed.column())
        return there, (1.0 + column.share) * there.friction + there.drag

    def _gains(self, t: Sliding) -> Array:
        """By what S q rises beyond what the torque makes it, before it falls again, while S is large enough."""
        cells, speed = self.cells, self.speed.low
        aside = 1.0 + (cells.one.slip + SINK) / (1.0 - cells.one.slip)
        steep = np.maximum(t.slope.low, FLOOR)
        gains = MOST * (t.loss.high / speed[:, None]) * (1.0 + t.rises / steep)
        gains += MOST**2 * t.bends * (cells.radius.high / speed)[:, None] / steep
        gains += aside * (t.eases + ((cells.share * cells.damping).high * 2.0 * MOST)[:, None])
        return np.where(t.slope.low > FLOOR, gains, np.inf)

    def _look(self, row: int) -> None:
        """Bound the friction in the next rows again, with the speeds that wheels have there."""
        filled, part = self.filled, slice(row, row + REACH)
        slow, fast = np.full(len(self.lost), np.inf), np.full(len(self.lost), -np.inf)
        for chunks in self.pending.values():
            for each in chunks:
                np.minimum.at(slow, each.cell, each.speed.low)
                np.maximum.at(fast, each.cell, each.speed.high)
        begin = max(int(np.searchsorted(EDGES, self.edges[row], side="right")) - 1, 0)
        end = int(np.searchsorted(EDGES, self.edges[min(part.stop, self.edges.size - 1)], side="left"))
        end = min(end, EDGES.size - 1)
        # A row has parts that it shares with the rows beside it.
        (first, last), number = self.entries, np.arange(begin, end)
        some = (number >= first[:, None] - SHARED) & (number <= last[:, None] + SHARED)
        entering = filled.speed[:, begin:end]
        slow = np.minimum(slow, np.where(some, entering.low, np.inf).min(axis=1, initial=np.inf))
        fast = np.maximum(fast, np.where(some, entering.high, -np.inf).max(axis=1, initial=-np.inf))
        known = slow <= fast
        slow = np.maximum(
            slow - LINGER * self.there.loss.high[:, part].max(axis=1), LEAST_SPEED * self.fastest
        )
        self.speed = Interval(np.where(known, slow, self.speed.low), np.where(known, fast, self.speed.high))
        there, torque = self._bounds(part)
        refined: list[tuple[Any, Any]] = [*zip(self.there, there, strict=True), (self.torque, torque)]
        for old, new in refined:
            for one, other in (
                ((old.low, new.low), (old.high, new.high)) if isinstance(old, Interval) else ((old, new),)
            ):
                one[:, part] = other
        self.gains[:, part] = self._gains(there)

    def _errors(self, row: int, boxes: Boxes) -> Interval:
        """Errors of the wheel speed in a row."""
        slip = Interval(self.edges[row], self.edges[row + 1])
        return (self.cells.one.slip - slip) * boxes.speed / self.cells.radius[boxes.cell]

    def followed(self) -> Caught:
        """Go through all rows."""
        begins = EDGES[self.entries[0]].min()  # there is nothing to look at before
        for row in range(self.count):
            if row % BLOCK == 0 and (self.pending or self.edges[min(row + REACH, self.count)] > begins):
                self._look(row)
            chunks = self.pending.pop(row, [])
            entering = self._entering(row)
            if entering is not None:
                chunks.append(entering)
            if not chunks:
                continue
            boxes = self._cut(row, together(chunks))
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
        speed = over(filled.speed)
        self.rate = np.maximum(self.rate, np.where(there, filled.rate[:, parts].max(axis=1), 0.0))
        return sliced(Boxes.of(cell, states, speed, filled.supply[cell, parts].min(axis=1)))[0]

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
        unlike = np.maximum(g.high * 0.51 - 0.4 * law.nominal / self.cells.fills[cell].high, 0.0) * change
        known = ((1.0 - law.kept) * error - law.a * (z + p * (1.0 / law.theta))).low - law.a * unlike
        beside = z + p * ((1.0 - law.theta) / law.theta) - error
        least = law.fills * room - change * (1.0 + steep * (0.51 * g.high + law.ahead))
        least = least + np.minimum(known, 0.0) * (1.0 + steep * law.ahead)
        motion = np.where(filled.alive, filled.motion, 0.0)[cell, : parts.stop].max(axis=1)
        way = self.cells.radius.high[cell] / self.speed.low[cell] * motion
        self.lost[cell[way > 0.5 * self.edges[row]]] = True
        found: Array = least - 1.05 * law.sigma - steep * np.maximum(beside.high, 0.0)
        return found

    def _steepest(self, row: int) -> Array:
        """Slope of the pull at most, of wheels of a row and those a sample before."""
        slip = Interval(self.edges[row], self.edges[row + 1])
        errors = (self.cells.one.slip - slip) * self.speed / self.cells.radius
        return _steepness(self.law, Interval(errors.low - 0.5, errors.high)).high

    def _cut(self, row: int, boxes: Boxes) -> Boxes | None:
        """Cut boxes to what holds together, and leave out what is empty."""
        law, beta = self.law, (1.0 - self.law.theta) / self.law.theta
        self.lost[boxes.cell[np.isnan(boxes.values).any(axis=1)]] = True
        boxes = boxes.kept(~self.lost[boxes.cell])
        errors, s = self._errors(row, boxes), boxes.states
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
        boxes = Boxes.of(boxes.cell, s, boxes.speed, boxes.supply).kept(some)
        return boxes if boxes.cell.size else None

    def _sample(self, row: int, boxes: Boxes) -> None:
        """Hand on what a sample makes of boxes."""
        law, s, cell = self.law, boxes.states, boxes.cell
        cells = self.cells.at(cell)
        g, kappa = cells.effect, cells.share
        there = self._around(row)
        slides, eases = there["slides"][cell], there["eases"][cell]
        torque = (there["torque"][cell] + s["y"]) / g
        full = cells.one.full
        s["room"] = s["room"].cut(
            Interval(full * (1.0 - SPARE) * boxes.supply - torque.high, full * (1.0 + SPARE) - torque.low)
        )
        rise = (cells.one.full - torque - s["room"]).at_least(0.0) * cells.supply_rate
        rise = Interval(rise.low * (1.0 - 0.5 * cells.supply_rate.high), rise.high)
        valve = Valve(law, cells, s["room"], rise, torque)
        ways = valve.parts(s["way"])
        change = valve.change(ways)
        most_room = s["room"].high + 2.0 * rise.high + np.maximum(-change.low, 0.0)
        self.rate = np.maximum(
            self.rate, _of_cells(cells.fills.high * law.over_fill * most_room, cell, len(self.rate))
        )
        beside = s["z"] + ((1.0 - law.theta) / law.theta) * s["p"] - s["error"]
        gained = g * change
        pull = _pull(law, self._errors(row, boxes) + law.ahead * (beside - s["y"]))
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
        speed = self.speed[cell]
        least, most_moved = np.maximum(moved.low - slides.high, 0.0), np.maximum(moved.high - slides.low, 0.0)
        length = (
            cells.radius.low / speed.high * least * (1.0 - 1e-12),
            cells.radius.high / speed.low * most_moved * (1.0 + 1e-12),
        )
        bad = length[0] < self.edges[row + 1] - self.edges[row]
        # The observed friction: what it is wanted for, and what there is.
        seen = torque.low + s["way"].low - pull.high + s["error"].low - there["falls"][cell].high
        beyond = there["friction"][cell].low - np.maximum(g.high - 1.0, 0.0) * torque.high
        seen = np.maximum(seen, beyond + (s["z"] + ((1.0 - law.theta) / law.theta) * s["p"]).low)
        bad |= seen <= 0.0
        least_room = 1.1 * WHOLE * (cells.one.full + 0.1)
        bad |= (s["room"].low <= least_room) | (torque.low <= least_room)
        bad |= (y.low <= LEAST) | (y.high >= MOST) | ~np.isfinite(way.low) | ~np.isfinite(way.high)
        bad |= (boxes.speed.low - 2.5 * there["loss"][cell].high < speed.low) | (
            boxes.speed.high > speed.high
        )
        hops = (
            np.searchsorted(self.edges, self.edges[row] + length[0], side="right") - 1 - row,
            np.searchsorted(self.edges, self.edges[row + 1] + length[1], side="left") - 1 - row,
        )
        bad |= hops[1] >= AHEAD
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
        keep = ~self.lost[cell]
        speed_after = boxes.speed - there["loss"][cell]
        lacks = (1.0 - boxes.supply) * np.exp(-cells.supply_rate.low) * (1.0 + 1e-12)
        after = Boxes.of(cell, states, speed_after, 1.0 - lacks).kept(keep)
        parts, origin = sliced(after)
        waiting, (nearest, farthest) = joined(parts, *(each[keep][origin] for each in hops))
        for hop in range(int(nearest.min(initial=AHEAD)), int(farthest.max(initial=0)) + 1):
            there_too = (nearest <= hop) & (farthest >= hop)
            if there_too.any():
                self.pending[row + hop].append(waiting.kept(there_too))

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
            "friction": over(t.friction),
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
        changes: tuple["tuple[Part, Part]", Interval, Interval],
        valve: "Valve",
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
        length, last = cells.radius.high / self.speed.low[cell], self.edges.size - 2

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
        self.lost[cell[(end == last) | (end - row >= 2 * AHEAD) | (fastest >= MOST)]] = True
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
        moved = (cells.radius.low / self.speed.high[cell]) * np.maximum(
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
        errors = self._errors(row, boxes)
        return Interval(
            errors.low - law.ahead * (s["y"].high - beside.low) - step,
            errors.high + law.ahead * np.maximum(beside.high - s["y"].low, 0.0) + step,
        )

    def _way(
        self,
        boxes: Boxes,
        cells: Cells,
        ways: "tuple[Part, Part]",
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
            found = found + part.way * corners(of_way, cells.effect, part.rho, part.share, steep)
            found = found - law.a * part.unlike * (1.0 + law.ahead * steep)
        return found

    @staticmethod
    def _beyond(valve: "Valve", way: Interval, steep: Interval) -> Interval:
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
        self._look(self.count)
        boxes = together([each for row in sorted(self.pending) for each in self.pending[row]])
        self.lost[boxes.cell[~np.isfinite(boxes.values).all(axis=1)]] = True
        states = boxes.states
        found = {name: Interval(np.full(count, np.inf), np.full(count, -np.inf)) for name in STATES}
        speed = Interval(np.full(count, np.inf), np.full(count, -np.inf))
        for which, ends in (*((each, found[name]) for name, each in states.items()), (boxes.speed, speed)):
            np.minimum.at(ends.low, boxes.cell, which.low)
            np.maximum.at(ends.high, boxes.cell, which.high)
        supply = np.full(count, np.inf)
        np.minimum.at(supply, boxes.cell, boxes.supply)
        last = max(self.pending, default=self.count)
        missing = ~np.isfinite(speed.low)
        torque = (
            self.torque[:, self.count : self.count + AHEAD].low.min(axis=1) + found["y"].low
        ) / self.cells.effect.high
        return Caught(
            states=found,
            slip=(float(self.edges[self.count]), float(self.edges[last + 1])),
            speed=speed,
            supply=np.maximum((torque + found["room"].low) / self.cells.one.full * (1.0 - 1e-9), supply),
            # Each sample leads out of its row.
            time=self.filled.time[np.arange(count), self.entries[1]] + float(last + 1),
            lost=self.lost | missing,
        )


def _pull(law: LawNumbers, seen: Interval) -> Interval:
    """Pull at predicted errors."""
    return seen.rising(partial(pulls, law))


def _steepness(law: LawNumbers, seen: Interval) -> Interval:
    """Slope of the pull."""

    def slope(x: Array) -> Array:
        curve = np.sqrt(np.maximum(2.0 * law.sigma * (x - 0.5 * law.begins), 1e-300))
        return np.where(x > law.begins, law.sigma / curve, law.gain)

    return seen.falling(slope)


def _of_cells(values: Array, cell: Index, count: int) -> Array:
    """Largest value of each cell."""
    found = np.zeros(count)
    np.maximum.at(found, cell, values)
    return found
