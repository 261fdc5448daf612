"""Wheels of which the valves fill from rolling: simulated ones stay in what is said of them; closed forms and sums."""

from dataclasses import replace
from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest

from tests.attack.plant import creep_force, resistance, static_load
from tests.certificates.band import from_rolling
from tests.certificates.band.from_rolling import LOW, TOLERANCE, WET, cells_of, problem, simulated, wheels
from tests.certificates.band.sampled_runs import plant_of
from wspd_design.certificates.kernel.interval import Interval
from wspd_design.certificates.theorems.from_rolling import cells as cells_module
from wspd_design.certificates.theorems.from_rolling import filling
from wspd_design.certificates.theorems.from_rolling.cells import gathered, sliding
from wspd_design.certificates.theorems.from_rolling.supply import Filling

RAILS = (LOW, WET)
EDGES = filling.EDGES
FULL = 60e3 * 0.02 / 752.0


@cache
def bounds(rail):
    found = wheels(rail, cells_of(rail))
    return filling.filled(from_rolling.law(rail), found, problem(rail).speeds[1])


@cache
def visited(rail):
    """States of simulated wheels up to which the valve filled, from the third sample on, with the parts they are in."""
    found, cell_of, so_far = simulated(rail)
    before = np.concatenate([np.ones((1, so_far.shape[1]), dtype=bool), so_far[:-1]])
    here = before & (found["slip"] < EDGES[-1])
    here[:2] = False
    sample, number = np.nonzero(here)
    slip = found["slip"][sample, number]
    assert slip.min() > -filling.SINK
    part = np.searchsorted(EDGES, slip, side="right") - 1
    states = {name: each[sample, number] for name, each in found.items()}
    return SimpleNamespace(
        cell=cell_of[number], part=part, fills=so_far[sample, number], states=states, sample=sample
    )


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
    assert (seen.states["speed"] >= found.speed[at]).all()
    assert (seen.states["level"] <= found.steep[at] + TOLERANCE).all()
    assert (seen.sample <= found.time[at]).all()


@pytest.mark.parametrize("rail", RAILS)
def test_valves_fill_and_pause_where_they_may(rail):
    seen, found = visited(rail), bounds(rail)
    at = seen.cell, seen.part
    assert found.alive[at][seen.fills].all()
    assert found.opens[at][~seen.fills].all()
    assert np.unique(seen.cell[~seen.fills]).size == len(found.lost)  # members of each cell pause


@cache
def passing(rail):
    law, cells, fastest = from_rolling.law(rail), wheels(rail, cells_of(rail)), problem(rail).speeds[1]
    slow = np.broadcast_to(0.9 * fastest, (len(cells.effect.low), EDGES.size - 1))
    with np.errstate(all="ignore"):
        return filling._passing(law, cells, fastest, slow)


@pytest.mark.parametrize("rail", RAILS)
def test_motion_torque_and_rate_of_simulated_wheels_are_within_bounds(rail):
    """At the moment of a sample: q from the torque and the friction there."""
    seen, found = visited(rail), passing(rail)
    at, states = (seen.cell, seen.part), seen.states
    assert (states["torque"] >= found.torque.low[at] - TOLERANCE).all()
    assert (states["torque"] <= found.torque.high[at] + TOLERANCE).all()
    tau = 0.02 / np.array([each["fill time"] for each in cells_of(rail)])
    rate = states["room"] * tau[seen.cell].min(axis=1)
    assert (rate <= found.rate[at] + TOLERANCE).all()
    rate = states["room"] * tau[seen.cell].max(axis=1)
    assert (rate >= found.least_rate[at] - TOLERANCE).all()
    assert (seen.sample >= found.soonest[at]).all()
    # In the first part a wheel may go back a little.
    assert (states["motion"] <= found.motion.high[at] + TOLERANCE).all()
    assert (states["motion"] >= found.motion.low[at] - np.where(seen.part == 0, 1e-4, TOLERANCE)).all()


