"""What theorems take for granted about a vehicle: a vehicle that does not meet it gets one sentence and no proof."""

from dataclasses import replace

import pytest

from wspd_design.certificates.records import Certificate, Status
from wspd_design.certificates.setting import assumptions
from wspd_design.certificates.setting.assumptions import Assumption, not_met
from wspd_design.certificates.theorems.table import THEOREMS
from wspd_design.certificates.theorems.theorem import asked
from wspd_design.parameters.records import DynamicBrake, Pads, TrackBrake


def test_pads_of_constant_friction_are_no_other_vehicle(er24pc):
    assert not_met(replace(er24pc, pads=Pads(kind="tread")), assumptions.ALL) == ""


def unlike_brakes(vehicle):
    return replace(vehicle, brake=replace(vehicle.brake, axle_shares=(1.0, 0.0, 1.0, 1.0)))


def shared_bogies(vehicle):
    return replace(
        vehicle, wheelsets=6, bodies=2, body_mass=0.5 * vehicle.body_mass - 0.5 * vehicle.bogie_mass
    )


BRAKES = {
    Assumption.MAIN_PIPE: {
        "build_up": "electro-pneumatic",
        "supply_rate": 0.0,
        "build_up_delay": 0.2,
        "build_up_ramp": 1.0,
    },
    Assumption.LAG: {"valve": "orifice"},
    Assumption.NO_LEAK: {"hold_leak": 0.01},
    Assumption.NO_DEAD_TIME: {"dead_time": 0.03},
    Assumption.ANY_PULSE: {"shortest_pulse": 0.01},
    Assumption.NO_WATCHDOG: {"longest_release": 10.0},
    Assumption.SUPPLY: {"cylinder_volume": 0.01, "reservoir_volume": 0.15},
}


def with_brake(**changes):
    return lambda vehicle: replace(vehicle, brake=replace(vehicle.brake, **changes))


def with_part(**parts):
    return lambda vehicle: replace(vehicle, **parts)


OTHER = {
    Assumption.EQUAL_BRAKES: unlike_brakes,
    Assumption.EQUAL_LOADS: shared_bogies,
    Assumption.CONSTANT_PADS: with_part(pads=Pads(speeds=(0.0, 40.0), speed_factors=(1.0, 0.8))),
    Assumption.FRICTION_ALONE: with_part(
        dynamic=DynamicBrake(torque=8e3, build_up_time=0.5, fade_speed=3.0, cut_out_speed=1.0)
    ),
    Assumption.ADHESION_ALONE: with_part(track_brake=TrackBrake(force=4e4)),
    **{assumption: with_brake(**changes) for assumption, changes in BRAKES.items()},
}
"""Vehicles that break one assumption each."""


@pytest.mark.parametrize("assumption", Assumption)
def test_the_locomotive_meets_every_assumption_and_each_can_be_broken(er24pc, assumption):
    other = OTHER[assumption](er24pc)
    assert not_met(er24pc, assumptions.ALL) == ""
    said = not_met(other, {assumption})
    assert said.startswith(f"The theorem takes for granted that {assumption.value}; {er24pc.name} ")
    assert not_met(other, set(Assumption) - {assumption}) == ""


def test_shares_that_are_all_one_are_equal_brakes(er24pc):
    assert (
        not_met(replace(er24pc, brake=replace(er24pc.brake, axle_shares=(1.0,) * 4)), assumptions.ALL) == ""
    )


@pytest.fixture(scope="module")
def spoken_of(make_problem, make_controller):
    """Theorems that speak about the sliding mode on the locomotive."""
    problem = make_problem(make_controller("smc"))
    return {name for name, theorem in THEOREMS.items() if isinstance(asked(theorem, problem), tuple)}


@pytest.mark.parametrize("assumption", Assumption)
def test_a_theorem_is_silent_exactly_about_vehicles_that_break_what_it_assumes(
    er24pc, make_problem, make_controller, spoken_of, assumption
):
    other = OTHER[assumption](er24pc)
    problem = make_problem(make_controller("smc"), vehicle=other)
    for name, theorem in THEOREMS.items():
        answer = asked(theorem, problem)
        silent = isinstance(answer, Certificate) and answer.method == "assumptions about the vehicle"
        assert silent is (name in spoken_of and assumption in theorem.assumes), name
        if silent:
            assert answer.status is Status.NOT_APPLICABLE
            assert answer.explanation == not_met(other, theorem.assumes)
