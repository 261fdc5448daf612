"""Wheels of which the valves fill from rolling: simulated ones stay in what is said of them; closed forms and sums."""

from dataclasses import replace
from itertools import pairwise
from types import SimpleNamespace

import numpy as np
import pytest

from tests.attack.plant import creep_force, resistance, static_load
from tests.certificates.band import from_rolling
from tests.certificates.band.from_rolling import LOW, TOLERANCE, WET, cells_of, problem, wheels
from tests.certificates.band.sampled_runs import plant_of
from tests.certificates.band.test_passing import (
    EDGES,
    FULL,
    PARTS,
    RAILS,
    bounds,
    dense,
    filled_wheels,
    means,
    passing_of,
    run,
    visited,
)
from wspd_design.certificates.kernel.interval import Interval
from wspd_design.certificates.theorems.from_rolling import cells as cells_module
from wspd_design.certificates.theorems.from_rolling import filling, passing, sample
from wspd_design.certificates.theorems.from_rolling.cells import gathered, sliding


# --- simulated wheels -------------------------------------------------------------------------------------------------
@pytest.mark.parametrize("rail", RAILS)
def test_no_cell_is_lost(rail):
    assert not bounds(rail).lost.any()


BETWEEN = {"z": "z", "p": "p", "error": "error", "y": "fall", "room": "room"}


@pytest.mark.parametrize("rail", RAILS)
@pytest.mark.parametrize("name", BETWEEN)
def test_states_of_simulated_wheels_are_within_bounds(rail, name):
    seen, bound = visited(rail), getattr(bounds(rail), BETWEEN[name])[visited(rail).cell, visited(rail).part]
    assert (seen.states[name] >= bound.low - TOLERANCE).all()
    assert (seen.states[name] <= bound.high + TOLERANCE).all()


@pytest.mark.parametrize("rail", RAILS)
def test_simulated_wheels_want_no_less_and_are_no_slower_or_later(rail):
    seen, found = visited(rail), bounds(rail)
    at = seen.cell, seen.part
    assert (seen.states["way"] >= found.way[at] - TOLERANCE).all()
    assert (seen.states["speed"] >= found.speed.low[at]).all()
    assert (seen.states["speed"] <= found.speed.high[at]).all()
    supply = (seen.states["torque"] + seen.states["room"]) / FULL
    assert (supply >= found.supply[at] - TOLERANCE).all()
    assert (seen.states["level"] <= found.steep[at] + TOLERANCE).all()
    assert (seen.sample <= found.time[at]).all()


@pytest.mark.parametrize("rail", RAILS)
def test_valves_fill_and_pause_where_they_may(rail):
    seen, found = visited(rail), bounds(rail)
    at = seen.cell, seen.part
    assert found.alive[at][seen.fills].all()
    assert found.opens[at][~seen.fills].all()
    assert np.unique(seen.cell[~seen.fills]).size == len(found.lost)  # members of each cell pause


def test_wheels_whose_valve_is_slower_than_the_supply_are_within_bounds():
    """The cell at the end of the box: 1/0.9 s over 1.125/s."""
    places = {"supply rate": 1.0, "fill time": 1.0, "max torque": 1.0, "wheelset inertia": 0.0}
    numbers = from_rolling.cell(LOW, places, 0.6)
    points = from_rolling.members(LOW, numbers, 12, 5)
    found = from_rolling.courses(LOW, points, 20, parts=2)
    bound = filling.filled(from_rolling.law(LOW), wheels(LOW, [numbers]), problem(LOW).speeds[1])
    part = np.searchsorted(EDGES, found["slip"][3:], side="right") - 1
    if bound.lost[0]:  # nothing is said
        return
    for name, field in BETWEEN.items():
        assert (found[name][3:] <= getattr(bound, field).high[0][part] + TOLERANCE).all(), name
        assert (found[name][3:] >= getattr(bound, field).low[0][part] - TOLERANCE).all(), name


# --- what friction comes in a sample ----------------------------------------------------------------------------------
@pytest.fixture(scope="module", params=RAILS)
def coming(request):
    """What comes in a sample in which a valve vents no more than something, and the rail."""
    bound = passing_of(request.param)
    with np.errstate(all="ignore"):
        windows, steep = passing.Windows(bound), passing.steepest(bound.wheels, bound)
    fading = np.maximum.accumulate(bound.there.fading, axis=1)

    def within(vents):
        with np.errstate(all="ignore"):
            return filling._coming(bound, windows, steep, fading, np.full(steep.shape, vents))

    return within, request.param


