"""Theorems about the sliding surface: reaching, boundary layer, existence.

With Psi = v F and rho = (inertia of the design model) / (true inertia) the sliding-mode law makes
v sbar' = r - rho W0 sat(sbar / layer), r = (1 - rho) v c e - Psi + rho Psi_hat at a constant reference.
"""

import math
from fractions import Fraction

from wspd_design.certificates.kernel.claim import Claim, Relation
from wspd_design.certificates.kernel.obligation import Inequality
from wspd_design.certificates.outside import OutsideModel
from wspd_design.certificates.records import Certificate, Point, Problem, Status
from wspd_design.certificates.setting import domain
from wspd_design.certificates.setting.model_error import (
    inertia_ratio,
    residual,
    residual_over_ratio,
    variables,
)
from wspd_design.certificates.setting.plant import (
    OTHERS,
    Values,
    place,
    plant_dynamics,
    plant_forces,
    plant_variables,
)
from wspd_design.certificates.theorems.theorem import Findings, Theorem, all_of, hypothesis, left_open
from wspd_design.controllers.sliding_mode import SlidingMode
from wspd_design.model.number import Number
from wspd_design.model.slip import resistance
from wspd_design.parameters.loading import constants
from wspd_design.parameters.units import KMH


def reserve(problem: Problem) -> float:
    """Reaching rate eta that brings a wheel from rolling to the surface above the lowest speed [m/s2].

    In sigma = integral of dt / v the distance to the surface shrinks with eta, and the speed falls no faster
    than v0 exp(-a_max sigma), with a_max of :func:`largest_deceleration`.
    """
    domain.box(problem)
    low, high = problem.speeds
    if not low < high:
        raise OutsideModel(f"the speeds {low:g} to {high:g} m/s are one speed, which leaves no time to reach")
    return largest_deceleration(problem) * problem.slip / math.log(high / low)


def largest_deceleration(problem: Problem) -> float:
    """Return a_max: full friction on all wheels and the resistance at the highest speed [m/s2]."""
    rolling = float(resistance(problem.vehicle, problem.speeds[1])) / problem.span("mass")[0]
    return problem.span("mu0")[1] * constants().gravity + rolling


def deceleration_claim(
    problem: Problem, relation: Relation, bound: float, **ranges: float | tuple[float, float]
) -> Claim:
    """Return a claim about the deceleration of the train [m/s2], by default on the whole domain."""
    return Claim(
        name="deceleration",
        variables=plant_variables(problem, hold=OTHERS, ranges=ranges),
        expression=lambda x: plant_dynamics(problem, x).deceleration,
        form=lambda x: plant_forces(problem, x).deceleration,
        relation=relation,
        bound=Fraction(bound),
        unit="m/s2",
    )


def gain_claim(problem: Problem) -> Claim:
    """Return the claim that the switching gain outweighs the model error with the reserve eta."""
    law, eta = problem.controller, reserve(problem)
    assert isinstance(law, SlidingMode)

    def needed(x: Values) -> Number:
        ratio = inertia_ratio(x)
        return abs(residual(problem, law, x) / ratio) + eta / ratio

    def arranged(x: Values) -> Number:
        inverse = x["wheelset inertia"] / x["model wheelset inertia"]
        return abs(residual_over_ratio(problem, law, x)) + eta * inverse

    return Claim(
        name="(abs(r) + eta)/rho",
        variables=variables(problem, law),
        expression=needed,
        form=arranged,
        relation="<=",
        bound=Fraction(law.gains.switching_gain),
        unit="m/s2",
    )


def _obligations(problem: Problem) -> tuple[Inequality, ...]:
    return (
        Inequality(key="gain", claim=gain_claim(problem)),
        Inequality(
            key="deceleration", claim=deceleration_claim(problem, "<=", largest_deceleration(problem))
        ),
    )


def _tell(problem: Problem, findings: Findings) -> Certificate:
    law = problem.controller
    assert isinstance(law, SlidingMode)
    eta, gain = reserve(problem), law.gains.switching_gain
    needed, slowing = findings["gain"], findings["deceleration"]
    at, status = needed.values, all_of(needed, slowing)
    left = problem.speeds[1] * math.exp(-slowing.high * problem.slip / eta)
    meaning = {
        Status.PROVED: "abs(s_D) falls with eta while the slip stays in its range. From slip "
        f"{problem.slips[0]:g} at {problem.speeds[1] * KMH:.3g} km/h the surface is reached above "
        f"{left * KMH:.3g} km/h.",
        Status.REFUTED: "There the torque can drive the slip away from its surface: a larger W0 or a better "
        "friction model is needed.",
        Status.UNDECIDED: f"Open: {left_open(findings.values())}.",
    }[status]
    refuted = needed.status is Status.REFUTED
    return Certificate(
        name="reaching",
        title="Reaching the sliding surface",
        claim=f"W0 = {gain:.4g} m/s2 outweighs the model error: abs(r) + eta <= rho W0, "
        f"eta = {eta:.3g} m/s2, on {domain.described(problem)}.",
        status=status,
        explanation=f"The smallest W0 that does lies between {needed.low:.7g} and {needed.high:.7g} m/s2. {meaning}",
        method="interval branch and bound, replayed by the independent checker",
        margin=needed.margin,
        worst_point=place(at),
        witness=(*place(at), Point(name="(abs(r) + eta)/rho", value=needed.low, unit="m/s2"))
        if refuted
        else (),
        hypotheses=(
            hypothesis(f"(abs(r) + eta)/rho <= W0 = {gain:.4g} m/s2", needed),
            hypothesis(f"deceleration <= a_max = {largest_deceleration(problem):.4g} m/s2", slowing),
        ),
        assumptions=(
            "T = u: no valve lag, no sampling, no limit of the brake torque",
            "slip reference constant",
        ),
        reference="eqs. (20), (23)-(25) with W = W0/v; docs/theory.md#reaching",
    )


def _no_switching_gain(problem: Problem) -> str:
    known = isinstance(problem.controller, SlidingMode)
    return "" if known else "has no switching gain W0 that stands against a model error"


REACHING = Theorem(
    name="reaching",
    title="Reaching the sliding surface",
    claim="abs(r) + eta <= rho W0 for a law with a friction model and a switching gain W0.",
    speaks_about=_no_switching_gain,
    obligations=_obligations,
    tell=_tell,
)
