"""Wheels of which the valves pause for the first time: simulated ones stay in the boxes of rows and in bounds."""

from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest

from tests.attack.plant import creep_force, static_load
from tests.certificates.band import from_rolling
from tests.certificates.band.from_rolling import (
    LOW,
    STATES,
    TOLERANCE,
    UNTIL,
    WET,
    cells_of,
    problem,
    simulated,
    wheels,
)
from tests.certificates.band.sampled_runs import Law, rolling
from tests.certificates.band.test_valve_of_wheels import COUNT, FULL, pulses
from wspd_design.certificates.kernel.interval import Interval
from wspd_design.certificates.theorems.from_rolling import catching, filling
from wspd_design.certificates.theorems.from_rolling.boxes import Boxes
from wspd_design.certificates.theorems.from_rolling.cells import sliding
from wspd_design.certificates.theorems.from_rolling.passing import EDGES
from wspd_design.certificates.theorems.from_rolling.valve import Valve

RAILS = (LOW, WET)


class Logged(catching._Way):
    """Remembers the boxes of each row, and the speeds that they were followed with."""

    def __init__(self, *given):
        super().__init__(*given)
        self.boxes, self.speeds = {}, {}

    def _cut(self, row, boxes):
        found = super()._cut(row, boxes)
        if found is not None:
            self.boxes[row], self.speeds[row] = found, self.speed
        return found


@cache
def given(rail):
    """What the way of all cells begins with."""
    law, cells, fastest = from_rolling.law(rail), wheels(rail, cells_of(rail)), problem(rail).speeds[1]
    return law, cells, filling.filled(law, cells, fastest), fastest, UNTIL[rail]


@cache
def followed(rail):
    """All cells through the rows, and what they are at the end."""
    with np.errstate(all="ignore"):
        way = Logged(*given(rail))
        return way, way.followed()


def supplied(found):
    """Supply of simulated wheels, over the full pressure."""
    return (found["torque"] + found["room"]) / FULL


def holding(boxes, cell, state):
    """Tell which of some boxes hold a state of a wheel; how far outside it is of the others does not matter."""
    inside = boxes.cell == cell
    inside &= (boxes.speed.low - TOLERANCE <= state["speed"]) & (
        state["speed"] <= boxes.speed.high + TOLERANCE
    )
    inside &= boxes.supply <= supplied(state) + TOLERANCE
    for name, bound in boxes.states.items():
        inside &= (bound.low - TOLERANCE <= state[name]) & (state[name] <= bound.high + TOLERANCE)
    return inside


def row_of(way, slip):
    return np.searchsorted(way.edges, slip, side="right") - 1


def at(found, *index):
    """Simulated states at some places."""
    return {name: each[index] for name, each in found.items()}


def point(value):
    return Interval(value, value)


def exact(number, state, **other):
    """Boxes of nothing but simulated states."""
    states = {name: point(state[name]) for name in STATES} | other
    return Boxes.of(number, states, point(state["speed"]), supplied(state) * (1.0 - 1e-12))


# --- simulated wheels -------------------------------------------------------------------------------------------------
@pytest.mark.parametrize("rail", RAILS)
def test_no_cell_is_lost(rail):
    assert not followed(rail)[1].lost.any()


@pytest.mark.parametrize("rail", RAILS)
def test_simulated_wheels_are_in_a_box_of_their_row(rail):
    way, _ = followed(rail)
    found, cell_of, so_far = simulated(rail)
    visited = 0
    for sample, number in zip(*np.nonzero(~so_far & (found["slip"] < UNTIL[rail])), strict=True):
        row = int(row_of(way, found["slip"][sample, number]))
        inside = holding(way.boxes[row], cell_of[number], at(found, sample, number))
        assert inside.any(), (cell_of[number], number, sample)
        visited += 1
    assert visited > 1000


@pytest.mark.parametrize("rail", RAILS)
def test_no_box_is_said_to_have_more_supply_or_another_speed_than_simulated_wheels(rail):
    """Of all boxes of a row there is one for each wheel: the least supply and the speeds of a cell hold all of them."""
    way, _ = followed(rail)
    found, cell_of, so_far = simulated(rail)
    supply, spare = supplied(found), []
    for row, boxes in way.boxes.items():
        least = np.full(len(way.lost), np.inf)
        np.minimum.at(least, boxes.cell, boxes.supply)
        speed = way.speeds[row]
        assert (speed.low[boxes.cell] <= boxes.speed.low).all()
        assert (speed.high[boxes.cell] >= boxes.speed.high).all()
        here = ~so_far & (found["slip"] >= way.edges[row]) & (found["slip"] < way.edges[row + 1])
        sample, number = np.nonzero(here)
        spare += list(supply[sample, number] - least[cell_of[number]])
        # And in the next two samples.
        for later in range(3):
            there = found["speed"][np.minimum(sample + later, len(supply) - 1), number]
            assert (there >= speed.low[cell_of[number]]).all()
            assert (there <= speed.high[cell_of[number]]).all()
    assert min(spare) >= 0.0
    assert np.median(spare) < 0.1
    assert len(spare) > 1000


