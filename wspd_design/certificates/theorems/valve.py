"""Theorems about what the lag of the valve leaves possible."""

from fractions import Fraction

from wspd_design.certificates.kernel.arb import above, below, point
from wspd_design.certificates.kernel.claim import Claim, Relation
from wspd_design.certificates.kernel.obligation import Condition, Inequality, Obligation, OnPart
from wspd_design.certificates.records import Certificate, Problem, Status
from wspd_design.certificates.setting import domain, laws
from wspd_design.certificates.setting.domain import KMH
from wspd_design.certificates.setting.plant import (
    OTHERS,
    Values,
    place,
    plant_dynamics,
    plant_forces,
    plant_variables,
)
from wspd_design.certificates.theorems.theorem import Findings, Theorem, hypothesis
from wspd_design.model.number import Number


def pole_claim(
    problem: Problem, relation: Relation, bound: float, **ranges: float | tuple[float, float]
) -> Claim:
    """Return a claim about the slip pole at the reference [1/s], by default on the whole domain."""

    def arranged(x: Values) -> Number:
        return plant_forces(problem, x).pole

    return Claim(
        name="slip pole",
        variables=plant_variables(problem, hold=OTHERS, ranges={"slip": problem.slip, **ranges}),
        expression=lambda x: plant_dynamics(problem, x).pole,
        form=arranged,
        relation=relation,
        bound=Fraction(bound),
        unit="1/s",
    )


def valve_rate(problem: Problem) -> tuple[float, float]:
    """Return 1/tau rounded down, to stay below, and rounded up, to exceed [1/s]."""
    rate = 1 / point(min(problem.vehicle.brake.fill_time, problem.vehicle.brake.vent_time))
    return below(rate), above(rate)


def interval_claim(problem: Problem, limit: float, speeds: tuple[float, float], relation: Relation) -> Claim:
    """Return the claim that the nominal slip pole reaches (or respects) a limit [1/s] at all speeds [m/s]."""
    return pole_claim(
        problem,
        relation,
        limit,
        speed=speeds,
        **{name: problem.nominal(name) for name in domain.PARAMETERS},
    )


def _obligations(problem: Problem) -> tuple[Obligation, ...]:
    domain.box(problem)
    low, high = valve_rate(problem)
    form = laws.slip_feedback_only(problem)
    return (
        OnPart(
            key="beyond",
            claim=lambda speeds: interval_claim(problem, high, speeds, ">="),
            quantity="speed",
            within=problem.speeds,
        ),
        Inequality(key="nowhere", claim=interval_claim(problem, low, problem.speeds, "<=")),
        Condition(key="feedback", text=form.text, holds=form.status is not Status.REFUTED),
    )


def _tell(problem: Problem, findings: Findings) -> Certificate:
    beyond, nowhere = findings["beyond"], findings["nowhere"]
    limit = valve_rate(problem)[1]
    low, high = beyond.part or problem.speeds
    where = f"from {low:.4g} to {high:.4g} m/s ({low * KMH:.3g} to {high * KMH:.3g} km/h)"
    status = (
        Status.LIMITATION
        if beyond.status is Status.PROVED
        else Status.VACUOUS
        if nowhere.status is Status.PROVED
        else Status.UNDECIDED
    )
    shown = beyond if status is Status.LIMITATION else nowhere
    return Certificate(
        name="no_go",
        title="Speeds that slip feedback cannot master",
        claim=f"No law without feedback of torque is asymptotically stable at slip {problem.slip:g} {where}, "
        f"with the nominal parameters and tau = {1.0 / limit:g} s.",
        status=status,
        explanation={
            Status.LIMITATION: "There every equilibrium is unstable whatever the gains.",
            Status.VACUOUS: "There is no such speed: the valve is faster than the slip pole throughout.",
            Status.UNDECIDED: "Nothing is known.",
        }[status],
        method="crossings by bisection, then interval branch and bound, replayed by the independent checker",
        margin=shown.margin,
        worst_point=place(shown.values) if shown.values else (),
        hypotheses=(
            hypothesis(findings["feedback"].asked, findings["feedback"]),
            hypothesis(shown.asked, shown),
        ),
        reference="eqs. (14), (19); docs/theory.md#no-go",
    )


def _feedback(problem: Problem) -> str:
    form = laws.slip_feedback_only(problem)
    return (
        "" if form.status is not Status.REFUTED else "feeds back more than the slip and is not bound by this"
    )


NO_GO = Theorem(
    name="no_go",
    title="Speeds that slip feedback cannot master",
    claim="No law without feedback of torque is asymptotically stable where the slip pole exceeds 1/tau.",
    speaks_about=_feedback,
    obligations=_obligations,
    tell=_tell,
)