def test_what_the_mean_friction_of_a_sample_has_more_is_within_bounds(coming):
    within, course = coming[0], dense(coming[1])
    ahead = means(course.f) - course.f[:-PARTS]
    good = course.here[PARTS:].copy()
    good[: 2 * PARTS] = False
    at = np.broadcast_to(course.cell, good.shape)[good], course.part[:-PARTS][good]
    ahead = ahead[good]
    spare = 1e-4 * np.abs(ahead) + 1e-8
    bound = within(0.0)
    assert (ahead <= bound.high[at] + spare).all()
    assert (ahead >= bound.low[at] - spare).all()
    assert (within(0.0).low[at] > 0.0).mean() > 0.1


@pytest.mark.parametrize("share", [0.2, 0.6, 0.9])
def test_what_comes_while_the_valve_vents_is_within_bounds(coming, share):
    """A torque that is less at once, by a share of what would stop the wheel."""
    within, rail = coming
    course, of, count = dense(rail), filled_wheels(rail), 0
    for begin in range(4, 40, 3):
        now = begin * PARTS
        good = course.here[now + PARTS] & (course.motion[now] > 0.0)
        vents = share * np.maximum(course.motion[now], 0.0) / of.effect
        state = np.array([course.slip[now], course.speed[now]])
        f = run(of, state, float(begin), 1, vents)["f"]
        ahead = means(f)[0] - f[0]
        for vent in np.unique(np.ceil(vents[good] * 100.0)) / 100.0:
            bound, here = within(vent), good & (vents <= vent) & (vents > vent - 0.01)
            at = course.cell[here], course.part[now][here]
            assert (ahead[here] <= bound.high[at] + 1e-8).all()
            assert (ahead[here] >= bound.low[at] - 1e-8).all()
        count += np.count_nonzero(good)
    assert count > 500


def test_what_comes_is_that_of_the_parts_ahead():
    """By hand: two parts where the friction rises, before one where it falls."""

    def row(*values):
        return np.array([values])

    wheels_of = SimpleNamespace(share=Interval(0.0, 0.1), effect=Interval(1.0, 1.1))
    bound = SimpleNamespace(
        wheels=wheels_of,
        motion=Interval(row(0.9, 0.9, 0.9), row(1.2, 1.2, 1.2)),
        there=SimpleNamespace(slope=Interval(row(0.5, 0.4, -0.2), row(0.6, 0.5, 0.1))),
        rate=row(0.05, 0.05, 0.05),
    )
    windows = SimpleNamespace(own=row(0, 1, 2), next=row(1, 2, 3))
    steep, vents = row(0.1, 0.3, 0.2), row(0.1, 0.1, 0.1)
    found = filling._coming(bound, windows, steep, row(0.01, 0.01, 0.01), vents)
    falls = -0.5 * 0.2 * 1.1 * (1.2 + 1.1 * 0.05)
    np.testing.assert_allclose(found.high, 0.5 * row(0.31, 0.31, 0.21))
    np.testing.assert_allclose(found.low, row(0.5 * 0.4 * (0.9 - 1.12 * 0.31 - 1.1 * 0.1), falls, falls))


@pytest.mark.parametrize("rail", RAILS)
def test_no_wheel_is_vented_so_much_that_it_turns_back(rail, monkeypatch):
    """Where the friction rises, no less than 0 comes: it need not be so for a wheel that does."""
    coming, seen = filling._coming, []
    monkeypatch.setattr(filling, "_coming", lambda *given: seen.append(given) or coming(*given))
    found = filling.filled(from_rolling.law(rail), wheels(rail, cells_of(rail)), problem(rail).speeds[1])
    bound, windows, *_, vents = seen[-1]
    rises = passing.least_over(bound.there.slope.low, windows.own, np.minimum(windows.next, EDGES.size - 2))
    vented = found.opens & (vents > 0.0) & (rises > 0.0)
    assert (bound.wheels.effect.high * vents < bound.motion.low)[vented].all()
    assert vented.any()


