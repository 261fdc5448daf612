"""The planar vehicle for any number of bogies: loads, load transfer, and the special case without heights."""

import math
from dataclasses import replace

import numpy as np
import pytest

from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import constants, load_rail
from wspd_design.plants.names import PLANTS, plant_of
from wspd_design.plants.planar import Planar
from wspd_design.plants.quarter import Quarter

RNG = np.random.default_rng(4)


def with_axles(vehicle, axles):
    return replace(vehicle, wheelsets=axles)


@pytest.mark.parametrize("axles", [4, 6, 8, 12])
def test_the_wheels_carry_the_vehicle(er24pc, axles):
    plant = Planar(with_axles(er24pc, axles))
    loads = plant.wheel_loads(tuple(RNG.normal(scale=1e4, size=2 * plant.transfers)))
    assert len(loads) == axles == len(plant.offsets)
    assert 2.0 * sum(loads) == pytest.approx(er24pc.mass * constants().gravity, rel=1e-12)


@pytest.mark.parametrize("axles", [4, 6, 8, 12])
def test_the_transfer_of_the_body_balances_its_moment(er24pc, axles):
    plant = Planar(with_axles(er24pc, axles))
    none = (0.0,) * (2 * plant.transfers)
    body = (1e4, *none[1:])
    changes = np.subtract(plant.wheel_loads(body), plant.wheel_loads(none))
    moment = -2.0 * float(
        changes @ np.array(plant.offsets)
    )  # about the first axle; the loads add up to nothing
    assert moment == pytest.approx(1e4 * er24pc.bogie_spacing, rel=1e-12)
    by_bogie = changes.reshape(-1, 2)
    np.testing.assert_allclose(by_bogie[:, 0], by_bogie[:, 1])
    np.testing.assert_allclose(
        np.diff(by_bogie[:, 0]), np.diff(by_bogie[:, 0])[0]
    )  # a rigid body on equal springs


@pytest.mark.parametrize("axles", [4, 6])
def test_the_transfer_within_a_bogie_stays_within_it(er24pc, axles):
    plant = Planar(with_axles(er24pc, axles))
    none = (0.0,) * (2 * plant.transfers)
    for bogie in range(plant.bogies):
        values = list(none)
        values[1 + bogie] = 3e3
        changes = np.subtract(plant.wheel_loads(tuple(values)), plant.wheel_loads(none)).reshape(-1, 2)
        np.testing.assert_allclose(changes[bogie], [1.5e3, -1.5e3], rtol=1e-9)
        assert not np.delete(changes, bogie, axis=0).any()


def test_four_axles_stand_where_they_stood(er24pc):
    base, spacing = er24pc.wheelbase, er24pc.bogie_spacing
    assert Planar(er24pc).offsets == (0.0, base, spacing, spacing + base)
    assert Quarter(er24pc).offsets == (0.0,) * 4


@pytest.mark.parametrize("axles", [4, 6])
def test_the_transfers_settle_where_the_moments_balance(er24pc, axles):
    plant = Planar(with_axles(er24pc, axles))
    forces = tuple(RNG.uniform(3e3, 9e3, axles))
    still = plant.train_motion(speed=20.0, creep_forces=forces, transfers=(0.0,) * (2 * plant.transfers))
    deceleration = -still.acceleration
    assert deceleration == pytest.approx((2.0 * sum(forces) + still.resistance) / er24pc.mass, rel=1e-12)
    rod, own = er24pc.traction_rod_height, er24pc.bogie_mass * deceleration
    pulled = np.array(forces).reshape(-1, 2).sum(axis=1) * 2.0
    settled = (
        er24pc.body_mass * deceleration * (er24pc.body_height - rod) / er24pc.bogie_spacing,
        *((own * er24pc.bogie_height + (pulled - own) * rod) / er24pc.wheelbase),
    )
    rest = (0.0,) * plant.transfers
    there = plant.train_motion(speed=20.0, creep_forces=forces, transfers=(*settled, *rest))
    np.testing.assert_allclose(there.transfer_rates, 0.0, atol=1e-6)
    omega = 2.0 * math.pi * er24pc.body_pitch_frequency
    assert still.transfer_rates[plant.transfers] == pytest.approx(omega**2 * settled[0], rel=1e-12)


def transfers_at_rest(plant, forces, grade):
    """Load transfers that have settled under creep forces on a grade, and the deceleration."""
    vehicle, none = plant.vehicle, (0.0,) * (2 * plant.transfers)
    weight = vehicle.mass * constants().gravity
    motion = plant.train_motion(speed=20.0, creep_forces=forces, transfers=none, grade_force=weight * grade)
    frequencies = (vehicle.body_pitch_frequency, *(vehicle.bogie_pitch_frequency,) * plant.bogies)
    rates = motion.transfer_rates[plant.transfers :]
    settled = (rate / (2.0 * math.pi * f) ** 2 for rate, f in zip(rates, frequencies, strict=True))
    return tuple(settled), -motion.acceleration


