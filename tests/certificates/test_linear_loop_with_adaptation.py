"""Routh's conditions and poles of the printed law with its adaptation, and files that say something else."""

import numpy as np
import pytest

from tests.certificates.round_trip import keep, no_word_can_be_changed, refused
from wspd_design.certificates.checks.linear import margins, routh_lag
from wspd_design.certificates.records import Status
from wspd_design.certificates.setting.linear_loop import outermost
from wspd_design.model.slip import slip_dynamics


@pytest.fixture(scope="module")
def printed(make_problem, make_controller):
    return make_problem(make_controller("afsmc", "table10-dry"), rail="table10-dry")


def test_adaptation_moves_the_poles_of_the_printed_law(printed):
    """Audit M1: +2.63 +- 15.8j at 10 m/s in place of -0.31."""
    assert outermost(printed, 10.0, sampled=False) == pytest.approx(2.63, abs=0.01)


@pytest.mark.parametrize("check", [routh_lag.CHECK, margins.CHECK], ids=["routh_lag", "margins"])
def test_refuted_with_a_witness_that_is_evaluated_again(printed, check):
    kept = keep(check, printed)
    assert kept.certificate.status is Status.REFUTED
    assert "adaptation" in kept.certificate.claim
    no_word_can_be_changed(kept)
    findings = {
        key: {name: entry for name, entry in each.items() if name != "place"}
        for key, each in kept.content["findings"].items()
    }
    assert refused(kept, findings=findings)


def test_poles_are_those_of_the_matrix(make_problem, make_controller):
    problem = make_problem(make_controller("smc", "polach-wet"), rail="polach-wet")
    law, tau = problem.controller, 0.6
    for speed in (5.0, 20.0):
        at = slip_dynamics(problem.vehicle, problem.rail, 0.14, speed)
        gains = law.linear_form(speed)
        loop = [tau, 1.0 - at.pole * tau, at.gain * gains.proportional - at.pole, at.gain * gains.integral]
        assert outermost(problem, speed, sampled=False) == pytest.approx(np.roots(loop).real.max(), rel=1e-6)