# --- what is put into the observer ------------------------------------------------------------------------------------
@pytest.mark.parametrize("rail", RAILS)
def test_no_less_was_shown_to_the_observer_than_may_have_been_cut(rail):
    """At each moment so far: f - (g - 1) T, which is T - (1 - s) D/(1 - s_r) - q."""
    found, of, bound = dense(rail), filled_wheels(rail), passing_of(rail)
    shown = found.f - (of.effect - 1.0) * found.torque
    here = found.here.copy()
    here[:PARTS] = False
    least = np.minimum.accumulate(np.where(here, shown, np.inf), axis=0)
    at = np.broadcast_to(found.cell, here.shape)[here], found.part[here]
    cut = filling._cut(bound, np.zeros(bound.rate.shape))
    assert (-least[here] <= cut[at] + 1e-9).all()
    assert (least[here] < 0.0).any()
    assert (np.diff(cut, axis=1) >= 0.0).all()
    more = filling._cut(bound, np.full(bound.rate.shape, 0.02)) - cut
    assert (more >= 0.0).all()
    assert (more <= 0.02 + 1e-12).all()


def test_nothing_is_cut_where_the_torque_is_large():
    bound = passing_of(WET)
    unlike = np.full(bound.rate.shape, np.inf)  # so that the torque alone counts
    large = Interval(bound.torque.high + 100.0, bound.torque.high + 100.0)
    motion = Interval(0.0 * bound.motion.low, np.full(bound.rate.shape, 2.0))
    with np.errstate(all="ignore"):
        assert (filling._cut(replace(bound, torque=large, motion=motion), unlike) == 0.0).all()
        none = Interval(0.0 * large.low, 0.0 * large.low)
        cut = filling._cut(replace(bound, torque=none, motion=motion), unlike)
    # Without a torque it is the motion that is shown, and the train that brakes.
    assert (cut >= 2.0 / (1.0 + bound.wheels.share.low)).all()
    train = np.maximum.accumulate(bound.there.falls.high + bound.there.drag.high, axis=1)
    assert (cut <= 2.0 + train).all()


# --- from part to part ------------------------------------------------------------------------------------------------
def windows_of(random, cells=4, parts=24):
    """Windows in which wheels may stay in some parts, and are in another one a sample later in others."""
    own = np.tile(np.arange(parts), (cells, 1))
    near = np.where(random.random(own.shape) < 0.5, own, np.maximum(own - 1, 0))
    far = np.maximum(np.minimum(near, own - 1) - random.integers(0, 5, own.shape), 0)
    return SimpleNamespace(own=own, far=far, near=near)


def test_values_before_are_those_of_the_parts_where_a_wheel_may_have_been():
    random = np.random.default_rng(5)
    windows = windows_of(random)
    found, rest = random.normal(size=(3, 2, *windows.own.shape)), random.normal(size=(3, 2, 4))
    for k in range(windows.own.shape[1]):
        before = filling._before(found, windows, k, rest)
        flat = filling._before(found[1, 0], windows, k, rest[1, 0])
        for i, j, cell in np.ndindex(3, 2, 4):
            first, last = windows.far[cell, k], min(windows.near[cell, k], k - 1)
            values = [*found[i, j, cell, first : last + 1], *([rest[i, j, cell]] if first == 0 else [])]
            assert before[i, j, cell] == max(values)
        np.testing.assert_array_equal(flat, before[1, 0])


def test_what_is_kept_holds_values_of_wheels_that_stay():
    random = np.random.default_rng(7)
    before, more = random.normal(size=(3, 200)), random.normal(size=(3, 200))
    same = random.random(200) < 0.5
    kept = filling._kept(0.8, before, more, same)
    value, largest = before, np.full(before.shape, -np.inf)
    for n in range(200):
        value = 0.8 * value + more
        largest = np.where(same | (n == 0), np.maximum(largest, value), largest)
    np.testing.assert_allclose(kept, largest, atol=1e-12)


