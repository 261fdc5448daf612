"""Stops of every running gear, with unlike brakes: balances, an independent integration, and who slides first."""

from dataclasses import replace

import numpy as np
import pytest
from gears import GEARS
from independent_axles import IndependentAxles, two_bodies, two_bogies, two_long_bogies, two_single_axles

from wspd_design.analysis.stopping import demanded_adhesion, full_adhesion_stop
from wspd_design.codegen.closed_loop import load_closed_loop
from wspd_design.codegen.virtual_machine import run_virtual
from wspd_design.parameters.loading import load_rail
from wspd_design.plants.planar import Planar
from wspd_design.simulation.ideal import ideal_stop
from wspd_design.simulation.loop_input import loop_input, sample_rows
from wspd_design.simulation.metrics import metrics
from wspd_design.simulation.records import Scenario
from wspd_design.simulation.stop import simulate

WET = load_rail("table10-wet")
SLOW = 10.0 / 3.6  # m/s, of the stops that are integrated twice


def braked(vehicle, shares, max_torque=24e3):
    return replace(vehicle, brake=replace(vehicle.brake, max_torque=max_torque, axle_shares=tuple(shares)))


def unlike(axles):
    """Shares of brakes: the second axle has none, the last one a weaker one."""
    return (1.0, 0.0, *(1.0,) * (axles - 3), 0.7) if axles > 2 else (1.0, 0.0)


@pytest.mark.parametrize("name", GEARS)
def test_momentum_and_energy_close_and_an_axle_without_a_brake_rolls(make_controller, name):
    vehicle = braked(GEARS[name], unlike(GEARS[name].wheelsets))
    law, scenario = make_controller("trenitalia"), Scenario(rail=WET, initial_speed=50.0 / 3.6)
    run = simulate(vehicle, law, scenario)
    found = metrics(run, vehicle, scenario, slip_reference=0.14)
    assert abs(found.momentum_residual) < 1e-9
    assert abs(found.energy_residual) < 1e-6
    assert found.efficiency < 1.0
    assert found.slip_max > 0.05  # others slide
    assert np.abs(run.slip[run.speed > 1.0, 1]).max() < 1e-3
    assert not run.torque[:, 1].any()
    assert run.axle_samples[1] == ()
    assert min(len(each) for axle, each in enumerate(run.axle_samples) if axle != 1) > 10
    assert (run.torque[:, -1] <= vehicle.brake_shares[-1] * vehicle.brake.max_torque * (1.0 + 1e-9)).all()


STANDING = {
    "two two-axle bogies": two_bogies,
    "two three-axle bogies": two_long_bogies,
    "two single axles": two_single_axles,
    "two bodies": two_bodies,
}
TWO_BODIES = replace(GEARS["three bodies on four bogies"], wheelsets=6, bodies=2, mass=2 * 18e3 + 3 * 7e3)


@pytest.mark.parametrize(
    "name",
    [
        pytest.param(each, marks=pytest.mark.reference) if each == "two two-axle bogies" else each
        for each in STANDING
    ],
)
def test_stops_agree_with_an_independent_integration(make_controller, name):
    plain = TWO_BODIES if name == "two bodies" else GEARS[name]
    shares = unlike(plain.wheelsets)
    vehicle = braked(plain, shares, 40e3)
    law = make_controller("trenitalia")
    run = simulate(vehicle, law, Scenario(rail=WET, initial_speed=SLOW))
    other = IndependentAxles(vehicle, WET, standing=STANDING[name](vehicle), shares=shares)
    time, y = other.run(law, SLOW)
    assert run.totals.distance == pytest.approx(y[other.X], rel=1e-5)
    assert run.time[-1] == pytest.approx(time, rel=1e-5)
    assert run.slip.max() > 0.05


def test_a_wrong_share_is_seen(make_controller):
    """Plant the fault: the other integration has a weaker brake at the front."""
    vehicle, law = braked(GEARS["two single axles"], unlike(2)), make_controller("trenitalia")
    run = simulate(vehicle, law, Scenario(rail=WET, initial_speed=SLOW))
    other = IndependentAxles(vehicle, WET, standing=two_single_axles(vehicle), shares=(0.99, 0.0))
    _, y = other.run(law, SLOW)
    assert abs(run.totals.distance / y[other.X] - 1.0) > 1e-5


