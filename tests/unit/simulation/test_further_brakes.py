"""Stops with pads that fade, an electrodynamic brake and magnets: balances, engines, drop-out and blending."""

from dataclasses import replace

import numpy as np
import pytest

from wspd_design.codegen.closed_loop import load_closed_loop
from wspd_design.codegen.virtual_machine import run_virtual
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import load_rail, load_vehicle
from wspd_design.parameters.records import DynamicBrake, Pads, TrackBrake
from wspd_design.plants.planar import Planar
from wspd_design.plants.quarter import Quarter
from wspd_design.simulation.ideal import ideal_stop
from wspd_design.simulation.loop_input import loop_input, sample_rows
from wspd_design.simulation.metrics import energy_residual, momentum_residual
from wspd_design.simulation.records import Patch, Scenario, Sensing
from wspd_design.simulation.self_check import simulate_checked
from wspd_design.simulation.stop import simulate

PADS = Pads(
    speeds=(0.0, 5.0, 10.0, 20.0, 40.0),
    speed_factors=(1.2, 1.1, 1.0, 0.9, 0.7),
    temperatures=(0.0, 50.0, 200.0),
    temperature_factors=(0.95, 1.0, 0.6),
    heat_capacity=4e4,
    cooling=60.0,
)
DYNAMIC = DynamicBrake(
    torque=9e3, power=240e3, build_up_time=0.4, fade_speed=3.0, cut_out_speed=1.2, drop_slip=0.2
)
MAGNETS = TrackBrake(
    force=36e3, build_up_time=0.5, cut_out_speed=8.0, speeds=(5.0, 20.0, 40.0), speed_factors=(1.2, 1.0, 0.8)
)
PARTS = {
    "pads": {"pads": PADS},
    "blended": {"dynamic": DYNAMIC},
    "magnets": {"track_brake": MAGNETS},
    "all": {"pads": PADS, "dynamic": DYNAMIC, "track_brake": MAGNETS},
}
DRY, LOW = load_rail("polach-dry"), load_rail("low-adhesion")


@pytest.fixture(scope="module")
def with_parts():
    """Put parts on the locomotive with service brakes."""

    def made(parts, **changes):
        return replace(load_vehicle("er24pc-service"), **PARTS[parts], **changes)

    return made


@pytest.mark.parametrize("rail", ["polach-dry", "low-adhesion"])
@pytest.mark.parametrize("name", ["none", "trenitalia"])
@pytest.mark.parametrize(("parts", "plant"), [*((parts, "planar") for parts in PARTS), ("all", "quarter")])
def test_residuals(with_parts, make_controller, parts, name, rail, plant):
    vehicle, scenario = with_parts(parts), Scenario(rail=load_rail(rail), initial_speed=30.0)
    run = simulate(vehicle, make_controller(name, rail), scenario, plant=plant)
    assert abs(momentum_residual(run, vehicle)) < 1e-12
    assert abs(energy_residual(run, vehicle)) < 1e-6


def forget_magnets(plant, given, motion):
    return motion._replace(
        resistance=motion.resistance - plant.track_brake_force(given["speed"], given["time"])
    )


def forget_the_electrodynamic_brake(plant, given, motion):  # noqa: ARG001
    return motion._replace(brake_torque=motion.brake_torque - motion.dynamic_torque)


def forget_the_pads(plant, given, motion):  # noqa: ARG001
    return motion._replace(brake_torque=given["torque"])


FAULTS = {
    "magnets": ("train_motion", forget_magnets),
    "blended": ("axle_motion", forget_the_electrodynamic_brake),
    "pads": ("axle_motion", forget_the_pads),
}


@pytest.mark.parametrize("parts", FAULTS)
def test_a_force_that_acts_and_is_not_counted_is_seen(monkeypatch, with_parts, make_controller, parts):
    method, forget = FAULTS[parts]
    true = getattr(Quarter, method)
    monkeypatch.setattr(
        Quarter, method, lambda plant, *rails, **given: forget(plant, given, true(plant, *rails, **given))
    )
    vehicle, scenario = with_parts(parts), Scenario(rail=DRY, initial_speed=10.0)
    run = simulate(vehicle, make_controller("none", "polach-dry"), scenario, plant="quarter")
    # An exponential step gives the train what the brakes are said to take, so that the momentum tells less.
    assert abs(momentum_residual(run, vehicle)) > 1e-5
    assert abs(energy_residual(run, vehicle)) > 1e-3


SCENARIOS = {
    "plain": Scenario(rail=LOW, initial_speed=15.0),
    "dead time, change of rail and grade": Scenario(
        rail=LOW,
        initial_speed=15.0,
        grade=-0.01,
        patches=(Patch(start=20.0, rail=DRY),),
        sensing=Sensing(dead_time=0.13),
    ),
}