def walks(random, windows, cell, count=60):
    """Parts in which a wheel is at its samples, from rest in the first one on."""
    for _ in range(count):
        found = [0]
        while True:
            here = found[-1]
            ahead = np.flatnonzero((windows.far[cell] <= here) & (here <= windows.near[cell]))
            ahead = ahead[ahead >= here]
            if not ahead.size or len(found) > 60:
                break
            found.append(int(random.choice(ahead)))
        yield found


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_the_observer_makes_no_more_of_values_than_is_said(sign):
    law, random = from_rolling.law(LOW), np.random.default_rng(9)
    windows = windows_of(random)
    values = sign * random.uniform(0.2, 1.0, windows.own.shape)
    bound, closest = filling._observed(law, windows, values), np.inf
    for cell in range(4):
        for parts in walks(random, windows, cell):
            once = twice = 0.0
            for begin, end in pairwise(parts):
                once = law.theta * once + (1.0 - law.theta) * values[cell, begin : end + 1].max()
                twice = law.theta * twice + (1.0 - law.theta) * once
                assert twice <= bound[cell, end] + 1e-12
                closest = min(closest, bound[cell, end] - twice)
    assert closest < 0.02
    # A value that stays is known in the end; what begins is not known at once.
    stays = SimpleNamespace(own=np.array([[0, 1]]), far=np.array([[0, 0]]), near=np.array([[0, 0]]))
    known = filling._observed(law, stays, np.array([[0.0, 3.0]]))
    np.testing.assert_allclose(known, [[0.0, 3.0 * (1.0 - law.theta) ** 2]])
    stays.near = np.array([[0, 1]])
    np.testing.assert_allclose(filling._observed(law, stays, np.array([[0.0, 3.0]])), [[0.0, 3.0]])


# --- cells that are lost ----------------------------------------------------------------------------------------------
@pytest.fixture(scope="module")
def few():
    """Some cells, how their wheels pass the slip, and the speeds that were assumed for that."""
    law, cells, fastest = from_rolling.law(LOW), wheels(LOW, cells_of(LOW)[4:7]), problem(LOW).speeds[1]
    shape = 3, EDGES.size - 1
    speed = Interval(np.full(shape, 0.94 * fastest), np.full(shape, fastest))
    with np.errstate(all="ignore"):
        return law, cells, passing.passed_through(law, cells, fastest, speed), speed


def lost(few, speed=None, **other):
    law, cells, passed, assumed = few
    passed = replace(passed, **other)
    with np.errstate(all="ignore"):
        return filling._filled(law, cells, passed, assumed if speed is None else speed).lost


def test_cells_of_which_nothing_is_known_are_lost(few):
    passed, speed = few[2:]
    assert not lost(few).any()
    assert lost(few, speed=Interval(passed.later.low + 1e-6, speed.high)).all()
    assert lost(few, speed=Interval(speed.low, passed.later.high - 1e-6)).all()
    assert not lost(few, speed=passed.later).any()
    assert lost(few, least_rate=0.0 * passed.least_rate).all()
    assert lost(few, rate=np.where(EDGES[1:] > 2e-3, np.inf, passed.rate)).all()
    assert lost(few, wheels=replace(passed.wheels, fills=passed.wheels.fills * 60.0)).all()


def test_cells_that_fill_to_the_end_are_lost(few, monkeypatch):
    """An error as large as that of a wheel that rolls, at all slips."""
    pulls = sample.pulls
    monkeypatch.setattr(filling, "pulls", lambda law, seen: pulls(law, seen) + 5.0)
    assert lost(few).all()


def test_pulls_are_those_of_the_law():
    law = from_rolling.law(WET)
    seen = np.linspace(-0.5, 6.0, 50)
    expected = [law.pull(each) for each in seen]
    np.testing.assert_allclose(sample.pulls(law, seen), expected, atol=1e-14)


