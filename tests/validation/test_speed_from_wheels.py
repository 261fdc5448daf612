"""The train speed from the wheels in the engine: with releases inside the envelope of ETCS, without them lost."""

from dataclasses import replace

import pytest

from wspd_design.controllers.observers.sensors import Sensors
from wspd_design.design.records import Specification
from wspd_design.design.selection import named_design
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import load_rail
from wspd_design.simulation.records import Scenario, Sensing
from wspd_design.simulation.stop import simulate
from wspd_design.studies.looks import looks, without_looks

SENSED = Sensing(pulses_per_turn=100, period_timing=True, accelerometer_bias=0.05, accelerometer_noise=0.1)
LOW, WET = load_rail("low-adhesion"), load_rail("polach-wet")


def law(vehicle, period=0.02, **sensors):
    specification = Specification(sample_time=period, sensors=Sensors(**{"speed": "wheels", **sensors}))
    return named_design("observer-smc", vehicle, WET, specification).build(vehicle, WET)


def other(vehicle, *, pads, mass):
    """Return a vehicle with other pads and mass than its law knows."""
    brake = replace(vehicle.brake, max_torque=pads * vehicle.brake.max_torque)
    added = (mass - 1.0) * vehicle.mass
    return replace(vehicle, brake=brake, mass=vehicle.mass + added, body_mass=vehicle.body_mass + added)


def scenario(rail, grade=0.0):
    return Scenario(rail=rail, initial_speed=120.0 / 3.6, sensing=SENSED, grade=grade, seed=11)


@pytest.mark.parametrize("rail", [LOW, WET], ids=lambda rail: rail.name)
@pytest.mark.parametrize("accelerometer", [False, True])
def test_speed_and_distance_are_known_where_pads_and_mass_are_not(er24pc, rail, accelerometer):
    run = simulate(
        other(er24pc, pads=0.8, mass=1.2), law(er24pc, accelerometer=accelerometer), scenario(rail)
    )
    assert run.totals.speed_error < 0.08
    assert run.totals.distance_error < 0.4
    assert run.totals.judged_lock == 0.0


def test_without_releases_the_speed_is_lost(er24pc):
    study = looks(other(er24pc, pads=0.8, mass=1.2), law(er24pc), scenario(LOW))
    assert study.looking.totals.speed_error < 0.08
    assert study.blind.totals.speed_error > 0.9
    assert study.blind.totals.judged_lock > 1.0
    assert study.blind.totals.distance_error > 1.0  # outside the envelope
    assert study.blind.totals.distance > 1.02 * study.looking.totals.distance


def test_the_fastest_axle_is_not_inside_the_envelope(er24pc):
    run = simulate(er24pc, law(er24pc, speed="fastest-axle"), scenario(LOW))
    assert run.totals.distance_error > 1.0


@pytest.mark.parametrize("grade", [-0.005, 0.005])
def test_a_grade_stays_inside_the_envelope(er24pc, grade):
    run = simulate(er24pc, law(er24pc, accelerometer=True, grade=True), scenario(LOW, grade))
    assert run.totals.distance_error < 0.5
    assert run.totals.speed_error < 0.1


def test_a_law_that_is_told_the_speed_has_no_releases_to_leave_out(er24pc):
    with pytest.raises(UserError, match=r'its train speed is not filtered from the wheels; .* "wheels"'):
        without_looks(law(er24pc, speed="told"))
