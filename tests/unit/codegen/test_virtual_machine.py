"""Without a compiler the closed loop gives the same numbers: all controllers, rails and features of a scenario."""

import math
import warnings
from dataclasses import replace

import numpy as np
import pytest

from wspd_design.codegen import closed_loop, notices, sampled
from wspd_design.codegen.closed_loop import load_closed_loop
from wspd_design.codegen.compiler import NoCompilerError
from wspd_design.codegen.virtual_machine import run_virtual
from wspd_design.parameters.loading import load_rail
from wspd_design.plants.planar import Planar
from wspd_design.simulation import ideal
from wspd_design.simulation.loop_input import loop_input, sample_rows
from wspd_design.simulation.records import LoadIrregularity, Patch, Scenario, Sensing, Start
from wspd_design.simulation.stop import simulate

pytestmark = pytest.mark.usefixtures("compiled_quickly")

SPEED = 60.0 / 3.6
LAWS = ("afsmc", "afsmc-repaired", "smc", "trenitalia", "knorr-bremse", "mitsubishi", "none")
SENSITIVE = {("mitsubishi", "polach-wet"), ("knorr-bremse", "polach-wet")}


def both(vehicle, law, scenario):
    """The same stop compiled and in the virtual machine."""
    plant = Planar(vehicle)
    given = replace(loop_input([(plant, scenario)], law), trace_rows=30_000)
    rows, disturbed = sample_rows(law), scenario.pad_vibration
    loop = load_closed_loop(plant, law, disturbed=disturbed)
    compiled = loop.run(given, sample_rows=rows)
    virtual = run_virtual(plant, law, given, sample_rows=rows, disturbed=disturbed)
    return compiled, virtual


def assert_same(virtual, compiled, tolerance=1e-9):
    assert virtual.result == compiled.result == sampled.GOOD
    assert abs(virtual.steps - compiled.steps) <= 2  # a last digit may round the number of steps up
    assert virtual.stopped.all()
    assert compiled.stopped.all()
    for name, values in compiled.stop_totals.items():
        rtol = 1e-6 if name == "end_speed" else tolerance  # what is left of the initial speed
        np.testing.assert_allclose(virtual.stop_totals[name], values, rtol=rtol, err_msg=name)
    for name, values in compiled.lane_totals.items():
        scale = np.abs(values).max()
        np.testing.assert_allclose(
            virtual.lane_totals[name], values, rtol=0, atol=1e3 * tolerance * scale, err_msg=name
        )
    assert virtual.trace.shape == compiled.trace.shape
    np.testing.assert_allclose(virtual.trace[:, :3], compiled.trace[:, :3], rtol=1e3 * tolerance, atol=1e-9)
    assert virtual.samples.shape == compiled.samples.shape
    np.testing.assert_array_equal(virtual.samples[:, 0], compiled.samples[:, 0])


@pytest.mark.parametrize("rail", ["table10-dry", "polach-wet"])
@pytest.mark.parametrize("name", LAWS)
def test_all_controllers(er24pc, make_controller, name, rail):
    law = make_controller(name, rail)
    compiled, virtual = both(er24pc, law, Scenario(rail=load_rail(rail), initial_speed=SPEED))
    if (name, rail) in SENSITIVE:  # it amplifies the last digit of everything
        assert virtual.stop_totals["distance"] == pytest.approx(compiled.stop_totals["distance"], rel=1e-3)
        return
    assert_same(virtual, compiled)


WAVES = tuple(tuple(1.0 + 0.04 * math.sin(0.7 * k + axle) for k in range(120)) for axle in range(4))
FEATURES = {
    "patches": {
        "patches": (
            Patch(start=20.0, rail=load_rail("polach-dry")),
            Patch(start=50.0, rail=load_rail("polach-wet")),
        )
    },
    "rails of single axles": {
        "axle_rails": tuple(load_rail(f"polach-{name}") for name in ("wet", "wet", "dry", "dry"))
    },
    "wheel loads, known for part of the way": {
        "load_irregularity": LoadIrregularity(spacing=0.5, factors=WAVES)
    },
    "vibration of the pads": {"pad_vibration": True},
    "noise, pulses, reference error and dead time": {
        "sensing": Sensing(speed_noise=0.02, pulses_per_turn=80, reference_error=0.01, dead_time=0.04)
    },
    "dead time of a whole sample": {"sensing": Sensing(dead_time=0.1)},
    "dead time of several samples": {"sensing": Sensing(dead_time=0.25)},
    "pulses that are timed": {"sensing": Sensing(pulses_per_turn=100, period_timing=True)},
    "a train speed that drifts and is noisy": {
        "sensing": Sensing(reference_drift=-0.05, reference_noise=0.1)
    },
    "shortest pulse": {"sensing": Sensing(shortest_pulse=0.0955)},
    "grade": {"grade": -0.02},
    "start with slip and torque": {"start": Start(slip=0.2, torque=20e3, braking_time=2.0)},
    "start while the pads vibrate, and a dead time": {
        "start": Start(torque=15e3, braking_time=0.75),
        "pad_vibration": True,
        "sensing": Sensing(dead_time=0.04),
    },
}


@pytest.mark.parametrize("feature", FEATURES)
def test_all_features_of_a_scenario(er24pc, make_controller, feature):
    plain = Scenario(rail=load_rail("polach-wet"), initial_speed=SPEED)
    law = make_controller("trenitalia")
    compiled, virtual = both(er24pc, law, replace(plain, **FEATURES[feature]))
    assert_same(virtual, compiled)
    without = simulate(er24pc, law, plain, plant="planar").totals.distance
    assert abs(compiled.stop_totals["distance"][0] - without) > 1e-5  # the feature does something