@cache
def moments(rail):
    """Friction, its slope, and torque and slides together, at the moments of samples; with the row of each."""
    way, (found, cell_of, so_far) = followed(rail)[0], simulated(rail)
    drawn = [from_rolling.members(rail, each, 16, 3 + k) for k, each in enumerate(cells_of(rail))]
    points = {name: np.concatenate([each[name] for each in drawn]) for name in drawn[0]}
    law = Law(problem(rail).controller, problem(rail).slip)
    runs = rolling(problem(rail), law, points)
    plant, slip, speed = runs.plant, found["slip"], found["speed"]
    wheel = (1.0 - slip) * speed / plant.wheel_radius
    moved = from_rolling.moving(plant, law, SimpleNamespace(speed=speed, wheel=wheel), 0.0)
    np.testing.assert_allclose(moved["slope"], found["slope"], rtol=1e-8, atol=1e-10)
    unit = law.h / plant.wheelset_inertia
    force = creep_force(plant, slip, speed, static_load(plant))
    friction = 2.0 * plant.wheel_radius * force * unit - 2.0 * plant.wheel_damping * unit * wheel
    here = ~so_far & (slip < way.edges[way.count])
    here[-1] = False
    sample, number = np.nonzero(here)
    return SimpleNamespace(
        at=(cell_of[number], row_of(way, slip[sample, number])),
        next=row_of(way, slip[sample + 1, number]),
        friction=friction[sample, number],
        slope=moved["slope"][sample, number],
        held=-moved["motion"][sample, number],
        loss=(speed[sample] - speed[sample + 1])[np.arange(sample.size), number],
    )


@pytest.mark.parametrize("rail", RAILS)
def test_friction_of_simulated_wheels_is_within_bounds_with_the_speeds_of_boxes(rail):
    """At the slip and speed of simulated wheels: the bounds are of a row, and of the speeds that wheels have there."""
    way, seen = followed(rail)[0], moments(rail)
    t = way.there
    assert seen.friction.size > 1000
    assert holds(t.friction[seen.at], seen.friction, TOLERANCE)
    assert holds(t.slope[seen.at], seen.slope, TOLERANCE)
    assert holds((way.torque + t.slides)[seen.at], seen.held, TOLERANCE)
    # What the train loses over a sample, which leads over some rows.
    for (cell, first), last, loss in zip(zip(*seen.at, strict=True), seen.next, seen.loss, strict=True):
        rows = slice(first, last + 1)
        assert t.loss.low[cell, rows].min() - TOLERANCE <= loss <= t.loss.high[cell, rows].max() + TOLERANCE


@pytest.mark.parametrize("rail", RAILS)
def test_looking_again_only_narrows_bounds(rail):
    """No bound of the friction is wider than with all speeds, and most are far narrower."""
    way, _ = followed(rail)
    with np.errstate(all="ignore"):
        wide = catching._Way(*given(rail))
    for name, old in wide.there._asdict().items():
        new = getattr(way.there, name)
        spare = 1e-9 * np.abs(old.high if isinstance(old, Interval) else old).max()
        if isinstance(old, Interval):
            assert (new.low >= old.low - spare).all(), name
            assert (new.high <= old.high + spare).all(), name
        else:
            assert (new <= old + spare).all(), name
    assert (way.gains <= wide.gains * (1.0 + 1e-9)).all()

    met = np.searchsorted(way.edges, 0.03)  # wheels of all cells come to rows from here on

    def width(value):
        return (value.high - value.low)[:, met:].mean(axis=1)

    assert (width(way.there.slope) < 0.6 * width(wide.there.slope)).all()


@pytest.mark.parametrize("row", [0, 70])
def test_rows_ahead_are_looked_at_with_the_speeds_of_boxes_and_of_wheels_that_enter(row):
    law, cells, filled, fastest, until = given(LOW)
    with np.errstate(all="ignore"):
        way = catching._Way(law, cells, filled, fastest, until)
        before, t = way.gains.copy(), way.there.slope.low.copy()
        loss, part = way.there.loss.high, slice(row, row + catching.BLOCK + 2 * catching.AHEAD)
        last = int(np.searchsorted(EDGES, way.edges[part.stop], side="left"))
        first = int(np.searchsorted(EDGES, way.edges[row], side="right")) - 1
        slowest = loss[:, part].max(axis=1) * catching.LINGER
        boxes = Boxes.of(
            np.array([1, 1, 2]),
            dict.fromkeys(STATES, point(np.zeros(3))),
            Interval(fastest - np.array([0.5, 4.0, 4.0]), fastest - np.array([0.4, 3.0, 3.0])),
            np.zeros(3),
        )
        way.pending[row + 5] = [boxes.kept([0, 2])]
        way.pending[row + 9] = [boxes.kept([1])]
        way._look(row)
        for cell in range(3):
            entering = np.arange(first, last)
            some = (entering >= way.entries[0][cell] - 8) & (entering <= way.entries[1][cell] + 8)
            low = list(filled.speed.low[cell, first:last][some]) + [fastest - 4.0] * (cell > 0)
            high = list(filled.speed.high[cell, first:last][some]) + [fastest - (0.4, 3.0)[cell - 1]] * (
                cell > 0
            )
            if low:
                assert way.speed.low[cell] == min(low) - slowest[cell]
                assert way.speed.high[cell] == max(high)
            else:
                assert (way.speed.low[cell], way.speed.high[cell]) == (
                    catching.LEAST_SPEED * fastest,
                    fastest,
                )
        there = sliding(cells.at((slice(None), None)), way.slip[:, part], way.speed.column())
        np.testing.assert_array_equal(way.there.slope.low[:, part], there.slope.low)
        np.testing.assert_array_equal(way.there.fading[:, part], there.fading)
        np.testing.assert_array_equal(way.gains[:, part], way._gains(there))
    for rows in (slice(0, row), slice(part.stop, None)):
        np.testing.assert_array_equal(way.gains[:, rows], before[:, rows])
        np.testing.assert_array_equal(way.there.slope.low[:, rows], t[:, rows])


