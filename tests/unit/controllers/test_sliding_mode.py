"""The sliding-mode law (21)-(26): equivalent torque, switching torque, limits."""

from dataclasses import replace

import pytest

from wspd_design.analysis.linearization import linearize
from wspd_design.controllers.protocol import Measurement
from wspd_design.controllers.sliding_mode import SlidingMode, SlidingModeGains
from wspd_design.parameters.loading import load_rail

RADIUS, PERIOD = 0.55, 0.1
GAINS = SlidingModeGains(slip_reference=0.14, surface_rate=0.4, switching_gain=2.0, boundary_layer=0.02)


@pytest.fixture
def controller(er24pc):
    rail = load_rail("polach-wet")
    return SlidingMode(name="smc", sample_time=PERIOD, vehicle=er24pc, rail=rail, gains=GAINS)


def measured(slip, speed):
    return Measurement(speed=speed, wheel_speed=(1.0 - slip) * speed / RADIUS, torque=0.0)


@pytest.mark.parametrize("speed", [30.0, 12.0, 3.0])
def test_on_the_surface_it_commands_the_equilibrium(er24pc, controller, speed):
    state, command = controller.step((0.0,), measured(0.14, speed))
    point = linearize(er24pc, load_rail("polach-wet"), slip=0.14, speed=speed)
    assert command.fill == pytest.approx(point.equilibrium_duty, rel=1e-12)
    assert command.vent == pytest.approx(1.0 - command.fill)
    assert state == (pytest.approx(0.0, abs=1e-15),)


@pytest.mark.parametrize("integral", [0.001, -0.004, 0.3, -0.3])
def test_switching_torque_of_23(er24pc, controller, integral):
    # At e = 0 the surface is c times the integral; W0/v sat(s/Phi)/G = W0 sat(s/Phi) 2 I/R in torque.
    speed = 15.0
    duty = controller.step((integral,), measured(0.14, speed))[1].fill
    point = linearize(er24pc, load_rail("polach-wet"), slip=0.14, speed=speed)
    saturated = min(max(0.4 * integral / 0.02, -1.0), 1.0)
    torque = 2.0 * saturated * er24pc.wheelset_inertia / RADIUS
    assert duty == pytest.approx(point.equilibrium_duty + torque / 60e3, rel=1e-12)
    assert 0.0 < duty < 1.0


def test_error_enters_the_equivalent_torque_with_c(er24pc, controller):
    # Corrected (23): G u_eq = -F + c e; the printed form has the slip in place of the error.
    speed, slip = 15.0, 0.12
    integral = -0.02 / 0.4  # puts s at zero
    duty = controller.step((integral,), measured(slip, speed))[1].fill
    point = linearize(er24pc, load_rail("polach-wet"), slip=slip, speed=speed)
    assert duty == pytest.approx(point.equilibrium_duty + 0.4 * 0.02 / point.gain / 60e3, rel=1e-12)


def test_integral_is_one_euler_step(controller):
    state, _ = controller.step((0.02,), measured(0.04, 10.0))
    assert state == (pytest.approx(0.02 + PERIOD * 0.10),)


@pytest.mark.parametrize(("slip", "integral", "duty"), [(0.0, 1.0, 1.0), (1.0, -9.0, 0.0)])
def test_command_is_limited_to_the_brake(controller, slip, integral, duty):
    strong = replace(controller, gains=replace(GAINS, switching_gain=50.0))
    assert tuple(strong.step((integral,), measured(slip, 10.0))[1]) == (duty, 1.0 - duty)


def test_it_stays_finite_at_standstill(controller):
    state, command = controller.step((0.0,), Measurement(speed=0.0, wheel_speed=0.0, torque=0.0))
    assert 0.0 <= command.fill <= 1.0
    assert state == (pytest.approx(PERIOD * 0.14),)
