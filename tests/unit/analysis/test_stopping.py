"""Mean values of EN 14531-1 against the worked example of another program, a published table and our simulation."""

from dataclasses import replace

import pytest

from wspd_design.analysis.stopping import (
    FrictionBrake,
    braked_weight_percentage,
    demanded_adhesion,
    full_adhesion_stop,
    mean_stop,
)
from wspd_design.controllers.baselines.unprotected import Unprotected
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import load_rail, load_vehicle
from wspd_design.simulation.records import Scenario
from wspd_design.simulation.stop import simulate

# A multiple unit of eight axles: the example of EN 14531-1 as RailProfAC/RailwayBrakeCalculation computes it.
TREAD = FrictionBrake(
    wheelsets=4,
    pressure=3.8e5,
    cylinder_area=346e-4,
    cylinder_efficiency=0.95,
    spring_force=300.0,
    rigging_ratio=5.0,
    rigging_efficiency=0.95,
    rigging_force=500.0,
    pad_friction=0.28,
    friction_radius=0.5,
    wheel_radius=0.5,
    dead_time=0.6,
    build_up_time=3.0,
)
DISC = FrictionBrake(
    wheelsets=4,
    pressure=3.0e5,
    cylinder_area=324e-4,
    cylinder_efficiency=0.98,
    spring_force=500.0,
    rigging_ratio=5.0,
    rigging_efficiency=0.95,
    rigging_force=0.0,
    pad_friction=0.35,
    friction_radius=0.27,
    wheel_radius=0.445,
    dead_time=0.3,
    build_up_time=2.0,
)


def unit_stop(kmh):
    parts = (TREAD, DISC)
    return mean_stop(
        kmh / 3.6,
        forces=[(part.wheelsets * part.retarding_force, part.equivalent_time) for part in parts],
        mass=4 * 15e3 + 4 * 14.5e3,
        rotating_mass=4 * 1.5e3 + 4 * 0.7e3,
        resistance=(3000.0, 110.0, 7.0),
    )


def test_forces_of_tread_and_disc():
    assert TREAD.retarding_force == pytest.approx(16073.0, abs=1.0)
    assert DISC.retarding_force == pytest.approx(9104.0, abs=1.0)


@pytest.mark.parametrize(
    ("kmh", "equivalent_time", "deceleration", "distance"),
    [
        (100, 1.6815, 0.8553, 497.80),
        (120, 1.6571, 0.8679, 695.39),
        (140, 1.6303, 0.8821, 920.60),
        (160, 1.6013, 0.8981, 1170.84),
        (200, 1.5378, 0.9352, 1735.52),
    ],
)
def test_stop_of_the_example(kmh, equivalent_time, deceleration, distance):
    stop = unit_stop(kmh)
    assert stop.equivalent_time == pytest.approx(equivalent_time, abs=6e-5)
    assert stop.deceleration == pytest.approx(deceleration, abs=6e-5)
    assert stop.distance == pytest.approx(distance, rel=1e-4)


@pytest.mark.parametrize(("kmh", "percentage"), [(100, 96.15), (120, 101.27), (140, 110.46), (160, 118.75)])
def test_braked_weight_percentage_of_the_example(kmh, percentage):
    assert braked_weight_percentage(unit_stop(kmh).distance, kmh / 3.6) == pytest.approx(percentage, abs=0.03)


def test_braked_weight_percentage_has_four_speeds():
    with pytest.raises(UserError, match="100, 120, 140, 160 km/h, not from 130"):
        braked_weight_percentage(700.0, 130.0 / 3.6)


@pytest.mark.parametrize("grade", [-0.02, 0.0, 0.02])
def test_simulated_stop_without_sliding_is_that_of_the_mean_values(grade):
    """Within 1 %: the formula takes the mean resistance, and no creep."""
    vehicle, rail = load_vehicle("er24pc-service"), load_rail("table10-dry")
    scenario = replace(Scenario.stop(from_kmh=120, rail=rail), grade=grade)
    run = simulate(vehicle, Unprotected(name="none", sample_time=0.1), scenario)
    assert run.slip.max() < 0.02
    assert run.distance[-1] == pytest.approx(
        full_adhesion_stop(vehicle, 120 / 3.6, grade=grade).distance, rel=0.01
    )


def test_a_grade_that_the_brake_does_not_hold():
    weak = load_vehicle("er24pc-service")
    weak = replace(weak, brake=replace(weak.brake, max_torque=5e3))
    with pytest.raises(UserError, match="does not stop"):
        full_adhesion_stop(weak, 20.0, grade=-0.1)


def test_demanded_adhesion_leaves_out_what_stops_the_wheelsets():
    vehicle = load_vehicle("er24pc-service")
    stop = full_adhesion_stop(
        replace(vehicle, resistance_constant=0.0, resistance_linear=0.0, resistance_quadratic=0.0), 20.0
    )
    assert demanded_adhesion(vehicle) == pytest.approx(stop.deceleration / 9.81, rel=1e-12)