@pytest.mark.parametrize("rail", RAILS)
def test_friction_of_other_speeds_is_not_within_bounds(rail):
    """If trains were faster than their boxes have them, the friction would be seen to be outside."""
    seen = moments(rail)
    with np.errstate(all="ignore"):
        way = catching._Way(*given(rail))
        for row in range(0, way.count, catching.BLOCK):
            narrow = followed(rail)[0].speeds.get(row, way.speed)
            boxes = Boxes.of(
                np.arange(len(way.lost)),
                dict.fromkeys(STATES, narrow),
                Interval(0.9 * narrow.low, 0.9 * narrow.high),
                way.rate,
            )
            way.filled = SimpleNamespace(
                speed=Interval(np.inf * given(rail)[2].way, -np.inf * given(rail)[2].way)
            )
            way.pending[row] = [boxes]
            way._look(row)
            way.pending.clear()
    assert not holds(way.there.slope[seen.at], seen.slope, TOLERANCE)


@pytest.mark.parametrize("rail", RAILS)
def test_simulated_wheels_end_as_is_said(rail):
    _, end = followed(rail)
    found, cell_of, so_far = simulated(rail)
    first = np.argmax(found["slip"] >= end.slip[0], axis=0)
    assert UNTIL[rail] <= end.slip[0] < UNTIL[rail] + catching.WIDTH
    assert first.min() > 0
    number = np.arange(len(cell_of))
    for name in STATES:
        value = found[name][first, number]
        assert (value >= end.states[name].low[cell_of] - TOLERANCE).all(), name
        assert (value <= end.states[name].high[cell_of] + TOLERANCE).all(), name
    slip = found["slip"][first, number]
    assert end.slip[0] <= slip.min()
    assert slip.max() <= end.slip[1]
    assert holds(end.speed[cell_of], found["speed"][first, number], TOLERANCE)
    assert (supplied(found)[first, number] >= end.supply[cell_of]).all()
    assert (first <= end.time[cell_of]).all()
    assert not so_far[first, number].any()


@pytest.mark.parametrize("rail", RAILS)
def test_what_is_said_at_the_end_is_not_far_from_simulated_wheels(rail):
    """Bounds that hold anything would be of no use."""
    _, end = followed(rail)
    for name, most in {"y": 0.15, "z": 0.05, "p": 0.05, "error": 0.05, "way": 0.12}.items():
        assert (end.states[name].high - end.states[name].low < most).all(), name
    assert (end.supply > 0.05).all()


@pytest.mark.parametrize("rail", RAILS)
def test_wheels_want_no_less_after_a_whole_sample_and_enter_in_a_box(rail):
    """Of the first sample that the valve does not fill; and what is handed on there."""
    way, _ = followed(rail)
    found, cell_of, so_far = simulated(rail)
    first = np.argmax(~so_far, axis=0)
    spare = []
    for number, sample in enumerate(first):
        state = at(found, sample, number)
        row = int(row_of(way, state["slip"]))
        least = way._after_whole(row, cell_of[[number]])[0]
        spare.append(state["way"] - least)
        assert holding(way._entering(row), cell_of[number], state).any(), (number, sample)
    assert -TOLERANCE < min(spare) < 0.012


# --- a sample of single wheels ---------------------------------------------------------------------------------------
@cache
def run(rail, count=36):
    """Wheels of all the box, their numbers, and whether the valve filled so far."""
    points = from_rolling.members(rail, {}, count, 17)
    points["fill time"] = np.minimum(points["fill time"], 0.88)  # no valve that is slower than the supply
    found = from_rolling.courses(rail, points, from_rolling.SAMPLES[rail], UNTIL[rail] + 0.02)
    so_far = np.logical_and.accumulate(found["whole"] | (np.arange(len(found["slip"])) < 2)[:, None], axis=0)
    return points, found, so_far


def way_of(rail):
    """The way of these wheels, each a cell of its own."""
    points, found, so_far = run(rail)
    count = len(points["speed"])
    before = np.concatenate([so_far[:1], so_far[:-1]])
    numbers = [{name: (float(points[name][k]),) * 2 for name in from_rolling.EIGHT} for k in range(count)]
    shape, ends = (count, EDGES.size - 1), (found["speed"].min(axis=0), found["speed"].max(axis=0))
    filled = SimpleNamespace(
        lost=np.zeros(count, dtype=bool),
        opens=np.ones(shape, dtype=bool),
        alive=np.ones(shape, dtype=bool),
        speed=Interval(*(np.broadcast_to(end[:, None], shape) for end in ends)),
        # What S q was while the valve filled, and at the sample after.
        steep=np.broadcast_to(np.where(before, found["level"], 0.0).max(axis=0)[:, None], shape),
    )
    law, cells, fastest = from_rolling.law(rail), wheels(rail, numbers), problem(rail).speeds[1]
    with np.errstate(all="ignore"):
        way = catching._Way(law, cells, filled, fastest, UNTIL[rail])
    way.rate = (found["room"] * 0.02 / points["fill time"]).max(axis=0)
    return way


