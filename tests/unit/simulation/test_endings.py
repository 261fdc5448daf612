"""How a stop ends: standstill, time limit, and controllers that command what no valve can do."""

import math
import time
from dataclasses import dataclass, replace

import numpy as np
import pytest

from wspd_design.controllers.protocol import Command
from wspd_design.model.number import where
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import constants, load_rail
from wspd_design.simulation import ideal
from wspd_design.simulation import loop_input as module
from wspd_design.simulation.campaign import simulate_many
from wspd_design.simulation.metrics import metrics
from wspd_design.simulation.records import Scenario
from wspd_design.simulation.runaway import runs_away
from wspd_design.simulation.runs import Ending
from wspd_design.simulation.self_check import simulate_checked
from wspd_design.simulation.stop import simulate


@dataclass(frozen=True)
class Constant:
    """Always the same command, from a given time on; hold before."""

    command: Command
    since: float = 0.0
    name: str = "constant"
    sample_time: float = 0.1

    def start(self, measurement):  # noqa: ARG002
        return (0.0,)

    def step(self, state, measurement):  # noqa: ARG002
        acting = state[0] > self.since - 1e-9
        return (state[0] + self.sample_time,), Command(*(where(acting, share, 0.0) for share in self.command))


@pytest.mark.parametrize("name", ["afsmc", "trenitalia", "none"])
@pytest.mark.parametrize("rail", ["table10-dry", "polach-wet"])
def test_a_stop_ends_at_the_stop_speed(stop, name, rail):
    run = stop(name, rail)
    assert run.ending is Ending.STOPPED
    assert run.speed[-1] == pytest.approx(constants().stop_speed, rel=1e-4)
    assert (np.diff(run.time) > 0.0).all()
    assert (np.diff(run.speed) < 0.0).all()
    assert run.distance[-1] == run.totals.distance
    assert (run.initial_speed, run.speed[0]) == (120.0 / 3.6, 120.0 / 3.6)


def test_a_train_that_never_stops_ends_at_the_time_limit(er24pc, monkeypatch):
    # A controller that never fills, a slippery rail and no resistance.
    free = replace(
        er24pc, resistance_constant=0.0, resistance_linear=0.0, resistance_quadratic=0.0, wheel_damping=0.0
    )
    limited = replace(constants(), time_limit=5.0)
    monkeypatch.setattr(module, "constants", lambda: limited)
    started = time.process_time()
    scenario = Scenario(rail=load_rail("low-adhesion"), initial_speed=20.0)
    run = simulate(free, Constant(Command(0.0, 0.0)), scenario, plant="quarter")
    assert time.process_time() - started < 5.0
    assert run.ending is Ending.TIME_LIMIT
    assert 5.0 < run.time[-1] < 5.2
    assert run.speed[-1] == pytest.approx(20.0, rel=1e-12)
    judged = metrics(run, free, scenario, slip_reference=0.14)
    assert math.isnan(judged.lag)
    assert math.isnan(judged.plateau)
    assert judged.distance == pytest.approx(20.0 * run.time[-1], rel=1e-12)
    assert "time limit" in run.ending.value
    assert "brake torque" in run.ending.value  # the remedy


@pytest.mark.parametrize(
    "command",
    [
        (1.2, 0.0),
        (0.0, 1.2),
        (-0.1, 0.0),
        (0.0, -1e-3),
        (0.7, 0.6),
        (math.nan, 0.0),
        (0.3, math.nan),
        (math.inf, 0.0),
    ],
)
def test_impossible_commands_are_refused(er24pc, command):
    scenario = Scenario(rail=load_rail("polach-dry"), initial_speed=20.0)
    with pytest.raises(
        UserError, match=r"controller constant commanded fill = .* at t = 0\.300 s.*limit the command"
    ):
        simulate(er24pc, Constant(Command(*command), since=0.3), scenario, plant="quarter")


@pytest.mark.parametrize("speed", [0.0, -5.0, math.nan, math.inf, 151.0])
def test_impossible_initial_speeds_are_refused(speed):
    with pytest.raises(UserError, match=r"initial speed = .* must be above 0 and below 150 m/s"):
        Scenario(rail=load_rail("polach-dry"), initial_speed=speed)


