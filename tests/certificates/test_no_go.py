"""The slip pole over the domain, and the speeds at which it beats the valve."""

import json
from dataclasses import replace

import numpy as np
import pytest

from wspd_design.certificates.checks.valve import no_go, open_loop_pole
from wspd_design.certificates.kernel.file import certificate_text
from wspd_design.certificates.kernel.subdomain import with_part
from wspd_design.certificates.records import Status
from wspd_design.certificates.replay import replay
from wspd_design.certificates.search.settle import settle
from wspd_design.certificates.setting import domain


def test_pole_is_enclosed(make_problem, make_controller):
    problem = make_problem(make_controller("afsmc"))
    verdict = open_loop_pole.check(problem)
    points = np.random.default_rng(6).uniform(*domain.slip_held(problem), (20_000, 5))
    found = domain.dynamics(problem, points).pole
    limit = 1.0 / problem.vehicle.brake.fill_time
    assert verdict.margin.high - verdict.margin.low < 2e-3
    assert limit - found.max() >= verdict.margin.low
    assert [proof.claim for proof in verdict.proofs] == ["slip pole", "slip pole"]
    shown = {proof.statement.split()[2]: float(proof.statement.split()[3]) for proof in verdict.proofs}
    assert shown[">="] <= found.min() <= found.max() <= shown["<="]


def test_no_go_of_the_reference_problem(make_reference_problem):
    """Polach dry rail with mu0 .55 and a valve of .6 s: no slip feedback works from .6 to 27 m/s."""
    problem = make_reference_problem()
    problem = replace(problem, rail=replace(problem.rail, mu0=0.55), speeds=(0.3, 33.4))
    verdict = no_go.check(problem)
    assert verdict.status is Status.PROVED
    low, high = no_go.widest_interval(problem, 1.0 / 0.6)
    assert low <= 0.6 < 27.0 <= high < 29.0
    wider = no_go.interval_claim(problem, 1.0 / 0.6, (low, 1.01 * high), ">=")
    assert settle(wider, tolerance=1e-3).status is Status.REFUTED
    _, proved, limit = verdict.series
    assert (proved.x[0], proved.x[-1]) == pytest.approx((3.6 * low, 3.6 * high))
    assert min(proved.y) >= limit.y[0]


def test_no_go_is_vacuous_with_a_fast_valve_and_not_about_laws_with_acceleration(
    make_problem, make_controller, fast_vehicle
):
    problem = make_problem(make_controller("afsmc"), vehicle=fast_vehicle)
    vacuous = no_go.check(problem)
    assert vacuous.status is Status.VACUOUS
    found = replay(problem, certificate_text(vacuous))
    assert found.accepted
    assert not found.missing
    forged = json.dumps(json.loads(certificate_text(vacuous)) | {"status": "PROVED"})
    assert "no proof of slip pole >= 50 1/s on a range of speed" in replay(problem, forged).reason
    # Nor is a law that the valve does beat vacuously so.
    slow = make_problem(make_controller("afsmc"))
    forged = json.dumps(json.loads(certificate_text(no_go.check(slow))) | {"status": "VACUOUS"})
    assert "no proof of slip pole <= 1.66667 1/s" in replay(slow, forged).reason
    assert no_go.check(make_problem(make_controller("trenitalia"))).status is Status.NOT_APPLICABLE


@pytest.fixture(scope="module")
def proved(make_problem, make_controller):
    problem = make_problem(make_controller("afsmc"))
    certificate = no_go.check(problem)
    assert certificate.status is Status.PROVED
    return problem, certificate


def _with_speeds(certificate, speeds):
    """Write the file with another range of speeds beside the proof."""
    content = json.loads(certificate_text(certificate))
    content["proofs"][0]["part"] = {"speed": speeds}
    return json.dumps(content)


def test_the_speeds_that_were_proved_are_shown(proved):
    problem, certificate = proved
    (shown,) = replay(problem, certificate_text(certificate)).shown
    low, high = no_go.widest_interval(problem, 1.0 / 0.6)
    words = shown.split()
    assert shown.startswith("slip pole >= 1.67")
    assert low <= float(words[-4]) <= 1.001 * low
    assert 0.999 * high <= float(words[-2]) <= high


def test_fewer_speeds_show_less_but_something_true(proved):
    problem, certificate = proved
    finding = settle(no_go.interval_claim(problem, 1.0 / 0.6, (4.0, 9.0), ">="), tolerance=1e-3)
    smaller = replace(certificate, proofs=(with_part(finding.proof, "speed", (4.0, 9.0)),))
    found = replay(problem, certificate_text(smaller))
    assert found.accepted
    assert found.shown[0].endswith("for speed from 4 to 9 m/s")


@pytest.mark.parametrize(
    "speeds",
    [
        ["2.0", "30.0"], ["9.0", "4.0"], ["4.0", "4.0"], ["nan", "9.0"], ["4.0", "inf"], ["-inf", "inf"],
        ["-4.0", "9.0"], ["0.1", "9.0"], ["4.0", "34.0"], ["4.0"],
        ["4.0", "9.0", "12.0"], [4.0, 9.0], "4.0 9.0", None, ["1e999", "9.0"],
        ["4" * 100_000, "9.0"], ["four", "nine"],
    ],
)  # fmt: skip
def test_speeds_that_are_none_or_were_not_proved_are_refused(proved, speeds):
    problem, certificate = proved
    found = replay(problem, _with_speeds(certificate, speeds))
    assert not found.accepted
    assert not found.shown


def test_a_point_is_no_interval(proved):
    problem, certificate = proved
    finding = settle(no_go.interval_claim(problem, 1.0 / 0.6, (4.0, 4.0), ">="), tolerance=1e-3)
    single = replace(certificate, proofs=(with_part(finding.proof, "speed", (4.0, 4.0)),))
    assert "a single speed" in replay(problem, certificate_text(single)).reason


def test_a_claim_about_too_many_speeds_has_no_proof(proved):
    """The tree of the right interval, with the ends and the fingerprint of one that is too wide."""
    problem, certificate = proved
    low, high = no_go.widest_interval(problem, 1.0 / 0.6)
    content = json.loads(certificate_text(certificate))
    proof = content["proofs"][0]
    claim = no_go.interval_claim(problem, 1.0 / 0.6, (low, 1.01 * high), ">=")
    proof |= {"part": {"speed": [repr(low), repr(1.01 * high)]}, "bound": repr(float(claim.bound))}
    proof["claim_sha256"] = claim.digest()
    content["proofs"] = [proof]
    assert not replay(problem, json.dumps(content)).accepted


@pytest.mark.parametrize("bound", ["1" + "0" * 400 + "/1", "nan", "inf", "1/0", "", "x", 1.7, None])
def test_bounds_that_are_no_numbers_are_refused(proved, bound):
    problem, certificate = proved
    content = json.loads(certificate_text(certificate))
    content["proofs"][0]["bound"] = bound
    assert not replay(problem, json.dumps(content)).accepted
