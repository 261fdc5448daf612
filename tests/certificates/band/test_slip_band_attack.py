"""Starts on the boundary of the proved ellipsoids and stops from rolling, with a plant and a law of their own."""

from dataclasses import replace

import numpy as np
import pytest

import wspd_design as wd
from tests.certificates.band.band_attack import attack_boundary, box, follow, sets_of
from tests.certificates.band.sampled_runs import BESIDE, BOX, Law, rolling, sampled
from wspd_design.certificates.setting.plant import plant_with
from wspd_design.certificates.theorems.band import CELLS

pytestmark = pytest.mark.slow
STARTS, STOPS = 2000, 100


@pytest.fixture(scope="module")
def sets(half, proved):
    finding = proved.findings[CELLS]
    return sets_of(half, finding.stated.proof, finding.numbers)


@pytest.fixture(scope="module")
def stops(half, sets):
    """Stops from rolling, half of the numbers at their ends."""
    random = np.random.default_rng(11)
    ends = box(half, sets) | {"speed": (20.0, half.speeds[1])}
    even = random.random((len(ends), STOPS))
    unit = np.where(random.random(even.shape) < 0.5, np.round(even), even)
    return {name: low + (high - low) * u for (name, (low, high)), u in zip(ends.items(), unit, strict=True)}


def stopped(problem, sets, points):
    law = Law(problem.controller, problem.slip)
    with np.errstate(all="ignore"):
        return follow(law, sets, rolling(problem, law, points), samples=5000)


def test_no_start_on_the_boundary_leaves(half, sets):
    seen = attack_boundary(half, sets, starts=STARTS)
    assert seen.entered.all()
    assert not seen.left.any()


def test_stops_from_rolling_enter_and_stay(half, sets, stops):
    seen = stopped(half, sets, stops)
    assert seen.entered.all()
    assert not seen.left.any()
    assert 0.14 < seen.way_in.max() < 0.143


def test_sets_that_are_too_small_are_left(half, sets):
    """The attack can tell: a part of each ellipsoid is left, one about centers that stay, and .4 of the band."""
    smaller = replace(sets, matrices=400.0 * sets.matrices)
    assert attack_boundary(half, smaller, starts=200).left.any()
    still = replace(sets, matrices=25.0 * sets.matrices, moves=0.0 * sets.moves)
    assert attack_boundary(half, still, starts=200).left.any()
    narrower = replace(sets, bands=0.4 * sets.bands)
    assert attack_boundary(half, narrower, starts=200).left.any()


def test_a_state_outside_is_seen_outside(half, sets):
    seen = attack_boundary(half, sets, starts=200, larger=2.0, samples=1)
    assert not seen.entered.any()
    starved = replace(sets, supplies=sets.supplies + 1.0)  # more than there is: nothing is said there
    assert not attack_boundary(half, starved, starts=200, samples=1).entered.any()


def test_a_law_that_drives_the_valve_too_far_leaves(half, sets):
    """The proof is about the valve times of the law: with the nominal ones in their place runs leave."""
    law = half.controller
    valve = replace(law.valve, time_share=1.0)
    hasty = replace(law, valve=valve, observer_rate=3.0 * law.observer_rate)
    assert attack_boundary(replace(half, controller=hasty), sets, starts=200).left.any()


def test_stops_agree_with_the_package(half):
    """Plant and law of the attack against the simulated stop, in two corners of the box."""
    law = Law(half.controller, half.slip)
    for end in (0, 1):
        numbers = {name: half.span(name)[end] for name in (*BOX, *BESIDE)}
        points = {name: np.array([number]) for name, number in (numbers | {"speed": 30.0}).items()}
        runs, slips = rolling(half, law, points), []
        for _ in range(round(3.0 / law.h)):
            runs, _, _ = sampled(law, runs)
            slips.append(float((1.0 - runs.plant.wheel_radius * runs.wheel / runs.speed)[0]))
        vehicle, rail = plant_with(half, numbers)
        run = wd.simulate(
            vehicle, half.controller, wd.Scenario(rail=rail, initial_speed=30.0), plant="quarter"
        )
        simulated = np.interp(law.h * np.arange(1, len(slips) + 1), run.time, run.slip[:, 0])
        assert max(slips) > 0.13
        assert np.max(np.abs(np.array(slips) - simulated)) < 1e-3
