"""Every run is repeated with half the steps; chaos is told apart from steps that are too long."""

from dataclasses import dataclass

import pytest

from wspd_design.controllers.protocol import Command
from wspd_design.parameters.loading import load_rail
from wspd_design.simulation import self_check
from wspd_design.simulation.records import Scenario
from wspd_design.simulation.self_check import simulate_checked, slip_difference
from wspd_design.simulation.stop import simulate

SPEED = 120.0 / 3.6


@pytest.mark.parametrize("rail", ["table10-dry", "table10-wet", "polach-dry", "polach-wet"])
@pytest.mark.parametrize("name", ["afsmc", "trenitalia", "knorr-bremse", "none"])
def test_steps_are_short_enough(er24pc, make_controller, name, rail):
    _, check = simulate_checked(
        er24pc, make_controller(name), Scenario(rail=load_rail(rail), initial_speed=SPEED)
    )
    assert check.passed
    assert not check.chaotic
    assert check.distance <= 1e-6
    assert check.slip <= 1e-4


def test_a_chaotic_loop_says_so_and_gives_a_spread(er24pc, make_controller):
    scenario = Scenario(rail=load_rail("polach-dry"), initial_speed=SPEED)
    run, check = simulate_checked(er24pc, make_controller("mitsubishi"), scenario)
    assert check.chaotic
    assert not check.passed
    assert 0.01 < check.spread < 0.1 * run.totals.distance


@dataclass(frozen=True)
class OnTheGrid:
    """A law whose pulses are rounded to a grid, as a simulation without edge alignment would do."""

    inner: object
    grid: float
    name: str = "on the grid"
    sample_time: float = 0.1

    def start(self, measurement):
        return self.inner.start(measurement)

    def step(self, state, measurement):
        state, command = self.inner.step(state, measurement)
        share = self.grid / self.sample_time
        return state, Command(*(round(float(x) / share) * share for x in command))


@pytest.mark.filterwarnings("ignore:controller on the grid")
def test_a_run_that_is_not_aligned_with_the_valve_edges_fails(er24pc, make_controller):
    """Edges on a grid of 1 ms against 0.5 ms differ by far more than the check allows."""
    scenario = Scenario(rail=load_rail("polach-wet"), initial_speed=SPEED)
    coarse, fine = (
        simulate(er24pc, OnTheGrid(make_controller("smc", "polach-wet"), grid), scenario)
        for grid in (1e-3, 5e-4)
    )
    assert abs(fine.totals.distance / coarse.totals.distance - 1.0) > 10 * self_check.DISTANCE_TOLERANCE
    assert slip_difference(er24pc, coarse, fine) > 10 * self_check.SLIP_TOLERANCE


def test_steps_that_are_too_long_are_refined(er24pc, make_controller, monkeypatch):
    scenario = Scenario(rail=load_rail("table10-dry"), initial_speed=SPEED)
    law = make_controller("smc", "table10-dry")
    monkeypatch.setattr("wspd_design.simulation.loop_input.LONGEST_STEP", 2e-3)
    _, check = simulate_checked(er24pc, law, scenario)
    assert check.passed
    assert check.refinement > 1
    monkeypatch.setattr("wspd_design.simulation.loop_input.LONGEST_STEP", 8e-3)
    _, check = simulate_checked(er24pc, law, scenario)
    assert not check.passed
    assert not check.chaotic  # the steps are too long, which is no fault of the loop
