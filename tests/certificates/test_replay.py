"""Whatever the suite proves about a loop is accepted again from its file, and about no other loop."""

import json
import math
from dataclasses import replace

import pytest
from wspd_design.certificates.kernel.exact import FORMAT
from wspd_design.certificates.theorems.obligations import OBLIGATIONS, obligations

from wspd_design.certificates import suite
from wspd_design.certificates.checks.sliding import sliding_exists
from wspd_design.certificates.checks.valve import no_go
from wspd_design.certificates.kernel.file import certificate_text
from wspd_design.certificates.records import Status
from wspd_design.certificates.replay import replay
from wspd_design.certificates.search import adhesion_peaks as peak_search
from wspd_design.parameters.loading import load_rail

SLOW = {"sampled_invariance", "hard_limits", "barbalat"}  # their files are checked in tests of their own
ANY_LOOP = {"derivation", "surface_hurwitz"}  # what they claim does not depend on the vehicle
RADIUS = 1.001  # another locomotive


@pytest.fixture(scope="module", params=["smc", "afsmc", "torque-feedback"])
def settled(request, make_problem, make_controller):
    problem = make_problem(make_controller(request.param))
    found = suite.verify(problem, only=OBLIGATIONS.keys() - SLOW)
    return problem, [each for each in found if each.proofs or each.status in (Status.PROVED, Status.REFUTED)]


def test_files_are_accepted_again(settled):
    problem, certificates = settled
    assert certificates
    for certificate in certificates:
        found = replay(problem, certificate_text(certificate))
        assert found.accepted, (certificate.name, found.reason)
        assert len(found.shown) == len(certificate.proofs)
        if certificate.status is Status.PROVED:
            assert not found.missing


def test_files_are_refused_for_another_loop(settled):
    problem, certificates = settled
    other = replace(
        problem, vehicle=replace(problem.vehicle, wheel_radius=RADIUS * problem.vehicle.wheel_radius)
    )
    # A witness alone may deny a claim about another loop as well.
    for certificate in (each for each in certificates if each.proofs):
        found = replay(other, certificate_text(certificate))
        assert found.empty or found.accepted is (certificate.name in ANY_LOOP), certificate.name


def test_every_proved_check_has_proofs(settled):
    _, certificates = settled
    assert all(each.proofs for each in certificates if each.status is Status.PROVED)


def test_a_loose_bound_does_not_make_a_refuted_check_proved(settled):
    problem, certificates = settled
    for certificate in certificates:
        if certificate.status is Status.REFUTED and certificate.proofs:
            text = certificate_text(certificate)
            assert replay(problem, text).missing, certificate.name
            forged = json.dumps(json.loads(text) | {"status": "PROVED"})
            found = replay(problem, forged)
            assert not found.accepted
            assert found.reason.startswith("no proof of")


def test_a_proof_cannot_stand_for_another_check(settled):
    problem, certificates = settled
    for certificate in certificates:
        content = json.loads(certificate_text(certificate)) | {"status": "PROVED"}
        for name in OBLIGATIONS.keys() - SLOW - {certificate.name, "boundary_layer", "reaching"}:
            assert not replay(problem, json.dumps(content | {"check": name})).accepted


def test_no_search_is_needed(settled, monkeypatch):
    """Whatever could search again fails, and the files are accepted all the same."""
    problem, certificates = settled

    def search(*_given, **_named):
        raise AssertionError("the checker searches")

    for module, name in (
        (no_go, "widest_interval"), (sliding_exists, "largest_friction"), (peak_search, "search"),
        (no_go, "settle"), (sliding_exists, "settle"), (sliding_exists, "enclose"), (sliding_exists, "prove"),
    ):  # fmt: skip
        monkeypatch.setattr(module, name, search)
    for certificate in certificates:
        assert replay(problem, certificate_text(certificate)).accepted


def test_a_witness_is_evaluated_again(settled):
    problem, certificates = settled
    refuted = [each for each in certificates if each.status is Status.REFUTED]
    for certificate in refuted:
        content = json.loads(certificate_text(certificate)) | {"witness": []}
        found = replay(problem, json.dumps(content))
        assert found.accepted
        assert not found.denied
    poles = [each for each in refuted if each.name == "open_loop_pole"]
    for certificate in poles:
        content = json.loads(certificate_text(certificate))
        found = replay(problem, json.dumps(content))
        assert "slip pole <= 1.66667 1/s: it is " in found.denied[0]
        # The lightest train on the most slippery rail has a slower pole, and what is evaluated counts.
        calm = {"mu0": problem.span("mu0")[0], "mass": problem.span("mass")[0], "speed": 120.0}
        moved = [each | {"value": calm.get(each["name"], each["value"])} for each in content["witness"]]
        assert "denies nothing" in replay(problem, json.dumps(content | {"witness": moved})).reason


