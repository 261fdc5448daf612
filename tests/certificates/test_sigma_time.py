"""Barbalat's lemma where it applies: in sigma = integral of dt/v, with adaptation rates alpha/v."""

from dataclasses import replace
from fractions import Fraction
from functools import partial

import numpy as np
import pytest

from tests.certificates.round_trip import keep, no_proof_can_be_missed, no_word_can_be_changed, not_for
from wspd_design.certificates.checks.adaptive import barbalat
from wspd_design.certificates.checks.ideal_run import adaptive_run
from wspd_design.certificates.kernel.checker import Work, value
from wspd_design.certificates.records import Status
from wspd_design.certificates.setting.plant import plant_dynamics, plant_with
from wspd_design.certificates.theorems.authority import torque_obligations
from wspd_design.certificates.theorems.barbalat import to_standstill
from wspd_design.model.number import saturation


@pytest.fixture(scope="module")
def make_scheduled(make_adaptive_problem):
    """Problem of the designed adaptive law with scheduled rates, on a domain in which the brake suffices."""
    return partial(make_adaptive_problem, scheduled_rates=True)


@pytest.fixture(scope="module")
def proved(make_scheduled):
    return keep(barbalat.CHECK, make_scheduled())


def test_lemma_applies_with_scheduled_rates(proved):
    verdict = proved.certificate
    assert verdict.status is Status.PROVED
    assert {hypothesis.status for hypothesis in verdict.hypotheses} == {Status.PROVED}
    assert verdict.margin.low > 0.0
    no_word_can_be_changed(proved)
    no_proof_can_be_missed(proved)


def test_conditions_come_first(proved):
    """Audit A9: every stop starts with slip 0, so the range of the slip stands before what follows from it."""
    claim = proved.certificate.claim
    places = [
        claim.index(part) for part in ("slip stays between", "T = u", "eta/g <= u*", "s_D tends to zero")
    ]
    assert places == sorted(places)


def test_constant_rates_stay_vacuous(make_scheduled):
    problem = make_scheduled()
    constant = replace(
        problem.controller, gains=replace(problem.controller.gains, scheduled_rates=False), name="constant"
    )
    assert barbalat.CHECK.run(replace(problem, controller=constant)).status is Status.VACUOUS


def test_runs_keep_what_is_proved(proved):
    """Integrations in time, down to a crawl, for plants at the ends of the box."""
    problem, verdict = proved.problem, proved.certificate
    at = {point.name: point.value for point in verdict.worst_point}
    gains = problem.controller.gains
    integrals = []
    for mass, inertia, mu0 in ((76841.0, 752.0, 0.3), (61473.0, 860.0, 0.28), (92209.0, 640.0, 0.3)):
        vehicle, rail = plant_with(problem, {"mass": mass, "wheelset inertia": inertia, "mu0": mu0})
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
    assert 0.0 < max(integrals) <= at["bound on the integral of abs(s_D) d sigma"]


@pytest.mark.parametrize(
    "changes",
    [{"hold_when_saturated": False}, {"dead_zone": False}, {"bound_rate": -1.0}, {"integral_gain": 0.0}],
)
def test_planted_law_loses_a_hypothesis(make_scheduled, changes):
    verdict = barbalat.CHECK.run(make_scheduled(**changes))
    assert verdict.status is Status.UNDECIDED
    assert Status.REFUTED in {hypothesis.status for hypothesis in verdict.hypotheses}


def test_brake_that_does_not_suffice_refutes_the_claim(make_scheduled):
    """u* inside the limits is part of what is claimed; today's sentence left it open."""
    problem = make_scheduled()
    slippery = replace(problem, bounds=problem.bounds | {"mu0": (0.28, 0.9)})
    verdict = keep(barbalat.CHECK, slippery).certificate
    assert verdict.status is Status.REFUTED
    assert "Not shown" in verdict.explanation


def test_claims_reach_standstill(proved):
    """The torque of (27) is bounded as v falls to zero, although F and G are not."""
    problem = proved.problem
    claims = torque_obligations(problem, to_standstill(problem))
    for each in claims:
        (speed,) = (v for v in each.claim.variables if v.name == "speed")
        assert speed.low == 0
        assert proved.certificate.findings[each.key].proved
    claim = next(each.claim for each in claims if each.claim.relation == "<=")
    point = {v.name: v.high for v in claim.free}
    still, crawl = (
        float(value(claim.statement(), {**point, "speed": speed}, Work())[0])
        for speed in (Fraction(0), Fraction(1, 1000))
    )
    assert still == pytest.approx(crawl, rel=1e-3)
    values = {v.name: float(point.get(v.name, v.low)) for v in claim.variables} | {"speed": 1e-3}
    plant = plant_dynamics(problem, values)
    closing = problem.controller.gains.integral_gain * (0.14 - values["slip"])
    assert crawl > float((-plant.drift + closing) / plant.gain)


def test_proof_for_faster_trains_only_is_refused(proved):
    speeds = proved.problem.speeds
    assert not_for(proved, replace(proved.problem, speeds=(speeds[0], speeds[1] + 1.0)))