@pytest.mark.parametrize(
    ("name", "case"), [("none", "plain"), ("trenitalia", "dead time, change of rail and grade")]
)
def test_compiled_and_virtual_machine_agree(with_parts, make_controller, case, name):
    plant, law = Planar(with_parts("all")), make_controller(name, "low-adhesion")
    given = replace(loop_input([(plant, SCENARIOS[case])], law), trace_rows=10_000)
    rows = sample_rows(law)
    compiled = load_closed_loop(plant, law).run(given, sample_rows=rows)
    virtual = run_virtual(plant, law, given, sample_rows=rows, disturbed=False)
    np.testing.assert_allclose(virtual.trace, compiled.trace, rtol=1e-8, atol=1e-8)
    np.testing.assert_allclose(virtual.samples, compiled.samples, rtol=1e-8, atol=1e-8)
    for name_ in compiled.lane_totals:
        np.testing.assert_allclose(
            virtual.lane_totals[name_], compiled.lane_totals[name_], rtol=1e-8, atol=1e-8
        )
    dynamic = compiled.trace[:, 3 + 5 * plant.axles : 3 + 6 * plant.axles]
    assert dynamic.max() > 1e3  # it blended in
    assert compiled.trace[:, -plant.axles :].max() > 5.0  # and the pads got warm


OTHER_BRAKES = {
    "ramp and lag": {"build_up": "electro-pneumatic", "build_up_delay": 0.2, "build_up_ramp": 1.0},
    "ramp and orifice": {
        "build_up": "electro-pneumatic",
        "build_up_delay": 0.2,
        "build_up_ramp": 1.0,
        "valve": "orifice",
        "reservoir_pressure": 8e5,
    },
    "low reservoir": {"cylinder_volume": 0.01, "reservoir_volume": 0.08, "reservoir_pressure": 8e5},
}


@pytest.mark.parametrize("kind", OTHER_BRAKES)
def test_every_valve_lets_the_cylinder_down_to_what_is_asked(with_parts, make_controller, kind):
    vehicle = with_parts("blended")
    vehicle = replace(vehicle, brake=replace(vehicle.brake, **OTHER_BRAKES[kind]))
    law, scenario = make_controller("none"), Scenario(rail=DRY, initial_speed=30.0)
    run = simulate(vehicle, law, scenario, plant="quarter")
    steady = run.dynamic_torque[:, 0] > 0.9999 * DYNAMIC.torque
    late = steady & (
        run.time > float(run.time[np.argmax(steady)]) + 3.0
    )  # five time constants of the cylinder
    assert late.any()
    assert run.torque[late, 0] == pytest.approx(vehicle.brake.max_torque, rel=0.02)
    assert abs(momentum_residual(run, vehicle)) < 1e-12
    assert abs(energy_residual(run, vehicle)) < 1e-6
    if kind != "ramp and orifice":
        return
    plant = Quarter(vehicle)  # which the stop above has compiled
    given = replace(
        loop_input([(plant, replace(scenario, rail=LOW, initial_speed=10.0))], law), trace_rows=20_000
    )
    compiled = load_closed_loop(plant, law).run(given, sample_rows=sample_rows(law))
    virtual = run_virtual(plant, law, given, sample_rows=sample_rows(law), disturbed=False)
    np.testing.assert_allclose(virtual.trace, compiled.trace, rtol=1e-8, atol=1e-8)
    for name in compiled.lane_totals:
        np.testing.assert_allclose(
            virtual.lane_totals[name], compiled.lane_totals[name], rtol=1e-8, atol=1e-8
        )


def test_axles_without_a_motor_brake_by_friction_alone(with_parts, make_controller):
    vehicle = with_parts("blended")
    vehicle = replace(vehicle, dynamic=replace(DYNAMIC, axle_shares=(1.0, 0.5, 0.0, 0.0)))
    scenario = Scenario(rail=DRY, initial_speed=30.0)
    run = simulate(vehicle, make_controller("none"), scenario)
    late = np.argmax(run.speed < 10.0)
    assert run.dynamic_torque[late] == pytest.approx((9e3, 4.5e3, 0.0, 0.0), rel=1e-6, abs=1e-6)
    assert run.torque[late] == pytest.approx(vehicle.brake.max_torque, rel=0.02)
    with pytest.raises(UserError, match='other brakes than the rest, which need the plant "planar"'):
        simulate(vehicle, make_controller("none"), scenario, plant="quarter")


