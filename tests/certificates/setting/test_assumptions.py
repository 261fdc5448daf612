"""What theorems take for granted about a vehicle: a vehicle that does not meet it gets one sentence and no proof."""

from dataclasses import replace

import pytest

from wspd_design.certificates.records import Certificate, Status
from wspd_design.certificates.setting import assumptions
from wspd_design.certificates.setting.assumptions import Assumption, not_met
from wspd_design.certificates.theorems.table import THEOREMS
from wspd_design.certificates.theorems.theorem import asked
from wspd_design.parameters.records import DynamicBrake, Pads, TrackBrake

OTHER = {Assumption.EQUAL_BRAKES: {"axle_shares": (1.0, 0.0, 1.0, 1.0)}}
"""Changes of the brake that break one assumption each."""
BESIDE = {
    Assumption.CONSTANT_PADS: {"pads": Pads(speeds=(0.0, 40.0), speed_factors=(1.0, 0.8))},
    Assumption.FRICTION_ALONE: {
        "dynamic": DynamicBrake(torque=8e3, build_up_time=0.5, fade_speed=3.0, cut_out_speed=1.0)
    },
    Assumption.ADHESION_ALONE: {"track_brake": TrackBrake(force=4e4)},
}
"""The same of the vehicle."""


def breaking(vehicle, assumption):
    brake = replace(vehicle.brake, **OTHER.get(assumption, {}))
    return replace(vehicle, brake=brake, **BESIDE.get(assumption, {}))


def test_pads_of_constant_friction_are_no_other_vehicle(er24pc):
    assert not_met(replace(er24pc, pads=Pads(kind="tread")), assumptions.ALL) == ""


@pytest.mark.parametrize("assumption", Assumption)
def test_the_locomotive_meets_every_assumption_and_each_can_be_broken(er24pc, assumption):
    other = breaking(er24pc, assumption)
    assert not_met(er24pc, assumptions.ALL) == ""
    said = not_met(other, {assumption})
    assert said.startswith(f"The theorem takes for granted that {assumption.value}; {er24pc.name} ")
    assert not_met(other, set(Assumption) - {assumption}) == ""


def test_shares_that_are_all_one_are_equal_brakes(er24pc):
    assert (
        not_met(replace(er24pc, brake=replace(er24pc.brake, axle_shares=(1.0,) * 4)), assumptions.ALL) == ""
    )


@pytest.mark.parametrize("assumption", Assumption)
def test_a_theorem_is_silent_exactly_about_vehicles_that_break_what_it_assumes(
    er24pc, make_problem, make_controller, assumption
):
    other = breaking(er24pc, assumption)
    problem = make_problem(make_controller("smc"), vehicle=other)
    for name, theorem in THEOREMS.items():
        answer = asked(theorem, problem)
        silent = isinstance(answer, Certificate) and answer.method == "assumptions about the vehicle"
        spoken_of = isinstance(asked(theorem, make_problem(make_controller("smc"))), tuple)
        assert silent is (spoken_of and assumption in theorem.assumes), name
        if silent:
            assert answer.status is Status.NOT_APPLICABLE
            assert answer.explanation == not_met(other, theorem.assumes)