@cache
def single(rail):
    """What a sample makes of their exact states: the most that can be told."""
    way, (_, found, so_far) = way_of(rail), run(rail)
    seen = {name: [] for name in ("friction", "limit", "lost", "inside", "number")}
    with np.errstate(all="ignore"):

        def hears(name):
            method = getattr(way, name)

            def heard(*given):
                seen["heard " + name] = result = method(*given)
                seen["followed"] = ~way.lost[given[1].cell]
                return result

            setattr(way, name, heard)

        hears("_friction")
        hears("_limit")
        for row in range(way.count):
            if row % catching.BLOCK == 0:
                way._look(row)
            # Late ones that still fill as well: what is wanted beyond a whole sample goes on to be wanted.
            here = (found["slip"] >= way.edges[row]) & (found["slip"] < way.edges[row + 1])
            here[:16] &= ~so_far[:16]
            sample, number = np.nonzero(here[:-2])
            if not number.size:
                continue
            way.pending.clear()
            way.lost[:] = False
            way._sample(row, exact(number, at(found, sample, number)))
            change = found["friction"][sample + 1, number] - found["friction"][sample, number]
            bound, limit = seen["heard _friction"][0], seen["heard _limit"]
            seen["friction"] += list(np.maximum(bound.low - change, change - bound.high)[seen["followed"]])
            # Until the end of the next sample.
            level = np.max([found["level"][sample + k, number] for k in range(3)], axis=0)
            seen["limit"] += list((level - limit)[seen["followed"]])
            for n, j in zip(sample, number, strict=True):
                seen["lost"].append(bool(way.lost[j]))
                boxes, state = way.pending[int(row_of(way, found["slip"][n + 1, j]))], at(found, n + 1, j)
                seen["inside"].append(any(holding(each, j, state).any() for each in boxes))
                seen["number"].append((row, int(n), int(j)))
    return seen


@pytest.mark.parametrize("rail", RAILS)
def test_a_sample_of_a_single_wheel_holds_its_next_state(rail):
    seen = single(rail)
    told = zip(seen["number"], seen["inside"], seen["lost"], strict=True)
    assert [each for each, inside, lost in told if not inside and not lost] == []
    assert np.count_nonzero(seen["inside"]) > 400
    assert np.mean(seen["lost"]) < 0.6
    assert max(seen["friction"]) < TOLERANCE
    assert max(seen["limit"]) < TOLERANCE


@pytest.mark.parametrize("rail", RAILS)
def test_limit_of_the_motion_holds_over_two_samples(rail):
    """Of wheels whose slip has risen so far, up to the row in which the next sample ends."""
    way, (_, found, _) = way_of(rail), run(rail)
    slip, level = found["slip"], found["level"]
    rises = np.logical_and.accumulate((np.diff(slip, axis=0) > 0.0) | (slip[1:] < way.edges[0]), axis=0)
    spare = []
    for row in range(way.count):
        if row % catching.BLOCK == 0:
            way._look(row)
        here = rises[1:] & (slip[:-2] >= way.edges[row]) & (slip[:-2] < way.edges[row + 1])
        sample, number = np.nonzero(here & (slip[2:] < way.edges[-1]))
        end = np.searchsorted(way.edges, slip[sample + 2, number], side="right") - 1
        limit = way._limit(row, SimpleNamespace(cell=number), end)
        for later in range(3):
            known = np.isfinite(limit)
            spare += list((1.0 - level[sample + later, number] / limit)[known])
    assert len(spare) > 300
    assert 0.0 <= min(spare) < 0.5