@pytest.mark.parametrize("grade", [-0.05, 0.0, 0.05])
@pytest.mark.parametrize("axles", [4, 6])
def test_the_moments_about_the_rail_balance_on_a_grade(er24pc, axles, grade):
    """The wheels turn back what inertia and gravity along the track do at the heights of body and bogies."""
    smooth = replace(er24pc, resistance_constant=0.0, resistance_linear=0.0, resistance_quadratic=0.0)
    bogie_mass = (smooth.mass - smooth.body_mass) * 2.0 / axles  # so that the parts weigh what the whole does
    plant = Planar(with_axles(replace(smooth, bogie_mass=bogie_mass), axles))
    forces = tuple(RNG.uniform(3e3, 9e3, axles))
    settled, deceleration = transfers_at_rest(plant, forces, grade)
    none = (0.0,) * (2 * plant.transfers)
    changes = np.subtract(plant.wheel_loads((*settled, *none[plant.transfers :])), plant.wheel_loads(none))
    moment = -2.0 * float(changes @ np.array(plant.offsets))
    along = deceleration - constants().gravity * grade
    first_moment = smooth.body_mass * smooth.body_height + plant.bogies * bogie_mass * smooth.bogie_height
    assert moment == pytest.approx(first_moment * along, rel=1e-12)
    assert deceleration - 2.0 * sum(forces) / smooth.mass == pytest.approx(constants().gravity * grade)


def test_a_grade_moves_no_load_by_itself(er24pc):
    """What rolls freely slows down by g times the grade, and nothing holds it; a train held on a slope leans down."""
    smooth = replace(er24pc, resistance_constant=0.0, resistance_linear=0.0, resistance_quadratic=0.0)
    settled, deceleration = transfers_at_rest(Planar(smooth), (0.0,) * 4, 0.03)
    assert deceleration == pytest.approx(0.03 * constants().gravity, rel=1e-12)
    np.testing.assert_allclose(settled, 0.0, atol=1e-9)
    holding = (smooth.mass * constants().gravity * 0.03 / 8.0,) * 4
    held, still = transfers_at_rest(Planar(smooth), holding, -0.03)
    assert still == pytest.approx(0.0, abs=1e-12)
    assert min(held) > 0.0


@pytest.mark.parametrize(
    ("changes", "why"),
    [
        ({"wheelsets": 1, "axles_per_bogie": 1}, "wheelsets = 1 make one support"),
        ({"wheelsets": 2}, "make one bogie"),
        ({"wheelsets": 5}, "wheelsets = 5 must be a multiple of axles_per_bogie = 2"),
        ({"wheelsets": 4, "axles_per_bogie": 4}, "axles_per_bogie = 4 must be 1"),
        ({"wheelsets": 8, "bodies": 2}, "bodies = 2 .* on 3 bogies"),
    ],
)
def test_what_stands_on_nothing_known_is_refused(er24pc, changes, why):
    vehicle = replace(er24pc, **changes)
    with pytest.raises(UserError, match=rf'vehicle er24pc: .*{why}.* take the plant "quarter"'):
        plant_of("planar", vehicle)
    assert plant_of("quarter", vehicle).axles == vehicle.wheelsets


def test_plants_by_name(er24pc):
    assert PLANTS == ("planar", "quarter", "locomotive", "locomotive-linear")
    for name in PLANTS:
        plant = plant_of(name, er24pc)
        assert (plant.name, plant.vehicle, plant.on(er24pc)) == (name, er24pc, plant)
    with pytest.raises(UserError, match='unknown plant "half"; available: planar, quarter'):
        plant_of("half", er24pc)


@pytest.mark.parametrize("axles", [1, 2, 6])
def test_a_wheelset_of_the_quarter_locomotive_does_not_know_the_others(er24pc, axles):
    # As many wheelsets carry as much more train.
    rail, share = load_rail("polach-wet"), axles / er24pc.wheelsets
    other = replace(
        er24pc,
        wheelsets=axles,
        mass=share * er24pc.mass,
        resistance_constant=share * er24pc.resistance_constant,
        resistance_linear=share * er24pc.resistance_linear,
        resistance_quadratic=share * er24pc.resistance_quadratic,
    )
    one, same = Quarter(er24pc), Quarter(other)
    assert same.wheel_loads(()) == pytest.approx((one.wheel_loads(())[0],) * axles, rel=1e-14)
    assert same.creep_rate(rail, 3.0) == pytest.approx(one.creep_rate(rail, 3.0), rel=1e-14)
    mine, theirs = (
        plant.train_motion(speed=20.0, creep_forces=(5e3,) * plant.axles).acceleration
        for plant in (one, same)
    )
    assert theirs == pytest.approx(mine, rel=1e-14)
