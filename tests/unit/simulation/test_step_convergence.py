"""The order of the integration: on four axles every state and integral converges with the fourth power of the step."""

import math
from dataclasses import replace

import numpy as np
import pytest

from wspd_design.codegen import closed_loop, kernels
from wspd_design.codegen.closed_loop import load_closed_loop
from wspd_design.codegen.memory import Memory
from wspd_design.codegen.virtual_machine import run_virtual
from wspd_design.model import adhesion, corners, further_brakes
from wspd_design.parameters.loading import load_rail
from wspd_design.parameters.records import DynamicBrake, Pads, TrackBrake
from wspd_design.plants.planar import Planar
from wspd_design.simulation import loop_input as module
from wspd_design.simulation.loop_input import loop_input, sample_rows
from wspd_design.simulation.records import LoadIrregularity, Patch, Scenario

SPEED = 120.0 / 3.6
LONG, SHORT, FINE = 10e-3, 2.5e-3, 0.25e-3  # s
ROUNDING = 2e-12  # relative: below it no order can be seen

WAVES = tuple(tuple(1.0 + 0.04 * math.sin(0.7 * k + axle) for k in range(200)) for axle in range(4))
SCENARIOS = {
    "plain": {},
    "grade": {"grade": -0.02},
    "change of rail": {
        "patches": (
            Patch(start=20.0, rail=load_rail("polach-dry")),
            Patch(start=45.0, rail=load_rail("polach-wet")),
        )
    },
    "loads over distance": {"load_irregularity": LoadIrregularity(spacing=0.5, factors=WAVES)},
    "vibration of the pads": {"pad_vibration": True},
}
PARTS = {  # all corners but those of low speeds are passed between 33 and 25 m/s
    "pads": Pads(
        speeds=(25.0, 27.0, 29.0, 31.0),
        speed_factors=(1.0, 0.8, 0.9, 0.7),
        temperatures=(0.0, 15.0, 60.0),
        temperature_factors=(0.9, 1.0, 0.7),
        heat_capacity=2e4,
    ),
    "dynamic": DynamicBrake(
        torque=9e3, power=450e3, build_up_time=0.3, fade_speed=28.0, cut_out_speed=26.5, drop_slip=0.5
    ),
    "track_brake": TrackBrake(
        force=5e4,
        build_up_time=0.5,
        cut_out_speed=27.0,
        speeds=(25.0, 29.0, 33.0),
        speed_factors=(1.2, 1.0, 0.9),
    ),
}


@pytest.fixture
def end_of(er24pc, make_controller, monkeypatch):
    """Everything that the loop knows at a time, with steps of a length: states and integrals by name."""

    def ended(name, scenario, step, time, engine="compiled", **parts):
        limited = replace(module.constants(), time_limit=time - 0.05)
        monkeypatch.setattr(module, "constants", lambda: limited)
        monkeypatch.setattr(module, "LONGEST_STEP", step)
        # Where the law switches is no matter of the integrator.
        law, plant = make_controller(name, "polach-wet"), Planar(replace(er24pc, **parts))
        given = replace(loop_input([(plant, scenario)], law), trace_rows=50_000)
        given.settings.record_interval = 0.0
        rows, disturbed = sample_rows(law), scenario.pad_vibration
        if engine == "compiled":
            output = load_closed_loop(plant, law, disturbed=disturbed).run(given, sample_rows=rows)
        else:
            output = run_virtual(plant, law, given, sample_rows=rows, disturbed=disturbed)
        last = output.trace[-1]
        assert last[0] == pytest.approx(time, rel=1e-12)
        numbers = {"speed": last[1:2], "distance": last[2:3], "wheel speeds": last[3:7], "loads": last[15:19]}
        lanes = {name: output.lane_totals[name] for name in ("torque", "brake_work", "sliding_work", "slip")}
        return {**numbers, **lanes, "resistance": output.stop_totals["resistance_work"]}

    return ended


def ratios(end_of, name, scenario, time, **options):
    """Per quantity, how many times smaller the error of a step is that is half as long."""
    long, short, fine = (end_of(name, scenario, step, time, **options) for step in (LONG, SHORT, FINE))
    found = {}
    for what, true in fine.items():
        worse, better = (np.abs(x[what] - true).max() / np.abs(true).max() for x in (long, short))
        if worse > 200.0 * ROUNDING:
            found[what] = math.sqrt(worse / max(better, ROUNDING))  # over two halvings
    return found


@pytest.mark.parametrize("case", SCENARIOS)
def test_every_quantity_converges_to_order_four(end_of, case):
    scenario = Scenario(rail=load_rail("polach-wet"), initial_speed=SPEED, **SCENARIOS[case])
    found = ratios(end_of, "none", scenario, 2.9)
    assert {"wheel speeds", "loads", "brake_work", "sliding_work", "slip"} <= set(found)
    assert min(found.values()) > 11.0, found


@pytest.mark.parametrize("part", PARTS)
def test_rounded_corners_keep_the_order(end_of, part):
    scenario = Scenario(rail=load_rail("polach-dry"), initial_speed=SPEED)
    found = ratios(end_of, "none", scenario, 2.9, **{part: PARTS[part]})
    assert "wheel speeds" in found  # some of the others are right to rounding
    assert min(found.values()) > 10.0, found


