"""Barbalat's lemma on a stop, and the integral that stands in its place."""

from dataclasses import replace

import pytest

from tests.certificates.round_trip import keep, no_proof_can_be_missed, no_word_can_be_changed
from wspd_design.certificates.checks.adaptive import barbalat
from wspd_design.certificates.records import Status
from wspd_design.controllers import adaptive_fuzzy as law_module


@pytest.mark.parametrize("name", ["afsmc", "smc"])
def test_statement_about_infinity_is_vacuous_and_the_integral_is_bounded(make_problem, make_controller, name):
    kept = keep(barbalat.CHECK, make_problem(make_controller(name)))
    verdict = kept.certificate
    no_word_can_be_changed(kept)
    no_proof_can_be_missed(kept)
    assert verdict.status is Status.VACUOUS
    for_ever, in_sigma, integral, lipschitz = verdict.hypotheses
    assert for_ever.status is Status.REFUTED
    assert in_sigma.status is (Status.REFUTED if name == "afsmc" else Status.NOT_APPLICABLE)
    assert "sigma" in verdict.explanation
    assert integral.status is Status.EVIDENCE
    assert lipschitz.status is Status.EVIDENCE
    at = {point.name: point.value for point in verdict.worst_point}
    assert 0.0 < at["integral of abs(s_D)"] < at["bound on the integral"]
    assert 8.0 < at["end of the run"] < 15.0


def test_integral_of_a_law_that_does_not_reach_exceeds_its_bound(make_problem, make_controller):
    law = make_controller("smc")
    weak = replace(law, gains=replace(law.gains, switching_gain=0.5), rail=replace(law.rail, mu0=0.1))
    _, _, integral, _ = barbalat.CHECK.run(make_problem(weak)).hypotheses
    assert integral.status is Status.UNDECIDED


def test_integral_under_wrong_adaptation_exceeds_its_bound(make_problem, make_controller, monkeypatch):
    right = law_module.adaptation

    def wrong(gains, surface, speed):
        rates = right(gains, surface, speed)
        return rates._replace(weights=tuple(0.0 for _ in rates.weights), bound=0.0)

    monkeypatch.setattr("wspd_design.certificates.theorems.ideal_loop.adaptation", wrong)
    _, _, integral, _ = barbalat.CHECK.run(make_problem(make_controller("afsmc"))).hypotheses
    assert integral.status is Status.UNDECIDED


def test_train_that_never_slows_down_leaves_the_claim_undecided(make_problem, make_controller, er24pc):
    coasting = replace(
        er24pc, resistance_constant=1e-3, resistance_linear=0.0, resistance_quadratic=0.0, name="coasting"
    )
    problem = make_problem(make_controller("smc"), vehicle=coasting, bounds={"mu0": (1e-5, 1e-5)})
    problem = replace(problem, rail=replace(problem.rail, mu0=1e-5))
    assert barbalat.CHECK.run(problem).status is Status.UNDECIDED


def test_rule_tables_have_no_surface(make_problem, make_controller):
    assert barbalat.CHECK.run(make_problem(make_controller("mitsubishi"))).status is Status.NOT_APPLICABLE
