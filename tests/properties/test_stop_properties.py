"""What holds for every stop: bounds, exact repetition, and scaling."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from wspd_design.parameters.loading import constants, load_rail
from wspd_design.parameters.records import Rail
from wspd_design.simulation.records import Scenario
from wspd_design.simulation.runs import Ending
from wspd_design.simulation.stop import simulate

CONTROLLERS = ("afsmc", "afsmc-repaired", "smc", "trenitalia", "knorr-bremse", "mitsubishi", "none")


@st.composite
def rails(draw):
    """Any rail with kS <= kA, for which friction bounds the creep force."""
    adhesion = draw(st.floats(0.1, 1.0))
    mu0 = draw(st.floats(0.1, 0.6))
    return Rail(
        name="random",
        mu0=mu0,
        friction_ratio=draw(st.floats(0.3, 1.0)),
        friction_decay=draw(st.floats(0.0, 1.0)),
        adhesion_reduction=adhesion,
        slip_reduction=adhesion * draw(st.floats(0.2, 1.0)),
    )


cases = {
    "rail": rails(),
    "speed": st.floats(3.0, 12.0),
    "mass_factor": st.floats(0.7, 1.4),
    "name": st.sampled_from(CONTROLLERS),
}


def shortest_distance(vehicle, rail, speed):
    """Bound without any build-up of the brake.

    The deceleration never exceeds full friction on all wheels, mu0 g, plus the resistance at the initial speed, so
    that the distance is at least that of constant deceleration with this sum.
    """
    resistance = (
        vehicle.resistance_constant
        + vehicle.resistance_linear * speed
        + vehicle.resistance_quadratic * speed**2
    )
    largest = rail.mu0 * constants().gravity + resistance / vehicle.mass
    return (speed**2 - constants().stop_speed ** 2) / (2.0 * largest)


@settings(max_examples=12, deadline=None)
@given(**cases)
def test_bounds(er24pc, make_controller, rail, speed, mass_factor, name):
    vehicle = replace(er24pc, mass=mass_factor * er24pc.mass)
    run = simulate(vehicle, make_controller(name), Scenario(rail=rail, initial_speed=speed), plant="quarter")
    assert run.ending is Ending.STOPPED
    assert run.totals.distance > shortest_distance(vehicle, rail, speed)
    assert (run.torque >= 0.0).all()
    assert (run.torque <= vehicle.brake.max_torque).all()
    assert (run.wheel_speed >= 0.0).all()
    # A braked wheel is never faster than the train, but for what its own inertia needs: I/R^2 times the
    # deceleration by resistance alone, over a creep slope of millions of newtons.
    assert run.slip.min() > -1e-3
    assert run.slip.max() <= 1.0
    assert 0.0 <= run.totals.lock_time <= run.time[-1]
    assert all(0.0 <= share <= 1.0 for sample in run.samples for share in (sample.fill, sample.vent))


def test_the_bound_on_the_distance_can_be_missed(er24pc, stop):
    # The planted fault: half the friction in the bound, and the stop on the real rail is shorter.
    run, rail = stop("none", "table10-dry"), load_rail("table10-dry")
    bound = shortest_distance(er24pc, rail, run.initial_speed)
    assert bound < run.totals.distance < 1.4 * bound
    assert run.totals.distance < shortest_distance(
        er24pc, replace(rail, mu0=0.5 * rail.mu0), run.initial_speed
    )


@settings(max_examples=6, deadline=None)
@given(**cases)
def test_pressure_stays_between_zero_and_the_supply(er24pc, make_controller, rail, speed, mass_factor, name):
    vehicle = replace(er24pc, mass=mass_factor * er24pc.mass)
    run = simulate(vehicle, make_controller(name), Scenario(rail=rail, initial_speed=speed), plant="quarter")
    # The controllers see the torque of the cylinder pressure, also at a locked wheel.
    shares = np.array([sample.seen.torque for sample in run.samples]) / vehicle.brake.max_torque
    supply = -np.expm1(-vehicle.brake.supply_rate * run.sample_time * np.arange(len(shares)))
    assert (shares >= 0.0).all()
    assert (shares <= supply + 1e-12).all()


@pytest.mark.parametrize("name", ["afsmc", "smc", "mitsubishi"])
def test_the_same_stop_twice_is_the_same_to_the_bit(er24pc, make_controller, name):
    scenario = Scenario(rail=load_rail("polach-wet"), initial_speed=15.0)
    one, other = (
        simulate(er24pc, make_controller(name, "polach-wet"), scenario, plant="quarter") for _ in range(2)
    )
    for trace in ("time", "speed", "distance", "wheel_speed", "slip", "torque"):
        np.testing.assert_array_equal(getattr(one, trace), getattr(other, trace))
    assert one.totals == other.totals
    assert one.samples == other.samples


def scaled(vehicle, factor, *, contact):
    """Scale all masses, forces and torques; with ``contact`` also what the creep force rests on.

    The creep force is Q mu g(C slip / (Q mu)): it scales with the load Q only if the stiffness C does. C grows with
    load^(2/3), so the shear modulus and the reference load have to be scaled too.
    """
    change = {"shear_modulus": factor, "reference_load": factor} if contact else {}
    return replace(
        vehicle,
        mass=factor * vehicle.mass,
        wheelset_inertia=factor * vehicle.wheelset_inertia,
        wheel_damping=factor * vehicle.wheel_damping,
        resistance_constant=factor * vehicle.resistance_constant,
        resistance_linear=factor * vehicle.resistance_linear,
        resistance_quadratic=factor * vehicle.resistance_quadratic,
        brake=replace(vehicle.brake, max_torque=factor * vehicle.brake.max_torque),
        contact=replace(
            vehicle.contact,
            **{name: factor * getattr(vehicle.contact, name) for name, factor in change.items()},
        ),
    )


@pytest.mark.parametrize("name", ["trenitalia", "mitsubishi", "none"])
def test_kinematics_do_not_know_the_unit_of_mass(er24pc, make_controller, name):
    # A factor of two is exact in binary, so that nothing at all may change.
    scenario = Scenario(rail=load_rail("polach-wet"), initial_speed=15.0)
    one = simulate(er24pc, make_controller(name), scenario, plant="quarter")
    double = simulate(scaled(er24pc, 2.0, contact=True), make_controller(name), scenario, plant="quarter")
    for trace in ("time", "speed", "distance", "wheel_speed", "slip"):
        np.testing.assert_array_equal(getattr(one, trace), getattr(double, trace))
    np.testing.assert_array_equal(2.0 * one.torque, double.torque)
    assert double.totals.torque == 2.0 * one.totals.torque


def test_a_heavier_train_on_the_same_contact_moves_otherwise(er24pc, make_controller):
    # The counterpart: with the contact left as it is, the creep does not scale.
    scenario = Scenario(rail=load_rail("polach-wet"), initial_speed=15.0)
    one = simulate(er24pc, make_controller("trenitalia"), scenario, plant="quarter")
    double = simulate(
        scaled(er24pc, 2.0, contact=False), make_controller("trenitalia"), scenario, plant="quarter"
    )
    assert not math.isclose(one.totals.distance, double.totals.distance, rel_tol=1e-5)
