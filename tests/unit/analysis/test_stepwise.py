"""Stops by steps against a worked example of another program, closed forms and our simulation."""

from dataclasses import replace

import pytest

from tests.unit.analysis.test_stopping import DISC as EXAMPLE_DISC
from wspd_design.analysis.stepwise import march, rolling_stop
from wspd_design.analysis.stopping import demanded_adhesion, full_adhesion_stop, rim_force
from wspd_design.controllers.baselines.unprotected import Unprotected
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import load_rail, load_vehicle
from wspd_design.parameters.records import DynamicBrake, Pads, TrackBrake
from wspd_design.simulation.records import Scenario
from wspd_design.simulation.stop import simulate

DISC = replace(EXAMPLE_DISC, build_up_time=1.0)


def unit(disc_force, step=0.01):
    """Four axles with an electrodynamic brake and four with discs, RailProfAC/RailwayBrakeCalculation, by steps.

    The discs of all four together give what the electrodynamic brake lacks to 130 kN, at most their own force; that
    program takes the force of the pads for it, which is no force at the rim.
    """

    def deceleration(time, speed):
        built_up = min(max((time - 0.3) / 1.0, 0.0), 1.0)
        electric = 4 * 25e3 * min(1.0, 15.0 / max(speed, 1e-9)) * built_up
        discs = min(130e3 - electric, 4 * disc_force * built_up if built_up < 1.0 else 4 * disc_force)
        discs = min(discs, (130e3 - electric) * built_up)
        running = 3000.0 + 110.0 * speed + 7.0 * speed**2
        return (electric + discs + running) / (4 * 15e3 + 4 * 14.5e3 + 4 * 1.5e3 + 4 * 0.7e3)

    return march(200 / 3.6, deceleration, step=step)


def test_the_blended_stop_of_the_example():
    distance, time = unit(DISC.retarding_force)
    assert distance == pytest.approx(2006.3, rel=5e-4)
    assert time == pytest.approx(66.13, rel=1e-3)


def test_the_force_of_the_pads_gives_the_distance_that_is_wrong():
    pads = (3.0e5 * 324e-4 * 0.98 - 500.0) * 5.0 * 0.95
    distance, _ = unit(pads)
    assert distance == pytest.approx(1361.0, rel=2e-3)


@pytest.mark.parametrize("deceleration", [0.5, 1.2])
def test_a_constant_deceleration_is_exact(deceleration):
    distance, time = march(30.0, lambda _time, _speed: deceleration)
    assert distance == pytest.approx(450.0 / deceleration, rel=1e-12)
    assert time == pytest.approx(30.0 / deceleration, rel=1e-12)


def test_one_that_is_proportional_to_the_speed_never_stops():
    with pytest.raises(UserError, match=r"still runs at .* km/h after 600 s"):
        march(30.0, lambda _time, speed: 1e-3 * speed)


PARTS = {
    "none": {},
    "pads": {
        "pads": Pads(
            speeds=(0.0, 10.0, 40.0),
            speed_factors=(1.2, 1.0, 0.7),
            temperatures=(0.0, 100.0),
            temperature_factors=(1.0, 0.8),
            heat_capacity=1e5,
        )
    },
    "electrodynamic brake": {
        "dynamic": DynamicBrake(torque=9e3, power=240e3, build_up_time=0.5, fade_speed=3.0, cut_out_speed=1.0)
    },
    "magnets": {"track_brake": TrackBrake(force=4e4, build_up_time=0.5, cut_out_speed=10.0)},
}
PARTS["all"] = {name: part for parts in list(PARTS.values()) for name, part in parts.items()}


@pytest.mark.parametrize("parts", PARTS)
@pytest.mark.parametrize(("kmh", "grade"), [(60.0, 0.0), (140.0, -0.01)])
def test_a_simulated_stop_without_sliding_is_the_same(parts, kmh, grade):
    vehicle = replace(load_vehicle("er24pc-service"), **PARTS[parts])
    scenario = replace(Scenario.stop(from_kmh=kmh, rail=load_rail("table10-dry")), grade=grade)
    run = simulate(vehicle, Unprotected(name="none", sample_time=0.1), scenario)
    assert run.slip_max < 0.02
    distance, time = rolling_stop(vehicle, kmh / 3.6, grade=grade)
    assert distance == pytest.approx(run.totals.distance, rel=0.005)
    assert time == pytest.approx(float(run.time[-1]), rel=0.005)
    if not PARTS[parts]:
        return
    stop = full_adhesion_stop(vehicle, kmh / 3.6, grade=grade)
    assert stop.distance == distance
    by_means = kmh / 3.6 * stop.equivalent_time + (kmh / 3.6) ** 2 / (2.0 * stop.deceleration)
    assert by_means == pytest.approx(stop.distance, rel=1e-9)


def test_half_the_step_changes_next_to_nothing():
    vehicle = replace(load_vehicle("er24pc-service"), **PARTS["all"])
    distances = [rolling_stop(vehicle, 40.0, step=step)[0] for step in (0.02, 0.01)]
    assert distances[0] == pytest.approx(distances[1], rel=1e-4)


def test_fading_pads_stop_later():
    vehicle = load_vehicle("er24pc-service")
    faded = replace(vehicle, **PARTS["pads"])
    assert full_adhesion_stop(faded, 40.0).distance > 1.03 * full_adhesion_stop(vehicle, 40.0).distance


def test_the_brake_asks_for_most_where_its_force_is_largest():
    vehicle = load_vehicle("er24pc-service")
    usual = demanded_adhesion(vehicle)
    faded = replace(vehicle, **PARTS["pads"])  # 1.2 times as much at standstill
    assert rim_force(faded) == pytest.approx(1.2 * rim_force(vehicle), rel=0.005)
    assert demanded_adhesion(faded) == pytest.approx(1.2 * usual, rel=0.005)
    blended = replace(vehicle, **PARTS["electrodynamic brake"])
    assert demanded_adhesion(blended) == pytest.approx(usual, rel=1e-6)  # friction supplies the rest, no more
    strong = replace(blended, dynamic=replace(blended.dynamic, torque=30e3, power=1e6))
    assert demanded_adhesion(strong) == pytest.approx(2.0 * usual, rel=1e-3)
