"""Wheels whose valves fill from rolling pass the slip as they are said to: simulated ones, closed forms and sums."""

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
from wspd_design.certificates.theorems.from_rolling import filling, passing
from wspd_design.certificates.theorems.from_rolling.supply import SPARE, Filling

RAILS = (LOW, WET)
EDGES = passing.EDGES
FULL = 60e3 * 0.02 / 752.0
PARTS = 40  # of a sample, in the simulation of wheels whose valves fill without a pause
SAMPLES = 45  # of it


def part_of(slip):
    return np.clip(np.searchsorted(EDGES, slip, side="right") - 1, 0, EDGES.size - 2)


@cache
def bounds(rail):
    found = wheels(rail, cells_of(rail))
    return filling.filled(from_rolling.law(rail), found, problem(rail).speeds[1])


@cache
def passing_of(rail):
    """How wheels pass the slip at the speeds that are found for them and a little beside."""
    speed, fastest = bounds(rail).speed, problem(rail).speeds[1]
    speed = Interval(speed.low - 0.02, np.minimum(speed.high + 0.02, fastest))
    with np.errstate(all="ignore"):
        return passing.passed_through(from_rolling.law(rail), wheels(rail, cells_of(rail)), fastest, speed)


@cache
def visited(rail):
    """States of simulated wheels up to which the valve filled, from the third sample on, with the parts they are in."""
    found, cell_of, so_far = simulated(rail)
    before = np.concatenate([np.ones((1, so_far.shape[1]), dtype=bool), so_far[:-1]])
    here = before & (found["slip"] < EDGES[-1])
    here[:2] = False
    sample, number = np.nonzero(here)
    slip = found["slip"][sample, number]
    assert slip.min() > -passing.SINK
    part = np.searchsorted(EDGES, slip, side="right") - 1
    states = {name: each[sample, number] for name, each in found.items()}
    return SimpleNamespace(
        cell=cell_of[number], part=part, fills=so_far[sample, number], states=states, sample=sample
    )


@cache
def filled_wheels(rail, count=16):
    """Members of all cells: how slip and speed of them change under a torque, and that of a valve that only fills."""
    numbers = cells_of(rail)
    drawn = [from_rolling.members(rail, each, count, 40 + k) for k, each in enumerate(numbers)]
    points = {name: np.concatenate([each[name] for each in drawn]) for name in drawn[0]}
    plant = plant_of(problem(rail), points)
    own, radius, h, slip_r = plant.wheelset_inertia, plant.wheel_radius, 0.02, 0.14
    kappa = (1 - slip_r) * plant.wheelsets * own / (radius**2 * plant.mass)
    effect = plant.max_torque / 60e3 * 752.0 / own

    def friction(slip, speed):
        force = creep_force(plant, slip, speed, static_load(plant))
        turning = (1 - slip) * speed / radius
        q = 2 * plant.wheel_damping * h / own
        held = (1 - slip_r) * h * resistance(plant, speed) / (radius * plant.mass)
        return 2 * radius * force * h / own - q * turning, kappa * q * turning + held

    def rates(torque, slip, speed):
        f, drag = friction(slip, speed)
        lost = kappa * f + drag
        motion = effect * torque - f - lost - lost * (slip_r - slip) / (1 - slip_r)
        return np.array([radius / speed * motion, -radius * lost / (1 - slip_r)]), motion, f

    return SimpleNamespace(
        rates=rates,
        torque=Filling(60e3 * h / 752.0, plant.supply_rate * h, h / plant.fill_time).torque,
        effect=effect,
        radius=radius,
        start=np.array([np.zeros(len(own)), points["speed"]]),
        cell=np.repeat(np.arange(len(numbers)), count),
    )


