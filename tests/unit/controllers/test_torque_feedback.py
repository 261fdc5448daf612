"""The static law with torque feedback."""

import casadi
import numpy as np
import pytest

from wspd_design.controllers.protocol import Measurement
from wspd_design.controllers.torque_feedback import holding_torque
from wspd_design.model.slip import slip_dynamics
from wspd_design.simulation.records import Scenario
from wspd_design.simulation.runs import Ending
from wspd_design.simulation.stop import simulate


@pytest.fixture(scope="module")
def law(make_controller):
    return make_controller("torque-feedback", "polach-wet", sample_time=0.02)


def measured(law, *, speed=20.0, slip=0.14, torque=None):
    wheel = speed * (1.0 - slip) / law.vehicle.wheel_radius
    return Measurement(
        speed=speed, wheel_speed=wheel, torque=holding_torque(law, speed) if torque is None else torque
    )


def duty(law, measurement):
    state, command = law.step((), measurement)
    assert state == ()
    assert command.fill + command.vent == pytest.approx(1.0)
    return command.fill


def test_torque_that_holds_the_reference_is_an_equilibrium(law):
    torque = holding_torque(law, 20.0)
    plant = slip_dynamics(law.vehicle, law.rail, 0.14, 20.0)
    assert plant.drift + plant.gain * torque == pytest.approx(0.0, abs=1e-12)
    assert duty(law, measured(law)) == pytest.approx(torque / law.vehicle.brake.max_torque, rel=1e-9)


def test_slopes_are_the_gains(law):
    step, limit = 1e-4, law.vehicle.brake.max_torque
    by_slip = (duty(law, measured(law, slip=0.14 - step)) - duty(law, measured(law, slip=0.14 + step))) / (
        2.0 * step
    )
    assert by_slip == pytest.approx(law.gains.sliding_gain * 20.0, rel=1e-6)  # gain times train speed
    torque = holding_torque(law, 20.0)
    low, high = (duty(law, measured(law, torque=torque + sign * step * limit)) for sign in (-1.0, 1.0))
    assert (low - high) / (2.0 * step) == pytest.approx(law.gains.torque_gain, rel=1e-6)


def test_limits(law):
    assert duty(law, measured(law, slip=0.9)) == 0.0
    assert duty(law, measured(law, slip=0.0, torque=0.0)) == 1.0
    assert 0.0 <= duty(law, measured(law, speed=0.0, slip=0.0, torque=1e4)) <= 1.0


def test_step_can_be_traced(law):
    inputs = casadi.SX.sym("m", 3)
    _, command = law.step((), Measurement(*(inputs[i] for i in range(3))))
    traced = casadi.Function("step", [inputs], [command.fill])
    for speed, slip in ((33.0, 0.13), (5.0, 0.141), (0.05, 0.1)):
        measurement = measured(law, speed=speed, slip=slip)
        assert float(traced(np.array(measurement))) == pytest.approx(duty(law, measurement), abs=1e-12)


def test_holds_the_slip_on_the_papers_valve(er24pc, law):
    """Slip feedback alone limit-cycles there with an rms of .03 to .25."""
    scenario = Scenario(rail=law.rail, initial_speed=120.0 / 3.6)
    run = simulate(er24pc, law, scenario, plant="quarter")
    assert run.ending is Ending.STOPPED
    settled = (run.speed < 25.0) & (run.speed > 10.0 / 3.6)
    assert np.abs(run.slip[settled, 0] - 0.14).max() < 0.01
