"""The dead band of a law that asks for a torque lets no wheel lock, however poor the rail."""

from dataclasses import replace

import pytest

from wspd_design.controllers.observers.sensors import Sensors
from wspd_design.controllers.wheel_law import WheelView
from wspd_design.design.records import Specification
from wspd_design.design.selection import named_design
from wspd_design.parameters.loading import load_rail


@pytest.fixture
def tracking(er24pc):
    rail = load_rail("very-low")
    specification = Specification(sensors=Sensors(), sample_time=0.02)
    return named_design("observer-smc", er24pc, rail, specification).build(er24pc, rail).core.tracking


def view(torque, slip):
    """See a wheel on a very poor rail at 20 m/s."""
    speed, desired, radius = 20.0, 0.04, 0.55
    return WheelView(
        speed=speed,
        acceleration=-0.2,
        wheel_speed=(1.0 - slip) * speed / radius,
        rolling_speed=speed / radius,
        desired_speed=(1.0 - desired) * speed / radius,
        desired_acceleration=-0.3,
        friction_torque=1.3e3,
        torque=torque,
        available=60e3,
        full_torque=60e3,
    )


@pytest.mark.parametrize("torque", [400.0, 1.7e3, 5e3])
def test_a_wheel_that_goes_to_lock_is_vented(tracking, torque):
    assert tracking.dead_band > 1.7e3  # the band alone would hold it
    assert tracking.command(view(torque, slip=0.5), target=-2e4).vent > 0.0


def test_the_band_rests_the_valve_about_a_torque_that_brakes_well(tracking):
    command = tracking.command(view(2e4, slip=0.04), target=2e4 + 500.0)
    assert command.fill == command.vent == 0.0
    assert replace(tracking, dead_band=0.0).command(view(2e4, slip=0.04), target=2e4 + 500.0).fill > 0.0