@pytest.mark.parametrize("name", ["two single axles", "two three-axle bogies", "three bodies on four bogies"])
def test_without_a_compiler_the_numbers_are_the_same(make_controller, name):
    vehicle = braked(GEARS[name], unlike(GEARS[name].wheelsets))
    plant, law = Planar(vehicle), make_controller("trenitalia")
    given = replace(loop_input([(plant, Scenario(rail=WET, initial_speed=6.0))], law), trace_rows=20_000)
    rows = sample_rows(law)
    compiled = load_closed_loop(plant, law).run(given, sample_rows=rows)
    virtual = run_virtual(plant, law, given, sample_rows=rows, disturbed=False)
    assert (virtual.steps, virtual.trace.shape) == (compiled.steps, compiled.trace.shape)
    np.testing.assert_allclose(virtual.wheel_speeds, compiled.wheel_speeds, atol=1e-7)
    for key, value in compiled.stop_totals.items():
        np.testing.assert_allclose(virtual.stop_totals[key], value, rtol=1e-7, atol=1e-7, err_msg=key)


@pytest.mark.parametrize("height", ["usual", "none"])
def test_the_rear_axles_of_the_bogies_slide_first(make_controller, height):
    """Weight transfer: axles 2 and 4 before 1 and 3 (Kang et al., brake HILS); without heights all at once."""
    vehicle = braked(GEARS["two two-axle bogies"], ())
    slow = replace(vehicle, brake=replace(vehicle.brake, supply_rate=0.1))  # builds up through the adhesion
    if height == "none":
        slow = replace(slow, body_height=0.0, bogie_height=0.0, traction_rod_height=0.0)
    run = simulate(slow, make_controller("none"), Scenario(rail=WET, initial_speed=120.0 / 3.6))
    slides = run.slip > 0.3
    first = np.where(slides.any(axis=0), run.time[slides.argmax(axis=0)], np.inf)
    if height == "none":
        assert len(set(first)) == 1
    else:
        assert 1.0 < max(first[1], first[3]) < min(first[0], first[2])


def test_the_ideal_stop_asks_no_axle_for_more_than_its_brake_gives(make_controller):
    """On good adhesion the ideal brake is the brake that fills: half as many brakes, a stop by the mean rules."""
    plain = GEARS["two two-axle bogies"]
    scenario = Scenario(rail=load_rail("polach-dry"), initial_speed=30.0)
    half = braked(plain, (1.0, 0.0, 0.0, 1.0), 6e3)
    all_weaker = braked(plain, (), 3e3)
    law = make_controller("none")
    ideal, filled = ideal_stop(half, scenario).distance, simulate(half, law, scenario).totals.distance
    assert ideal == pytest.approx(filled, rel=1e-6)
    assert ideal == pytest.approx(ideal_stop(all_weaker, scenario).distance, rel=1e-3)


@pytest.mark.parametrize("name", ["two two-axle bogies", "three bodies on four bogies", "two single axles"])
def test_mean_value_rules_know_unlike_brakes(make_controller, name):
    """On full adhesion: the distance of EN 14531-1 within 1 %, and the adhesion that the axle which asks most uses."""
    plain = GEARS[name]
    vehicle = braked(plain, unlike(plain.wheelsets), 9e3)
    vehicle = replace(
        vehicle, resistance_constant=600.0, resistance_linear=8.0, resistance_quadratic=1.6, wheel_damping=0.0
    )
    speed = 120.0 / 3.6
    run = simulate(
        vehicle, make_controller("none"), Scenario(rail=load_rail("polach-dry"), initial_speed=speed)
    )
    assert full_adhesion_stop(vehicle, speed).distance == pytest.approx(run.totals.distance, rel=0.01)
    smooth = replace(vehicle, resistance_constant=0.0, resistance_linear=0.0, resistance_quadratic=0.0)
    run = simulate(
        smooth, make_controller("none"), Scenario(rail=load_rail("polach-dry"), initial_speed=speed)
    )
    late = slice(int(0.7 * len(run.time)), int(0.9 * len(run.time)))
    slowing = -np.polyfit(run.time[late], run.speed[late], 1)[0]
    turning = vehicle.wheelset_inertia * slowing / vehicle.wheel_radius
    forces = (run.torque[late].mean(axis=0) - turning) / vehicle.wheel_radius
    used = forces / (2.0 * run.wheel_load[0])
    assert demanded_adhesion(vehicle) == pytest.approx(used.max(), rel=2e-3)
