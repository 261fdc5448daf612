"""One quadratic Lyapunov function for all speeds: a proof for laws that feed back the braking torque."""

import math
from fractions import Fraction
from typing import TYPE_CHECKING

from wspd_design.certificates.checks.frame import certified, level, series
from wspd_design.certificates.kernel.arb import Ball, point
from wspd_design.certificates.records import (
    Certificate,
    Hypothesis,
    Point,
    Problem,
    Proof,
    Range,
    Series,
    Status,
)
from wspd_design.certificates.search.quadratic import NotFound, search
from wspd_design.certificates.search.settle import Finding, enclose, engine
from wspd_design.certificates.setting import domain, laws
from wspd_design.certificates.setting.domain import KMH
from wspd_design.certificates.setting.plant import place, plant_dynamics
from wspd_design.certificates.theorems.quadratic import (
    Loop,
    Matrix,
    Quadratic,
    certificate_text,
    check_quadratic,
    held,
    loop_of,
    pole_claim,
    rates,
)
from wspd_design.controllers.torque_feedback import TorqueFeedback
from wspd_design.model.slip import slip_dynamics

if TYPE_CHECKING:
    from wspd_design.certificates.kernel.claim import Relation

NAME, TITLE = "lpv_lyapunov", "Quadratic function for all speeds"
TOLERANCE = 0.1  # 1/s, of the ends of the polytope
SPEEDS = 25


@certified(name=NAME, title=TITLE)
def check(problem: Problem) -> Certificate:
    """Enclose the polytope, search the function, and let it be checked exactly."""
    law = problem.controller
    claim = "One quadratic function of slip and torque error falls at all speeds."
    if not isinstance(law, TorqueFeedback):
        if laws.slip_feedback_only(problem).status is Status.REFUTED:
            reason = "uses torque or acceleration, but is no static linear law that a quadratic function could judge"
        else:
            reason = "feeds back neither torque nor acceleration; for such a law see no_go"
        return laws.not_applicable(problem, NAME, claim, reason)
    domain.box(problem)
    loop = loop_of(problem, law)
    ends = tuple(_end(problem, relation) for relation in (">=", "<="))
    low, high = problem.speeds[0] * KMH, problem.speeds[1] * KMH
    claim = (
        f"Near slip {problem.slip:g}, with the valve lag of {float(loop.lag):g} s, one quadratic function of the "
        f"errors of sliding speed and torque falls along the loop, continuous and sampled every "
        f"{problem.sample_time * 1e3:g} ms, whatever the course of speed from {high:.3g} to {low:.3g} km/h, "
        "for all masses, inertias and frictions of the domain."
    )
    hypotheses = [Hypothesis(text="the slip pole less a/v stays in its interval", status=_weaker(ends))]
    status, why, proof = Status.UNDECIDED, "", None
    found: Quadratic | None = None
    witness = _unstable(problem, loop, ends)
    if witness:
        status = Status.REFUTED
    elif all(end.proof is not None for end in ends):
        try:
            found = search(loop, (ends[0].claim.bound, ends[1].claim.bound))
            proof, why = _proved(problem, found, ends)
        except NotFound as reason:
            why = str(reason)
        status = Status.PROVED if proof is not None else Status.UNDECIDED
    else:
        why = next(end.reason for end in ends if end.proof is None)
    hypotheses.append(
        Hypothesis(text="P, and its decrease at every vertex, are positive definite", status=status)
    )
    curves, worst = _plots(problem, law, loop)
    bounds = ends[0].extreme.low, ends[1].extreme.high
    polytope = f"p - a/v lies between {bounds[0]:.3g} and {bounds[1]:.3g} 1/s"
    explanation = {
        Status.PROVED: "",
        Status.UNDECIDED: f"{polytope}. Nothing is shown: {why}.",
        Status.REFUTED: f"{polytope}. At the witness the loop with these gains is unstable in exact arithmetic, so "
        "that no such function can exist.",
    }[status]
    margin = Range(low=None, high=1.0 - worst, unit="per sample")
    if found is not None and status is Status.PROVED:
        margin = Range(low=float(1 - found.contraction), high=1.0 - worst, unit="per sample")
        explanation = (
            f"{polytope}. The error, measured by the root of the function, falls at least as "
            f"exp(-{float(found.decay):.3g} t) in continuous time and by a factor of "
            f"{float(found.contraction):.3g} per sample."
        )
    return Certificate(
        name=NAME,
        title=TITLE,
        claim=claim,
        status=status,
        explanation=explanation,
        margin=margin,
        worst_point=witness,
        witness=witness,
        hypotheses=tuple(hypotheses),
        assumptions=(
            "small deviations from the reference; nothing saturates",
            "averaged valve with the slower of its two time constants; command held over a sample, no computing time",
            "sampled loop: p - a/v constant within a sample, arbitrary from one to the next",
            "the slow change of the torque that holds the reference is left out",
        ),
        method="linear matrix inequality by cvxpy and Clarabel; exact LDL' of rational matrices at the vertices, "
        "matrix exponentials enclosed by Arb on parts that cover the interval",
        resolution=f"ends of the polytope within {TOLERANCE:g} 1/s"
        + (f"; {proof.leaves} parts of its interval" if proof is not None else ""),
        reference="eqs. (14), (19); docs/theory.md#lpv",
        engine=engine(),
        proofs=() if proof is None else (proof,),
        series=curves,
    )


