"""A slip that takes more torque than full pressure gives is not exceeded again, whatever the law does.

The one-sided claim beside a band of slip: where the brake is the limit no law holds its reference from both sides, but
the side that protects the wheel needs no law.
"""

from fractions import Fraction

from wspd_design.certificates.kernel.claim import Claim
from wspd_design.certificates.kernel.finding import Finding
from wspd_design.certificates.kernel.obligation import Inequality
from wspd_design.certificates.outside import OutsideModel
from wspd_design.certificates.quantities import PLANT
from wspd_design.certificates.records import Certificate, Problem, Status
from wspd_design.certificates.setting import creep_slope
from wspd_design.certificates.setting.adhesion_edges import RESISTANCE, Ranges
from wspd_design.certificates.setting.assumptions import ALL, OF_VALVES, Assumption
from wspd_design.certificates.setting.plant import (
    Values,
    place,
    plant_forces,
    plant_records,
    plant_variables,
)
from wspd_design.certificates.theorems.edges import of_key, on_edges
from wspd_design.certificates.theorems.scope import scope
from wspd_design.certificates.theorems.theorem import (
    Findings,
    Theorem,
    all_of,
    following_from,
    hypothesis,
    left_open,
)
from wspd_design.certificates.theorems.whom import every_law
from wspd_design.model.number import Number
from wspd_design.model.slip import slip_dynamics
from wspd_design.parameters.units import KMH

FADES = "fades"
HOLDS = "holds"
USES = tuple(name for name in PLANT if name not in ("slip", *RESISTANCE))
"""What the claims depend on; the resistance slows the train down further, and does not enter the torque."""


def fading(problem: Problem) -> Inequality:
    """Ask that the creep force at a slip from the reference on nowhere rises with the speed."""
    slips = (problem.slip, problem.slips[1])
    return Inequality(key=FADES, claim=creep_slope.fading_claim(problem, slips, "<=", Fraction(0)))


def sides(problem: Problem) -> tuple[Inequality, ...]:
    """Ask whether the least full pressure holds every slip from the reference on: the brake is never the limit."""
    least = problem.span("max torque")[0]
    kept = {name: problem.nominal(name) for name in creep_slope.HELD}

    def holds(edge: Ranges) -> Claim:
        return torque_claim(problem, least, {**edge, **kept, "slip": (problem.slip, problem.slips[1])})

    return on_edges(HOLDS, problem, holds, most=True, axle=False)


def torque_claim(problem: Problem, bound: float, ranges: Ranges) -> Claim:
    """Claim a bound on the torque that holds a slip, the wheelset alone slowing the train down [N m]."""

    def torque(x: Values) -> Number:
        vehicle, rail = plant_records(problem, x)
        force = slip_dynamics(vehicle, rail, x["slip"], x["speed"]).creep_force
        plant = slip_dynamics(vehicle, rail, x["slip"], x["speed"], deceleration=2.0 * force / vehicle.mass)
        return -plant.drift / plant.gain

    def arranged(x: Values) -> Number:
        radius, left = x["wheel radius"], 1.0 - x["slip"]
        turning = left * x["wheelset inertia"] * 2.0 / (x["mass"] * radius)
        return plant_forces(problem, x).creep_force * (2.0 * radius + turning) - (
            2.0 * left * x["speed"] * x["wheel damping"] / radius
        )

    return Claim(
        name="T_s",
        variables=plant_variables(problem, uses=PLANT, hold=RESISTANCE, ranges=ranges),
        expression=torque,
        form=arranged,
        relation="<=",
        bound=Fraction(bound),
        unit="N m",
    )


def _obligations(problem: Problem) -> tuple[Inequality, ...]:
    if problem.speeds[0] <= 0.0:
        raise OutsideModel("the slip has no limit at standstill")
    return (fading(problem), *sides(problem))


def limited(findings: Findings) -> Finding | None:
    """Return the finding with the highest speed from which on a slip takes more than full pressure, or none."""
    denied = [each for each in of_key(findings.items(), HOLDS) if each.status is Status.REFUTED]
    return max(denied, key=lambda each: each.values["speed"]) if denied else None


def _tell(problem: Problem, findings: Findings) -> Certificate:
    fades, holds = findings[FADES], of_key(findings.items(), HOLDS)
    said = scope(problem, USES, creep_slope.HELD)
    low, most = problem.speeds[0] * KMH, problem.slips[1]
    where = limited(findings)
    known = ("slip", "speed", *said.varied)
    if where is not None:
        status = following_from(fades)
        full = problem.span("max torque")[0] / 1e3
        slip, fast = where.values["slip"], where.values["speed"] * KMH
        explanation = (
            f"In a corner of the box slip {slip:.3g} takes more than full pressure, {full:.3g} kN m, from "
            f"{fast:.3g} km/h down."
        )
    elif all_of(*holds) is Status.PROVED:
        status = Status.VACUOUS
        explanation = (
            f"The brake is nowhere the limit: full pressure holds slip {problem.slip:g} to {most:g}."
        )
    else:
        status = Status.UNDECIDED
        reason = left_open(holds)
        explanation = f"Whether the brake is the limit anywhere is open{': ' if reason else ''}{reason}."
    return Certificate(
        claim=f"A slip from {problem.slip:g} to {most:g} that takes more torque than full pressure gives is not "
        f"exceeded again: a wheelset that slips at most s where the torque that holds s is at least T_max slips at "
        f"most s down to {low:.3g} km/h, whatever the law, the valves and the sensors do. It is claimed {said.text}, "
        "all of them constant.",
        status=status,
        explanation=explanation,
        worst_point=place(where.values, known) if where is not None else (),
        hypotheses=(
            hypothesis("the creep force at a given slip nowhere rises with the speed", fades),
            *(
                (hypothesis("full pressure holds all these slips on all of the box", *holds),)
                if status is Status.VACUOUS
                else ()
            ),
        ),
        assumptions=(
            "the numbers do not change during the stop, and the wheel carries its static load",
            "the train slows down, at least as this wheelset alone slows it down; the torque never exceeds T_max",
            "a slip below the reference costs distance, and nothing is said about it: this is no band about the "
            "reference; nor is anything said about higher speeds",
        ),
        domain=said.domain,
        varied=said.varied,
        held=said.held,
        method="interval branch and bound, replayed by the independent checker",
        reference="docs/theory.md#limit",
    )


SLIP_LIMIT = Theorem(
    name="slip_limit",
    title="Slip that takes more than full pressure",
    claim="A slip that takes more torque than full pressure gives is not exceeded again.",
    speaks_about=every_law,
    obligations=_obligations,
    tell=_tell,
    assumes=ALL - OF_VALVES - {Assumption.SUPPLY, Assumption.ADHESION_ALONE},
)
