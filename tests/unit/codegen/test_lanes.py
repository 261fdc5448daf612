"""A stop has the same bits wherever it runs: beside other stops, in threads, and with other compiler options."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest

from wspd_design.codegen import compiler
from wspd_design.codegen.closed_loop import ClosedLoop, closed_loop_source, load_closed_loop
from wspd_design.codegen.compiler import load_library
from wspd_design.codegen.kernels import plant_kernels
from wspd_design.codegen.law_library import LoadedLaw, law_source
from wspd_design.codegen.laws import law_kernels
from wspd_design.parameters.loading import load_rail
from wspd_design.plants.planar import Planar
from wspd_design.simulation.loop_input import loop_input, sample_rows
from wspd_design.simulation.records import LoadIrregularity, Patch, Scenario, Sensing, Start

SPEEDS = (10.0, 9.0, 4.0, 10.0, 0.5, 7.0, 10.0, 8.5)


@pytest.fixture(scope="module", params=["afsmc", "trenitalia", "mitsubishi"])
def law(request, make_controller):
    return make_controller(request.param, "polach-wet")


@pytest.fixture(scope="module")
def scenario():
    return Scenario(rail=load_rail("polach-wet"), initial_speed=10.0)


def results(output, stop=0, stops=1):
    """All numbers of one of the stops."""
    lanes = [values[stop::stops] for values in (*output.lane_totals.values(), output.wheel_speeds)]
    return np.concatenate([*lanes, [values[stop] for values in output.stop_totals.values()]])


def cases(vehicle, scenario, speeds):
    return [
        (Planar(vehicle), replace(scenario, initial_speed=speed, seed=7 * k))
        for k, speed in enumerate(speeds)
    ]


@pytest.mark.parametrize("stops", [2, 8])
def test_a_stop_does_not_depend_on_the_stops_beside_it(er24pc, law, scenario, stops):
    noisy = replace(scenario, sensing=Sensing(speed_noise=0.01, dead_time=0.03))
    several = cases(er24pc, noisy, SPEEDS[:stops])
    beside = load_closed_loop(Planar(er24pc), law, stops=stops).run(loop_input(several, law))
    alone = load_closed_loop(Planar(er24pc), law)
    assert beside.stopped.all()
    for stop, case in enumerate(several):
        single = alone.run(loop_input([case], law))
        np.testing.assert_array_equal(results(beside, stop, stops), results(single))


def test_stops_side_by_side_start_where_each_of_them_starts(er24pc, law, scenario):
    starts = (Start(), Start(slip=0.3, torque=10e3, braking_time=1.0))
    several = [(Planar(er24pc), replace(scenario, start=start)) for start in starts]
    loop = load_closed_loop(Planar(er24pc), law, stops=2)
    beside = loop.run(loop_input(several, law))
    alone = load_closed_loop(Planar(er24pc), law)
    singles = [results(alone.run(loop_input([case], law))) for case in several]
    for stop, single in enumerate(singles):
        np.testing.assert_array_equal(results(beside, stop, 2), single)
    assert not np.array_equal(*singles)


WAVES = tuple(tuple(1.0 + 0.05 * (-1) ** (k + axle) for k in range(5 + axle)) for axle in range(4))
APART = (
    {},
    {"sensing": Sensing(speed_noise=0.05, dead_time=0.25, shortest_pulse=0.01)},
    {"sensing": Sensing(pulses_per_turn=80), "grade": 0.02},
    {"sensing": Sensing(pulses_per_turn=100, period_timing=True, dead_time=0.03)},
    {"sensing": Sensing(reference_error=0.02, reference_drift=-0.1, reference_noise=0.1)},
    {"pad_vibration": True, "sensing": Sensing(torque_error=-0.1)},
    {
        "patches": (
            Patch(start=3.0, rail=load_rail("low-adhesion")),
            Patch(start=9.0, rail=load_rail("polach-wet")),
        )
    },
    {"load_irregularity": LoadIrregularity(spacing=0.7, factors=WAVES), "grade": -0.02},
)


def test_every_disturbance_is_that_of_its_own_stop(er24pc, law, scenario):
    several = [(Planar(er24pc), replace(scenario, **changes, seed=k)) for k, changes in enumerate(APART)]
    shared = load_closed_loop(Planar(er24pc), law, stops=len(several), disturbed=True)
    beside = shared.run(loop_input(several, law))
    assert beside.stopped.all()
    singles = []
    for stop, (plant, each) in enumerate(several):
        alone = load_closed_loop(plant, law, disturbed=each.pad_vibration).run(
            loop_input([(plant, each)], law)
        )
        singles.append(results(alone))
        np.testing.assert_array_equal(results(beside, stop, len(several)), singles[-1])
    distances = [single[len(single) - len(beside.stop_totals)] for single in singles]
    assert len(set(distances)) == len(several)  # each of them does something


def test_samples_of_stops_side_by_side(er24pc, law, scenario):
    several = cases(er24pc, scenario, SPEEDS[:2])
    rows = sample_rows(law)
    loop = load_closed_loop(Planar(er24pc), law, stops=2)
    beside = loop.run(loop_input(several, law), sample_rows=rows).samples
    for stop, case in enumerate(several):
        single = load_closed_loop(Planar(er24pc), law).run(loop_input([case], law), sample_rows=rows)
        mine = beside[: len(single.samples), 1:].reshape(len(single.samples), -1, 2)[:, :, stop]
        np.testing.assert_array_equal(mine.reshape(len(mine), -1), single.samples[:, 1:])


def test_two_runs_and_threads_are_the_same(er24pc, law, scenario):
    loop = load_closed_loop(Planar(er24pc), law)
    several = cases(er24pc, scenario, SPEEDS)

    def run(case):
        return results(loop.run(loop_input([case], law)))

    first, second = [run(case) for case in several], [run(case) for case in several]
    with ThreadPoolExecutor(max_workers=4) as pool:
        threaded = list(pool.map(run, several))
    np.testing.assert_array_equal(first, second)
    np.testing.assert_array_equal(first, threaded)


@pytest.mark.parametrize(
    "flags",
    [
        ("-O1", "-march=native"),
        ("-O3", "-march=native", "-mprefer-vector-width=128"),
        pytest.param(("-O2",), marks=pytest.mark.reference),  # as the library of a wheel for x86-64
    ],
    ids=" ".join,
)
def test_compiler_options_do_not_change_a_bit(er24pc, make_controller, scenario, flags, cache, monkeypatch):  # noqa: ARG001
    law = make_controller("afsmc")
    given = loop_input([(Planar(er24pc), replace(scenario, initial_speed=3.0))], law)
    usual = load_closed_loop(Planar(er24pc), law).run(given)
    kept = tuple(flag for flag in compiler.PORTABLE_FLAGS if not flag.startswith("-O"))
    monkeypatch.setattr(compiler, "FLAGS", (*flags, *kept))
    plant = load_library(closed_loop_source(plant_kernels(Planar(er24pc), disturbed=False), stops=1))
    traced = law_kernels(law)
    loaded = LoadedLaw(traced, load_library(law_source(traced, axles=4, stops=1)), axles=4, stops=1)
    other = ClosedLoop(plant, loaded, axles=4, stops=1).run(given)
    assert other.steps == usual.steps
    np.testing.assert_array_equal(results(other), results(usual))