@pytest.mark.parametrize("rail", RAILS)
def test_what_holds_together_is_not_cut_away(rail):
    """Of boxes around exact states, with any side at them."""
    way, (_, found, so_far), random = way_of(rail), run(rail), np.random.default_rng(14)
    count = cut = 0
    for row in range(20, way.count, 3):
        here = ~so_far & (found["slip"] >= way.edges[row]) & (found["slip"] < way.edges[row + 1])
        sample, number = np.repeat(np.nonzero(here), 8, axis=1)
        if not number.size:
            continue
        states, state = {}, at(found, sample, number)
        for name in STATES:
            value = state[name]
            below, above = random.exponential(0.01, (2, value.size)) * random.integers(0, 2, (2, value.size))
            states[name] = Interval(value - below - 1e-9, value + above + 1e-9)
        before = sum((each.high - each.low).sum() for each in states.values())
        whole = exact(number, state, **states)
        whole.values[: number.size // 2, -3] += 0.2  # trains that may be slower, or faster
        whole.values[number.size // 2 :, -2] += 0.2
        boxes = way._cut(row, whole)
        assert boxes.cell.size == number.size
        for name, bound in boxes.states.items():
            assert holds(bound, state[name], TOLERANCE), name
        np.testing.assert_array_equal(boxes.supply, whole.supply)
        np.testing.assert_array_equal(boxes.speed.low, whole.speed.low)
        np.testing.assert_array_equal(boxes.speed.high, whole.speed.high)
        count += number.size
        cut += before - sum((each.high - each.low).sum() for each in boxes.states.values())
    assert count > 500
    assert cut > 0.1


CROOKED = {
    "y falls below 0": {"y": (-0.05, 0.1)},
    "y is too large": {"y": (0.05, 0.45)},
    "there is no room": {"room": (0.0, 0.2), "supply": 0.0},
    "what is wanted is not known": {"way": (-np.inf, 0.0)},
}


def one_of(way, chosen):
    """Number in an array, state and row of the first simulated wheel of some."""
    _, found, so_far = run(LOW)
    sample, number = np.argwhere(~so_far & chosen(found))[0]
    state = {name: each[sample, [number]] for name, each in found.items()}
    return np.array([number]), state, int(row_of(way, state["slip"][0]))


def settled(found):
    return (found["slip"] > 0.02) & (found["slip"] < 0.05) & (np.abs(found["way"]) < 0.005)


@pytest.mark.parametrize("what", [None, *CROOKED])
def test_cells_with_states_that_are_not_followed_are_lost(what):
    way = way_of(LOW)
    number, state, row = one_of(way, settled)
    ends = dict(CROOKED.get(what, {}))
    supply = ends.pop("supply", None)
    boxes = exact(
        number, state, **{name: Interval(*(np.array([end]) for end in span)) for name, span in ends.items()}
    )
    if supply is not None:
        boxes.values[:, -1] = -supply
    with np.errstate(all="ignore"):
        way._look(row)
        way._sample(row, boxes)
    assert way.lost[number] == (what is not None)
    assert bool(way.pending) == (what is None)
    assert np.count_nonzero(way.lost) <= 1


@pytest.mark.parametrize(
    ("below", "above", "lost"),
    [(2.6, 0.001, False), (2.4, 0.001, True), (-0.1, 0.1, True), (9.0, -0.001, True), (9.0, -9.0, True)],
)
def test_boxes_with_other_speeds_than_those_looked_at_are_lost(below, above, lost):
    """How far the box is from the slowest speed, in what a sample loses, and from the fastest one [m/s]."""
    way = way_of(LOW)
    number, state, row = one_of(way, settled)
    with np.errstate(all="ignore"):
        way._look(row)
        loss, speed = way._around(row)["loss"].high[number], state["speed"][0]
        way.speed.low[number], way.speed.high[number] = speed - below * loss, speed + above
        way._sample(row, exact(number, state))
    assert way.lost[number] == lost
    assert bool(way.pending) == (not lost)


@pytest.mark.parametrize(
    ("wanted", "found", "lost"), [(-0.9, 0.0, False), (None, -9.0, False), (-0.9, -9.0, True)]
)
def test_a_cell_is_lost_if_neither_what_is_wanted_nor_the_friction_tells_that_some_is_observed(
    wanted, found, lost
):
    """What is wanted at least, and by how much less friction there is."""
    way = way_of(LOW)
    number, state, row = one_of(way, settled)
    ends = {} if wanted is None else {"way": Interval(np.array([wanted]), np.array([0.0]))}
    with np.errstate(all="ignore"):
        way._look(row)
        around = way._around(row)
        way._around = lambda _: around | {"friction": around["friction"] + found}
        way._sample(row, exact(number, state, **ends))
    assert way.lost[number] == lost


def test_a_room_that_is_not_known_is_that_of_the_least_supply():
    way = way_of(LOW)
    number, state, row = one_of(way, settled)
    with np.errstate(all="ignore"):
        way._look(row)
        way._sample(row, exact(number, state, room=Interval(np.array([0.0]), np.array([2.0]))))
    assert not way.lost[number]


@pytest.mark.parametrize("which", ["speed", "supply", *STATES])
def test_a_cell_with_a_state_that_is_not_a_number_is_lost(which):
    way = way_of(LOW)
    number, state, row = one_of(way, lambda found: found["slip"] > 0.02)
    boxes = exact(number, state)
    column = {"speed": -2, "supply": -1}.get(which) or 2 * STATES.index(which) + 1
    boxes.values[:, column] = np.nan
    with np.errstate(all="ignore"):
        assert way._cut(row, boxes) is None
    assert way.lost[number]


def cut_rooms(rail, monkeypatch, more):
    """Rooms that are left of wide ones by the torque and the supply, and by how much simulated ones are outside."""
    way, (_, found, so_far) = way_of(rail), run(rail)
    seen = []
    monkeypatch.setattr(catching, "Valve", lambda *numbers: seen.append(numbers) or Valve(*numbers))
    outside, width = [], []
    with np.errstate(all="ignore"):
        for row in range(0, way.count, 2):
            if row % catching.BLOCK == 0:
                way._look(row)
            here = ~so_far & (found["slip"] >= way.edges[row]) & (found["slip"] < way.edges[row + 1])
            sample, number = np.nonzero(here)
            if not number.size:
                continue
            state = at(found, sample, number)
            wide = Interval(state["room"] - 0.3, state["room"] + 0.6)
            boxes = exact(number, state, room=wide)
            boxes.values[:, -1] -= more
            way._sample(row, boxes)
            _, _, room, _, torque = seen[-1]
            assert holds(torque, state["torque"], TOLERANCE)
            outside += list(np.maximum(room.low - state["room"], state["room"] - room.high))
            width += list(room.high - room.low)
    return np.array(outside), np.array(width)


@pytest.mark.parametrize("rail", RAILS)
def test_room_is_cut_to_what_supply_and_torque_leave(rail, monkeypatch):
    outside, width = cut_rooms(rail, monkeypatch, 0.0)
    assert outside.size > 200
    assert outside.max() <= TOLERANCE
    assert width.max() < 0.9
    assert np.median(width) < 0.8


@pytest.mark.parametrize("rail", RAILS)
def test_a_supply_that_is_too_large_cuts_the_room_away(rail, monkeypatch):
    """What looks for the simulated room sees it."""
    outside, _ = cut_rooms(rail, monkeypatch, 0.1)
    assert outside.max() > 0.01


# --- what is wanted ---------------------------------------------------------------------------------------------------
@pytest.fixture(scope="module", params=[1.0, -1.0], ids=["fills", "vents"])
def pulse(request):
    return pulses(3, request.param)


def holds(bound, value, spare=1e-9):
    return (bound.low - spare <= value).all() and (value <= bound.high + spare).all()


def test_what_is_wanted_beyond_a_whole_sample():
    """Its sign is turned; it goes on to be wanted, and more so by the steepness."""
    made, one = pulses(5, 1.0).valve, np.ones(COUNT)
    whole = made.whole[0]
    way = Interval(whole.low + 0.01, whole.high + 0.02)
    found = catching._Way._beyond(made, way, Interval(0.1 * one, 0.2 * one))
    np.testing.assert_allclose(found.low, -1.2 * (way.high - whole.low), rtol=1e-9)
    np.testing.assert_allclose(found.high, -1.1 * (way.low - whole.high), rtol=1e-9)
    down = Interval(-made.whole[1].high - 0.02, -made.whole[1].low - 0.01)
    found = catching._Way._beyond(made, down, Interval(0.0 * one, 0.0 * one))
    assert (found.high >= 0.02 - 1e-12).all()
    assert (found.low >= 0.01 - 1e-12).all()
    none = catching._Way._beyond(made, Interval(0.0 * one, 0.5 * whole.low), Interval(one, one))
    assert np.abs([none.low, none.high]).max() < 1e-290


# --- pull, corners and boxes ------------------------------------------------------------------------------------------
def test_pull_and_its_slope():
    law = from_rolling.law(WET)
    seen = np.concatenate([np.linspace(-0.2, 6.0, 60), [law.begins]])
    np.testing.assert_allclose(
        catching._pull(law, Interval(seen, seen)).low, [law.pull(x) for x in seen], atol=1e-12
    )
    some = seen[seen > 0.0]
    expected = [law.steepness(law.pull(x)) for x in some]
    np.testing.assert_allclose(catching._steepness(law, Interval(some, some)).high, expected, rtol=1e-12)
    over = catching._steepness(law, Interval(np.array([0.5]), np.array([3.0])))
    assert over.low[0] <= law.steepness(law.pull(3.0))
    assert over.high[0] >= law.steepness(law.pull(0.5))


def test_edges_of_rows_go_on_beyond_the_last_one():
    edges, count = catching.rows(0.06)
    assert edges[count] >= 0.06 > edges[count - 1]
    assert edges[0] == 0.001
    assert (np.diff(edges) > 0.0).all()
    assert np.diff(edges).max() <= catching.WIDTH * (1 + 1e-9)
    assert edges.size == count + catching.AHEAD + 2


def test_what_is_wanted_after_a_whole_sample_is_that_of_the_map():
    """Of exact states: no more than the map has, and little less."""
    random, law, count = np.random.default_rng(12), from_rolling.law(WET), 300
    beta = (1.0 - law.theta) / law.theta
    z, p, error = random.uniform(-0.02, 0.02, (3, count))
    one, share = np.ones(count), random.random(count)
    g, rho, room = (random.uniform(*ends, count) for ends in ((0.75, 1.35), (0.4, 1.2), (0.05, 0.4)))
    seen = random.uniform(1.0, 6.0, count)
    pull, way = np.array([law.pull(each) for each in seen]), law.fills * room
    tau, own = rho * law.over_fill, law.nominal * law.over_fill
    change, mean = room * -np.expm1(-tau), room * (1.0 + np.expm1(-tau) / tau)
    unlike = g * mean - room * (1.0 + np.expm1(-own) / own)
    beside = z + beta * p - error
    known = (1.0 - law.kept) * error - law.a * (z + p / law.theta + unlike)
    later = seen - (pull - way + beside) - g * mean + law.ahead * (known - change)
    pulls = np.array([law.pull(each) for each in later])
    mapped = way - change + known + pulls - pull
    steep = np.array([law.steepness(min(ends)) for ends in zip(pull, pulls, strict=True)])

    def everywhere(value):
        return np.repeat(value[:, None], EDGES.size - 1, axis=1)

    def part(value):
        return Interval(everywhere(value), everywhere(value))

    filled = SimpleNamespace(
        room=part(room),
        z=part(z),
        p=part(p),
        error=part(error),
        rate=everywhere(tau * room),
        motion=everywhere(0.2 * share),
        alive=everywhere(one > 0.0),
    )
    cells = SimpleNamespace(
        effect=Interval(g, g), fills=Interval(rho, rho), radius=Interval(0.5 * one, 0.5 * one)
    )
    made = SimpleNamespace(
        law=law,
        filled=filled,
        cells=cells,
        speed=Interval(25.0 * one, 26.0 * one),
        edges=np.array([0.004, 0.004]),  # twice what a wheel with half of the motions slips by in a sample
        lost=np.zeros(count, dtype=bool),
        _steepest=lambda _: steep,
    )
    ok = later > 0.5
    found = catching._Way._after_whole(made, 0, np.arange(count))
    # Wheels that were not in the parts that are looked at, a sample before.
    np.testing.assert_array_equal(made.lost, share > 0.5)
    assert np.count_nonzero(ok) > 250
    assert (found - mapped)[ok].max() < 1e-12
    assert (mapped - found)[ok].min() < 6e-4


# --- what the friction changes by, of wheels whose friction rises evenly over the slip -------------------------------
def even(seed, sign, count=600, parts=800, *, fades=0.0, eases=0.0):
    """Friction with one slope, two samples with a pulse each: f, y and torque by integration, and their bounds."""
    random = np.random.default_rng(seed)
    law, one = from_rolling.law(WET), np.ones(count)
    g, kappa = random.uniform(0.75, 1.35, count), random.uniform(0.08, 0.14, count)
    slope = random.uniform(-0.4, 1.3, count)
    fades, eases = fades * random.random(count), eases * random.random(count)
    rho, room = random.uniform(0.4, 1.2, (2, count)), random.uniform(0.1, 0.4, (2, count))
    torque, q = room[1], random.uniform(0.02, 0.12, count)
    share = random.random((2, count))
    times = np.linspace(0.0, 1.0, parts + 1)[:, None]
    signs = np.array([sign, np.where(random.random(count) < 0.7, sign, -sign)], dtype=object)
    course, ways, level = [], [], torque
    left = room[0]
    for k in range(2):
        sized = np.where(signs[k] > 0, law.fills * left, law.vents * level) * share[k]
        length = -np.log1p(-sized / np.where(signs[k] > 0, left, level)) / law.over_fill
        speed = np.where(signs[k] > 0, rho[0], rho[1]) * law.over_fill
        gone = -np.expm1(-speed * np.minimum(times, length))
        change = np.where(signs[k] > 0, left * gone, -level * gone)
        course.append(level + change)
        ways.append(np.where(signs[k] > 0, sized, -sized))
        level, left = course[-1][-1], left - change[-1]
    moves, friction, summed, step = [q], 0.0 * q, [], 1.0 / parts
    for k in range(2):
        mean, pulled = 0.0 * q, np.diff(course[k], axis=0)
        for n in range(parts):
            pushed = g * pulled[n] + (eases - (1.0 + kappa) * fades) * step
            middle = q + 0.5 * (pushed - (1.0 + kappa) * slope * q * step)
            following = q + pushed - (1.0 + kappa) * slope * middle * step
            gained = step * (slope * middle + fades)
            mean = mean + step * (friction + 0.5 * gained)
            friction, q = friction + gained, following
            moves.append(q)
        summed.append(mean)
    y = moves[0] - (1.0 + kappa) * summed[0] + 0.5 * eases  # by the mean of the drag
    change = course[0][-1] - torque
    exact = summed[1] - summed[0]

    rows = 6 * catching.AHEAD
    wide = np.ones((count, rows))
    none = Interval(0.0 * one, 0.0 * one)
    way = SimpleNamespace(
        there=SimpleNamespace(slope=point(slope[:, None] * wide), fading=fades[:, None] * wide),
        speed=Interval(30.0 * one, 33.0 * one),
        edges=0.01 + 2e-4 * np.arange(rows + 1),
        lost=np.zeros(count, dtype=bool),
        _around=lambda _: {"slides": none, "eases": Interval(0.0 * one, eases)},
    )
    cells = SimpleNamespace(
        effect=point(g),
        share=point(kappa),
        radius=point(0.53 * one),
        fills=point(rho[0]),
        vents=point(rho[1]),
    )
    valve = Valve(law, cells, point(room[0]), none, point(torque))
    made = valve.parts(point(ways[0]))
    states = dict.fromkeys(STATES, none) | {"y": point(y)}
    boxes = Boxes.of(np.arange(count), states, point(32.0 * one), 0.1 * one)
    after = valve.change(valve.parts(point(ways[1]), later=True))
    steepest = np.max(moves, axis=0) * np.maximum(slope, 0.0)
    return SimpleNamespace(
        given=(boxes, cells, (made, point(change), after)),
        way=way,
        valve=valve,
        exact=exact,
        y=y + g * change - (1.0 + kappa) * exact + eases,
        steepest=steepest,
        slope=slope,
        moves=np.array(moves),
    )


def test_wheels_that_come_beyond_the_last_row_within_two_samples_are_lost():
    """There nothing is known of the friction."""
    made, rows, lost = even(7, 1.0), 16, []
    boxes, cells, changes = made.given
    made.way._limit = lambda *_: np.full(made.y.size, np.inf)
    for count in (made.way.edges.size - 1, rows):
        slope, fading = made.way.there.slope, made.way.there.fading
        made.way.there = SimpleNamespace(slope=slope[:, :count], fading=fading[:, :count])
        made.way.edges, made.way.lost = made.way.edges[: count + 1], np.zeros(made.y.size, dtype=bool)
        with np.errstate(all="ignore"):
            catching._Way._friction(made.way, 0, boxes, cells, changes, made.valve)
        lost.append(made.way.lost)
    slip = made.way.edges[1] + 0.53 / made.way.speed.low * 2.0 * made.moves.mean(axis=0)
    beyond = slip >= made.way.edges[rows - 1]
    assert lost[1][beyond].all()
    assert np.count_nonzero(beyond & ~lost[0]) > 50
    assert np.count_nonzero(~lost[1]) > 50


def test_limit_is_that_of_all_rows_up_to_the_end_and_of_what_came_before():
    one = np.ones(2)
    gains = np.array([[9.0, 0.1, 0.5, 0.2, 0.3, np.inf], [9.0, 0.1, 0.2, 0.3, 0.4, 0.5]])
    cells = SimpleNamespace(effect=Interval(one, 2.0 * one), share=Interval(1.0 * one, 2.0 * one))
    cells.at = lambda cell: SimpleNamespace(
        effect=Interval(one[cell], 2.0 * one[cell]), share=Interval(one[cell], 2.0 * one[cell])
    )
    made = SimpleNamespace(gains=gains, cells=cells, rate=np.array([0.1, 0.2]), level=np.array([0.0, 0.35]))
    box = SimpleNamespace(cell=np.array([0, 0, 1, 1]))
    # (2 rate + the largest gain)/(1 + 1), and no less than what was before.
    found = catching._Way._limit(made, 1, box, np.array([1, 4, 2, 5]))
    np.testing.assert_allclose(found, [0.15, 0.35, 0.35, 0.45], rtol=1e-8)
    np.testing.assert_allclose(made.level, [0.35, 0.45], rtol=1e-8)
    found = catching._Way._limit(made, 1, box, np.array([1, 5, 2, 3]))
    np.testing.assert_allclose(found, [0.35, np.inf, 0.45, 0.45], rtol=1e-8)


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("limited", [False, True])
@pytest.mark.parametrize("beside", [{}, {"fades": 1e-3}, {"fades": 1e-4, "eases": 1e-4}], ids=str)
def test_change_of_an_even_friction_is_within_bounds(sign, limited, beside):
    """Beside the slip, the speed makes the friction rise and the drag fall."""
    made = even(7, sign, **beside)
    limit = made.steepest + 1e-12 if limited else np.full(made.y.size, np.inf)
    boxes, cells, changes = made.given
    ends = []
    made.way._limit = lambda *given: ends.append(given[2]) or limit
    with np.errstate(all="ignore"):
        friction, y = catching._Way._friction(made.way, 0, boxes, cells, changes, made.valve)
    # Wheels that do not slide on in this sample are not followed; in the next one they are seen then.
    assert made.way.lost[made.moves[: len(made.moves) // 2 + 1].min(axis=0) <= 0.0].all()
    ok = ~made.way.lost
    # The limit is asked for up to where the next sample ends.
    slip = made.way.edges[1] + 0.53 / made.way.speed.low * 2.0 * made.moves.mean(axis=0)
    assert (made.way.edges[ends[0] + 1] >= slip)[ok].all()
    assert np.count_nonzero(ok) > 300
    assert (friction.low - made.exact)[ok].max() < 1e-7
    assert (made.exact - friction.high)[ok].max() < 1e-7
    assert (y.low - made.y)[ok].max() < 1e-7
    assert (made.y - y.high)[ok].max() < 1e-7
    assert (friction.high - friction.low)[ok].max() < 0.032
    # As close as that: next to nothing is left where nothing moves the torque.
    assert (made.exact - friction.low)[ok].min() < 2e-3
    assert (friction.high - made.exact)[ok].min() < 1e-3


def test_what_is_wanted_in_the_next_sample_is_within_bounds(pulse):
    """The exact map with the pull at both predicted errors, of exact states."""
    random, law, one = np.random.default_rng(31), pulse.law, np.ones(COUNT)
    beta = (1.0 - law.theta) / law.theta
    z, p, error = random.uniform(-0.02, 0.02, (3, COUNT))
    seen = random.uniform(0.5, 6.0, COUNT)
    pull = np.array([law.pull(each) for each in seen])
    beside = z + beta * p - error
    y = pull - pulse.way + beside
    errors = seen - law.ahead * (pulse.way - pull)
    unlike = pulse.g * pulse.mean - pulse.own
    known = (1.0 - law.kept) * error - law.a * (z + p / law.theta + unlike)
    later = seen - y - pulse.g * pulse.mean + law.ahead * (known - pulse.change)
    exact = pulse.way - pulse.change + known + np.array([law.pull(each) for each in later]) - pull

    states = {"y": point(y), "z": point(z), "p": point(p), "error": point(error), "way": point(pulse.way)}
    states["room"] = point(one)
    boxes = Boxes.of(np.arange(COUNT), states, point(30.0 * one), 0.1 * one)
    way = SimpleNamespace(law=law, _errors=lambda *_: point(errors))
    most = np.abs(y) + pulse.g * np.abs(pulse.change) + law.ahead * (np.abs(known) + np.abs(pulse.change))
    assert (np.abs(later - seen) <= most + 1e-12).all()
    parts = pulse.valve.parts(point(pulse.way))
    steep = catching._steepness(law, catching._Way._seen(way, 0, boxes, point(beside), most))
    cells = SimpleNamespace(effect=point(pulse.g))
    given = point(pull), point(beside), most
    found = catching._Way._way(way, boxes, cells, parts, steep, given)
    found = found - catching._Way._beyond(pulse.valve, point(pulse.way), steep)
    ok = (later > 0.05) & (np.abs(y) < 0.4)
    assert np.count_nonzero(ok) > 250
    assert (found.low - exact)[ok].max() < 1e-7
    assert (exact - found.high)[ok].max() < 1e-7
    curved = ok & (later > 1.5) & pulse.roomy & (np.abs(pulse.way) < 0.02)
    assert (found.high - found.low)[curved].max() < 0.002


def test_what_the_law_does_not_know_of_means_moves_what_is_wanted(pulse):
    """By the gain of the observer, and by what the pull makes of that."""
    random, law, one = np.random.default_rng(5), pulse.law, np.ones(COUNT)
    none = Interval(0.0 * one, 0.0 * one)
    states = dict.fromkeys(STATES, none) | {"y": Interval(0.1 * one, 0.1 * one)}
    boxes = Boxes.of(np.arange(COUNT), states, point(30.0 * one), 0.1 * one)
    way = SimpleNamespace(law=law)
    steep = Interval(*(random.uniform(0.01, 0.1, COUNT),) * 2)
    parts = pulse.valve.parts(Interval(pulse.way, pulse.way))
    cells = SimpleNamespace(effect=Interval(pulse.g, pulse.g))
    given = steep, (Interval(0.12 * one, 0.12 * one), none, 0.1 * one)
    before = catching._Way._way(way, boxes, cells, parts, *given)
    for k in range(2):
        moved = list(parts)
        moved[k] = parts[k]._replace(unlike=parts[k].unlike + Interval(-1e-3 * one, 2e-3 * one))
        found = catching._Way._way(way, boxes, cells, moved, *given)
        gain = law.a * (1.0 + law.ahead * steep.low)
        np.testing.assert_allclose(found.low - before.low, -2e-3 * gain, atol=1e-12)
        np.testing.assert_allclose(found.high - before.high, 1e-3 * gain, atol=1e-12)
