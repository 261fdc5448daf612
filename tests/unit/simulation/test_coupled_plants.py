"""A coupled plant in the closed loop: the planar one in this form gives the stops of the planar one."""

from dataclasses import replace

import numpy as np
import pytest
from coupled_planar import CoupledPlanar
from test_lock import LOCK_AND_RELEASE

from wspd_design.codegen.closed_loop import load_closed_loop
from wspd_design.codegen.kernels import plant_kernels
from wspd_design.codegen.virtual_machine import run_virtual
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.files import load_entries
from wspd_design.parameters.loading import load_rail, load_track_spectrum
from wspd_design.plants.planar import Planar
from wspd_design.simulation.batch import run_batch
from wspd_design.simulation.draws import Deck, within_bounds_of_stop, within_own_bounds
from wspd_design.simulation.loop_input import loop_input, sample_rows
from wspd_design.simulation.records import Fault, LoadIrregularity, Patch, Scenario, Sensing
from wspd_design.simulation.stop import simulate_on
from wspd_design.simulation.track import irregular_track

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


def engines(plant, law, scenario):
    """The same stop compiled and in the virtual machine."""
    given = replace(loop_input([(plant, scenario)], law), trace_rows=20_000)
    rows = sample_rows(law)
    compiled = load_closed_loop(plant, law).run(given, sample_rows=rows)
    return compiled, run_virtual(plant, law, given, sample_rows=rows, disturbed=False)


def test_without_a_compiler_the_numbers_are_the_same(er24pc, make_controller):
    scenario = replace(
        WET, initial_speed=6.0, patches=(Patch(start=5.0, rail=load_rail("polach-dry")),), grade=-0.01
    )
    compiled, virtual = engines(CoupledPlanar(er24pc), make_controller("trenitalia"), scenario)
    assert (virtual.steps, virtual.trace.shape) == (compiled.steps, compiled.trace.shape)
    np.testing.assert_allclose(virtual.trace, compiled.trace, rtol=1e-7, atol=1e-7)
    for name, values in compiled.lane_totals.items():
        np.testing.assert_allclose(virtual.lane_totals[name], values, rtol=1e-7, atol=1e-9, err_msg=name)


def test_the_track_under_every_wheel_is_that_of_its_table(er24pc, make_controller):
    # A stop so long that the table repeats: 3 km from 144 km/h with a gentle brake.
    scenario = replace(WET, initial_speed=40.0, irregularities="high", seed=7)
    gentle = replace(er24pc, brake=replace(er24pc.brake, max_torque=2.5e3))
    run = simulate_on(CoupledPlanar(gentle, track_gain=10.0), make_controller("none"), scenario)
    table = irregular_track(load_track_spectrum("erri-b176"), "high", seed=7)
    assert run.distance[-1] > 1.2 * table.period
    offsets = Planar(gentle).offsets
    heights = np.column_stack([table.at(run.distance - offset)[0][0] for offset in offsets])
    assert np.abs(heights).max() > 3e-3
    # Transfers move load and make none: without what the track does the loads add up to the weight.
    total = (run.wheel_load / (1.0 + 10.0 * heights)).sum(axis=1)
    np.testing.assert_allclose(total, gentle.mass * 9.81 / 2, rtol=1e-9)


def test_without_a_compiler_the_track_is_the_same(er24pc, make_controller):
    compiled, virtual = engines(
        CoupledPlanar(er24pc, track_gain=10.0),
        make_controller("trenitalia"),
        replace(WET, irregularities="low"),
    )
    assert compiled.stop_totals["distance"][0] > 40.0
    np.testing.assert_allclose(virtual.trace, compiled.trace, rtol=1e-7, atol=1e-7)


def test_an_irregular_track_needs_a_plant_that_rolls_over_it(er24pc, make_controller):
    with pytest.raises(UserError, match='"planar" does not; take the plant "locomotive"'):
        simulate_on(Planar(er24pc), make_controller("none"), replace(WET, irregularities="low"))
    even = LoadIrregularity(spacing=1.0, factors=((1.0,),) * 4)
    with pytest.raises(UserError, match="works out its wheel loads itself"):
        simulate_on(CoupledPlanar(er24pc), make_controller("none"), replace(WET, load_irregularity=even))


def test_numbers_of_the_own_file_are_drawn(er24pc, make_controller):
    plant = CoupledPlanar(er24pc)
    draws = within_own_bounds(plant)
    assert [draw.name for draw in draws] == ["multibody.track_gain"]
    scenario = replace(WET, irregularities="low")
    cases = Deck(plant, scenario, draws).cases(0, 3)
    gains = [each.track_gain for each, _ in cases]
    assert len(set(gains)) == 3
    assert all(0.0 < gain < 10.0 for gain in gains)
    assert plant_kernels(cases[0][0], disturbed=False) is plant_kernels(plant, disturbed=False)
    law = make_controller("trenitalia")
    one, other = (simulate_on(each, law, stop).totals.distance for each, stop in cases[:2])
    assert one != other
    with pytest.raises(UserError, match=r'did you mean "multibody\.track_gain"'):
        Deck(plant, scenario, [replace(draws[0], name="multibody.track_gian")])


def test_what_moves_load_on_the_planar_plant_alone_is_not_drawn(er24pc):
    files = (load_entries("vehicle", "er24pc"),)
    planar, coupled = (
        {draw.name for draw in within_bounds_of_stop(WET, files, kind(er24pc))}
        for kind in (Planar, CoupledPlanar)
    )
    assert planar - coupled >= {"vehicle.body_height", "vehicle.body_pitch_frequency"}
    assert coupled >= {"vehicle.mass", "vehicle.wheelset_inertia", "vehicle.brake.fill_time"}


def test_a_stop_does_not_know_those_beside_it(er24pc, make_controller):
    law, stops = make_controller("trenitalia"), 16
    cases = [
        (
            CoupledPlanar(er24pc, track_gain=5.0),
            replace(WET, initial_speed=6.0, irregularities=level, seed=seed),
        )
        for seed in range(stops // 2)
        for level in ("high", "none")
    ]
    beside = run_batch(cases, law, lambda some: loop_input(some, law), what="here")
    alone = [
        load_closed_loop(cases[0][0], law).run(loop_input([case], law)).stop_totals["distance"][0]
        for case in cases
    ]
    np.testing.assert_array_equal(beside.stops["distance"], alone)
    assert len(set(alone)) == 1 + stops // 2