def test_the_friction_brake_supplies_the_rest(with_parts, make_controller):
    # Nothing slides: the torque is the demanded one, but for the lag of the cylinder behind the other brake.
    vehicle = with_parts("blended")
    run = simulate(vehicle, make_controller("none"), Scenario(rail=DRY, initial_speed=30.0), plant="quarter")
    built_up = (run.time > 8.0) & (run.speed > 5.0)
    total, demanded = run.torque[built_up, 0], vehicle.brake.max_torque
    slopes = np.gradient(run.dynamic_torque[:, 0], run.time)[built_up]
    lag = vehicle.brake.fill_time + 0.1  # and one sample
    assert np.abs(total - demanded).max() < 1.1 * lag * np.abs(slopes).max() < 0.06 * demanded
    assert run.dynamic_torque[built_up, 0].min() > 0.4 * demanded
    assert run.dynamic_torque[built_up, 0].max() == pytest.approx(DYNAMIC.torque, rel=1e-6)
    assert float(run.dynamic_torque[-1, 0]) == 0.0  # it has cut out
    assert float(run.torque[-1, 0]) == pytest.approx(demanded, rel=0.05)  # friction has taken over


def test_the_power_limits_the_torque_at_speed(with_parts, make_controller):
    vehicle = with_parts("blended")
    run = simulate(vehicle, make_controller("none"), Scenario(rail=DRY, initial_speed=30.0), plant="quarter")
    fast = (run.time > 3.0) & (run.speed > 20.0)
    power = run.dynamic_torque[fast, 0] * run.wheel_speed[fast, 0]
    assert power == pytest.approx(DYNAMIC.power, rel=1e-3)


def test_it_drops_out_where_the_wheel_slides_and_friction_takes_over(with_parts, make_controller):
    scenario = Scenario(
        rail=DRY, initial_speed=30.0, patches=(Patch(start=100.0, rail=LOW), Patch(start=160.0, rail=DRY))
    )
    vehicle, law = with_parts("blended"), make_controller("none")
    run = simulate(vehicle, law, scenario)
    front = run.dynamic_torque[:, 0]
    slid = float(run.time[np.argmax(run.slip[:, 0] > DYNAMIC.drop_slip)])
    assert front[run.time < slid].max() > 5e3
    gone = run.time > slid + law.sample_time + 10.0 * DYNAMIC.build_up_time
    assert front[gone].max() < 1.0  # for the rest of the stop
    again = gone & (run.slip[:, 0] < 0.01) & (run.speed > 3.0)
    assert again.any()
    assert run.torque[again, 0] == pytest.approx(vehicle.brake.max_torque, rel=0.02)
    stays = simulate(replace(vehicle, dynamic=replace(DYNAMIC, drop_slip=1.0)), law, scenario)
    assert stays.dynamic_torque[stays.time > float(run.time[gone][0]), 0].max() > 5e3


@pytest.mark.parametrize("parts", PARTS)
@pytest.mark.parametrize("name", ["none", "trenitalia"])
def test_steps_are_short_enough(with_parts, make_controller, parts, name):
    scenario = Scenario(rail=LOW, initial_speed=20.0)
    _, check = simulate_checked(with_parts(parts), make_controller(name, "low-adhesion"), scenario)
    assert not check.unresolved


@pytest.mark.parametrize("parts", ["blended", "all"])
def test_nothing_stops_shorter_than_the_ideal_brake(with_parts, make_controller, parts):
    vehicle, scenario = with_parts(parts), Scenario(rail=LOW, initial_speed=20.0)
    ideal = ideal_stop(vehicle, scenario).distance
    for name in ("none", "trenitalia", "torque-feedback"):
        assert simulate(vehicle, make_controller(name, "low-adhesion"), scenario).totals.distance > ideal
    dry = replace(scenario, rail=DRY)  # where nothing slides the ideal brake is any brake
    usual = simulate(vehicle, make_controller("none"), dry).totals.distance
    assert ideal_stop(vehicle, dry).distance == pytest.approx(usual, rel=1e-6)


def test_magnets_shorten_a_stop_on_a_slippery_rail(with_parts, make_controller):
    scenario, law = Scenario(rail=LOW, initial_speed=30.0), make_controller("trenitalia", "low-adhesion")
    vehicle = with_parts("magnets")
    without = simulate(replace(vehicle, track_brake=None), law, scenario)
    run = simulate(vehicle, law, scenario)
    assert run.totals.distance < 0.75 * without.totals.distance
    impulse = np.trapezoid(run.track_brake_force, run.time)
    rolling = without.totals.resistance_impulse * float(run.time[-1] / without.time[-1])
    assert run.totals.resistance_impulse == pytest.approx(impulse + rolling, rel=0.02)
    assert run.track_brake_force[run.speed < 6.9].max() == 0.0  # lifted