def _end(problem: Problem, relation: "Relation") -> Finding:
    """Enclose one end of the interval of p - a/v."""
    return enclose(pole_claim(problem, relation, Fraction(0)), tolerance=TOLERANCE)


def _weaker(ends: tuple[Finding, ...]) -> Status:
    return Status.PROVED if all(end.status is Status.PROVED for end in ends) else Status.UNDECIDED


def _proved(problem: Problem, found: Quadratic, ends: tuple[Finding, ...]) -> tuple[Proof | None, str]:
    """Let the checker decide."""
    first, second = (end.proof for end in ends)
    assert first is not None
    assert second is not None
    text = certificate_text(found, (first.certificate, second.certificate))
    verdict = check_quadratic(text, problem)
    if not verdict.accepted:
        return None, verdict.reason
    proof = Proof(
        claim="common quadratic function",
        statement=verdict.statement,
        claim_hash=first.claim_hash,
        certificate=text,
        leaves=verdict.leaves,
        seconds=verdict.seconds,
    )
    return proof, ""


def _unstable(problem: Problem, loop: Loop, ends: tuple[Finding, ...]) -> tuple[Point, ...]:
    """Look for a point where the frozen loop is unstable for certain."""
    import numpy as np

    vehicle = problem.vehicle
    usual = {
        **ends[0].place,
        "mass": vehicle.mass,
        "wheelset inertia": vehicle.wheelset_inertia,
        "mu0": problem.rail.mu0,
    }
    nominal = [{**usual, "speed": float(v)} for v in np.geomspace(*problem.speeds, SPEEDS)]
    for at in (ends[1].place, ends[0].place, *nominal):
        plant = plant_dynamics(problem, {name: point(value) for name, value in at.items()})
        q = plant.pole - plant.deceleration / at["speed"]
        gamma = (
            point(Fraction(vehicle.wheel_radius) * Fraction(vehicle.brake.max_torque))
            / at["wheelset inertia"]
        )
        if _leaves(held(loop, q, gamma)) or _grows(rates(loop, q, gamma)):
            return (*place(at), Point(name="p - a/v", value=float(q), unit="1/s"))
    return ()


def _grows(a: Matrix) -> bool:
    """Whether a continuous loop is unstable for certain: a positive trace or a negative determinant."""
    trace, determinant = _invariants(a)
    return bool(trace > 0) or bool(determinant < 0)


def _leaves(a: Matrix) -> bool:
    """Whether a sampled loop is unstable for certain, after Jury."""
    trace, determinant = _invariants(a)
    return bool(determinant > 1) or bool(1 + trace + determinant < 0) or bool(1 - trace + determinant < 0)


def _invariants(a: Matrix) -> tuple[Ball, Ball]:
    """Trace and determinant, as balls."""
    entries = [[point(each) if isinstance(each, (float, Fraction)) else each for each in row] for row in a]
    return entries[0][0] + entries[1][1], entries[0][0] * entries[1][1] - entries[0][1] * entries[1][0]


def _plots(problem: Problem, law: TorqueFeedback, loop: Loop) -> tuple[tuple[Series, ...], float]:
    """Largest eigenvalue of the sampled loop over speed with nominal parameters, and its largest value."""
    import numpy as np

    speeds = np.geomspace(*problem.speeds, SPEEDS)
    plant = slip_dynamics(problem.vehicle, problem.rail, problem.slip, speeds)
    poles = plant.pole - plant.deceleration / speeds
    gamma = law.vehicle.wheel_radius * problem.vehicle.brake.max_torque / problem.vehicle.wheelset_inertia
    sizes = []
    for q in poles:
        step = held(loop, point(float(q)), point(gamma))
        eigenvalues = np.linalg.eigvals(np.array([[float(each) for each in row] for row in step]))
        sizes.append(float(np.abs(eigenvalues).max()))
    axes = ("speed [km/h]", "eigenvalue [-]")
    curves = (
        series("largest of the sampled loop, nominal", *axes, speeds * KMH, np.array(sizes)),
        level("limit", *axes, speeds * KMH, 1.0),
        series("nominal", "speed [km/h]", "p - a/v [1/s]", speeds * KMH, poles),
    )
    return curves, max(sizes) if sizes else math.inf
