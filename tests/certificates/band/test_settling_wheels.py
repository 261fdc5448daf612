"""Wheels of a cell on the braking curve: what is simulated stays in its polytopes, and faults are refused."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

import wspd_design as wd
from tests.certificates.band.braked_plant import EIGHT, course, drawn
from tests.certificates.band.conftest import problem_of
from wspd_design.certificates.kernel.checker import Refused
from wspd_design.certificates.theorems.band import contact_held
from wspd_design.certificates.theorems.from_rolling import sample as one_sample
from wspd_design.certificates.theorems.from_rolling import settling
from wspd_design.certificates.theorems.from_rolling.braked_wheel import Between, wheels_of
from wspd_design.certificates.theorems.from_rolling.reached import deviations
from wspd_design.certificates.theorems.from_rolling.sample import law_numbers
from wspd_design.certificates.theorems.from_rolling.settling import (
    Plan,
    Start,
    in_time,
    settles,
    through_rows,
)
from wspd_design.certificates.theorems.slip_band.arrival import Asked
from wspd_design.certificates.theorems.slip_band.statement import law_of

START = Start(
    z=Between(-0.004, 0.004),
    p=Between(-0.005, 0.005),
    error=Between(-0.003, 0.01),
    way=Between(-0.006, 0.004),
    slip=Between(0.059, 0.062),
    speed=Between(31.8, 100.0 / 3.0),
    room=0.2,
    supply=0.34,
)
BEGINS, UNTIL = 0.0592, 0.0225
TOLERANCE = 2e-6  # rad/s, of the simulation


@pytest.fixture(scope="module")
def problem():
    return contact_held(problem_of(1.0, rail=wd.load_rail("low-adhesion")))


@pytest.fixture(scope="module")
def numbers(problem):
    """A quarter of each range; all of the supply rate."""
    middle = {name: 0.5 * sum(problem.span(name)) for name in EIGHT}
    share = dict.fromkeys(EIGHT, 0.25) | {"supply rate": 1.0}
    return {
        name: tuple(middle[name] + share[name] * (end - middle[name]) for end in problem.span(name))
        for name in EIGHT
    }


@pytest.fixture(scope="module")
def wheels(problem, numbers):
    return wheels_of(problem, law_of(problem.controller), numbers)


@pytest.fixture(scope="module")
def law(problem):
    return law_numbers(law_of(problem.controller))


@pytest.fixture(scope="module")
def followed(law, wheels):
    """Samples in time, rows, and samples in time again."""
    first = list(in_time(law, wheels, settling.begun(law, wheels, START), 3))
    rows = []
    last = through_rows(law, wheels, first[-1].state, UNTIL, rows)
    return first, rows, list(in_time(law, wheels, last, 40))


@pytest.fixture(scope="module")
def simulated(problem, numbers):
    found = course(problem, drawn(numbers, 120, seed=3), 230)
    return found, np.argmax(found["slip"] > BEGINS, axis=0)


def asked(half, **other):
    """A ball around the reference."""
    return Asked(
        **{
            "speeds": (23.0, 34.0),
            "settled": 0.0,
            "matrix": (np.eye(5) / half**2).tolist(),
            "center": [0.0] * 5,
            "moved": [0.0] * 5,
            "supply": 0.4,
        }
        | other
    )


def inside(sample, found, n, j):
    """Whether a simulated wheel is in the polytope of a sample."""
    u = np.array([found[name][n, j] for name in one_sample.STATES])
    states = sample.state.states
    at, slack = states.rows @ u, TOLERANCE * np.abs(states.rows).sum(axis=1)
    error = sample.state.error
    return (
        (at <= states.high + slack).all()
        and (at >= states.low - slack).all()
        and error.low - TOLERANCE <= found["e"][n, j] <= error.high + TOLERANCE
        and sample.state.speed.low - settling.SLOWER <= found["speed"][n, j] <= sample.state.speed.high + 1e-6
        and sample.errors.low - TOLERANCE <= found["E"][n, j] <= sample.errors.high + TOLERANCE
        and sample.state.supply <= found["supply"][n, j] + TOLERANCE
    )


def test_simulated_wheels_begin_in_the_start_box(simulated):
    found, first = simulated
    for j, n in enumerate(first):
        for name, span in (("z", START.z), ("p", START.p), ("x", START.way), ("e", START.error)):
            assert span.low < found[name][n, j] < span.high, name
        assert START.slip.low < found["slip"][n, j] < START.slip.high
        assert found["room"][n, j] > START.room


def test_simulated_wheels_stay_in_the_polytopes_of_their_samples_and_rows(followed, simulated):
    first, rows, last = followed
    found, begins = simulated
    visited = np.zeros(len(rows), dtype=int)
    for j, n in enumerate(begins):
        for k, sample in enumerate(first):
            assert inside(sample, found, n + k, j), (j, k)
        n += len(first) - 1
        while found["P"][n, j] > rows[-1].state.states.extents[0, 0]:
            held = [
                k
                for k, row in enumerate(rows)
                if row.state.states.extents[0, 0] <= found["P"][n, j] <= row.state.states.extents[0, 1]
            ]
            assert held
            for k in held:
                assert inside(rows[k], found, n, j), (j, k)
                visited[k] += 1
            n += 1
        for k, sample in enumerate(last):
            assert inside(sample, found, n + k, j), (j, k)
    assert visited.max() >= len(begins)  # every wheel has a sample in each row
    assert np.count_nonzero(visited >= len(begins)) > len(rows) / 2


def test_the_next_error_is_what_the_state_says(simulated, law):
    """y and c, from the state alone, tell the next error but for what the valve does."""
    found, first = simulated
    y = found["P"] - found["x"] + found["z"] + (1 - law.theta) / law.theta * found["p"] - found["e"]
    for j, n in enumerate(first):
        left = found["E"][n + 1 : n + 60, j] - found["E"][n : n + 59, j] + y[n : n + 59, j]
        assert np.abs(left).max() < 1.7 * np.abs(found["x"][n : n + 59, j]).max()


def test_deviations_of_the_band_hold_those_of_simulated_wheels(problem, numbers, followed):
    """From what the band says they are: torque and friction beside those that hold a speed at an error."""
    members = drawn(numbers, 60, seed=5)
    found, settled = course(problem, members, 230), 8.6e-4
    begins, (first, rows, last) = np.argmax(found["slip"] > BEGINS, axis=0), followed
    _, inertia, radius, _, torque, *_ = members
    slip, h, effect = problem.slip, 0.02, torque / 60000.0 * 752.0 / inertia
    count = 0
    for j, n in enumerate(begins):
        n += len(first) - 1
        while found["P"][n, j] > rows[-1].state.states.extents[0, 0]:
            n += 1
        for k, sample in enumerate(last):
            ends = deviations(sample, settled, np.eye(5))
            if sample.state.states.extents[0, 1] > sample.law.gain * sample.law.begins or ends is None:
                continue
            at = {name: each[n + k, j] for name, each in found.items() if name != "turned"}
            turning = at["slows"] * (1 - slip) / radius[j] * h
            turned = found["turned"](found["speed"][n + k], settled)[j]
            holds = (turned - turning) / effect[j]
            deviates = np.array(
                [
                    at["E"] - settled,
                    at["p"],
                    at["observed"] - holds - turning,
                    at["torque"] - holds,
                    turning - at["known"] * (1 - slip) / 0.55 * h,
                ]
            )
            low, high = ends
            assert (low - TOLERANCE <= deviates).all(), (j, k, low, deviates)
            assert (deviates <= high + TOLERANCE).all(), (j, k, high, deviates)
            count += 1
    assert count > 500


def test_the_wheels_settle(problem, numbers):
    shown = settles(problem, numbers, START, [asked(0.02)], Plan(3, UNTIL, 60))
    assert 0.137 < shown.slip < 0.142
    assert shown.speed > 28.0
    assert shown.supply > 0.5
    assert -0.02 < shown.errors.low < shown.errors.high < 0.02


def test_simulated_wheels_tell_what_is_shown(problem, numbers, simulated):
    shown = settles(problem, numbers, START, [asked(0.02)], Plan(3, UNTIL, 60))
    found, first = simulated
    for j, n in enumerate(first):
        until = n + int(shown.samples)
        assert found["slip"][n : until + 1, j].max() <= shown.slip
        assert found["speed"][min(until, len(found["speed"]) - 1), j] >= shown.speed


@pytest.mark.parametrize(
    ("ellipsoid", "what"),
    [
        (asked(1e-4), "may not be in the ellipsoid"),
        (asked(0.02, speeds=(33.0, 34.0)), "may not be in the ellipsoid"),
        (asked(0.02, supply=0.99), "may not be in the ellipsoid"),
        (asked(0.02, center=[0.1, 0.0, 0.0, 0.0, 0.0]), "may not be in the ellipsoid"),
    ],
)
def test_a_band_that_they_do_not_reach_is_refused(problem, numbers, ellipsoid, what):
    with pytest.raises(Refused, match=what):
        settles(problem, numbers, START, [ellipsoid], Plan(3, UNTIL, 40))


@pytest.mark.parametrize(
    "plan", [Plan(-1, UNTIL, 5), Plan(3, UNTIL, 10**9), Plan(3, 0.2, 5), Plan(3, UNTIL, 0)]
)
def test_plans_that_do_not_fit_are_refused(problem, numbers, plan):
    with pytest.raises(Refused):
        settles(problem, numbers, START, [asked(0.02)], plan)


@pytest.mark.parametrize(
    "start",
    [
        START._replace(way=Between(-0.1, 0.1)),
        START._replace(room=0.0, supply=0.0),
        START._replace(error=Between(-0.2, 0.2)),
        START._replace(p=Between(-0.2, 0.2)),
    ],
)
def test_starts_beyond_the_braking_curve_are_refused(problem, numbers, start):
    with pytest.raises(Refused):
        settles(problem, numbers, start, [asked(0.02)], Plan(3, UNTIL, 40))


def test_no_band_is_refused(problem, numbers):
    with pytest.raises(Refused, match="no band"):
        settles(problem, numbers, START, [], Plan(3, UNTIL, 40))


def test_a_smaller_start_box_does_not_hold_the_simulated_wheels(simulated, law, wheels):
    small = START._replace(z=Between(3e-4, 4e-4), p=Between(1e-4, 2e-4), way=Between(-0.0013, -0.0012))
    first = next(iter(in_time(law, wheels, settling.begun(law, wheels, small), 0)))
    found, begins = simulated
    assert not any(inside(first, found, n, j) for j, n in enumerate(begins))


# --- planted faults ---------------------------------------------------------------------------------------------------
@pytest.mark.parametrize("state", range(4))
def test_a_wrong_map_loses_simulated_wheels(monkeypatch, law, wheels, simulated, state):
    """With half of what one of the states becomes."""
    maps = one_sample._maps

    def wrong(*given):
        of_state, of_error, of_known = maps(*given)
        of_state = of_state.copy()
        of_state[:, state, :] *= 0.5
        return of_state, of_error, of_known

    monkeypatch.setattr(one_sample, "_maps", wrong)
    tight = START._replace(z=Between(0.0, 0.001), p=Between(0.0, 0.0006), way=Between(-0.0026, -0.0009))
    try:
        samples = list(in_time(law, wheels, settling.begun(law, wheels, tight), 12))
    except Refused:
        return
    found, begins = simulated
    assert not all(
        inside(sample, found, n + k, j) for j, n in enumerate(begins) for k, sample in enumerate(samples)
    )


def test_a_row_that_is_narrower_than_the_fall_is_widened(followed):
    _, rows, _ = followed
    for row in rows:
        low, high = row.state.states.extents[0]
        assert high - low >= -row.change.low
        assert row.change.high < 0.0


def test_rows_hold_what_they_lead_to(followed):
    _, rows, _ = followed
    for row, following in pairwise(rows):
        low, high = row.ends(settling.IN_ROWS)
        for states in (row.state.states, following.state.states):
            assert (low[1:] >= states.low[1:] - 1e-12).all()
            assert (high[1:] <= states.high[1:] + 1e-12).all()
        assert replace(row.state, error=row.next_error).error.high <= row.state.error.high
        # The next row begins where this one ends.
        assert following.state.states.extents[0, 1] == pytest.approx(
            row.state.states.extents[0, 0], abs=1e-12
        )