RAMP = {"build_up": "electro-pneumatic", "build_up_delay": 0.25, "build_up_ramp": 1.3}
ORIFICE = {"valve": "orifice", "fill_time": 0.5, "vent_time": 0.3, "reservoir_pressure": 8e5}
AIR = {"cylinder_volume": 0.012, "reservoir_volume": 0.06}
BRAKES = {
    "ramp, leak and dead time": RAMP | {"hold_leak": 0.1, "dead_time": 0.06},
    "orifice and shortest pulse": ORIFICE | {"shortest_pulse": 0.05},
    "low reservoir and watchdog": AIR | {"longest_release": 0.35},
    "ramp, orifice, low reservoir, watchdog and dead time": RAMP
    | ORIFICE
    | AIR
    | {"longest_release": 0.25, "dead_time": 0.14, "critical_pressure_ratio": 0.4},
}


# What these have, the last one has as well; the shortest pulse is one of the features above.
WITHIN = ("orifice and shortest pulse", "low reservoir and watchdog")


@pytest.mark.parametrize(
    "kind", [pytest.param(each, marks=pytest.mark.reference) if each in WITHIN else each for each in BRAKES]
)
def test_all_brakes(er24pc, make_controller, kind):
    vehicle = replace(er24pc, brake=replace(er24pc.brake, **BRAKES[kind]))
    stop = Scenario(rail=load_rail("low-adhesion"), initial_speed=SPEED)
    compiled, virtual = both(vehicle, make_controller("trenitalia"), stop)
    assert_same(virtual, compiled)
    assert bool(compiled.lane_totals["watchdog"].sum() > 0.0) is ("longest_release" in BRAKES[kind])
    assert compiled.lane_totals["filled_pressure"].min() > 1e5


def test_a_wrong_formula_is_seen(er24pc, make_controller, monkeypatch):
    # The planted fault: one sixth in place of one third for the stages in the middle, in the compiled loop.
    law = make_controller("trenitalia", sample_time=0.1 + 1e-7)
    true = closed_loop.closed_loop_source

    def faulty(*arguments, **options):
        source = true(*arguments, **options)
        assert "+ 2.0 * (of(1) + of(2))" in source
        return source.replace("+ 2.0 * (of(1) + of(2))", "+ 2.000001 * (of(1) + of(2))")

    monkeypatch.setattr(closed_loop, "closed_loop_source", faulty)
    compiled, virtual = both(er24pc, law, Scenario(rail=load_rail("table10-dry"), initial_speed=5.0))
    with pytest.raises(AssertionError):
        assert_same(virtual, compiled)


def test_a_bad_command_is_told(er24pc, make_controller):
    class Overfilling:
        name, sample_time = "overfilling", 0.1

        def start(self, measurement):  # noqa: ARG002
            return (0.0,)

        def step(self, state, measurement):  # noqa: ARG002
            return (state[0] + 1.0,), (type(law_command))(fill=0.2 * state[0], vent=0.0)

    law_command = make_controller("none").step((), None)[1]
    rail = load_rail("table10-dry")
    compiled, virtual = both(er24pc, Overfilling(), Scenario(rail=rail, initial_speed=SPEED))
    assert compiled.result == virtual.result == sampled.BAD_COMMAND
    assert virtual.bad_command == pytest.approx(compiled.bad_command, rel=1e-12)
    assert compiled.bad_command == pytest.approx((0.6, 1.2, 0.0))


@pytest.fixture
def no_compiler(monkeypatch):
    def fail(_source):
        raise NoCompilerError("no C compiler for this test")

    monkeypatch.setattr(closed_loop, "load_library", fail)
    monkeypatch.setattr(notices, "_told", set())


def test_simulate_falls_back_with_one_notice(er24pc, make_controller, no_compiler):  # noqa: ARG001
    law = make_controller("trenitalia", sample_time=0.1 + 2e-7)  # not loaded before
    scenario = Scenario(rail=load_rail("table10-dry"), initial_speed=5.0)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        runs = [simulate(er24pc, law, scenario, plant="planar") for _ in range(3)]
    assert [run.engine for run in runs] == ["CasADi virtual machine"] * 3
    assert [str(notice.message).partition(";")[0] for notice in caught] == ["no C compiler for this test"]


@pytest.mark.parametrize("options", [{}, {"slip": 0.14}, {"instantaneous": True}], ids=str)
@pytest.mark.parametrize("plant", ["quarter", "planar"])
def test_ideal_stops_are_the_same(er24pc, monkeypatch, options, plant):
    scenario = Scenario(rail=load_rail("polach-wet"), initial_speed=6.0)
    compiled = ideal.ideal_stop(er24pc, scenario, plant=plant, **options)

    def fail(_source):
        raise NoCompilerError("no C compiler for this test")

    monkeypatch.setattr(closed_loop, "load_library", fail)
    monkeypatch.setattr(notices, "_told", {"no C compiler for this test"})
    named = replace(er24pc, name="virtual")  # so that the loop is made anew
    virtual = ideal.ideal_stop(named, scenario, plant=plant, **options)
    assert virtual.distance == pytest.approx(compiled.distance, rel=1e-9)
    assert virtual.stopping_time == pytest.approx(compiled.stopping_time, rel=1e-9)