def run(of, state, begin, samples, less=0.0):
    """Courses from a state on, :data:`PARTS` times a sample; the torque may be less than that of the filling."""
    found, step = [], 1.0 / PARTS

    def torque(time):
        return of.torque(time) - less

    for n in range(round(samples * PARTS) + 1):
        time = begin + n * step
        rate, motion, f = of.rates(torque(time), *state)
        found.append({"slip": state[0], "speed": state[1], "motion": motion, "f": f, "torque": torque(time)})
        second = of.rates(torque(time + step / 2), *(state + step / 2 * rate))[0]
        third = of.rates(torque(time + step / 2), *(state + step / 2 * second))[0]
        last = of.rates(torque(time + step), *(state + step * third))[0]
        state = state + step / 6 * (rate + 2 * second + 2 * third + last)
    return {name: np.array([each[name] for each in found]) for name in found[0]}


@cache
def dense(rail):
    """Wheels of all cells whose valves fill without a pause, many times in each sample; where the bounds hold."""
    of = filled_wheels(rail)
    found = run(of, of.start, 0.0, SAMPLES)
    known = np.isfinite(passing_of(rail).motion.high) & bounds(rail).alive
    part = part_of(found["slip"])
    here = known[of.cell, part] & (found["slip"] < EDGES[-1])
    return SimpleNamespace(**found, part=part, here=np.logical_and.accumulate(here, axis=0), cell=of.cell)


def means(values):
    """Means over the sample that begins at each time, of values many times in it."""
    sums = np.concatenate([0.0 * values[:1], np.cumsum(0.5 * (values[1:] + values[:-1]), axis=0)])
    return (sums[PARTS:] - sums[:-PARTS]) / PARTS


# --- simulated wheels at their samples --------------------------------------------------------------------------------
@pytest.mark.parametrize("rail", RAILS)
def test_motion_torque_and_rate_of_simulated_wheels_are_within_bounds(rail):
    """At the moment of a sample: q from the torque and the friction there."""
    seen, found = visited(rail), passing_of(rail)
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
def test_torques_are_those_of_the_fastest_and_the_slowest_filling_at_the_times_of_a_part(rail):
    seen, found, cells = visited(rail), passing_of(rail), wheels(rail, cells_of(rail))
    tau = cells.fills * from_rolling.law(rail).over_fill
    fast = Filling(FULL, cells.supply_rate.high, tau.high).column()
    slow = Filling(FULL, cells.supply_rate.low, tau.low).column()
    at, torque = (seen.cell, seen.part), seen.states["torque"]
    assert (torque <= fast.torque(found.latest)[at] + TOLERANCE).all()
    assert (torque >= slow.torque(found.slow[0])[at] - TOLERANCE).all()
    assert (torque <= slow.torque(found.slow[1])[at] + TOLERANCE).all()
    assert (torque >= fast.torque(found.soonest)[at] - TOLERANCE).all()


@pytest.mark.parametrize("rail", RAILS)
def test_what_the_torque_has_more_than_its_observed_mean_is_within_bounds(rail):
    found, cell_of, so_far = simulated(rail)
    law, torque = from_rolling.law(rail), found["torque"]
    back = np.arange(len(torque))
    weights = law.a * (back + 1) * law.theta**back
    with np.errstate(all="ignore"):
        lags = passing.lags_of(law, wheels(rail, cells_of(rail)), passing_of(rail))
    count = 0
    for n in range(2, len(torque)):
        part = np.searchsorted(EDGES, found["slip"][n], side="right") - 1
        here = so_far[n - 1] & (part < EDGES.size - 1)
        at = cell_of[here], part[here]
        lag = (torque[n] - weights[:n] @ torque[:n][::-1])[here]
        assert (lag <= lags[at] + TOLERANCE).all()
        count += lag.size
    assert count > 1000


@pytest.mark.parametrize("rail", RAILS)
def test_rise_of_the_friction_is_below_its_bound(rail):
    seen, found = visited(rail), passing_of(rail)
    with np.errstate(all="ignore"):
        steep = passing.steepest(found.wheels, found)
    assert (seen.states["level"] <= steep[seen.cell, seen.part] + TOLERANCE).all()


