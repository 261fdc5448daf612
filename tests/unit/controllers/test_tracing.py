"""Every step function can be traced by CasADi and compiled, and computes what it computes in Python."""

from dataclasses import replace

import casadi
import numpy as np
import pytest

from wspd_design.controllers.protocol import Measurement

CONTROLLERS = (
    "afsmc",
    "afsmc-repaired",
    "smc",
    "torque-feedback",
    "trenitalia",
    "knorr-bremse",
    "mitsubishi",
    "none",
)


def traced(controller):
    """Trace ``step`` into (state, measurement) -> (state, command)."""
    state = casadi.SX.sym("state", len(controller.start(Measurement(10.0, 10.0, 0.0))))
    measurement = casadi.SX.sym("measurement", 3)
    following, command = controller.step(
        tuple(state[i] for i in range(state.numel())), Measurement(*(measurement[i] for i in range(3)))
    )
    outputs = [casadi.vertcat(casadi.SX(0, 1), *following), casadi.vertcat(*(casadi.SX(x) for x in command))]
    return casadi.Function("step", [state, measurement], outputs)


def difference(values, expected):
    """Largest difference, relative to what is larger than one."""
    values, expected = np.asarray(values, dtype=float), np.asarray(expected, dtype=float)
    return np.max(np.abs(values - expected) / np.maximum(1.0, np.abs(expected)), initial=0.0)


def largest_differences(controller, samples):
    """Largest difference of the compiled loop's steps, and of CasADi's, from those in Python."""
    function, compiled, traced_only = traced(controller), 0.0, 0.0
    state = controller.start(samples[0].seen)
    for sample in samples:
        following, command = controller.step(state, sample.seen)
        compiled = max(
            compiled, difference((*sample.state, sample.fill, sample.vent), (*following, *command))
        )
        got = [np.array(x).ravel() for x in function(np.array(state), np.array(sample.seen))]
        traced_only = max(traced_only, difference(np.concatenate(got), (*following, *command)))
        state = sample.state
    return compiled, traced_only


@pytest.mark.parametrize("rail", ["polach-wet", "table10-dry"])
@pytest.mark.parametrize("name", CONTROLLERS)
def test_traced_and_compiled_steps_equal_python_along_a_run(make_controller, stop, name, rail):
    samples = stop(name, rail).samples
    assert len(samples) > 90
    compiled, traced_only = largest_differences(make_controller(name, rail), samples)
    assert traced_only < 1e-12
    assert compiled < 1e-12


def test_another_controller_is_seen(make_controller, stop):
    controller = make_controller("trenitalia")
    other = replace(controller, table=replace(controller.table, fill_pulse=0.961))
    compiled, _ = largest_differences(other, stop("trenitalia", "polach-wet").samples)
    assert compiled > 1e-4
