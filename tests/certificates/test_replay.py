"""Whatever the suite proves about a loop is accepted again from its file, and about no other loop."""

import json
from dataclasses import replace

import pytest

from wspd_design.certificates import suite
from wspd_design.certificates.certificate_file import certificate_text
from wspd_design.certificates.records import Status
from wspd_design.certificates.replay import OBLIGATIONS, replay

SLOW = {"sampled_invariance"}
RADIUS = 1.001  # another locomotive


@pytest.fixture(scope="module", params=["smc", "afsmc", "torque-feedback"])
def settled(request, make_problem, make_controller):
    problem = make_problem(make_controller(request.param))
    names = OBLIGATIONS.keys() - SLOW
    return problem, [each for each in suite.verify(problem, only=names) if each.proofs]


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
    for certificate in certificates:
        found = replay(other, certificate_text(certificate))
        assert not found.accepted, certificate.name


def test_a_loose_bound_does_not_make_a_refuted_check_proved(settled):
    problem, certificates = settled
    for certificate in certificates:
        if certificate.status is Status.REFUTED:
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
