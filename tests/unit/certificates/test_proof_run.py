"""The idealized run and the tools that judge a function along it."""

from dataclasses import replace

import flint
import numpy as np
import pytest

from wspd_design.certificates.checks.adaptive.ideal_weights import ideal
from wspd_design.certificates.checks.ideal_run import (
    ProofRun,
    adaptive_run,
    cut_short,
    largest_rise,
    numeric_rate,
    sliding_run,
)
from wspd_design.certificates.theorems.adaptive_error import signals
from wspd_design.certificates.theorems.ideal_loop import exact_rate
from wspd_design.controllers.protocol import Measurement
from wspd_design.controllers.sliding_mode import sliding_torque
from wspd_design.model.number import saturation
from wspd_design.parameters.loading import load_rail


def test_torque_is_what_the_controller_commands_within_the_limits(make_controller):
    law = make_controller("smc")
    compared = 0
    for speed in (5.0, 15.0, 30.0):
        for slip in np.linspace(0.02, 0.3, 29):
            wheel = speed * (1.0 - slip) / law.vehicle.wheel_radius
            _, command = law.step((0.01,), Measurement(speed=speed, wheel_speed=wheel, torque=0.0))
            torque = sliding_torque(law, slip, speed, 0.01)
            expected = np.clip(torque / law.vehicle.brake.max_torque, 0.0, 1.0)
            assert command.fill == pytest.approx(expected, abs=1e-9)
            compared += 0.0 < expected < 1.0
    assert compared > 10


def test_run_ends_at_the_lowest_speed_and_holds_the_slip(er24pc, make_controller):
    run = sliding_run(er24pc, load_rail("polach-dry"), make_controller("smc"), speeds=(3.0, 30.0), slip=0.3)
    assert run.speed[0] == 30.0
    assert run.slip[0] == 0.3
    assert run.speed[-1] == pytest.approx(3.0, abs=1e-6)
    assert run.slip[-1] == pytest.approx(0.14, abs=1e-3)
    assert run.integral[-1] == pytest.approx(np.trapezoid(0.14 - run.slip, run.time), abs=1e-3)


def test_rates_are_the_slopes_of_the_states(er24pc, printed_gains):
    run = adaptive_run(er24pc, load_rail("polach-wet"), printed_gains(), speeds=(20.0, 30.0))
    traveled = run.states[:, -1] - run.states[:, 0]
    assert np.trapezoid(run.rates, run.time, axis=1) == pytest.approx(traveled, rel=2e-3, abs=2e-3)


def test_bound_holds_along_the_run_and_is_not_wasteful(er24pc, printed_gains):
    rail, gains = load_rail("polach-dry"), printed_gains()
    run = adaptive_run(er24pc, rail, gains, speeds=(5.0, 30.0))
    target = ideal(er24pc, rail, gains, run, 0.4)
    at = signals(er24pc, rail, gains, run.states, target)
    reserve = 0.4 / (at.gain[0] * at.speed[0])
    assert np.abs(at.approximation_error).max() + reserve == pytest.approx(at.bound, rel=1e-9)


def test_numeric_rate_is_the_derivative_along_the_flow():
    time = np.linspace(0.0, 2.0, 40)
    states = np.array([np.cos(time), 1000.0 * np.exp(-5.0 * time)])
    run = ProofRun(time=time, states=states, rates=np.array([-np.sin(time), -5.0 * states[1]]))

    def product(x):
        return x[0] ** 2 * x[1]

    exact = (-2.0 * np.cos(time) * np.sin(time) - 5.0 * np.cos(time) ** 2) * states[1]
    assert numeric_rate(product, run) == pytest.approx(exact, rel=1e-6, abs=1e-6)


def test_exact_rate_is_the_derivative_along_the_flow():
    def flow(x):
        return [x[1], -4.0 * x[0]]

    rate = exact_rate(lambda x: x[0] ** 2 + abs(x[1]) + saturation(x[0]), flow, (0.3, -0.7))
    with flint.ctx.workprec(300):
        x, y = flint.arb(0.3), flint.arb(-0.7)
        exact = 2 * x * y - (-4 * x) + y
    assert rate.contains(exact)
    assert float(rate.rad()) < 1e-14


@pytest.mark.parametrize(
    ("values", "expected"),
    [
        ([5.0, 4.0, 3.0], (0.0, 0, 0)),
        ([5.0, 1.0, 2.0, 0.5, 3.0, 0.0], (2.5, 3, 4)),
        ([0.0, 1.0], (1.0, 0, 1)),
    ],
)
def test_largest_rise(values, expected):
    assert largest_rise(np.array(values)) == expected


def test_run_that_locks_is_cut_short(er24pc, make_controller):
    law = make_controller("smc")
    backwards = replace(law, gains=replace(law.gains, switching_gain=-30.0, slip_reference=0.1))
    run = sliding_run(er24pc, load_rail("polach-dry"), backwards, speeds=(3.0, 30.0), slip=0.3)
    assert "leaves the range" in run.cut
    assert run.cut in cut_short([run, run])