# --- the friction over slip and speed --------------------------------------------------------------------------------
@pytest.mark.parametrize("rail", RAILS)
def test_bounds_of_the_friction_hold_numeric_derivatives(rail):
    """For random members of the box, at random slips and speeds; each a cell of its own."""
    random = np.random.default_rng(12)
    points = from_rolling.members(rail, {}, 60, 21)
    plant, h, slip_r, n = plant_of(problem(rail), points), 0.02, 0.14, 60
    numbers = [{name: (points[name][k],) * 2 for name in from_rolling.EIGHT} for k in range(n)]
    cells = wheels(rail, numbers)
    slip = 10.0 ** random.uniform(-5, -0.7, n)
    speed = random.uniform(25.0, 33.0, n)
    own, radius = plant.wheelset_inertia, plant.wheel_radius
    q = 2 * plant.wheel_damping * h / own
    kappa = (1 - slip_r) * plant.wheelsets * own / (radius**2 * plant.mass)

    def f(s, v):
        force = creep_force(plant, s, v, static_load(plant))
        return 2 * radius * force * h / own - q * (1 - s) * v / radius

    def drag(s, v):
        held = (1 - slip_r) * h * resistance(plant, v) / (radius * plant.mass)
        return kappa * q * (1 - s) * v / radius + held

    def slope(s, v):
        return radius / v * np.imag(f(s + 1e-30j, v)) / 1e-30

    found = sliding(cells, Interval(slip, slip), Interval(speed, speed))
    falls = kappa * f(slip, speed) + drag(slip, speed)
    loss = radius * falls / (1 - slip_r)
    step = 1e-5
    bends = (slope(slip * (1 + step), speed) - slope(slip * (1 - step), speed)) / (2 * step * slip)
    rises = -(slope(slip, speed * (1 + step)) - slope(slip, speed * (1 - step))) / (2 * step)
    fading = -np.imag(f(slip, speed + 1e-30j)) / 1e-30 * loss
    eases = np.imag(drag(slip, speed + 1e-30j)) / 1e-30 * loss
    for bound, exact in (
        (found.friction, f(slip, speed)),
        (found.slope, slope(slip, speed)),
        (found.drag, drag(slip, speed)),
        (found.falls, falls),
        (found.loss, loss),
        (found.slides, falls * (slip_r - slip) / (1 - slip_r)),
    ):
        np.testing.assert_allclose(bound.low, exact, rtol=1e-8, atol=1e-11)
        np.testing.assert_allclose(bound.high, exact, rtol=1e-8, atol=1e-11)
        assert (bound.low <= exact + 1e-13 * (1 + np.abs(exact))).all()
        assert (bound.high >= exact - 1e-13 * (1 + np.abs(exact))).all()
    np.testing.assert_allclose(found.bends, np.maximum(bends, 0.0), rtol=2e-3, atol=2e-4)
    np.testing.assert_allclose(found.rises, np.maximum(rises, 0.0), rtol=1e-4, atol=1e-6)
    np.testing.assert_allclose(found.fading, np.maximum(fading, 0.0), rtol=1e-6, atol=1e-12)
    np.testing.assert_allclose(found.eases, eases, rtol=1e-6, atol=1e-14)
    assert np.count_nonzero(bends > 0.0) > 2
    assert np.count_nonzero(rises > 0.0) > 20


def test_the_shape_of_the_force_over_ranges_is_that_of_its_points():
    """Ranges with a place in them at which one of the parts turns, and others; close to what the points have."""
    random, (adhesion, slip) = np.random.default_rng(3), (0.3, 0.1)
    roots = np.array([1.0, np.sqrt(3.0), np.sqrt(2.0) - 1.0, np.sqrt(2.0) + 1.0])
    turns = np.concatenate([roots / adhesion, [1.0 / np.sqrt(3.0) / slip]])
    low = np.concatenate([turns - 0.4, 10.0 ** random.uniform(-3, 1.5, 60)])
    high = np.concatenate([turns + 0.4, low[5:] * random.uniform(1.0, 1.5, 60)])
    found = cells_module._shape(Interval(low, high), adhesion, slip)
    z = low + np.linspace(0.0, 1.0, 1001)[:, None] * (high - low)
    a, b, factor = adhesion * z, slip * z, 2.0 / np.pi
    level = factor * (a / (1 + a**2) + np.arctan(b))
    steep = factor * (adhesion * (1 - a**2) / (1 + a**2) ** 2 + slip / (1 + b**2))
    curved = adhesion**2 * 2 * a * (3 - a**2) / (1 + a**2) ** 3 + slip**2 * 2 * b / (1 + b**2) ** 2
    parts = adhesion * (1 - a**2) / (1 + a**2) ** 2, adhesion**2 * 2 * a * (3 - a**2) / (1 + a**2) ** 3
    others = slip / (1 + b**2), slip**2 * 2 * b / (1 + b**2) ** 2
    exact = level, steep, level - z * steep, factor * curved
    for bound, value in zip(found, exact, strict=True):
        assert (bound.low <= value.min(axis=0) + 1e-13).all()
        assert (bound.high >= value.max(axis=0) - 1e-13).all()
    # Each of two parts by its own ends.
    apart = [2 * a**3 / (1 + a**2) ** 2, np.arctan(b) - b / (1 + b**2)]
    for bound, one, other in (
        (found[0], a / (1 + a**2), np.arctan(b)),
        (found[1], parts[0], others[0]),
        (found[2], *apart),
        (found[3], parts[1], others[1]),
    ):
        low_, high_ = (getattr(one, end)(axis=0) + getattr(other, end)(axis=0) for end in ("min", "max"))
        np.testing.assert_allclose(bound.low, factor * low_, rtol=1e-4, atol=1e-7)
        np.testing.assert_allclose(bound.high, factor * high_, rtol=1e-4, atol=1e-7)


