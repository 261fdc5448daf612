"""A coupled plant in the closed loop: the planar one in this form gives the stops of the planar one."""

from dataclasses import replace

import numpy as np
import pytest
from coupled_planar import CoupledPlanar
from test_lock import LOCK_AND_RELEASE

from wspd_design.parameters.loading import load_rail
from wspd_design.plants.planar import Planar
from wspd_design.simulation.records import Fault, Patch, Scenario, Sensing
from wspd_design.simulation.stop import simulate_on

WET = Scenario(rail=load_rail("polach-wet"), initial_speed=60.0 / 3.6)
FEATURES = {
    "plain": {},
    "grade": {"grade": -0.02},
    "patches and axle rails": {
        "patches": (Patch(start=20.0, rail=load_rail("polach-dry")),),
        "axle_rails": tuple(load_rail(f"polach-{name}") for name in ("wet", "wet", "dry", "dry")),
    },
    "sensors, dead time and a stuck valve": {
        "sensing": Sensing(speed_noise=0.02, pulses_per_turn=80, dead_time=0.04),
        "faults": (Fault(axle=2, kind="valve-holds", since=1.0),),
    },
}


def both(vehicle, law, scenario):
    return (simulate_on(kind(vehicle), law, scenario, refinement=2) for kind in (Planar, CoupledPlanar))


def assert_same(coupled, planar):
    assert coupled.totals.distance == pytest.approx(planar.totals.distance, rel=1e-6)
    for name in ("torque", "brake_work", "sliding_work", "resistance_work", "lock_time", "vented_pressure"):
        assert getattr(coupled.totals, name) == pytest.approx(
            getattr(planar.totals, name), rel=1e-5, abs=2e-6
        ), name
    assert coupled.slip_max == pytest.approx(planar.slip_max, abs=1e-5)
    assert len(coupled.samples) == len(planar.samples)
    np.testing.assert_allclose(
        [each.seen.wheel_speed for each in coupled.samples],
        [each.seen.wheel_speed for each in planar.samples],
        atol=2e-3,
    )


@pytest.mark.parametrize("feature", FEATURES)
def test_the_stop_is_that_of_the_planar_plant(er24pc, make_controller, feature):
    planar, coupled = both(er24pc, make_controller("trenitalia"), replace(WET, **FEATURES[feature]))
    assert_same(coupled, planar)


def test_wheels_lock_and_are_let_go(er24pc):
    planar, coupled = both(er24pc, LOCK_AND_RELEASE, replace(WET, initial_speed=120.0 / 3.6))
    assert 1.0 < planar.totals.lock_time < 0.9 * planar.time[-1]
    assert_same(coupled, planar)
    assert coupled.wheel_speed.min() == 0.0


def test_further_traces_are_recorded_from_the_start(er24pc, make_controller):
    run = simulate_on(CoupledPlanar(er24pc), make_controller("trenitalia"), WET)
    assert run.time[0] == 0.0
    np.testing.assert_array_equal(run.further["doubled_load"], 2.0 * run.wheel_load)
    np.testing.assert_allclose(run.wheel_load[0], er24pc.mass * 9.81 / 8, rtol=1e-12)
