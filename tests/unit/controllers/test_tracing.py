"""Every step function can be traced by CasADi and then computes what it computes in Python."""

from dataclasses import replace

import casadi
import numpy as np
import pytest

from wspd_design.controllers.protocol import Measurement
from wspd_design.parameters.loading import load_rail
from wspd_design.simulation.records import Scenario
from wspd_design.simulation.stop import simulate

CONTROLLERS = ("afsmc", "afsmc-repaired", "smc", "trenitalia", "knorr-bremse", "mitsubishi", "none")


class Recorder:
    """A controller that keeps what it is asked and what it answers."""

    def __init__(self, controller):
        self.controller, self.calls = controller, []
        self.name, self.sample_time = controller.name, controller.sample_time

    def start(self, measurement):
        return self.controller.start(measurement)

    def step(self, state, measurement):
        answer = self.controller.step(state, measurement)
        self.calls.append((state, measurement, answer))
        return answer


def traced(controller):
    """Trace ``step`` into (state, measurement) -> (state, command)."""
    state = casadi.SX.sym("state", len(controller.start(Measurement(10.0, 10.0, 0.0))))
    measurement = casadi.SX.sym("measurement", 3)
    following, command = controller.step(
        tuple(state[i] for i in range(state.numel())), Measurement(*(measurement[i] for i in range(3)))
    )
    outputs = [casadi.vertcat(casadi.SX(0, 1), *following), casadi.vertcat(*(casadi.SX(x) for x in command))]
    return casadi.Function("step", [state, measurement], outputs)


def largest_difference(controller, calls):
    function, worst = traced(controller), 0.0
    for state, measurement, (following, command) in calls:
        got = [np.array(x).ravel() for x in function(np.array(state), np.array(measurement))]
        for values, expected in zip(got, (following, command), strict=True):
            scale = np.maximum(1.0, np.abs(expected))
            worst = max(worst, *(np.abs(values - expected) / scale), 0.0)
    return worst


@pytest.fixture(scope="module")
def recorded(er24pc, make_controller):
    def record(name, rail="polach-wet"):
        recorder = Recorder(make_controller(name, rail))
        simulate(er24pc, recorder, Scenario(rail=load_rail(rail), initial_speed=80.0 / 3.6))
        return recorder

    return record


@pytest.mark.parametrize("name", CONTROLLERS)
def test_traced_step_equals_python_along_a_run(recorded, name):
    recorder = recorded(name)
    assert len(recorder.calls) > 60
    assert largest_difference(recorder.controller, recorder.calls) < 1e-12


def test_another_controller_is_seen(recorded):
    recorder = recorded("trenitalia")
    table = replace(recorder.controller.table, upper_speed_ratio=0.93)
    assert largest_difference(replace(recorder.controller, table=table), recorder.calls) > 1e-3
