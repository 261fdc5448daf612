"""Barbalat's lemma for the adaptive law with scheduled rates, in sigma = integral of dt/v.

A stop ends after some seconds, but not in sigma: dv/d sigma = -a v, so that v >= v0 exp(-a_max sigma) stays positive
while the train comes to a standstill. There V = s_D^2/(2 g) + abs(b~)^2/(2 alpha1) + psi~^2/(2 alpha2) has no term of
G', and with rates alpha/v in time its rate is dV/d sigma = s_D (u* - b*'w) - psi abs(s_D) <= -(eta/g) abs(s_D). Hence
the integral of abs(s_D) d sigma is at most V(0) g/eta. As abs(ds_D/d sigma) = g abs(u* - T) is bounded, s_D is
uniformly continuous, and Barbalat's lemma says that it tends to zero.
"""

from fractions import Fraction

from wspd_design.certificates.checks import verdict
from wspd_design.certificates.checks.adaptive.adaptive_energy import (
    DECELERATION_TOLERANCE,
    TORQUE_TOLERANCE,
    energy,
    inside,
    rounded_up,
    smallest_gain,
)
from wspd_design.certificates.checks.sliding.reaching import deceleration_claim, largest_deceleration, reserve
from wspd_design.certificates.checks.sliding.sliding_exists import torque_claim
from wspd_design.certificates.kernel.arb import above, point
from wspd_design.certificates.kernel.claim import Claim
from wspd_design.certificates.records import Certificate, Hypothesis, Point, Problem, Status
from wspd_design.certificates.search.settle import enclose, engine, settle
from wspd_design.certificates.setting import laws
from wspd_design.certificates.setting.domain import KMH
from wspd_design.controllers.adaptive_fuzzy import AdaptiveFuzzy
from wspd_design.parameters.loading import constants


def claims(problem: Problem, law: AdaptiveFuzzy) -> tuple[Claim, Claim, Claim]:
    """Claims about u* - eta/g, u* + eta/g and the deceleration, down to standstill."""
    limit, speeds = problem.vehicle.brake.max_torque, (0.0, problem.speeds[1])
    return (
        torque_claim(problem, law, ">=", 0.0, speed=speeds),
        torque_claim(problem, law, "<=", limit, speed=speeds),
        deceleration_claim(problem, "<=", largest_deceleration(problem), speed=speeds),
    )


def convergence(problem: Problem, law: AdaptiveFuzzy) -> Certificate:
    """Decide what the lemma needs; the certificate is completed by :mod:`barbalat`.

    Parameters
    ----------
    problem : Problem
        Its lowest speed does not matter: the claims go down to standstill.
    law : AdaptiveFuzzy
        With dead zone and scheduled rates.
    """
    gains, limit, eta = law.gains, problem.vehicle.brake.max_torque, reserve(problem)
    least, most, deceleration = claims(problem, law)
    low, high = (enclose(claim, tolerance=TORQUE_TOLERANCE) for claim in (least, most))
    slowing = settle(deceleration, tolerance=DECELERATION_TOLERANCE)
    bounded = verdict.status(low, high)
    positive = smallest_gain(gains) > 0.0
    hypotheses = (
        verdict.condition("K_P, K_I, Phi and both adaptation rates are positive", positive),
        verdict.condition(
            "the law adapts with s_D alone, at rates alpha/v", gains.dead_zone and gains.scheduled_rates
        ),
        Hypothesis(text="sigma has no end: a <= a_max at all speeds above 0", status=slowing.status),
        Hypothesis(text="psi >= abs(u* - beta) + eta/g at all speeds above 0", status=bounded),
        Hypothesis(
            text=f"eta/g <= u* <= {limit / 1e3:g} kN m - eta/g at all speeds above 0, so that u* - T is bounded and "
            "s_D uniformly continuous in sigma",
            status=inside(low, high, limit),
        ),
        verdict.condition(
            "the adaptation is held while the command pushes beyond the brake", gains.hold_when_saturated
        ),
    )
    status = laws.of_theorem(hypotheses)
    open_ones = [each.text for each in hypotheses if each.status is not Status.PROVED]
    where: tuple[Point, ...] = ()
    said = "There is no bound of the integral to state"
    if positive and bounded is Status.PROVED:
        found = energy(problem, gains, float(low.claim.bound), float(high.claim.bound), eta, 1.0)
        lightest, radius = point(problem.inertia_bounds[0]), point(problem.vehicle.wheel_radius)
        steepest = radius / lightest * point(max(high.claim.bound, Fraction(limit) - low.claim.bound))
        where = (
            Point(name="V(0) in sigma", value=above(found.start), unit="N s2"),
            Point(name="bound of the integral of abs(s_D) d sigma", value=above(found.integral), unit="s2/m"),
            Point(name="Lipschitz constant of s_D in sigma", value=above(steepest), unit="m/s2"),
        )
        said = (
            f"The integral of abs(s_D) d sigma is at most {rounded_up(above(found.integral))} s2/m and s_D changes by "
            f"at most {rounded_up(above(steepest))} m/s2 per unit of sigma"
        )
    return Certificate(
        name="barbalat",
        title="barbalat",
        claim=f"As the train comes to a standstill from {problem.speeds[1] * KMH:.3g} km/h, s_D tends to zero: in "
        "sigma = integral of dt/v the run has no end, the integral of abs(s_D) is finite and s_D uniformly "
        f"continuous; slip {problem.slips[0]:g} to {problem.slips[1]:g}, all masses, inertias and frictions of the "
        "domain.",
        status=status,
        explanation=f"{said}. "
        + (f"Not shown: {'; '.join(open_ones)}." if open_ones else "All that the lemma needs is proved.")
        + " It says that the error enters the boundary layer at standstill at the latest, not how soon.",
        margin=verdict.margin(low, high),
        worst_point=where,
        hypotheses=hypotheses,
        assumptions=(
            "T = u inside the limits of the brake: no valve lag, no sampling, continuous adaptation",
            "slip reference constant",
            "the slip stays in the range of the domain",
            "the model of the slip and the rates alpha/v hold down to standstill; both are limited below "
            f"{constants().slip_regularization_speed:g} m/s",
        ),
        method="repaired Lyapunov function in sigma; torques and deceleration enclosed by interval branch and bound "
        "and replayed by the checker; the rest in balls",
        resolution=f"{low.boxes + high.boxes + slowing.boxes} boxes; torques within {TORQUE_TOLERANCE:g} N m",
        reference="eqs. (41)-(48) with rates alpha/v; docs/theory.md#barbalat",
        undecided=verdict.undecided(low, high, slowing),
        engine=engine(),
        proofs=verdict.proofs(low, high, slowing),
    )
