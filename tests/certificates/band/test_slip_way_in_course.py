"""The first second of the way in, all of its states, for boxes that are followed together or alone."""

from itertools import islice

import numpy as np
import pytest

import wspd_design as wd
from tests.certificates.band import sampled_runs
from tests.certificates.band.conftest import problem_of
from tests.certificates.band.sampled_runs import BESIDE, BOX, Law, rolling, sampled
from wspd_design.certificates.theorems.slip_band import approach
from wspd_design.certificates.theorems.slip_band.followed_plant import NUMBERS, State

SAMPLES, POINTS = 50, 40
SPREAD = 0.002  # of all numbers, about the nominal ones
MU0 = (0.08, 0.04)  # in the middle of two boxes


@pytest.fixture(scope="module")
def problem():
    return problem_of(1.0, rail=wd.load_rail("low-adhesion"))


def boxes_of(problem, mu0s):
    """Boxes about the nominal numbers, each with a friction of its own."""
    middle = np.array([[problem.nominal(name) for name in NUMBERS] for _ in mu0s])
    middle[:, NUMBERS.index("mu0")] = mu0s
    spread = np.zeros((len(mu0s), len(NUMBERS), len(NUMBERS)))
    spread[:, range(len(NUMBERS)), range(len(NUMBERS))] = SPREAD * middle
    return middle, spread


def course(problem, boxes):
    return approach.follow(problem.controller, problem.vehicle, problem.rail, boxes, problem.speeds[1])


def test_states_of_simulated_stops_are_enclosed_sample_by_sample(problem, monkeypatch):
    """With everything that the law remembers, in the words of the states."""
    monkeypatch.setattr(sampled_runs, "SUBSTEP", 4e-4)
    random, law = np.random.default_rng(3), Law(problem.controller, problem.slip)
    middle, _ = boxes_of(problem, MU0[1:])
    drawn = middle[0][:, None] * (1.0 + SPREAD * random.choice([-1.0, 1.0], (len(NUMBERS), POINTS)))
    points = dict(zip(NUMBERS, drawn, strict=True))
    points |= {name: np.full(POINTS, problem.nominal(name)) for name in BESIDE if name != "supply rate"}
    assert points.keys() == {*BOX, *BESIDE}
    runs = rolling(problem, law, points | {"speed": np.full(POINTS, problem.speeds[1])})
    pads, scale = runs.plant.max_torque / law.full, law.radius / runs.plant.wheel_radius
    slid = 0.0
    with np.errstate(all="ignore"):
        for top, state, _ in islice(course(problem, boxes_of(problem, MU0[1:])), SAMPLES):
            supply = -np.expm1(-runs.plant.supply_rate * runs.since)
            mean = law.pulses(runs.memory, runs.measured, runs.torque / pads, law.full * supply)[2]
            expected = runs.memory.observed + law.h / law.inertia * (runs.memory.friction - mean)
            before = runs
            runs, _, highest = sampled(law, runs)
            seen = State(
                speed=runs.speed,
                sliding=runs.speed - runs.plant.wheel_radius * runs.wheel,
                innovation=runs.plant.wheel_radius * (runs.wheel - expected),
                friction=before.memory.friction,
                torque=runs.torque / pads,
                acceleration=before.memory.acceleration / scale,
                change=runs.speed - before.speed,
                supply=-np.expm1(-runs.plant.supply_rate * runs.since),
            )
            for name, form, values in zip(State._fields, state, seen, strict=True):
                slack = 1e-6 * (1.0 + np.abs(values))
                assert np.all((form.low[0] - slack <= values) & (values <= form.high[0] + slack)), name
            assert np.all(highest <= top[0] + 1e-7)
            slid = max(slid, float(np.max(seen.sliding)))
    assert slid > 0.1
    # Not wider than what the numbers of the box make of it, many times.
    assert state.torque.radius[0] < 20.0 * np.ptp(seen.torque)


def test_boxes_that_are_left_out_are_not_mixed_up_with_those_that_go_on(problem):
    with np.errstate(all="ignore"):
        both, alone = (course(problem, boxes_of(problem, each)) for each in (MU0, MU0[1:]))
        first = [next(both) for _ in range(3)]
        assert first[-1][1].speed.center.shape == (2,)
        later = [both.send(np.array([False, True])), *islice(both, 15)]
        wanted = list(islice(alone, 19))
    for (top, state, _), (wanted_top, other, _) in zip([*first, *later], wanted, strict=True):
        assert top[-1] == pytest.approx(wanted_top[0])
        for one, same in zip(state, other, strict=True):
            assert (one.low[-1], one.high[-1]) == pytest.approx((same.low[0], same.high[0]))
