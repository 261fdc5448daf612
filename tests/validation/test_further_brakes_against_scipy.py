"""Stops with pads that fade, an electrodynamic brake and magnets against a second simulation by SciPy's Radau."""

from dataclasses import replace

import pytest
from independent_further_brakes import IndependentFurtherBrakes

from wspd_design.parameters.loading import load_rail, load_vehicle
from wspd_design.parameters.records import DynamicBrake, Pads, TrackBrake
from wspd_design.simulation.records import Scenario
from wspd_design.simulation.self_check import simulate_checked

# Every corner of the tables is passed within a stop from 8 m/s, and the pads get warm enough to fade.
PADS = Pads(
    speeds=(1.0, 3.0, 5.0, 7.0),
    speed_factors=(1.2, 1.05, 0.9, 0.8),
    temperatures=(0.0, 40.0, 120.0),
    temperature_factors=(1.0, 1.1, 0.7),
    heat_capacity=6e3,
    cooling=50.0,
)
DYNAMIC = DynamicBrake(
    torque=9e3, power=90e3, build_up_time=0.3, fade_speed=3.0, cut_out_speed=1.2, drop_slip=0.2
)
MAGNETS = TrackBrake(
    force=30e3, build_up_time=0.4, cut_out_speed=2.5, speeds=(2.0, 4.0, 8.0), speed_factors=(1.3, 1.1, 0.8)
)
PARTS = {
    "pads": {"pads": PADS},
    "blended": {"dynamic": DYNAMIC},
    "magnets": {"track_brake": MAGNETS},
    "all": {"pads": PADS, "dynamic": DYNAMIC, "track_brake": MAGNETS},
}


def both(parts, law, rail):
    vehicle = replace(load_vehicle("er24pc-service"), **PARTS[parts])
    scenario = Scenario(rail=load_rail(rail), initial_speed=8.0)
    run, check = simulate_checked(vehicle, law, scenario, plant="quarter")
    assert not check.unresolved
    return run, IndependentFurtherBrakes(vehicle, load_rail(rail)).run(law, 8.0)


@pytest.mark.parametrize(
    ("parts", "law", "rail"),
    [
        pytest.param("pads", "none", "polach-dry", marks=pytest.mark.reference),  # "all" has them, too
        ("blended", "none", "polach-dry"),
        pytest.param("magnets", "trenitalia", "low-adhesion", marks=pytest.mark.reference),
        ("all", "trenitalia", "low-adhesion"),
    ],
)
def test_distance_and_time(make_controller, parts, law, rail):
    run, (time, state, _) = both(parts, make_controller(law, rail), rail)
    assert run.totals.distance == pytest.approx(state[2], rel=2e-7)
    assert float(run.time[-1]) == pytest.approx(time, rel=2e-7)
    if run.pad_temperature is not None:
        assert float(run.pad_temperature[-1, 0]) == pytest.approx(state[4], rel=1e-6)
        assert state[4] > 20.0


def test_the_electrodynamic_brake_drops_out_at_the_same_sample(make_controller):
    run, (_, _, dropped) = both("blended", make_controller("none", "low-adhesion"), "low-adhesion")
    falling = run.time[(run.dynamic_torque[:, 0] < 0.99 * run.dynamic_torque.max()) & (run.time > dropped)]
    assert 0.1 < dropped < float(run.time[-1]) - 1.0
    assert float(falling[0]) - dropped < 0.02
    after = run.time > dropped + 10.0 * DYNAMIC.build_up_time
    assert after.any()
    assert float(run.dynamic_torque[after].max()) < 1e-3 * DYNAMIC.torque
