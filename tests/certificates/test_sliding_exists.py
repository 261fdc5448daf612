"""The limits of the brake against the torque that holds the surface."""

from dataclasses import replace

import numpy as np
import pytest

from tests.certificates.round_trip import keep, no_proof_can_be_missed, no_word_can_be_changed, refused
from wspd_design.certificates.checks.sliding import sliding_exists
from wspd_design.certificates.quantities import AXLE, PLANT, STATE
from wspd_design.certificates.records import Status
from wspd_design.certificates.setting import domain
from wspd_design.certificates.setting.plant import complete, plant_dynamics
from wspd_design.certificates.theorems.authority import torque_findings
from wspd_design.certificates.theorems.sliding import reserve
from wspd_design.parameters.bounds import Bounds


def _with_torque(vehicle, torque):
    return replace(
        vehicle,
        brake=replace(
            vehicle.brake, max_torque=torque, bounds=Bounds.of({"max_torque": (0.9 * torque, 1.1 * torque)})
        ),
    )


def _slack(problem, count=4000, seed=3):
    """u* - eta/g and u* + eta/g at random points of the whole box [N m]."""
    names = [name for name in domain.uncertain(problem) if name in (*PLANT, *AXLE) and name != "wheel radius"]
    spans = {name: domain.span(problem, name) for name in (*STATE, *names)}
    points = np.random.default_rng(seed).uniform(*np.array(list(spans.values())).T, (count, len(spans)))
    known = {name: ends[0] for name, ends in problem.bounds.items() if name in PLANT}
    values = known | dict(zip(spans, points.T, strict=True))
    plant = plant_dynamics(problem, complete(problem, values))
    law = problem.controller
    ideal = (-plant.drift + law.surface_rate * (0.14 - values["slip"])) / plant.gain
    needed = reserve(problem) / (plant.gain * values["speed"])
    return ideal - needed, ideal + needed


@pytest.fixture(scope="module")
def limited(make_problem, make_controller):
    return keep(sliding_exists.CHECK, make_problem(make_controller("afsmc")))


def test_rail_on_which_the_brake_is_the_limit_refutes_that_the_surface_exists(limited):
    """Today's sentence excepted the points where it is false; now they refute it."""
    verdict = limited.certificate
    assert verdict.status is Status.REFUTED
    assert "Brake-limited" in verdict.explanation
    assert "T_max - eta/g" in verdict.claim
    assert {"max torque", *AXLE} <= set(verdict.varied)
    assert refused(limited, status="PROVED")
    assert refused(limited, status="VACUOUS")


def test_margin_and_witness_are_of_the_side_to_release_where_both_are_refuted(limited):
    verdict = limited.certificate
    release, apply = torque_findings(verdict.findings)
    assert release.status is apply.status is Status.REFUTED
    assert verdict.margin == release.margin
    assert {point.name: point.value for point in verdict.witness}["u* - eta/g"] <= verdict.margin.high


def test_margins_are_not_above_any_random_point(limited):
    released, applied = _slack(limited.problem)
    release, apply = torque_findings(limited.certificate.findings)
    assert release.margin.low <= released.min()
    assert apply.margin.low <= 51e3 - applied.max()


def test_margin_is_that_of_the_side_with_less_room_where_both_are_proved(small):
    verdict = sliding_exists.CHECK.run(small(200e3))
    assert verdict.margin == min(
        (each.margin for each in torque_findings(verdict.findings)), key=lambda m: m.low
    )


def test_friction_up_to_which_the_brake_suffices_is_shown(make_problem, make_controller, narrow, er24pc):
    law = make_controller("afsmc", "polach-wet")
    bounds = narrow(er24pc, make_problem(law, rail="polach-wet").rail, mu0=(0.2, 0.8))
    problem = make_problem(law, rail="polach-wet", bounds=bounds, slips=(0.05, 0.3), speeds=(5.0, 30.0))
    kept = keep(sliding_exists.CHECK, problem)
    (until,) = (each for key, each in kept.certificate.findings.items() if key.startswith("until"))
    assert until.status is Status.PROVED
    low, high = until.part
    assert low == 0.2
    assert f"mu0 from 0.2 to {high:.3g}" in kept.certificate.explanation
    limit = problem.span("max torque")[0]
    assert _slack(replace(problem, bounds=problem.bounds | {"mu0": (high, high)}))[1].max() <= limit
    beyond = replace(problem, bounds=problem.bounds | {"mu0": (1.05 * high, 1.05 * high)})
    assert _slack(beyond)[1].max() > limit
    no_word_can_be_changed(kept)
    no_proof_can_be_missed(kept)


@pytest.fixture(scope="module")
def small(make_problem, make_controller, narrow, er24pc):
    """Make a problem of an axle at static load on a short range of slip."""

    def make(torque):
        vehicle = _with_torque(er24pc, torque)
        law = make_controller("afsmc", "polach-wet")
        law = replace(law, max_torque=torque)
        rail = make_problem(law, rail="polach-wet").rail
        bounds = narrow(vehicle, rail, mass=(70e3, 80e3), mu0=(0.28, 0.3)) | {
            "max torque": (0.9 * torque, 1.1 * torque),
            "train deceleration": (1.5, 3.2),
        }
        slips, speeds = (0.05, 0.3), (5.0, 30.0)
        return make_problem(
            law, rail="polach-wet", vehicle=vehicle, bounds=bounds, slips=slips, speeds=speeds
        )

    return make


def test_strong_brake_is_never_the_limit(small):
    kept = keep(sliding_exists.CHECK, small(200e3))
    assert kept.certificate.status is Status.PROVED
    assert "never the limit" in kept.certificate.explanation
    no_word_can_be_changed(kept)
    no_proof_can_be_missed(kept)


def test_weak_brake_never_reaches_the_reference(small):
    kept = keep(sliding_exists.CHECK, small(2e3))
    assert kept.certificate.status is Status.VACUOUS
    assert kept.certificate.explanation.startswith("The brake never reaches the reference")
    # That has to be shown.
    findings = kept.content["findings"]
    less = {key: each for key, each in findings.items() if not key.startswith("out of reach")}
    assert refused(kept, findings=less)
    assert refused(kept, status="REFUTED")


def test_surface_faster_than_a_vented_wheel_is_refuted(make_problem, make_controller):
    law = make_controller("smc")
    demanding = replace(law, gains=replace(law.gains, surface_rate=4.0))
    verdict = sliding_exists.CHECK.run(make_problem(demanding))
    assert verdict.status is Status.REFUTED
    at = {point.name: point.value for point in verdict.witness}
    assert at["u* - eta/g"] < 0.0
    assert at["slip"] == pytest.approx(0.6)


def test_rule_tables_have_no_ideal_torque(make_problem, make_controller):
    problem = make_problem(make_controller("knorr-bremse"))
    assert sliding_exists.CHECK.run(problem).status is Status.NOT_APPLICABLE