@pytest.mark.parametrize("name", ["margins", "afsmc_energy"])
def test_a_witness_of_the_loop_is_computed_again(make_problem, make_controller, name):
    law = make_controller("afsmc")
    problem = make_problem(law)
    (certificate,) = suite.verify(problem, only=(name,))
    assert certificate.status is Status.REFUTED
    text = certificate_text(certificate)
    found = replay(problem, text)
    assert found.accepted
    assert len(found.denied) == 1
    assert found.leaves == 0
    stated = {point.name: point for point in certificate.witness}
    kmh = f"{stated['speed'].value:.6g} km/h"
    assert found.denied[0].endswith(kmh)
    # On a rail that does not fall with sliding, with a law that knows its torque, there is nothing to deny.
    generous = replace(
        law, gains=replace(law.gains, initial_bound=100.0, boundary_layer=1e6, integral_gain=1e-6)
    )
    calm = replace(problem, rail=load_rail("table10-dry"), controller=generous)
    assert "denies nothing" in replay(calm, text).reason
    forged = json.dumps(json.loads(text) | {"status": "PROVED"})
    assert not replay(problem, forged).accepted


BAD_WITNESSES = (
    None, 7, {}, ["slip"], [{"name": "speed"}], [{"name": "speed", "value": "fast", "unit": "m/s"}],
    [{"name": "speed", "value": [], "unit": "m/s"}],
)  # fmt: skip


def test_witnesses_that_are_none_are_refused(make_problem, make_controller):
    problem = make_problem(make_controller("afsmc"))
    (certificate,) = suite.verify(problem, only=("open_loop_pole",))
    content = json.loads(certificate_text(certificate))
    assert len(replay(problem, json.dumps(content)).denied) == 1
    for witness in BAD_WITNESSES:
        assert not replay(problem, json.dumps(content | {"witness": witness})).accepted, witness
    for value in (500.0, 5.0, -60.0, math.nan, math.inf, 1e400):
        points = [each | {"value": value} if each["name"] == "speed" else each for each in content["witness"]]
        assert not replay(problem, json.dumps(content | {"witness": points})).accepted, value


def test_a_file_without_proof_or_witness_shows_nothing(make_problem, make_controller):
    problem = make_problem(make_controller("afsmc"))
    (certificate,) = suite.verify(problem, only=("tracking",))
    assert certificate.status is Status.REFUTED
    text = certificate_text(certificate)
    found = replay(problem, text)
    assert found.accepted
    assert found.empty
    forged = replay(problem, json.dumps(json.loads(text) | {"status": "PROVED"}))
    assert not forged.accepted


def test_what_is_proved_is_not_vacuous(make_problem, make_controller):
    problem = make_problem(make_controller("afsmc"))
    (certificate,) = suite.verify(problem, only=("well_posed",))
    forged = json.dumps(json.loads(certificate_text(certificate)) | {"status": "VACUOUS"})
    assert replay(problem, forged).reason == "no proof can show that well_posed is vacuous"


def test_a_law_that_feeds_back_acceleration_cannot_be_bound_by_the_no_go(make_problem, make_controller):
    problem = make_problem(make_controller("torque-feedback"))
    (certificate,) = suite.verify(problem, only=("no_go",))
    assert certificate.status is Status.NOT_APPLICABLE
    forged = json.dumps(json.loads(certificate_text(certificate)) | {"status": "PROVED"})
    assert "feeds back neither torque nor wheel acceleration" in replay(problem, forged).reason


@pytest.mark.parametrize(("width", "conditions"), [(0.025, 0), (0.0, 1), (0.1, 1)])
def test_a_layer_outside_the_domain_cannot_be_proved(make_problem, make_controller, width, conditions):
    """Besides the two inequalities of the reaching condition nothing is open, or what no proof can show."""
    law = make_controller("smc", "polach-wet")
    problem = make_problem(replace(law, gains=replace(law.gains, boundary_layer=width)), rail="polach-wet")
    needed = obligations("boundary_layer", problem)
    assert len(needed) == 2 + conditions
    assert not any(each.concerns({"format": FORMAT, "claim": each.text}) for each in needed[2:])


@pytest.mark.parametrize(("name", "scheduled"), [("afsmc_energy", False), ("barbalat", True)])
def test_the_law_must_adapt_as_the_theorem_says(make_adaptive_problem, name, scheduled):
    """The inequalities are the same for a law that does not, and their proofs do not suffice for it."""
    problem = make_adaptive_problem(scheduled_rates=scheduled)
    (certificate,) = suite.verify(problem, only=(name,))
    assert certificate.status is Status.PROVED
    text = certificate_text(certificate)
    assert replay(problem, text).accepted
    for planted in (
        {"scheduled_rates": not scheduled}, {"dead_zone": False}, {"hold_when_saturated": False}, {"weight_rate": -1.0},
    ):  # fmt: skip
        found = replay(make_adaptive_problem(**{"scheduled_rates": scheduled} | planted), text)
        assert not found.accepted, planted
        assert found.reason.startswith("no proof of"), planted
