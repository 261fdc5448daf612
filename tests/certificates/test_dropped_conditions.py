"""A PROVED file whose inequalities hold is refused where a condition on the law does not hold."""

import json

import pytest

from wspd_design.certificates.checks.valve import open_loop_pole, sampling
from wspd_design.certificates.kernel.file import certificate_text
from wspd_design.certificates.records import Status
from wspd_design.certificates.replay import replay


@pytest.mark.parametrize("check", [sampling, open_loop_pole], ids=["sampling", "open_loop_pole"])
def test_theorems_on_feedback_of_the_slip_say_nothing_about_torque_feedback(
    check, make_problem, make_controller, fast_vehicle
):
    """The valve beats the pole, so that every inequality is proved; the law reads the torque."""
    fast = make_problem(make_controller("afsmc", sample_time=0.01), rail="table10-wet", vehicle=fast_vehicle)
    genuine = check.check(fast)
    assert genuine.status is Status.PROVED
    assert replay(fast, certificate_text(genuine)).accepted
    other = make_problem(
        make_controller("torque-feedback", "table10-wet", sample_time=0.01),
        rail="table10-wet",
        vehicle=fast_vehicle,
    )
    honest = check.check(other)
    assert honest.status is not Status.PROVED
    forged = json.loads(certificate_text(genuine))
    if honest.proofs:
        forged["proofs"] = json.loads(certificate_text(honest))["proofs"]
    refused = replay(other, json.dumps(forged))
    assert not refused.accepted
    assert not replay(other, json.dumps(json.loads(certificate_text(honest)) | {"status": "PROVED"})).accepted