# --- simulated wheels at any time -------------------------------------------------------------------------------------
@pytest.mark.parametrize("rail", RAILS)
def test_motion_torque_and_speed_while_the_valve_fills_are_within_bounds(rail):
    """Where wheels that fill without a pause are for a moment, up to the slip that has bounds that hold."""
    found, bound = dense(rail), passing_of(rail)
    here = found.here.copy()
    here[: 2 * PARTS] = False
    at = np.broadcast_to(found.cell, here.shape)[here], found.part[here]
    # A wheel that the resistance slows down before there is a torque goes back a little, in the first part.
    assert (found.motion[here] <= bound.motion.high[at] + 1e-9).all()
    assert (found.motion[here] >= bound.motion.low[at] - np.where(at[1] == 0, 1e-4, 1e-9)).all()
    assert (found.torque[here] <= bound.torque.high[at] + 1e-9).all()
    assert (found.torque[here] >= bound.torque.low[at] - 1e-9).all()
    for speed in (bound.later, bounds(rail).speed):
        assert (found.speed[here] >= speed.low[at]).all()
        assert (found.speed[here] <= speed.high[at]).all()
    assert np.count_nonzero(here) > 1000


def reached(rail):
    """Times at which each wheel comes to each edge but the first, by cubics through times and motions."""
    found, of = dense(rail), filled_wheels(rail)
    rate = of.radius / found.speed * found.motion
    times = np.full((found.cell.size, EDGES.size), np.nan)
    for k in range(found.cell.size):
        n = np.searchsorted(np.maximum.accumulate(found.slip[:, k]), EDGES)
        edge = np.flatnonzero(n < len(rate))[1:]
        edge = edge[found.here[n[edge], k]]
        n = n[edge]
        low, wide = found.slip[n - 1, k], found.slip[n, k] - found.slip[n - 1, k]
        x, step = (EDGES[edge] - low) / wide, 1.0 / PARTS
        begins, ends = wide / rate[n - 1, k], wide / rate[n, k]
        times[k, edge] = (n - 1) * step + x * (
            begins + x * (3.0 * step - 2.0 * begins - ends + x * (begins + ends - 2.0 * step))
        )
    return times


@pytest.mark.parametrize("rail", RAILS)
def test_parts_are_crossed_in_the_time_that_is_said(rail):
    """The first part is one that wheels are in from the beginning."""
    found, bound, times = dense(rail), passing_of(rail), reached(rail)
    taken, crossed = np.diff(times, axis=1)[:, 1:], np.isfinite(times[:, 2:])
    low, high = (each[found.cell, 1:] for each in (bound.crossing.low, bound.crossing.high))
    assert (taken >= low - 1e-7)[crossed].all()
    assert (taken <= high + 1e-7)[crossed].all()
    known = np.isfinite(times[:, 1:])
    assert (times[:, 1:] <= bound.passed[found.cell] + 1e-7)[known].all()
    assert (times[:, :-1] >= bound.soonest[found.cell] - 1e-7)[known & (EDGES[:-1] > 0.0)].all()
    assert np.count_nonzero(crossed) > 10000


def inside(rail, windows):
    """Whether wheels were behind the farthest and before the nearest part a sample ago, and are not beyond the next."""
    found = dense(rail)
    here = found.here[PARTS:].copy()
    here[:PARTS] = False
    cell = np.broadcast_to(found.cell, here.shape)[here]
    before, after = found.part[:-PARTS][here], found.part[PARTS:][here]
    assert here.sum() > 5000
    return (
        windows.far[cell, after] <= before,
        before <= windows.near[cell, after],
        after < windows.next[cell, before],
    )


@pytest.mark.parametrize("rail", RAILS)
def test_wheels_are_in_their_windows(rail):
    with np.errstate(all="ignore"):
        windows = passing.Windows(passing_of(rail))
    for each in inside(rail, windows):
        assert each.all()


@pytest.mark.parametrize("fault", ["low", "high"])
def test_wheels_leave_windows_of_wrong_times(fault):
    """Of parts that take half of the longest time at most, or twice the shortest one at least."""
    bound = passing_of(LOW)
    low, high = bound.crossing.low, bound.crossing.high
    wrong = Interval(2.0 * low, high) if fault == "low" else Interval(low, 0.5 * high)
    with np.errstate(all="ignore"):
        windows = passing.Windows(replace(bound, crossing=wrong))
    found = inside(LOW, windows)
    assert not found[0 if fault == "low" else 1].all()
    assert found[1 if fault == "low" else 0].all()


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


