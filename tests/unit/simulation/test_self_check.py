"""Every run is repeated with half the steps; sensitive loops are told apart from steps that are too long."""

from dataclasses import dataclass
from itertools import product

import pytest

from wspd_design.controllers.protocol import Command
from wspd_design.parameters.loading import load_rail
from wspd_design.simulation import self_check
from wspd_design.simulation.records import Scenario
from wspd_design.simulation.self_check import simulate_checked, slip_difference
from wspd_design.simulation.stop import simulate

SPEED = 120.0 / 3.6
LAWS = (
    "afsmc",
    "afsmc-repaired",
    "smc",
    "trenitalia",
    "knorr-bremse",
    "mitsubishi",
    "none",
    "torque-feedback",
)
RAILS = ("table10-dry", "table10-wet", "polach-dry", "polach-wet")
SENSITIVE = {
    ("smc", "polach-wet"),
    ("trenitalia", "polach-wet"),
    ("knorr-bremse", "polach-wet"),
    ("mitsubishi", "polach-wet"),
    ("mitsubishi", "polach-dry"),
    ("mitsubishi", "table10-wet"),
}
"""On four axles a millionth of the initial speed moves the distance by a millionth of its own many times over, or the
slip by more than 0.01; on every other rail these laws stay within a half of that."""


@pytest.fixture(scope="module")
def checked(er24pc, make_controller):
    def check(name, rail):
        scenario = Scenario(rail=load_rail(rail), initial_speed=SPEED)
        return simulate_checked(er24pc, make_controller(name, rail), scenario)

    return check


SLOW = {("torque-feedback", "table10-dry"), ("torque-feedback", "polach-dry")}  # to design


@pytest.mark.parametrize(
    ("name", "rail"),
    [pytest.param(*case, marks=pytest.mark.slow if case in SLOW else ()) for case in product(LAWS, RAILS)],
)
def test_every_stop_is_resolved_with_two_refinements_or_sensitive(checked, name, rail):
    run, check = checked(name, rail)
    assert check.sensitive == ((name, rail) in SENSITIVE)
    assert (check.spread > 0.0) == check.sensitive
    assert check.spread < 0.1 * run.totals.distance
    if not check.sensitive:
        assert not check.unresolved
        assert check.distance <= 1e-6
        assert check.slip <= 1e-4
        assert check.refinement <= 4


def test_a_sensitive_stop_may_be_resolved_or_not(checked):
    # Steps are short enough for this very run, though its neighbours end elsewhere.
    _, resolved = checked("trenitalia", "polach-wet")
    assert (resolved.sensitive, resolved.unresolved) == (True, False)
    _, lost = checked("mitsubishi", "polach-dry")
    assert (lost.sensitive, lost.unresolved) == (True, True)


def test_the_demo_passes_at_100_hertz(er24pc, make_controller):
    scenario = Scenario(rail=load_rail("polach-wet"), initial_speed=SPEED)
    _, check = simulate_checked(er24pc, make_controller("afsmc", "polach-wet", sample_time=0.01), scenario)
    assert not check.unresolved
    assert check.refinement <= 4


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


def test_steps_that_are_too_long_are_refined_or_unresolved(er24pc, make_controller, monkeypatch):
    # A quick law on the rail where friction falls: its errors fall with the steps.
    scenario = Scenario(rail=load_rail("table10-dry"), initial_speed=SPEED)
    law = make_controller("smc", "table10-dry")
    _, check = simulate_checked(er24pc, law, scenario)
    assert (check.unresolved, check.sensitive) == (False, False)
    assert check.refinement > 1
    monkeypatch.setattr("wspd_design.simulation.loop_input.LONGEST_STEP", 20e-3)
    monkeypatch.setattr(self_check, "REFINEMENTS", (1, 2))
    _, check = simulate_checked(er24pc, law, scenario)
    assert check.unresolved
    assert not check.sensitive  # the steps are too long, which is no fault of the loop


@pytest.mark.filterwarnings("ignore:.*faster than trains run")
def test_the_start_of_the_fastest_train_has_neighbours(er24pc, make_controller):
    scenario = Scenario(rail=load_rail("table10-dry"), initial_speed=149.99999)
    _, check = simulate_checked(er24pc, make_controller("none"), scenario)
    assert check.spread == 0.0
