"""Wheels of which the valves pause for the first time: simulated ones stay in the boxes of rows; valve and boxes."""

from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest

from tests.attack.plant import filled as filled_plant
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
from wspd_design.certificates.kernel.interval import Interval
from wspd_design.certificates.theorems.from_rolling import catching, filling

RAILS = (LOW, WET)
FULL = 60e3 * 0.02 / 752.0


class Logged(catching._Way):
    """Remembers the boxes of each row."""

    def __init__(self, *given):
        super().__init__(*given)
        self.boxes = {}

    def _cut(self, row, boxes):
        found = super()._cut(row, boxes)
        if found is not None:
            self.boxes[row] = found
        return found


@cache
def followed(rail):
    """All cells through the rows, and what they are at the end."""
    law, cells, fastest = from_rolling.law(rail), wheels(rail, cells_of(rail)), problem(rail).speeds[1]
    filled = filling.filled(law, cells, fastest)
    with np.errstate(all="ignore"):
        way = Logged(law, cells, filled, fastest, UNTIL[rail])
        return way, way.followed()


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
        row = int(np.searchsorted(way.edges, found["slip"][sample, number], side="right") - 1)
        boxes = way.boxes[row]
        inside = (boxes.cell == cell_of[number]) & (boxes.speed <= found["speed"][sample, number])
        for name in STATES:
            value, bound = found[name][sample, number], boxes.states[name]
            inside &= (bound.low - TOLERANCE <= value) & (value <= bound.high + TOLERANCE)
        assert inside.any(), (cell_of[number], number, sample)
        visited += 1
    assert visited > 1000


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
    assert (found["speed"][first, number] >= end.speed[cell_of]).all()
    supply = (found["torque"] + found["room"])[first, number] / FULL
    assert (supply >= end.supply[cell_of]).all()
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
        state = {name: found[name][sample, number] for name in (*STATES, "slip", "speed")}
        row = int(np.searchsorted(way.edges, state["slip"], side="right") - 1)
        least = way._after_whole(row, cell_of[[number]])[0]
        spare.append(state["way"] - least)
        boxes = way._entering(row)
        inside = (boxes.cell == cell_of[number]) & (boxes.speed <= state["speed"])
        for name in STATES:
            bound = boxes.states[name]
            inside &= (bound.low - TOLERANCE <= state[name]) & (state[name] <= bound.high + TOLERANCE)
        assert inside.any(), (number, sample)
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
    shape = count, filling.EDGES.size - 1
    filled = SimpleNamespace(
        lost=np.zeros(count, dtype=bool),
        opens=np.ones(shape, dtype=bool),
        alive=np.ones(shape, dtype=bool),
        speed=np.full(shape, found["speed"].min() / (1.0 - catching.SLOWER) - 0.05),
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
            # Late ones that still fill as well: what is wanted beyond a whole sample goes on to be wanted.
            here = (found["slip"] >= way.edges[row]) & (found["slip"] < way.edges[row + 1])
            here[:16] &= ~so_far[:16]
            sample, number = np.nonzero(here[:-2])
            if not number.size:
                continue
            states = {name: Interval(*(found[name][sample, number],) * 2) for name in STATES}
            way.pending.clear()
            way.lost[:] = False
            way._sample(row, catching.Boxes(number, states, found["speed"][sample, number]))
            change = found["friction"][sample + 1, number] - found["friction"][sample, number]
            bound, limit = seen["heard _friction"][0], seen["heard _limit"]
            seen["friction"] += list(np.maximum(bound.low - change, change - bound.high)[seen["followed"]])
            # Until the end of the next sample.
            level = np.max([found["level"][sample + k, number] for k in range(3)], axis=0)
            seen["limit"] += list((level - limit)[seen["followed"]])
            for n, j in zip(sample, number, strict=True):
                seen["lost"].append(bool(way.lost[j]))
                following = int(np.searchsorted(way.edges, found["slip"][n + 1, j], side="right") - 1)
                boxes = [each.kept(each.cell == j) for each in way.pending[following]]
                inside = False
                for each in boxes:
                    good = each.speed <= found["speed"][n + 1, j]
                    for name in STATES:
                        value = found[name][n + 1, j]
                        good &= (each.states[name].low <= value + TOLERANCE) & (
                            value <= each.states[name].high + TOLERANCE
                        )
                    inside |= good.any()
                seen["inside"].append(inside)
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
        here = rises[1:] & (slip[:-2] >= way.edges[row]) & (slip[:-2] < way.edges[row + 1])
        sample, number = np.nonzero(here & (slip[2:] < way.edges[-1]))
        end = np.searchsorted(way.edges, slip[sample + 2, number], side="right") - 1
        limit = way._limit(row, catching.Boxes(number, {}, found["speed"][sample, number]), end)
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
        states, exact = {}, {name: found[name][sample, number] for name in STATES}
        for name, value in exact.items():
            below, above = random.exponential(0.01, (2, value.size)) * random.integers(0, 2, (2, value.size))
            states[name] = Interval(value - below - 1e-9, value + above + 1e-9)
        before = sum((each.high - each.low).sum() for each in states.values())
        boxes = way._cut(row, catching.Boxes(number, states, found["speed"][sample, number]))
        assert boxes.cell.size == number.size
        for name, value in exact.items():
            assert (boxes.states[name].low <= value + TOLERANCE).all(), name
            assert (boxes.states[name].high >= value - TOLERANCE).all(), name
        count += number.size
        cut += before - sum((each.high - each.low).sum() for each in boxes.states.values())
    assert count > 500
    assert cut > 0.1


CROOKED = {
    "y falls below 0": {"y": (-0.05, 0.1)},
    "y is too large": {"y": (0.05, 0.45)},
    "nothing is observed": {"way": (-0.9, 0.0)},
    "there is no room": {"room": (0.0, 0.2)},
    "what is wanted is not known": {"way": (-np.inf, 0.0)},
}


@pytest.mark.parametrize("what", [None, "slow", *CROOKED])
def test_cells_with_states_that_are_not_followed_are_lost(what):
    way, (_, found, so_far) = way_of(LOW), run(LOW)
    sample, number = next(
        (n, j)
        for n, j in zip(*np.nonzero(~so_far), strict=True)
        if 0.02 < found["slip"][n, j] < 0.05 and abs(found["way"][n, j]) < 0.005
    )
    row = int(np.searchsorted(way.edges, found["slip"][sample, number], side="right") - 1)
    ends = {name: (found[name][sample, number],) * 2 for name in STATES} | CROOKED.get(what, {})
    states = {name: Interval(*(np.array([each]) for each in span)) for name, span in ends.items()}
    speed = way.slow[[number]] - 0.01 if what == "slow" else found["speed"][sample, [number]]
    with np.errstate(all="ignore"):
        way._sample(row, catching.Boxes(np.array([number]), states, speed))
    assert way.lost[number] == (what is not None)
    assert bool(way.pending) == (what is None)
    assert np.count_nonzero(way.lost) <= 1


def test_a_cell_with_a_state_that_is_not_a_number_is_lost():
    way, (_, found, so_far) = way_of(LOW), run(LOW)
    sample, number = np.argwhere(~so_far & (found["slip"] > 0.02))[0]
    row = int(np.searchsorted(way.edges, found["slip"][sample, number], side="right") - 1)
    states = {name: Interval(*(np.array([found[name][sample, number]]),) * 2) for name in STATES}
    states["z"] = Interval(states["z"].low, np.array([np.nan]))
    with np.errstate(all="ignore"):
        way._cut(row, catching.Boxes(np.array([number]), states, found["speed"][sample, [number]]))
    assert way.lost[number]


# --- the valve --------------------------------------------------------------------------------------------------------
COUNT = 400


def pulses(seed, sign):
    """Random valves with a pulse each, and the torque many times in its sample: exact forms of the plant."""
    random = np.random.default_rng(seed)
    law = from_rolling.law(WET)
    fill, vent = random.uniform(0.3, 0.9, (2, COUNT))
    rate, since = random.uniform(0.375, 1.1, COUNT), random.uniform(0.05, 2.0, COUNT)
    supply = FULL * -np.expm1(-rate * since)
    rise = rate * 0.02 * (FULL - supply)
    # From rest the room is never less than what the supply rises by in a sample.
    torque = np.minimum(supply * random.uniform(0.1, 0.98, COUNT), supply - rise)
    room = supply - torque
    g = random.uniform(0.75, 1.35, COUNT)
    share = np.where(random.random(COUNT) < 0.3, 1.0, random.random(COUNT))
    way = sign * share * (law.fills * room if sign > 0 else law.vents * torque)
    way = np.where(random.random(COUNT) < 0.2, 1.3 * way, way)
    size = np.abs(way) / (room if sign > 0 else torque)
    length = np.minimum(-np.log1p(-size) / law.over_fill, 1.0)
    times = np.linspace(0.0, 1.0, 2001)[:, None]
    pulse = np.minimum(times, length)
    numbers = SimpleNamespace(max_torque=FULL, fill_time=fill, supply_rate=rate)
    if sign > 0:
        course = filled_plant(numbers, torque, 0.02 * pulse, since=since)
    else:
        course = torque * np.exp(-0.02 * pulse / vent)
    own = law.nominal * pulse * law.over_fill
    assumed = room * -np.expm1(-own) if sign > 0 else -torque * -np.expm1(-own)
    later = FULL * -np.expm1(-rate * (since + 0.02))

    def mean(values, weights=1.0):
        middle = 0.5 * (values[1:] + values[:-1])
        weights = np.broadcast_to(weights, middle.shape)
        return (middle * weights).sum(axis=0) / len(middle)

    def one(values):
        return Interval(values, values)

    cells = SimpleNamespace(fills=one(0.36 / fill), vents=one(0.36 / vent))
    spare = Interval(rise * (1 - 0.5 * rate * 0.02), rise)
    made = catching._Valve(law, cells, one(room), spare, one(torque))
    middles = (times[1:] + times[:-1]) / 2
    return SimpleNamespace(
        valve=made,
        law=law,
        g=g,
        way=way,
        change=course[-1] - torque,
        mean=mean(course - torque),
        own=mean(assumed),
        length=length,
        first=2 * mean(course - torque, middles),
        second=2 * mean(course - torque, 1 - middles),
        room=later - course[-1],
        roomy=(rise < 0.1 * room) | np.full(COUNT, sign < 0),
        whole=np.abs(way) >= (law.fills * room if sign > 0 else law.vents * torque) * (1 - 1e-12),
    )


@pytest.fixture(scope="module", params=[1.0, -1.0], ids=["fills", "vents"])
def pulse(request):
    return pulses(3, request.param)


def holds(bound, value, spare=1e-9):
    return (bound.low - spare <= value).all() and (value <= bound.high + spare).all()


@pytest.mark.parametrize("later", [False, True])
def test_changes_and_means_of_pulses_are_within_bounds(pulse, later):
    parts = pulse.valve.parts(Interval(pulse.way, pulse.way), later=later)
    up, down = parts
    assert (up.way.high <= np.maximum(pulse.way, 0.0)).all()
    assert (down.way.low >= np.minimum(pulse.way, 0.0)).all()
    assert holds(pulse.valve.change(parts), pulse.change)
    assert (pulse.mean / pulse.change >= pulse.valve.least_share(parts) - 1e-6).all()
    if not later:
        part = up if pulse.way[0] > 0 else down
        assert (part.length.high >= pulse.length - 1e-9).all()
        assert (part.length.low <= pulse.length + 1e-9).all()
        assert (part.share.high >= pulse.mean / pulse.change - 1e-6).all()
        assert (part.share.low <= pulse.mean / pulse.change + 1e-6).all()
        # They are not far away: nothing is doubled or forgotten.
        some, change = pulse.roomy, pulse.valve.change(parts)
        assert (change.high - change.low < 0.12 * np.abs(pulse.change))[some].all()
        assert (part.share.high - part.share.low < 0.05)[some].all()
        assert np.count_nonzero(some) > 50


def test_what_observer_learns_of_pulses_is_within_bounds(pulse):
    parts = pulse.valve.parts(Interval(pulse.way, pulse.way))
    z, unlike = pulse.valve.learned(Interval(pulse.g, pulse.g), parts)
    exact = pulse.g * pulse.mean - pulse.own
    assert holds(unlike, exact, 1e-7)
    assert holds(z, (pulse.g - 1) * pulse.change - (1 - pulse.law.theta) * exact, 1e-7)
    assert (unlike.high - unlike.low < 0.25 * np.abs(pulse.change))[pulse.roomy].all()


def test_weights_that_rise_and_fall_count_no_more_than_is_said(pulse):
    parts = pulse.valve.parts(Interval(pulse.way, pulse.way))
    first = pulse.valve.in_first(parts)
    assert (first >= pulse.first - 1e-9).all()
    second = pulse.valve.in_second(Interval(pulse.change, pulse.change))
    assert (second >= pulse.second - 1e-9).all()
    upwards = np.maximum(pulse.change, 0.0)
    some = pulse.roomy
    assert (first - np.maximum(pulse.first, 0.0) <= 0.12 * upwards + 1e-300)[some].all()
    assert (second <= np.maximum(pulse.second, 0.0) + 0.3 * upwards + 1e-300)[some].all()


def test_room_of_the_next_sample_is_within_bounds(pulse):
    parts, way = pulse.valve.parts(Interval(pulse.way, pulse.way)), Interval(pulse.way, pulse.way)
    found = pulse.valve.next_room(parts, way)
    assert holds(found, pulse.room)
    assert (found.high - found.low < 0.02).all()


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


def test_corners_hold_what_lies_between():
    random = np.random.default_rng(9)

    def affine(a, b, c):
        return a * b - 2.0 * a * b * c + b - 3.0 * c

    low = random.normal(size=(3, 50))
    high = low + random.random((3, 50))
    found = catching._corners(affine, *(Interval(*ends) for ends in zip(low, high, strict=True)))
    ends = []
    for _ in range(200):
        share = random.random((3, 50))
        share = np.where(random.random((3, 1)) < 0.8, np.round(share), share)
        value = affine(*(low + share * (high - low)))
        assert holds(found, value, 0.0)
        ends.append(value)
    np.testing.assert_allclose(found.low, np.min(ends, axis=0), atol=1e-9)
    np.testing.assert_allclose(found.high, np.max(ends, axis=0), atol=1e-9)


def boxes(seed, count=40):
    random = np.random.default_rng(seed)
    states = {}
    for name in STATES:
        low = random.uniform(0.0, 0.1, count) if name == "y" else random.uniform(-0.05, 0.05, count)
        states[name] = Interval(low, low + random.exponential(0.02, count))
    states["way"].low[:3], states["way"].high[2:5] = -0.5, 0.5
    for name, k, low, high in (
        ("way", 6, 0.0, 0.03),
        ("y", 7, 0.01, 0.0301),
        ("y", 8, 0.055, 0.2),
        ("y", 9, 0.02, 0.02),
    ):
        states[name].low[k], states[name].high[k] = low, high
    return catching.Boxes(random.integers(0, 3, count), states, random.uniform(25.0, 33.0, count))


def draw(some, random):
    """A state in each of some boxes."""
    found = {}
    for name in STATES:
        bound, share = some.states[name], random.random(some.cell.size)
        share = np.where(random.random(share.size) < 0.3, np.round(share), share)
        found[name] = np.minimum(bound.low + share * (bound.high - bound.low), bound.high)
    return found


def held_by(some, cell, state, speed):
    inside = (some.cell == cell) & (some.speed <= speed)
    for name in STATES:
        inside &= (some.states[name].low <= state[name]) & (state[name] <= some.states[name].high)
    return inside.any()


@pytest.mark.parametrize("numbered", [False, True])
def test_nothing_of_a_box_is_lost_as_it_is_divided(numbered):
    whole, random = boxes(1), np.random.default_rng(2)
    sliced = catching._sliced(whole, numbered)
    assert sliced.cell.size > 2 * whole.cell.size
    for _ in range(30):
        drawn = draw(whole, random)
        for k in range(whole.cell.size):
            state = {name: each[k] for name, each in drawn.items()}
            assert held_by(sliced, whole.cell[k], state, whole.speed[k])
    width = sliced.states["y"].high - sliced.states["y"].low
    assert width.max() <= catching.SLICE * (1 + 1e-9)
    if numbered:
        origin = sliced.states["origin"].low.astype(int)
        np.testing.assert_array_equal(sliced.cell, whole.cell[origin])
        np.testing.assert_array_equal(np.unique(origin), np.arange(whole.cell.size))


def test_nothing_of_boxes_is_lost_as_they_are_put_together():
    random = np.random.default_rng(4)
    chunks = [catching._sliced(boxes(seed)) for seed in (5, 6, 7)]
    joined = catching._joined(chunks)
    assert joined.cell.size < sum(each.cell.size for each in chunks)
    for chunk in chunks:
        for _ in range(10):
            drawn = draw(chunk, random)
            for k in range(chunk.cell.size):
                state = {name: each[k] for name, each in drawn.items()}
                assert held_by(joined, chunk.cell[k], state, chunk.speed[k])
    assert catching._joined([]).cell.size == 0


def test_boxes_of_different_cells_and_slices_stay_apart():
    """Put together are only those of one cell, and of one slice of y and of the way."""
    one = np.array([0.0])

    def box(cell, y, way):
        states = {name: Interval(one, one) for name in STATES}
        states["y"], states["way"] = Interval(one + y, one + y), Interval(one + way, one + way)
        return catching.Boxes(np.array([cell]), states, one + 30.0 + y)

    parts = [
        box(0, 0.005, 0.001),
        box(0, 0.006, 0.002),
        box(0, 0.015, 0.001),
        box(0, 0.005, 0.007),
        box(1, 0.005, 0.001),
    ]
    joined = catching._joined(parts)
    assert joined.cell.tolist() == [0, 0, 0, 1]
    assert joined.speed.min() == 30.005


def test_edges_of_rows_go_on_beyond_the_last_one():
    edges, count = catching.rows(0.001, 0.06)
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
    exact = way - change + known + pulls - pull
    steep = np.array([law.steepness(min(ends)) for ends in zip(pull, pulls, strict=True)])

    def everywhere(value):
        return np.repeat(value[:, None], filling.EDGES.size - 1, axis=1)

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
        slow=25.0 * one,
        edges=np.array([0.004, 0.004]),  # twice what a wheel with half of the motions slips by in a sample
        lost=np.zeros(count, dtype=bool),
        _steepest=lambda _: steep,
    )
    ok = later > 0.5
    found = catching._Way._after_whole(made, 0, np.arange(count))
    # Wheels that were not in the parts that are looked at, a sample before.
    np.testing.assert_array_equal(made.lost, share > 0.5)
    assert np.count_nonzero(ok) > 250
    assert (found - exact)[ok].max() < 1e-12
    assert (exact - found)[ok].min() < 6e-4


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

    def point(value):
        return Interval(value, value)

    rows = 3 * catching.AHEAD
    wide = np.ones((count, rows))
    none = Interval(0.0 * one, 0.0 * one)
    way = SimpleNamespace(
        there=SimpleNamespace(slope=point(slope[:, None] * wide), fading=fades[:, None] * wide),
        slow=30.0 * one,
        fastest=33.0,
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
    valve = catching._Valve(law, cells, point(room[0]), none, point(torque))
    made = valve.parts(point(ways[0]))
    states = dict.fromkeys(STATES, none) | {"y": point(y)}
    boxes = catching.Boxes(np.arange(count), states, 32.0 * one)
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


def test_limit_is_that_of_all_rows_up_to_the_end_and_of_what_came_before():
    one = np.ones(2)
    gains = np.array([[9.0, 0.1, 0.5, 0.2, 0.3, np.inf], [9.0, 0.1, 0.2, 0.3, 0.4, 0.5]])
    cells = SimpleNamespace(effect=Interval(one, 2.0 * one), share=Interval(1.0 * one, 2.0 * one))
    cells.at = lambda cell: SimpleNamespace(
        effect=Interval(one[cell], 2.0 * one[cell]), share=Interval(one[cell], 2.0 * one[cell])
    )
    made = SimpleNamespace(gains=gains, cells=cells, rate=np.array([0.1, 0.2]), level=np.array([0.0, 0.35]))
    box = catching.Boxes(np.array([0, 0, 1, 1]), {}, np.full(4, 30.0))
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
    slip = made.way.edges[1] + 0.53 / made.way.slow * 2.0 * made.moves.mean(axis=0)
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

    def point(value):
        return Interval(value, value)

    states = {"y": point(y), "z": point(z), "p": point(p), "error": point(error), "way": point(pulse.way)}
    boxes = catching.Boxes(np.arange(COUNT), states, 30.0 * one)
    way = SimpleNamespace(law=law, errors=point(errors[:, None]))
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
    boxes, way = catching.Boxes(np.arange(COUNT), states, 30.0 * one), SimpleNamespace(law=law)
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