def test_times_of_torques_are_passed_before_and_after(fillings):
    guess = low = np.full(30, 1.5)
    for torque in np.linspace(0.001, 1.2, 300):
        asked = np.full(30, torque)
        guess, low = fillings.until(asked, guess), fillings.since(asked, low)
        reached = np.isfinite(guess)
        assert (fillings.torque(guess)[reached] >= asked[reached]).all()
        assert (fillings.torque(low) <= asked).all()
        assert ((guess - low) < 3 * SPARE + 3e-3)[reached].all()
        assert reached.all()
    assert (fillings.since(np.full(30, -1.0), guess) == 1.0).all()
    assert np.isinf(fillings.until(np.full(30, 2.0), np.full(30, 1.5))).all()


# --- parts of the sums -----------------------------------------------------------------------------------------------
def test_room_is_that_of_fillings_within_the_cell():
    """At the torques of a part: of the fillings at all corners."""
    numbers = [from_rolling.cell(LOW, {"fill time": 0.2, "supply rate": 0.8}, 3.0)]
    law, cells, fastest = from_rolling.law(LOW), wheels(LOW, numbers), problem(LOW).speeds[1]
    slow = np.full((1, EDGES.size - 1), 0.94 * fastest)
    with np.errstate(all="ignore"):
        passed = passing.passed_through(law, cells, fastest, Interval(slow, np.full(slow.shape, fastest)))
        rooms = passing.rooms_of(law, cells, passed)
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


def test_the_largest_of_a_window_is_that_of_its_values():
    random = np.random.default_rng(2)
    values = random.normal(size=(5, 61))
    first = random.integers(0, 61, size=(5, 61))
    last = np.minimum(first + random.integers(0, 61, size=(5, 61)), 60)
    expected = [
        [row[a : b + 1].max() for a, b in zip(*ends, strict=True)]
        for row, *ends in zip(values, first, last, strict=True)
    ]
    np.testing.assert_array_equal(passing.most_over(values, first, last), expected)
    np.testing.assert_array_equal(passing.least_over(-values, first, last), -np.array(expected))
    held = passing.over(Interval(-values, values), first, last)
    np.testing.assert_array_equal(held.low, -np.array(expected))
    np.testing.assert_array_equal(held.high, expected)


def test_a_train_has_lost_at_least_what_it_does_beyond_the_parts_passed():
    """By hand: what is lost a sample falls from the first part to the second, and then rises."""
    loss, passed = np.array([[2.0, 1.0, 3.0]]), np.array([[1.0, 2.0, 4.0]])
    np.testing.assert_allclose(passing._lost(loss, passed, np.array([[0.5, 1.5, 3.0]])), [[0.5, 1.5, 5.0]])
    assert (passing._lost(-loss, passed, passed) == 0.0).all()


@pytest.mark.parametrize("rail", RAILS)
def test_a_train_loses_no_more_than_until_all_parts_are_passed(rail):
    bound = passing_of(rail)
    lost = problem(rail).speeds[1] - bound.later.low
    more, spent = np.diff(lost, axis=1), np.diff(bound.passed, axis=1)
    good = bounds(rail).alive[:, 1:]
    assert (lost[:, 0] >= bound.passed[:, 0] * bound.there.loss.high[:, 0]).all()
    assert (more >= spent * bound.there.loss.high[:, 1:] - 1e-12)[good].all()


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
    high = passing._faster(q[some], drive[some], held[some], 2.0 * longest[some])
    low = passing._slower(q[some], drive[some], held[some], shorter[some], longest[some])
    assert (high >= exact[some] - 1e-6).all()
    assert (low <= exact[some] + 1e-6).all()
    # A friction that falls: how fast is left to the end of the part.
    drive = np.abs(drive)
    assert (passing._faster(q, drive, held, 2.0 * longest) >= q)[drive > held * q].all()
