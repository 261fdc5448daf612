"""Barbalat's lemma where it applies: in sigma = integral of dt/v, with adaptation rates alpha/v."""

import json
from dataclasses import replace
from fractions import Fraction
from functools import partial

import numpy as np
import pytest

from wspd_design.certificates.checks.adaptive import barbalat, sigma_time
from wspd_design.certificates.checks.ideal_run import adaptive_run
from wspd_design.certificates.kernel.checker import check, value
from wspd_design.certificates.records import Status
from wspd_design.certificates.setting.domain import varied
from wspd_design.model.number import saturation
from wspd_design.model.slip import slip_dynamics


@pytest.fixture(scope="module")
def make_scheduled(make_adaptive_problem):
    """Problem of the designed adaptive law with scheduled rates, on a domain in which the brake suffices."""
    return partial(make_adaptive_problem, scheduled_rates=True)


@pytest.fixture(scope="module")
def proved(make_scheduled):
    problem = make_scheduled()
    return problem, barbalat.check(problem)


def test_lemma_applies_with_scheduled_rates(proved):
    _, verdict = proved
    assert verdict.status is Status.PROVED
    assert {hypothesis.status for hypothesis in verdict.hypotheses} == {Status.PROVED}
    assert len(verdict.proofs) == 3
    assert verdict.margin.low > 0.0


def test_constant_rates_stay_vacuous(make_scheduled):
    problem = make_scheduled()
    constant = replace(
        problem.controller, gains=replace(problem.controller.gains, scheduled_rates=False), name="constant"
    )
    assert barbalat.check(replace(problem, controller=constant)).status is Status.VACUOUS


def test_runs_keep_what_is_proved(proved):
    """Integrations in time, down to a crawl, for plants at the ends of the box."""
    problem, verdict = proved
    at = {point.name: point.value for point in verdict.worst_point}
    gains = problem.controller.gains
    integrals = []
    for mass, inertia, mu0 in ((76841.0, 752.0, 0.3), (61473.0, 860.0, 0.28), (92209.0, 640.0, 0.3)):
        vehicle, rail = varied(problem, mass, inertia, mu0)
        run = adaptive_run(vehicle, rail, gains, speeds=(0.01, problem.speeds[1]))
        assert not run.cut
        surface = 0.14 - run.slip + gains.integral_gain * run.integral
        dead = surface - gains.boundary_layer * saturation(surface / gains.boundary_layer)
        sigma = np.concatenate(
            [[0.0], np.cumsum(np.diff(run.time) * 0.5 * (1 / run.speed[1:] + 1 / run.speed[:-1]))]
        )
        integrals.append(np.trapezoid(np.abs(dead), sigma))
        steepest = np.max(np.abs(np.diff(dead)) / np.diff(sigma))
        assert steepest <= at["Lipschitz constant of s_D in sigma"]
        assert abs(dead[-1]) <= 1e-6
    assert 0.0 < max(integrals) <= at["bound of the integral of abs(s_D) d sigma"]


@pytest.mark.parametrize(
    "changes",
    [{"hold_when_saturated": False}, {"dead_zone": False}, {"bound_rate": -1.0}, {"integral_gain": 0.0}],
)
def test_planted_law_loses_a_hypothesis(make_scheduled, changes):
    verdict = barbalat.check(make_scheduled(**changes))
    assert verdict.status is Status.UNDECIDED
    assert Status.REFUTED in {hypothesis.status for hypothesis in verdict.hypotheses}


def test_brake_that_does_not_suffice_leaves_it_undecided(make_scheduled):
    verdict = barbalat.check(replace(make_scheduled(), mu0_bounds=(0.28, 0.9)))
    assert verdict.status is Status.UNDECIDED
    assert "Not shown" in verdict.explanation


def test_claims_reach_standstill(proved):
    """The torque of (27) is bounded as v falls to zero, although F and G are not."""
    problem, verdict = proved
    least, most, slowing = sigma_time.claims(problem, problem.controller)
    for claim, proof in zip((least, most, slowing), verdict.proofs, strict=True):
        (speed,) = (v for v in claim.variables if v.name == "speed")
        assert speed.low == 0
        assert check(replace(claim, bound=_bound(proof)), proof.certificate).accepted
    point = {v.name: v.high for v in least.free}
    still, crawl = (
        float(value(most, {**point, "speed": speed})[0]) for speed in (Fraction(0), Fraction(1, 1000))
    )
    assert still == pytest.approx(crawl, rel=1e-3)
    vehicle, rail = varied(problem, *(float(point[name]) for name in ("mass", "wheelset inertia", "mu0")))
    plant = slip_dynamics(vehicle, rail, 0.3, 1e-3)
    closing = problem.controller.gains.integral_gain * (0.14 - 0.3)
    assert crawl > float((-plant.drift + closing) / plant.gain)


def test_proof_for_faster_trains_only_is_refused(proved):
    problem, verdict = proved
    faster = replace(problem, speeds=(problem.speeds[0], problem.speeds[1] + 1.0))
    for claim, proof in zip(sigma_time.claims(faster, faster.controller), verdict.proofs, strict=True):
        assert not check(replace(claim, bound=_bound(proof)), proof.certificate).accepted


def _bound(proof):
    return Fraction(float(json.loads(proof.certificate)["bound"]))