@pytest.mark.parametrize(
    "part",
    ["dynamic", *(pytest.param(each, marks=pytest.mark.reference) for each in ("pads", "track_brake"))],
)
def test_sharp_corners_would_spoil_it(monkeypatch, end_of, part):
    monkeypatch.setattr(corners, "corner", lambda x, _: corners.maximum(x, 0.0))
    monkeypatch.setattr(further_brakes, "corner", corners.corner)
    scenario = Scenario(rail=load_rail("polach-dry"), initial_speed=SPEED)
    found = ratios(end_of, "none", scenario, 2.9, **{part: PARTS[part]})
    assert min(found.values()) < 8.0, found


@pytest.mark.parametrize("name", ["trenitalia", "afsmc"])
def test_valve_edges_and_locks_do_not_spoil_the_order(end_of, name):
    scenario = Scenario(rail=load_rail("polach-wet"), initial_speed=SPEED)
    found = ratios(end_of, name, scenario, 6.0)
    assert {"speed", "distance", "wheel speeds", "loads", "brake_work", "sliding_work", "slip"} <= set(found)
    assert min(found.values()) > 12.0, found


def test_the_virtual_machine_has_the_same_order(end_of):
    scenario = Scenario(rail=load_rail("polach-wet"), initial_speed=SPEED)
    found = ratios(end_of, "none", scenario, 2.0, engine="virtual machine")
    assert {"wheel speeds", "loads"} <= set(found)
    assert min(found.values()) > 12.0, found


# Faults planted in the compiled loop: what is replaced, by what, and in which scenario it is seen.
FROZEN = """choose_steps(loop, next);
    Motion middle = loop->now;
    WIDE double load[LANES];
    for (int k = 0, half = REST_STATES / 2 * STOPS; k < half; k++)
        middle.rest[k] += 0.5 * loop->step[k % STOPS] * loop->now.rest[half + k];
    load_wheels(loop, &middle, load);
    contact_kernel(loop->lane_fixed, load, loop->contact);"""
FAULTS = {
    "stiffness of the contact frozen at the middle of a step": ("choose_steps(loop, next);", FROZEN, "plain"),
    "damping frozen at the end of a step": (
        "level + later, damping + later, &further[k]);",
        "level + later, damping + LANES, &further[k]);",
        "plain",
    ),
    "steps that run across the points of the table of loads": (
        "if (point < loop->load_points && wait < step) step = wait;",
        "",
        "loads over distance",
    ),
    "loads at the place where the step began": (
        "EACH_STOP to->distance[s] = FMA(share * step[s], at->speed[s], from->distance[s]);",
        "EACH_STOP to->distance[s] = from->distance[s];",
        "loads over distance",
    ),
    "steps that run across the change of rail": (
        "double wait = wait_for(loop, s, loop->patch_start[loop->patch[l] * STOPS + s] - place);",
        "double wait = 1e300;",
        "change of rail",
    ),
    "the method of Euler": (
        "#define SUM(of) ((of(0) + of(3)) + 2.0 * (of(1) + of(2)))",
        "#define SUM(of) (6.0 * of(0))",
        "plain",
    ),
}


# One in each scenario shows that faults are seen there.
SEEN = (
    "the method of Euler",
    "steps that run across the points of the table of loads",
    "steps that run across the change of rail",
)


@pytest.mark.parametrize(
    "fault", [each if each in SEEN else pytest.param(each, marks=pytest.mark.reference) for each in FAULTS]
)
def test_a_fault_of_the_integration_spoils_the_order(monkeypatch, end_of, fault):
    true = closed_loop.closed_loop_source
    old, new, case = FAULTS[fault]

    def faulty(*arguments, **options):
        source = true(*arguments, **options)
        assert old in source
        return source.replace(old, new)

    monkeypatch.setattr(closed_loop, "closed_loop_source", faulty)
    for module_, name in ((closed_loop, "_plants"), (kernels, "_memory")):
        monkeypatch.setattr(module_, name, Memory(8))
    if new == FROZEN:
        monkeypatch.setattr(adhesion, "stiffness_growth", lambda _ratio: 1.0)
    scenario = Scenario(rail=load_rail("polach-wet"), initial_speed=SPEED, **SCENARIOS[case])
    found = ratios(end_of, "none", scenario, 2.9)
    assert min(found.values()) < 6.0, found


def test_the_growth_of_the_stiffness_is_good_to_order_four(er24pc):
    load = 9e4
    begin = adhesion.contact_stiffness(er24pc.contact, load)
    errors = [
        abs(
            begin
            * adhesion.stiffness_growth(1.0 + x)
            / adhesion.contact_stiffness(er24pc.contact, load * (1.0 + x))
            - 1.0
        )
        for x in (0.05, -0.05, 0.025, -0.025)
    ]
    assert max(errors) < 1e-8
    assert errors[0] / errors[2] > 25.0  # of order five, so that the step stays of order four
