"""The locomotive as a plant: what it takes from the vehicle, what from its multibody file, and what it refuses."""

from dataclasses import replace

import numpy as np
import pytest

from wspd_design.codegen.kernels import plant_kernels
from wspd_design.codegen.plant_numbers import RAIL, Surroundings, parameter_values
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.files import data_file
from wspd_design.parameters.loading import load_rail, load_vehicle
from wspd_design.plants.locomotive import LinearLocomotive, Locomotive
from wspd_design.plants.multibody.loading import load_multibody
from wspd_design.plants.multibody.records import effective_inertia


def named(plant):
    return dict(zip(plant.number_names, plant.numbers, strict=True))


def test_totals_are_those_of_the_vehicle(er24pc):
    lighter = replace(er24pc, mass=70e3, wheelset_inertia=700.0, wheel_radius=0.52, wheelbase=2.8)
    plant, own = Locomotive(lighter), load_multibody("er24pc-82")
    model = own.with_numbers({name: named(plant)[name] for name in own.number_names})
    assert sum(model.mass(body) for body in model.bodies) == pytest.approx(70e3, rel=1e-12)
    assert effective_inertia(model, "wheelset_1") == pytest.approx(700.0, rel=1e-12)
    assert model.numbers["wheelset.inertia_axial"] == own.numbers["wheelset.inertia_axial"]
    assert plant.offsets == pytest.approx((0.0, 2.8, er24pc.bogie_spacing, 2.8 + er24pc.bogie_spacing))
    assert sum(plant.loads_at_rest()) == pytest.approx(70e3 * 9.81 / 2, rel=1e-9)


def test_rest_is_82_coordinates_and_rates_without_speed_and_wheel_speeds(er24pc):
    plant = Locomotive(er24pc)
    assert plant.rest_states == 81 + 77
    rest = np.array(plant.rest_at(20.0, (30.0,) * 4))
    # At the speed of the train: 2 bogies, 4 wheelsets, 4 motors; turning: 4 rotors, against their wheels.
    assert ((rest == 20.0).sum(), (rest == 0.0).sum()) == (10, 158 - 14)
    np.testing.assert_allclose(rest[(rest != 0.0) & (rest != 20.0)], -4.95 * 30.0)


@pytest.mark.parametrize("kind", [Locomotive, LinearLocomotive])
def test_vehicles_that_do_not_fit_are_refused(er24pc, kind):
    for changes, why in (
        ({"multibody": ""}, "names no multibody file"),
        ({"multibody": "er24pc-28"}, 'unknown multibody vehicle "er24pc-28", did you mean|er24pc-82'),
        ({"wheelsets": 6}, "has 6 wheelsets and its multibody file er24pc-82 4"),
    ):
        with pytest.raises(UserError, match=why):
            kind(replace(er24pc, **changes))
    for changes, why in (
        ({"mass": 20e3}, "leaves car_body of its multibody file"),
        ({"wheelset_inertia": 300.0}, "leaves rotor_1 of its multibody file er24pc-82 nothing"),
    ):
        with pytest.raises(UserError, match=why):
            kind(replace(er24pc, **changes)).numbers  # noqa: B018


def test_axles_stand_where_those_of_the_vehicle_do(tmp_path):
    """A file with a wheelbase of its own lost it to a vehicle of single axles, which has none."""
    file = tmp_path / "wagon.toml"
    text = data_file("multibody", "two-axle-wagon.toml").read_text(encoding="utf-8")
    file.write_text(text.replace("bogie_spacing", "wheelbase"), encoding="utf-8")
    wagon = replace(load_vehicle("two-axle-wagon"), multibody=str(file))
    assert Locomotive(wagon).offsets == (0.0, 9.0)
    with pytest.raises(
        UserError, match=r"axle 2 of vehicle two-axle-wagon stands 8 m .* 9 m; let both agree"
    ):
        Locomotive(replace(wagon, bogie_spacing=8.0)).numbers  # noqa: B018


def test_an_axle_that_is_braked_has_a_brake_in_the_file(er24pc, tmp_path):
    """A torque on an axle without a brake would do nothing."""
    file = tmp_path / "bare.toml"
    text = data_file("multibody", "er24pc-82.toml").read_text(encoding="utf-8")
    start, end = text.index("[brakes.brake]"), text.index("[numbers.mass]")
    levers = text.index("[numbers.brake.lever]")
    file.write_text(text[:start] + text[end:levers], encoding="utf-8")
    bare = replace(er24pc, multibody=str(file))
    with pytest.raises(UserError, match=r"brakes wheelset_1, on which its multibody file .* has no brake"):
        Locomotive(bare)
    Locomotive(replace(bare, brake=replace(er24pc.brake, axle_shares=(0.0,) * 4)))


def test_without_brakes_the_locomotive_rolls_on(er24pc):
    calm = replace(er24pc, resistance_constant=0.0, resistance_linear=0.0, resistance_quadratic=0.0)
    plant, rail = Locomotive(calm), load_rail("polach-wet")
    kernels = plant_kernels(plant, disturbed=False).whole
    rails = np.repeat([getattr(rail, name) for name in RAIL], 4)
    constants = kernels.vehicle_constants(parameter_values(calm, rail, Surroundings()), plant.numbers, rails)
    wheels = np.full(4, 20.0 / calm.wheel_radius)
    rest = plant.rest_at(20.0, tuple(wheels))
    found = kernels.vehicle(constants, 20.0, wheels, rest, 0.0, 0.0, 0.0, np.zeros(12), 0.0)
    acceleration, turning, rates, force, *_, loads, _, _ = (np.array(each).ravel() for each in found)
    assert abs(acceleration[0]) < 1e-9
    np.testing.assert_allclose(loads, plant.loads_at_rest(), rtol=1e-12)
    np.testing.assert_allclose(force, 0.0, atol=1e-6)
    # The wheels are cones: their spin on the rail pushes them sideways, and the loads left and right differ.
    np.testing.assert_allclose(turning, 0.0, atol=0.01)
    assert (np.abs(rates) > 1.0).sum() == 8  # turns of wheelsets and rotors, which run on


def test_other_numbers_of_the_file_are_the_same_code(er24pc):
    plant = LinearLocomotive(er24pc)
    softer = plant.with_number("primary.stiffness_z", 1e6)
    assert softer.numbers != plant.numbers
    assert plant_kernels(softer, disturbed=False) is plant_kernels(plant, disturbed=False)
