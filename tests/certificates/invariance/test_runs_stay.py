"""Simulated stops that start inside proved sets, or come into them, never leave."""

import math
from dataclasses import replace

import numpy as np
import pytest

from tests.certificates.invariance.loops import check, drawn, feedback_problem, one_sample
from wspd_design.certificates.search.invariant_sets import document
from wspd_design.certificates.search.invariant_sets.search import search
from wspd_design.simulation.records import Scenario
from wspd_design.simulation.stop import simulate


def member(problem, found, slip, torque, speed):
    """Whether a state is in the set of a window that holds its speed; None below the lowest window."""
    answers = []
    for each in found:
        window, cells = each.cells.window, each.cells
        if window.low <= speed <= window.high:
            level = torque / problem.vehicle.brake.max_torque + window.tilt * (slip - problem.slip)
            i = math.floor(slip * cells.per_unit) - cells.first[0]
            j = math.floor(level * cells.per_unit) - cells.first[1]
            shape = cells.members.shape
            answers.append(0 <= i < shape[0] and 0 <= j < shape[1] and bool(cells.members[i, j]))
    return any(answers) if answers else None


def start(problem, found, rng):
    """A state inside the fastest set, as often as not in a corner of it."""
    cells = found[-1].cells
    states = np.argwhere(found[-1].states)
    i, j = states[rng.choice([0, -1, rng.integers(len(states))])]
    slip = (i + cells.first[0] + rng.random()) / cells.per_unit
    level = (j + cells.first[1] + rng.random()) / cells.per_unit
    share = level - cells.window.tilt * (slip - problem.slip)
    return slip, min(max(share, 0.0), 1.0) * problem.vehicle.brake.max_torque


def runs(problem, found, bounds, count, *, seed=0):
    """Count the runs that leave; also check the slip between the samples."""
    rng = np.random.default_rng(seed)
    left = 0
    for _ in range(count):
        plant, speed = drawn(problem, rng), problem.speeds[1]
        slip, torque = start(problem, found, rng)
        if not member(problem, found, slip, torque, speed):
            continue  # the torque was cut to what the brake has
        while True:
            slip, torque, speed, low, high = one_sample(problem, plant, slip, torque, speed)
            inside = member(problem, found, slip, torque, speed)
            if inside is None:
                break
            if not (inside and bounds[0] - 1e-9 <= low and high <= bounds[1] + 1e-9):
                left += 1
                break
    return left


def test_runs_stay_in_proved_sets(problem, found, written):
    verdict = check(problem, written)
    assert verdict.accepted
    assert runs(problem, found, verdict.slips, 8) == 0


def test_runs_leave_sets_that_are_too_large(problem, found):
    """The same comparison sees a set that was made larger by what the search removed."""
    larger = [
        replace(each, cells=replace(each.cells, members=np.roll(each.cells.members, 25, axis=0)))
        for each in found
    ]
    assert runs(problem, larger, (0.0, 1.0), 8) > 0


@pytest.fixture(scope="module")
def held():
    """A problem with its sets, which the checker accepts."""
    problem = feedback_problem(spread=0.02, speeds=(9.0, 12.0))
    found = search(problem, most_work=math.inf)
    verdict = check(problem, document.write(problem, found))
    assert verdict.accepted, verdict.reason
    return problem, found, verdict.slips


@pytest.mark.parametrize("seed", [1, 2])
def test_the_simulated_stop_stays(seed, held):
    """The program's own simulation begins at rolling; from its first sample in a set on it stays."""
    problem, found, slips = held
    vehicle, rail = drawn(problem, np.random.default_rng(seed))
    # The sets assume full supply pressure.
    vehicle = replace(vehicle, brake=replace(vehicle.brake, supply_rate=200.0))
    run = simulate(vehicle, problem.controller, Scenario.stop(from_kmh=60.0, rail=rail), plant="quarter")
    entered = None
    for sample in run.axle_samples[0]:
        seen = sample.seen
        slip = 1.0 - vehicle.wheel_radius * seen.wheel_speed / seen.speed
        inside = member(problem, found, slip, seen.torque, seen.speed)
        if inside is None:
            continue
        entered = sample.time if entered is None and inside else entered
        assert entered is None or inside
    assert entered is not None
    during = (run.time >= entered) & (run.speed >= 9.0)
    assert during.sum() > 100
    assert run.slip[during].min() >= slips[0] - 1e-6
    assert run.slip[during].max() <= slips[1] + 1e-6
