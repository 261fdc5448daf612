"""The inversion of the valve against the valve itself, and against faults that are planted in it."""

from dataclasses import replace

import pytest

from wspd_design.controllers.protocol import Command
from wspd_design.controllers.valve_inversion import ValveInversion
from wspd_design.model.brake import braking_torque, pattern_pressure
from wspd_design.parameters.loading import load_vehicle

FULL, PERIOD = 60e3, 0.02


@pytest.fixture
def brake(er24pc):
    # Without build-up: the demanded pressure is the full one.
    return replace(
        er24pc.brake, fill_time=0.5, vent_time=0.8, build_up="electro-pneumatic", build_up_ramp=1e-6
    )


def inversion(brake, **changes):
    return ValveInversion(
        **({"brake": brake, "sample_time": PERIOD, "time_share": 1.0, "least_pulse": 0.0} | changes)
    )


def valve(brake, command, torque, at=10.0):
    """Torques at the end of a sample and in its mean, from the pressures of the plant."""
    start = torque / brake.max_torque * brake.max_pressure
    ends = at + command.fill * PERIOD, at + (command.fill + command.vent) * PERIOD
    pattern = (at, start, *ends, brake.max_pressure)
    count = 4000
    times = [at + PERIOD * (k + 0.5) / count for k in range(count)]
    torques = [braking_torque(brake, pattern_pressure(brake, t, pattern)[0]) for t in times]
    last = braking_torque(brake, pattern_pressure(brake, at + PERIOD, pattern)[0])
    return last, sum(torques) / count


@pytest.mark.parametrize(("torque", "target"), [(20e3, 20.8e3), (20e3, 19.6e3), (50e3, 50.2e3), (5e3, 4.9e3)])
def test_the_pulse_leads_to_the_wanted_torque(brake, torque, target):
    command = inversion(brake).command(torque, target, FULL, 0.0, FULL)
    reached, mean = valve(brake, command, torque)
    assert reached == pytest.approx(target, abs=1.0)
    assert inversion(brake).after(command, torque, FULL, FULL) == pytest.approx((reached, mean), rel=1e-6)


@pytest.mark.parametrize(
    "command", [Command(1.0, 0.0), Command(0.3, 0.5), Command(0.0, 1.0), Command(0.0, 0.0)]
)
def test_torque_after_any_command(brake, command):
    assert inversion(brake).after(command, 2e4, FULL, FULL) == pytest.approx(
        valve(brake, command, 2e4), rel=1e-6
    )


def test_dead_band_least_pulse_and_limits(brake):
    law = inversion(brake)
    assert law.command(2e4, 2.05e4, FULL, 600.0, FULL) == (0.0, 0.0)
    assert law.command(2e4, 2.07e4, FULL, 600.0, FULL).fill > 0.0
    assert inversion(brake, least_pulse=0.015).command(2e4, 2.05e4, FULL, 0.0, FULL) == (0.0, 0.0)
    assert law.command(2e4, -1e9, FULL, 0.0, FULL) == (0.0, 1.0)
    assert law.command(2e4, 1e9, FULL, 0.0, FULL) == (1.0, 0.0)
    # What the demand does not allow cannot be wanted: a cylinder above it is let down, one at it holds.
    assert law.command(2e4, 5e4, 2e4, 0.0, FULL) == (0.0, 0.0)
    assert law.command(2e4, 5e4, 1e4, 0.0, FULL).vent > 0.0


def test_a_wheelset_without_a_brake_gets_numbers(brake):
    law = inversion(brake)
    assert law.command(0.0, 0.0, 0.0, 0.0, 0.0) == (0.0, 0.0)
    assert law.after(Command(1.0, 0.0), 0.0, 0.0, 0.0) == (0.0, 0.0)


def test_the_wrong_sign_would_be_seen(brake):
    command = inversion(brake).command(2e4, 2.08e4, FULL, 0.0, FULL)
    wrong = Command(fill=command.vent, vent=command.fill)
    assert valve(brake, wrong, 2e4)[0] < 2e4 < valve(brake, command, 2e4)[0]


def test_a_fast_valve_runs_beyond_the_target_of_nominal_inversion_alone(brake):
    """Half the nominal times: rho is about 2 with the nominal inversion, 1.2 with .6 of the times."""
    fast = replace(brake, fill_time=0.25, vent_time=0.4)
    target = 19.6e3
    nominal = inversion(brake).command(2e4, target, FULL, 0.0, FULL)
    careful = inversion(brake, time_share=0.6).command(2e4, target, FULL, 0.0, FULL)
    way = [(2e4 - valve(fast, each, 2e4)[0]) / (2e4 - target) for each in (nominal, careful)]
    assert way == pytest.approx([2.0, 1.2], abs=0.05)


def test_an_orifice_is_inverted_at_its_present_rate():
    brake = replace(
        load_vehicle("er24pc").brake,
        valve="orifice",
        fill_time=0.2,
        vent_time=0.2,
        build_up="electro-pneumatic",
        build_up_ramp=1e-6,
        reservoir_pressure=7e5,
    )
    law = inversion(brake)
    for target in (20.8e3, 19.2e3):
        reached, _ = valve(brake, law.command(2e4, target, FULL, 0.0, FULL), 2e4)
        assert reached == pytest.approx(target, abs=0.15 * abs(target - 2e4))