@pytest.mark.parametrize("rail", RAILS)
def test_bounds_over_ranges_hold_those_of_points(rail):
    """Cells, and ranges of slip and speed: what is found at points of them lies within."""
    random = np.random.default_rng(4)
    numbers = cells_of(rail)
    cells = wheels(rail, numbers)
    low = np.concatenate([[-1e-4, 0.0], 10.0 ** random.uniform(-5, -0.8, 60)])
    width = np.concatenate([[1.2e-4, 1e-3], 10.0 ** random.uniform(-5, -2, 60)])
    begin = random.uniform(20.0, 32.0, 62)
    end = begin + random.uniform(0.0, 2.0, 62)
    rows = cells.at((slice(None), None))
    found = sliding(rows, Interval(low, low + width), Interval(begin, end))
    for seed in range(12):
        points = [from_rolling.members(rail, each, 1, seed * 10 + k) for k, each in enumerate(numbers)]
        exact = wheels(rail, [{n: (float(each[n][0]),) * 2 for n in from_rolling.EIGHT} for each in points])
        share = random.random((2, 62))
        share = np.where(random.random((2, 62)) < 0.4, np.round(share), share)
        slip, speed = low + share[0] * width, begin + share[1] * (end - begin)
        at = sliding(exact.at((slice(None), None)), Interval(slip, slip), Interval(speed, speed))
        for name in at._fields:
            one, bound = getattr(at, name), getattr(found, name)
            if isinstance(one, Interval):
                assert (bound.low <= one.high).all(), name
                assert (bound.high >= one.low).all(), name
            else:
                assert (one <= bound + 1e-9 * (1.0 + bound)).all(), name


def test_friction_of_a_small_slip_below_0_is_no_less_than_said():
    points = from_rolling.members(LOW, {}, 20, 5)
    plant = plant_of(problem(LOW), points)
    cells = wheels(LOW, [{n: (points[n][k],) * 2 for n in from_rolling.EIGHT} for k in range(20)])
    speed, own, radius = np.full(20, 33.0), plant.wheelset_inertia, plant.wheel_radius
    for slip in (-1e-4, -4e-5, 0.0, 2e-5):
        slips = np.full(20, slip)
        force = creep_force(plant, slips, speed, static_load(plant))
        exact = 0.02 / own * (2 * radius * force - 2 * plant.wheel_damping * (1 - slips) * speed / radius)
        found = sliding(cells, Interval(np.full(20, -1e-4), np.full(20, 2e-5)), Interval(speed, speed))
        assert (found.friction.low <= exact).all()
        assert (found.friction.high >= exact).all()


def test_slope_of_a_small_slip_below_0_is_no_less_than_said():
    """The force is that of the same slip the other way, and so is its slope."""
    cells = wheels(LOW, cells_of(LOW)[-3:])
    speed = np.full(3, 33.0)
    said = sliding(cells, Interval(np.full(3, -1e-4), np.full(3, 2e-5)), Interval(speed, speed)).slope
    there = sliding(cells, Interval(np.full(3, 1e-4), np.full(3, 1e-4)), Interval(speed, speed)).slope
    assert (said.low <= there.high).all()


def test_numbers_of_cells_are_gathered_in_their_order():
    numbers = cells_of(LOW)
    cells = wheels(LOW, numbers)
    for k, each in enumerate(numbers):
        one = wheels(LOW, [each])
        for name in ("effect", "fills", "grip", "steepness", "mass"):
            assert getattr(cells, name).low[k] == getattr(one, name).low[0]
            assert getattr(cells.at([k]), name).high == getattr(one, name).high[0]
    assert gathered([cells.one]).one is cells.one
