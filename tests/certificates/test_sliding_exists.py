"""The limits of the brake against the torque that holds the surface."""

import json
from dataclasses import replace

import numpy as np
import pytest

from wspd_design.certificates.checks.sliding import reaching, sliding_exists
from wspd_design.certificates.kernel.file import certificate_text
from wspd_design.certificates.records import Status
from wspd_design.certificates.replay import replay
from wspd_design.certificates.setting import domain
from wspd_design.certificates.setting.domain import MU0, SLIP, SPEED


def _with_torque(vehicle, torque):
    return replace(vehicle, brake=replace(vehicle.brake, max_torque=torque))


def test_printed_law_can_always_release_and_is_brake_limited_somewhere(make_problem, make_controller):
    verdict = sliding_exists.check(make_problem(make_controller("afsmc")))
    assert verdict.status is Status.PROVED
    assert "Brake-limited" in verdict.explanation
    assert {hypothesis.status for hypothesis in verdict.hypotheses} == {Status.PROVED}


def test_largest_friction_parts_what_the_brake_can_hold(make_problem, make_controller):
    law = make_controller("afsmc")
    problem = make_problem(law)
    suffices, fails = sliding_exists.largest_friction(problem, law)
    assert fails - suffices < 2e-3
    limit, margin = problem.vehicle.brake.max_torque, reaching.reserve(problem)
    points = np.random.default_rng(5).uniform(*domain.box(problem), (5000, 5))

    def most(mu0):
        points[:, MU0] = mu0
        plant = domain.dynamics(problem, points)
        rate = law.gains.integral_gain / law.gains.proportional_gain
        ideal = (-plant.drift + rate * (0.14 - points[:, SLIP])) / plant.gain
        return (ideal + margin / (plant.gain * points[:, SPEED])).max()

    assert most(suffices) <= limit
    # Random points miss the very corner, so that they need a little more friction to show the lack.
    assert most(1.1 * fails) > limit


def test_margin_is_not_above_any_random_point(make_problem, make_controller):
    law = make_controller("smc")
    problem = make_problem(law)
    points = np.random.default_rng(3).uniform(*domain.box(problem), (5000, 5))
    plant = domain.dynamics(problem, points)
    ideal = (-plant.drift + law.gains.surface_rate * (0.14 - points[:, SLIP])) / plant.gain
    slack = ideal - reaching.reserve(problem) / (plant.gain * points[:, SPEED])
    assert sliding_exists.check(problem).margin.low <= slack.min()


def test_strong_brake_is_never_the_limit(make_problem, make_controller, er24pc):
    problem = make_problem(make_controller("afsmc"), vehicle=_with_torque(er24pc, 200e3))
    verdict = sliding_exists.check(problem)
    assert verdict.status is Status.PROVED
    assert "never the limit" in verdict.explanation


def test_weak_brake_makes_the_claim_vacuous(make_problem, make_controller, er24pc):
    problem = make_problem(make_controller("afsmc"), vehicle=_with_torque(er24pc, 2e3))
    verdict = sliding_exists.check(problem)
    assert verdict.status is Status.VACUOUS
    content = json.loads(certificate_text(verdict))
    found = replay(problem, json.dumps(content))
    assert found.accepted
    assert not found.missing
    # That the brake never suffices has to be shown as well.
    shown = [(proof["claim"], proof["relation"]) for proof in content["proofs"]]
    del content["proofs"][shown.index(("u* + eta/g", ">="))]
    assert "no proof of u* + eta/g >= 2000 N m" in replay(problem, json.dumps(content)).reason


def test_the_friction_up_to_which_the_brake_suffices_is_shown(make_problem, make_controller):
    law = make_controller("afsmc")
    problem = make_problem(law)
    content = json.loads(certificate_text(sliding_exists.check(problem)))
    shown = replay(problem, json.dumps(content)).shown
    most, _ = sliding_exists.largest_friction(problem, law)
    assert shown[-1].split(" for ")[1].startswith("mu0 from 0.44")
    assert 0.999 * most <= float(shown[-1].split()[-1]) <= most
    for part in (
        {"mu0": ["0.3", "0.45"]},
        {"mu0": ["0.44", repr(1.2 * most)]},
        {"speed": ["0.44", "0.45"]},
        {},
    ):
        content["proofs"][-1]["part"] = part
        assert not replay(problem, json.dumps(content)).accepted, part
    # Without the range the proof is one about the whole domain, where it does not hold.
    del content["proofs"][-1]["part"]
    assert "belongs to another claim" in replay(problem, json.dumps(content)).reason


def test_surface_faster_than_a_vented_wheel_is_refuted(make_problem, make_controller):
    law = make_controller("smc")
    demanding = replace(law, gains=replace(law.gains, surface_rate=4.0))
    verdict = sliding_exists.check(make_problem(demanding))
    assert verdict.status is Status.REFUTED
    at = {point.name: point.value for point in verdict.witness}
    assert at["u* - eta/g"] < 0.0
    assert at["slip"] == pytest.approx(0.6)


def test_rule_tables_have_no_ideal_torque(make_problem, make_controller):
    problem = make_problem(make_controller("knorr-bremse"))
    assert sliding_exists.check(problem).status is Status.NOT_APPLICABLE
