"""The slip pole over the domain, and the speeds at which it beats the valve."""

from dataclasses import replace

import numpy as np

from wspd_design.certificates import domain, no_go, open_loop_pole
from wspd_design.certificates.proof.engine import settle
from wspd_design.certificates.records import Status


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


def test_no_go_is_vacuous_with_a_fast_valve_and_not_about_laws_with_acceleration(
    make_problem, make_controller, fast_vehicle
):
    problem = make_problem(make_controller("afsmc"), vehicle=fast_vehicle)
    assert no_go.check(problem).status is Status.VACUOUS
    assert no_go.check(make_problem(make_controller("trenitalia"))).status is Status.NOT_APPLICABLE