def test_initial_speed_in_kmh():
    assert Scenario.stop(from_kmh=120, rail=load_rail("polach-dry")).initial_speed == pytest.approx(
        33.3333333
    )


@pytest.mark.parametrize("period", [0.02, 0.1, 0.25])
def test_sampling_instants(er24pc, make_controller, period):
    scenario = Scenario(rail=load_rail("table10-wet"), initial_speed=12.0)
    run = simulate(er24pc, make_controller("afsmc", sample_time=period), scenario, plant="quarter")
    np.testing.assert_allclose([s.time for s in run.samples], period * np.arange(len(run.samples)), atol=1e-9)
    assert len(run.samples) == math.ceil(run.time[-1] / period)
    assert run.sample_time == period


@pytest.mark.parametrize("speed", [0.005, 0.01 / 3.6, 1e-9])
@pytest.mark.parametrize("plant", ["quarter", "planar"])
def test_a_start_below_the_stop_speed_is_at_rest_at_once(er24pc, make_controller, plant, speed):
    scenario = Scenario(rail=load_rail("polach-wet"), initial_speed=speed)
    run, check = simulate_checked(er24pc, make_controller("afsmc"), scenario, plant=plant)
    assert run.ending is Ending.STOPPED
    assert (run.totals.distance, run.totals.torque, run.time.tolist(), run.samples) == (0.0, 0.0, [0.0], ())
    assert (check.distance, check.spread, check.refinement) == (0.0, 0.0, 1)
    judged = metrics(run, er24pc, scenario, slip_reference=0.14)
    assert (judged.momentum_residual, judged.energy_residual, judged.ideal_stop) == (0.0, 0.0, 0.0)
    for figure in (judged.efficiency, judged.lag, judged.plateau, judged.adhesion_utilization):
        assert math.isnan(figure)
    table = simulate_many(er24pc, make_controller("afsmc"), scenario, count=3, plant=plant).table
    assert table["stopped"].all()
    assert (table["distance_m"] == 0.0).all()


def test_a_start_above_the_stop_speed_moves(er24pc, make_controller):
    scenario = Scenario(rail=load_rail("polach-wet"), initial_speed=0.006)
    run = simulate(er24pc, make_controller("none"), scenario)
    assert 0.0 < run.totals.distance <= 0.006 * run.time[-1]


SLIPPERY = Scenario(rail=load_rail("low-adhesion"), initial_speed=60.0 / 3.6, grade=-0.08)


def test_a_train_that_cannot_stop_is_told_at_once(er24pc, make_controller):
    run, check = simulate_checked(er24pc, make_controller("none"), SLIPPERY, plant="quarter")
    assert run.ending is Ending.RUNAWAY
    assert run.time[-1] < 10.2
    assert not check.unresolved
    judged = metrics(run, er24pc, SLIPPERY, slip_reference=0.14)
    assert judged.ideal_ending is Ending.RUNAWAY
    assert math.isnan(judged.ideal_stop)
    assert "no brake can stop this train" in run.ending.value


def test_who_runs_away_gains_speed_even_at_the_best_slip(er24pc, monkeypatch):
    # The grade that decides lies where the ideal brake just does not slow the train: searched, and simulated.
    low, high = -0.1, -0.05
    for _ in range(30):
        middle = 0.5 * (low + high)
        gone = runs_away(er24pc, replace(SLIPPERY, grade=middle))
        low, high = (middle, high) if gone else (low, middle)
    for grade, stops in ((low, False), (high + 0.004, True)):
        monkeypatch.setattr(ideal, "runs_away", lambda *_: False)
        monkeypatch.setattr(module, "runs_away", lambda *_: False)
        ideal.ideal_stop.cache_clear()
        found = ideal.ideal_stop(er24pc, replace(SLIPPERY, grade=grade), plant="quarter")
        assert (found.ending is Ending.STOPPED) == stops
    assert not runs_away(er24pc, replace(SLIPPERY, grade=0.08))
    assert not runs_away(er24pc, replace(SLIPPERY, grade=0.0))