@pytest.mark.parametrize("rail", RAILS)
def test_what_the_torque_has_more_than_its_observed_mean_is_within_bounds(rail):
    found, cell_of, so_far = simulated(rail)
    law, bound, torque = from_rolling.law(rail), passing(rail), found["torque"]
    back = np.arange(len(torque))
    weights = law.a * (back + 1) * law.theta**back
    with np.errstate(all="ignore"):
        lags = filling._lags(law, wheels(rail, cells_of(rail)), bound, weights[: filling.WEIGHED])
    known, count = bounds(rail).alive, 0
    for n in range(2, len(torque)):
        part = np.searchsorted(EDGES, found["slip"][n], side="right") - 1
        here = so_far[n - 1] & (part < EDGES.size - 1)
        at = cell_of[here], part[here]
        lag = (torque[n] - weights[:n] @ torque[:n][::-1])[here]
        assert known[at].all()
        assert (lag >= np.maximum(lags.low[at], 0.0) - TOLERANCE).all()
        assert (lag <= lags.high[at] + TOLERANCE).all()
        count += lag.size
    assert count > 1000


@pytest.mark.parametrize("rail", RAILS)
def test_rise_of_the_friction_is_below_its_bound(rail):
    seen, found = visited(rail), passing(rail)
    with np.errstate(all="ignore"):
        steep = filling._steepest(found.wheels, found)
    assert (seen.states["level"] <= steep[seen.cell, seen.part] + TOLERANCE).all()


@cache
def dense(rail, parts=40, count=16):
    """Wheels of all cells whose valves fill without a pause, many times in each sample."""
    numbers = cells_of(rail)
    drawn = [from_rolling.members(rail, each, count, 40 + k) for k, each in enumerate(numbers)]
    points = {name: np.concatenate([each[name] for each in drawn]) for name in drawn[0]}
    plant = plant_of(problem(rail), points)
    own, radius, h, slip_r = plant.wheelset_inertia, plant.wheel_radius, 0.02, 0.14
    kappa = (1 - slip_r) * plant.wheelsets * own / (radius**2 * plant.mass)
    g = plant.max_torque / 60e3 * 752.0 / own
    full = 60e3 * h / 752.0
    filling_of = Filling(full, plant.supply_rate * h, h / plant.fill_time)

    def friction(slip, speed):
        force = creep_force(plant, slip, speed, static_load(plant))
        turning = (1 - slip) * speed / radius
        q = 2 * plant.wheel_damping * h / own
        held = (1 - slip_r) * h * resistance(plant, speed) / (radius * plant.mass)
        return 2 * radius * force * h / own - q * turning, kappa * q * turning + held

    def rates(time, slip, speed):
        f, drag = friction(slip, speed)
        lost = kappa * f + drag
        motion = g * filling_of.torque(time) - f - lost - lost * (slip_r - slip) / (1 - slip_r)
        return np.array([radius / speed * motion, -radius * lost / (1 - slip_r)]), motion, f

    state = np.array([np.zeros(len(own)), points["speed"]])
    found, step = [], 1.0 / parts
    for n in range(45 * parts):
        time = n * step
        rate, motion, f = rates(time, *state)
        found.append({"slip": state[0], "speed": state[1], "motion": motion, "f": f})
        second = rates(time + step / 2, *(state + step / 2 * rate))[0]
        third = rates(time + step / 2, *(state + step / 2 * second))[0]
        last = rates(time + step, *(state + step * third))[0]
        state = state + step / 6 * (rate + 2 * second + 2 * third + last)
    found = {name: np.array([each[name] for each in found]) for name in found[0]}
    return found, np.repeat(np.arange(len(numbers)), count), parts


