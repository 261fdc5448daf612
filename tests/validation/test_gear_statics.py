"""Load transfer of every running gear against statics by hand, on level track and on grades of 5 %."""

from dataclasses import replace

import numpy as np
import pytest
from gears import GEARS, GRAVITY, loads_by_hand

from wspd_design.controllers.baselines.unprotected import Unprotected
from wspd_design.parameters.files import available
from wspd_design.parameters.loading import load_rail, load_vehicle
from wspd_design.plants.planar import Planar
from wspd_design.simulation.records import Scenario
from wspd_design.simulation.stop import simulate

GRADES = (-0.05, 0.0, 0.05)
SMALL_ANGLE = 2e-3  # the model takes 1 for the cosine of the grade, and the grade for its sine
EXACT = 1e-12
RNG = np.random.default_rng(10)


def smooth(vehicle, **changes):
    return replace(
        vehicle, resistance_constant=0.0, resistance_linear=0.0, resistance_quadratic=0.0, **changes
    )


def settled_loads(vehicle, axle_forces, grade):
    """Load of each axle once the pitch has settled, and the deceleration."""
    plant = Planar(vehicle)
    none = (0.0,) * (2 * plant.transfers)
    motion = plant.train_motion(
        speed=20.0,
        creep_forces=tuple(0.5 * force for force in axle_forces),
        transfers=none,
        grade_force=vehicle.mass * GRAVITY * grade,
    )
    frequencies = np.array([vehicle.body_pitch_frequency, *(vehicle.bogie_pitch_frequency,) * plant.bogies])
    settled = np.array(motion.transfer_rates[plant.transfers :]) / (2.0 * np.pi * frequencies) ** 2
    loads = plant.wheel_loads((*settled, *none[plant.transfers :]))
    return 2.0 * np.array(loads), -motion.acceleration


def forces_of(vehicle):
    """A different creep force at each axle, unless the moments of single axles are shared by several bodies."""
    if vehicle.axles_per_bogie == 1 and vehicle.bodies > 1:
        return np.full(vehicle.wheelsets, 8e3)
    return RNG.uniform(5e3, 15e3, vehicle.wheelsets)


PRESETS = available("vehicle")


def preset(name):
    """A shipped vehicle whose masses add up to the last digit, as the calculation by hand has them."""
    vehicle = load_vehicle(name)
    supports = vehicle.wheelsets // vehicle.axles_per_bogie
    return replace(vehicle, mass=vehicle.bodies * vehicle.body_mass + supports * vehicle.bogie_mass)


@pytest.mark.parametrize("grade", GRADES)
@pytest.mark.parametrize("name", PRESETS)
def test_loads_of_shipped_vehicles_settle_there_too(name, grade):
    vehicle = smooth(preset(name))
    forces = np.linspace(0.02, 0.12, vehicle.wheelsets) * vehicle.mass * GRAVITY / vehicle.wheelsets
    found, deceleration = settled_loads(vehicle, forces, grade)
    expected = loads_by_hand(vehicle, forces, deceleration, grade)
    np.testing.assert_allclose(found, expected, rtol=SMALL_ANGLE if grade else EXACT)


@pytest.mark.parametrize("grade", GRADES)
@pytest.mark.parametrize("name", GEARS)
def test_loads_settle_at_the_equilibrium_of_all_parts(name, grade):
    vehicle = smooth(GEARS[name])
    for _ in range(5):
        forces = forces_of(vehicle)
        found, deceleration = settled_loads(vehicle, forces, grade)
        expected = loads_by_hand(vehicle, forces, deceleration, grade)
        np.testing.assert_allclose(found, expected, rtol=SMALL_ANGLE if grade else EXACT)
        level, _ = settled_loads(vehicle, np.zeros(vehicle.wheelsets), 0.0)
        assert np.abs(found - level).max() > 5.0 * SMALL_ANGLE * expected.mean()  # there is a load transfer


@pytest.mark.parametrize(
    "fault",
    [
        {"body_height": 1.95},
        {"bogie_spacing": 8.5},
        {"wheelbase": 2.2},
        {"bodies": 2, "wheelsets": 6, "body_mass": 18.5e3},
        {"traction_rod_height": 0.7},
    ],
)
def test_a_wrong_number_of_the_gear_is_seen(fault):
    """Plant the fault: the code has another number than the calculation by hand."""
    name = "three bodies on four bogies" if "bodies" in fault else "two two-axle bogies"
    right = smooth(GEARS[name])
    forces = np.linspace(4e3, 9e3, right.wheelsets)
    wrong = replace(right, **fault)
    found, deceleration = settled_loads(wrong, forces[: wrong.wheelsets], 0.0)
    expected = loads_by_hand(right, forces, deceleration, 0.0)[: wrong.wheelsets]
    assert np.abs(found / expected - 1.0).max() > 1e5 * EXACT


@pytest.mark.parametrize("grade", GRADES)
@pytest.mark.parametrize("name", GEARS)
def test_the_loads_of_a_simulated_stop_are_those_by_hand(name, grade):
    """Late in a stop on good adhesion, when the brake is built up and the pitch has died out."""
    vehicle = smooth(GEARS[name], pitch_damping_ratio=1.0)
    law = Unprotected(name="none", sample_time=0.1)
    run = simulate(vehicle, law, Scenario(rail=load_rail("polach-dry"), initial_speed=30.0, grade=grade))
    at = int(np.searchsorted(run.time, 0.8 * run.time[-1]))
    span = slice(at - 50, at + 50)
    deceleration = -np.polyfit(run.time[span], run.speed[span], 1)[0]
    turning = vehicle.wheelset_inertia * deceleration / vehicle.wheel_radius
    forces = (run.torque[at] - turning) / vehicle.wheel_radius  # the brake also slows the turning
    expected = loads_by_hand(vehicle, forces, deceleration, grade)
    np.testing.assert_allclose(2.0 * run.wheel_load[at], expected, rtol=SMALL_ANGLE)
    moved = expected - loads_by_hand(vehicle, 0.0 * forces, GRAVITY * np.sin(np.arctan(grade)), grade)
    assert moved[0] > 0.0 > moved[-1]
