"""The ladder of models: what a stop is taken apart into, and which model is said to suffice."""

import math
from dataclasses import replace

import numpy as np
import pytest

from wspd_design.parameters.loading import load_rail, load_vehicle
from wspd_design.simulation.records import Scenario
from wspd_design.studies.ladder import Ladder, ladder, models_of
from wspd_design.studies.rung import axle_figures

RADIUS = 0.55


@pytest.fixture(scope="module")
def found(er24pc, make_controller):
    scenario = Scenario.stop(from_kmh=60.0, rail=load_rail("polach-dry"))
    return ladder(
        er24pc,
        make_controller("afsmc"),
        scenario,
        slip_reference=0.14,
        models=models_of(er24pc)[:2],
    )


@pytest.fixture(scope="module")
def planar(found):
    return found.rungs[-1]


def figures(run, build_up=0.0):
    return axle_figures(run, wheelsets=4, wheel_radius=RADIUS, build_up=build_up)


def test_the_models_of_a_vehicle_are_the_rungs(found):
    assert [each.plant for each in found.rungs] == ["quarter", "planar"]
    single = replace(load_vehicle("er24pc"), wheelsets=1, axles_per_bogie=1, multibody="")
    assert [each.title for each in models_of(single)] == ["quarter"]
    assert [each.title for each in models_of(load_vehicle("er24pc"))] == [
        "quarter",
        "planar",
        "locomotive",
        "irregular track",
    ]


def test_one_wheelset_stands_for_all(found):
    assert len(found.rungs[0].axles) == 4
    assert len(set(found.rungs[0].axles)) == 1


def test_braking_loads_the_front_and_the_vehicle_weighs_the_same(planar):
    front, *_, rear = planar.axles
    assert front.transfer > 0.05
    assert rear.transfer < -0.05
    # The mean force is that of gravity, whatever moves between the wheelsets.
    assert sum(each.braking_load for each in planar.axles) == pytest.approx(
        sum(each.static_load for each in planar.axles), rel=1e-9
    )


def test_the_quarter_model_misses_the_load_transfer_and_nothing_else_is_judged_by_it(found):
    by_name = {each.measure.name: each for each in found.agreements}
    transfer = by_name["load transfer"]
    largest = max(abs(each.transfer) for each in found.rungs[-1].axles)
    assert transfer.deviations == (pytest.approx(largest), 0.0)
    assert transfer.suffices == 1
    distances = [each.metrics.distance for each in found.rungs]
    assert by_name["distance"].deviations[0] == pytest.approx(abs(distances[0] / distances[1] - 1.0))


def test_a_model_suffices_only_if_all_above_it_do(found):
    quarter, planar = found.rungs
    far = replace(planar, metrics=replace(planar.metrics, distance=1.05 * planar.metrics.distance))
    middle = replace(found, rungs=(planar, far, planar))
    (distance, *_) = middle.agreements
    assert distance.measure.name == "distance"
    assert distance.suffices == 2
    assert isinstance(middle, Ladder)
    (distance, *_) = replace(found, rungs=(far, planar, planar)).agreements
    assert distance.suffices == 1
    assert quarter.title == "quarter"


def test_what_a_stop_does_not_have_suffices_nowhere_below(found):
    quarter, planar = found.rungs
    silent = replace(quarter, axles=tuple(replace(each, vibration=math.nan) for each in quarter.axles))
    *_, vibration = replace(found, rungs=(silent, planar)).agreements
    assert vibration.suffices == 1


@pytest.mark.parametrize("hertz", [10.5, 14.0])
def test_a_planted_vibration_is_found_with_its_size_and_frequency(planar, hertz):
    """A wheel that swings by 0.2 m/s from 2.0 to 3.5 s: rms 0.2/sqrt(2) there, and no wheelset else is touched."""
    run = planar.run
    wheels = np.full_like(run.wheel_speed, 10.0)
    during = (run.time > 2.0) & (run.time < 3.5)
    wheels[during, 2] += 0.2 / RADIUS * np.sin(2.0 * math.pi * hertz * run.time[during])
    axles = figures(replace(run, wheel_speed=wheels))
    assert axles[2].vibration == pytest.approx(0.2 / math.sqrt(2.0), rel=0.03)
    assert axles[2].vibration_frequency == pytest.approx(hertz, abs=0.3)
    assert np.interp(3.5, run.time, run.speed) <= axles[2].vibration_speed
    assert axles[2].vibration_speed <= np.interp(2.0, run.time, run.speed)
    assert max(axles[k].vibration for k in (0, 1, 3)) < 1e-9


def test_what_a_wheel_does_outside_the_band_is_no_vibration(planar):
    run = planar.run
    wheels = np.full_like(run.wheel_speed, 10.0)
    wheels[:, 0] += 0.5 * np.sin(2.0 * math.pi * 1.0 * run.time)
    wheels[:, 1] += 0.5 * np.sin(2.0 * math.pi * 60.0 * run.time)
    axles = figures(replace(run, wheel_speed=wheels))
    assert max(axles[0].vibration, axles[1].vibration) < 0.01


def test_the_spread_of_a_load_is_that_of_its_noise(planar):
    """A load that swings quickly by 5 kN about a slow ramp spreads by 5/sqrt(2) kN: the ramp is no spread."""
    run = planar.run
    load = np.full_like(run.wheel_load, 9e4)
    load[:, 1] += 5e3 * np.sin(2.0 * math.pi * 8.0 * run.time) - 1e3 * run.time
    axles = figures(replace(run, wheel_load=load))
    assert axles[1].load_spread == pytest.approx(5e3 / math.sqrt(2.0), rel=0.02)
    assert axles[0].load_spread < 1e-6


def test_the_wheel_that_swings_more_counts_where_both_are_told_apart(planar):
    run = planar.run
    left = run.wheel_load + 4e3 * np.sin(2.0 * math.pi * 8.0 * run.time)[:, np.newaxis]
    right = 2.0 * run.wheel_load - left
    axles = figures(replace(run, further={"wheel_load_left": left, "wheel_load_right": right}))
    alone = figures(run)
    for both, one in zip(axles, alone, strict=True):
        assert both.braking_load == pytest.approx(one.braking_load, rel=1e-12)
        assert both.load_spread == pytest.approx(math.hypot(one.load_spread, 4e3 / math.sqrt(2.0)), rel=0.02)
        assert both.least_load < one.least_load - 3.5e3


def test_loads_count_once_the_brake_is_built_up(planar):
    run = planar.run
    load = np.where(run.time < 2.0, 1e5, 8e4)[:, np.newaxis] * np.ones((1, 4))
    assert figures(replace(run, wheel_load=load), build_up=2.1)[0].braking_load == pytest.approx(8e4)
    assert figures(replace(run, wheel_load=load), build_up=math.nan)[0].braking_load > 8.1e4


def test_half_steps_are_compared(found):
    assert all(0.0 < each.step_change < 1e-6 for each in found.rungs)