@pytest.mark.parametrize("rail", RAILS)
def test_motion_while_the_valve_fills_is_within_bounds(rail):
    """Where wheels that fill without a pause are for a moment, up to the slip that has bounds that hold."""
    found, cell_of, parts = dense(rail)
    bound = passing(rail)
    known = np.isfinite(bound.motion.high) & bounds(rail).alive
    slip = found["slip"]
    k = np.clip(np.searchsorted(EDGES, slip, side="right") - 1, 0, EDGES.size - 2)
    here = known[cell_of[None, :], k]
    here[: 2 * parts] = False
    here = np.logical_and.accumulate(here[2 * parts :], axis=0)
    at = np.broadcast_to(cell_of, here.shape)[here], k[2 * parts :][here]
    motion = found["motion"][2 * parts :][here]
    assert (motion <= bound.motion.high[at] + 1e-9).all()
    # A wheel that the resistance slows down before there is a torque goes back a little, in the first part.
    assert (motion >= bound.motion.low[at] - np.where(at[1] == 0, 1e-4, 1e-9)).all()
    assert (found["speed"][2 * parts :][here] >= bound.slowest[at]).all()
    assert np.count_nonzero(here) > 1000


@pytest.mark.parametrize("rail", RAILS)
def test_places_some_samples_ago_and_growth_of_the_friction_are_within_bounds(rail):
    """Windows of parts, and what the friction has more than its means over the samples before."""
    found, cell_of, parts = dense(rail)
    bound = passing(rail)
    with np.errstate(all="ignore"):
        windows = filling._Windows(bound)
        growth = filling._Growth(bound, windows)
        steep = filling._steepest(bound.wheels, bound)
        coming, since = filling._since(growth, windows, steep)
    known = np.isfinite(bound.motion.high) & bounds(rail).alive
    part = np.clip(np.searchsorted(EDGES, found["slip"], side="right") - 1, 0, EDGES.size - 2)
    sums = np.cumsum(found["f"], axis=0)
    count = 0
    for now in range(4 * parts, 30 * parts, parts // 2):
        at = cell_of, part[now]
        good = known[cell_of, part[min(now + parts, len(part) - 1)]] & known[at]
        mean = (sums[now + parts] - sums[now]) / parts
        assert (windows.next[at] > part[now + parts])[good].all()
        ahead = mean - found["f"][now]
        spare = 3e-4 * np.abs(ahead) + 1e-7 + np.abs(found["f"][now + 1] - found["f"][now])
        assert (ahead <= coming.high[at] + spare)[good].all()
        assert (ahead >= coming.low[at] - spare)[good].all()
        for back in range(1, min(now // parts - 2, filling.BACK - 1)):
            then = now - back * parts
            middle = then - parts // 2
            for first, last, where in (
                (windows.far[back], windows.near[back], then),
                (windows.first_middle(back), windows.last_middle(back), middle),
            ):
                assert (first[at] <= part[where])[good].all()
                assert (last[at] >= part[where])[good].all()
            begin = then - parts
            before = (sums[then] - sums[begin]) / parts
            assert (mean - before <= since[back].high[at] + 2 * spare)[good].all()
            assert (mean - before >= since[back].low[at] - 2 * spare)[good].all()
        count += np.count_nonzero(good)
    assert count > 500


# --- the supply -------------------------------------------------------------------------------------------------------
@pytest.fixture(scope="module")
def fillings():
    random = np.random.default_rng(8)
    return Filling(1.5957, random.uniform(0.004, 0.03, 30), random.uniform(0.05, 0.12, 30))


def integrated(filling_of, times, parts=400):
    """Torque from its rate and that of the supply, by small steps."""
    torque, found = 0.0 * filling_of.supply_rate, []
    s, tau, step = filling_of.supply_rate, filling_of.fill_rate, 1.0 / parts

    def rate(time, torque):
        return tau * (filling_of.full * (1.0 - np.exp(-s * time)) - torque)

    for n in range(round((times[-1] - 1.0) * parts) + 1):
        time = 1.0 + n * step
        if np.isclose(times, time).any():
            found.append(torque)
        first = rate(time, torque)
        torque = torque + step * rate(time + step / 2, torque + step / 2 * first)
    return np.array(found)


def test_torque_and_room_are_those_of_an_integration(fillings):
    times = np.array([1.0, 2.0, 7.5, 20.0])
    expected = integrated(fillings, times)
    for time, torque in zip(times, expected, strict=True):
        np.testing.assert_allclose(fillings.torque(np.full(30, time)), torque, atol=1e-7)
        supply = 1.5957 * -np.expm1(-fillings.supply_rate * time)
        np.testing.assert_allclose(fillings.room(np.full(30, time)), supply - torque, atol=1e-7)
    later = fillings.torque(np.full(30, 7.5 + 1e-5)) - fillings.torque(np.full(30, 7.5 - 1e-5))
    np.testing.assert_allclose(fillings.rate(np.full(30, 7.5)), later / 2e-5, rtol=1e-5)
    assert (fillings.torque(np.zeros(30)) == 0.0).all()


def test_the_room_is_largest_at_its_peak(fillings):
    times = np.linspace(1.0, 200.0, 19901)
    room = fillings.column().room(np.broadcast_to(times, (30, times.size)))
    np.testing.assert_allclose(times[room.argmax(axis=1)], fillings.peak, atol=0.011)
    assert (fillings.room(fillings.peak) >= room.max(axis=1) - 1e-12).all()


@pytest.mark.parametrize("rates", [(0.064, 0.04), (0.0225, 0.0223)])
def test_the_room_is_largest_at_its_peak_where_the_supply_is_faster_than_the_valve(rates):
    filling_of = Filling(1.5957, *(np.array([each]) for each in rates))
    times = np.linspace(1.0, 200.0, 19901)
    room = filling_of.column().room(times[None])[0]
    np.testing.assert_allclose(times[room.argmax()], filling_of.peak, atol=0.011)


def test_a_supply_as_fast_as_the_valve_has_a_torque():
    rates = np.array([0.0225])
    for near in (0.0, 1e-13, 1e-9, 1e-6):
        filling_of = Filling(1.5957, rates, rates + near)
        (expected,) = integrated(filling_of, np.array([20.0]))
        np.testing.assert_allclose(filling_of.torque(np.array([20.0])), expected, atol=1e-7)
        times = np.linspace(1.0, 200.0, 19901)
        room = filling_of.column().room(times[None])[0]
        np.testing.assert_allclose(times[room.argmax()], filling_of.peak, atol=0.011)


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


def test_times_of_torques_are_passed_before_and_after(fillings):
    guess = low = np.full(30, 1.5)
    for torque in np.linspace(0.001, 1.2, 300):
        asked = np.full(30, torque)
        guess, low = fillings.until(asked, guess), fillings.since(asked, low)
        reached = np.isfinite(guess)
        assert (fillings.torque(guess)[reached] >= asked[reached]).all()
        assert (fillings.torque(low) <= asked).all()
        assert ((guess - low) < 3 * filling.SPARE + 3e-3)[reached].all()
        assert reached.all()
    assert (fillings.since(np.full(30, -1.0), guess) == 1.0).all()
    assert np.isinf(fillings.until(np.full(30, 2.0), np.full(30, 1.5))).all()


# --- cells that are lost ----------------------------------------------------------------------------------------------
@pytest.fixture(scope="module")
def few():
    """Some cells, how their wheels pass the slip, and the least speeds that were assumed for that."""
    law, cells, fastest = from_rolling.law(LOW), wheels(LOW, cells_of(LOW)[4:7]), problem(LOW).speeds[1]
    slow = np.broadcast_to(0.94 * fastest, (3, EDGES.size - 1))
    with np.errstate(all="ignore"):
        return law, cells, filling._passing(law, cells, fastest, slow), slow


def lost(few, slow=None, **other):
    law, cells, passed, assumed = few
    passed = replace(passed, **other)
    with np.errstate(all="ignore"):
        return filling._filled(law, cells, passed, assumed if slow is None else slow).lost


def test_cells_of_which_nothing_is_known_are_lost(few):
    passed = few[2]
    assert not lost(few).any()
    assert lost(few, slow=passed.slowest + 1e-6).all()
    assert lost(few, least_rate=0.0 * passed.least_rate).all()
    assert lost(few, rate=np.where(EDGES[1:] > 2e-3, np.inf, passed.rate)).all()
    assert lost(few, wheels=replace(passed.wheels, fills=passed.wheels.fills * 60.0)).all()


def test_cells_that_fill_to_the_end_are_lost(few, monkeypatch):
    """An error as large as that of a wheel that rolls, at all slips."""
    pulls = filling._pulls
    monkeypatch.setattr(filling, "_pulls", lambda law, seen: pulls(law, seen) + 5.0)
    assert lost(few).all()


def test_room_is_that_of_fillings_within_the_cell():
    """At the torques of a part: of the fillings at all corners."""
    numbers = [from_rolling.cell(LOW, {"fill time": 0.2, "supply rate": 0.8}, 3.0)]
    law, cells, fastest = from_rolling.law(LOW), wheels(LOW, numbers), problem(LOW).speeds[1]
    slow = np.broadcast_to(0.94 * fastest, (1, EDGES.size - 1))
    with np.errstate(all="ignore"):
        passed = filling._passing(law, cells, fastest, slow)
        rooms = filling._rooms(law, cells, passed)
    times = np.linspace(1.0, 60.0, 6001)
    good = np.isfinite(passed.motion.high[0])
    for fill in (*numbers[0]["fill time"], np.mean(numbers[0]["fill time"])):
        for rate in numbers[0]["supply rate"]:
            one = Filling(FULL, np.full(times.size, rate * 0.02), np.full(times.size, 0.02 / fill))
            torque, room = one.torque(times), one.room(times)
            for k in np.flatnonzero(good)[::6]:
                at = (torque >= passed.torque.low[0, k]) & (torque <= passed.torque.high[0, k])
                assert (room[at] >= rooms.low[0, k] - 1e-9).all()
                assert (room[at] <= rooms.high[0, k] + 1e-9).all()


# --- parts of the sums -----------------------------------------------------------------------------------------------
def test_the_largest_of_a_window_is_that_of_its_values():
    random = np.random.default_rng(2)
    values = random.normal(size=(5, 61))
    first = random.integers(0, 61, size=(5, 61))
    last = np.minimum(first + random.integers(0, 61, size=(5, 61)), 60)
    expected = [
        [row[a : b + 1].max() for a, b in zip(*ends, strict=True)]
        for row, *ends in zip(values, first, last, strict=True)
    ]
    np.testing.assert_array_equal(filling._most(values, first, last), expected)


def test_steps_of_the_motion_hold_integrations():
    """q dq/ds = (v/R) (drive - held q), for constants within what the bounds take."""
    random = np.random.default_rng(6)
    q, drive, held = (
        random.uniform(0.0, 0.1, 400),
        random.uniform(-0.02, 0.08, 400),
        random.uniform(-0.5, 1.5, 400),
    )
    longest = 10.0 ** random.uniform(-4, -1, 400)
    shorter = longest * random.uniform(0.9, 1.0, 400)
    exact, steps = q * q, 4000
    for _ in range(steps):
        middle = exact + shorter / steps * (drive - held * np.sqrt(np.maximum(exact, 0.0)))
        exact = np.maximum(
            exact + 2 * shorter / steps * (drive - held * np.sqrt(np.maximum(middle, 0.0))), 0.0
        )
    exact = np.sqrt(exact)
    some = held >= 0.0
    high = filling._faster(q[some], drive[some], held[some], 2.0 * longest[some])
    low = filling._slower(q[some], drive[some], held[some], shorter[some], longest[some])
    assert (high >= exact[some] - 1e-6).all()
    assert (low <= exact[some] + 1e-6).all()
    # A friction that falls: how fast is left to the end of the part.
    drive = np.abs(drive)
    assert (filling._faster(q, drive, held, 2.0 * longest) >= q)[drive > held * q].all()


def test_pulls_are_those_of_the_law():
    law = from_rolling.law(WET)
    seen = np.linspace(-0.5, 6.0, 50)
    expected = [law.pull(each) for each in seen]
    np.testing.assert_allclose(filling._pulls(law, seen), expected, atol=1e-14)


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
