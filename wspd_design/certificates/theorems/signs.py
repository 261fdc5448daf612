"""Theorem about what every proof takes for granted: the train slows down, and torque raises the slip."""

from collections.abc import Callable
from fractions import Fraction
from math import isfinite
from typing import NamedTuple, TypeAlias

from wspd_design.certificates.kernel.claim import Claim
from wspd_design.certificates.kernel.finding import Finding
from wspd_design.certificates.kernel.obligation import Inequality
from wspd_design.certificates.quantities import CONTACT, PLANT, RAIL
from wspd_design.certificates.records import Certificate, Point, Problem, Status
from wspd_design.certificates.setting.adhesion_edges import RESISTANCE, Ranges
from wspd_design.certificates.setting.assumptions import Assumption
from wspd_design.certificates.setting.plant import (
    AXLE_PLANT,
    Forces,
    Values,
    place,
    plant_dynamics,
    plant_forces,
    plant_variables,
)
from wspd_design.certificates.theorems.edges import of_key, on_edges, together
from wspd_design.certificates.theorems.scope import scope
from wspd_design.certificates.theorems.theorem import Findings, Theorem, all_of, hypothesis, left_open
from wspd_design.certificates.theorems.whom import every_law
from wspd_design.model.generated import slip as generated
from wspd_design.model.number import Number
from wspd_design.model.slip import SlipDynamics, wheels

FIXED = (*CONTACT, *RAIL, "mass", *RESISTANCE)
MEGA = 1e6  # N m in a MN m, so that the gain is a number of common size
LEAST_GAIN = Fraction(1, 10**6)  # 1/s per MN m: above zero, where zero itself would not do

Kernel: TypeAlias = Callable[[SlipDynamics, Values], Number]
Form: TypeAlias = Callable[[Forces, Values], Number]


class SignOf(NamedTuple):
    """A quantity that must not be negative; it rises with the adhesion."""

    key: str
    name: str
    unit: str
    least: Fraction
    axle: bool  # whether every axle has one of its own
    kernel: Kernel
    form: Form


def _gain(x: Values) -> Number:
    return generated.slip_gain(x["speed"], x["wheelset inertia"] / 2.0, x["wheel radius"]) * MEGA


SIGNS = (
    SignOf(
        key="deceleration",
        name="deceleration a",
        unit="m/s2",
        least=Fraction(0),
        axle=False,
        kernel=lambda plant, _: plant.deceleration,
        form=lambda arranged, _: arranged.deceleration,
    ),
    SignOf(
        key="adhesion",
        name="adhesion force f",
        unit="N",
        least=Fraction(0),
        axle=True,
        kernel=lambda plant, _: plant.creep_force,
        form=lambda arranged, _: arranged.creep_force,
    ),
    SignOf(
        key="gain",
        name="input gain G",
        unit="1/s per MN m",
        least=LEAST_GAIN,
        axle=True,
        kernel=lambda plant, _: plant.gain * MEGA,
        form=lambda _, x: _gain(x),
    ),
    SignOf(
        key="rate",
        name="rate of the input gain G' = G a/v",
        unit="1/s2 per MN m",
        least=Fraction(0),
        axle=False,
        kernel=lambda plant, x: plant.gain * MEGA * plant.deceleration / x["speed"],
        form=lambda arranged, x: _gain(x) * arranged.deceleration / x["speed"],
    ),
)


def sign_obligations(problem: Problem) -> tuple[Inequality, ...]:
    """Return the signs that are claimed: a, f, G and G' = G a / v."""
    return tuple(each for sign in SIGNS for each in _on_edges(problem, sign))


def _on_edges(problem: Problem, sign: SignOf) -> tuple[Inequality, ...]:
    def claimed(ranges: Ranges) -> Claim:
        return Claim(
            name=sign.name,
            variables=plant_variables(problem, uses=AXLE_PLANT if sign.axle else PLANT, ranges=ranges),
            expression=lambda x: sign.kernel(plant_dynamics(problem, x), x),
            form=lambda x: sign.form(plant_forces(problem, x), x),
            relation=">=",
            bound=sign.least,
            unit=sign.unit,
        )

    if sign.key == "gain":  # it does not depend on the adhesion
        return (
            Inequality(
                key="gain, whatever the adhesion",
                claim=claimed({name: problem.nominal(name) for name in FIXED}),
            ),
        )
    return on_edges(sign.key, problem, claimed, most=False, axle=sign.axle)


def _tell(problem: Problem, findings: Findings) -> Certificate:
    found = {sign.key: together(of_key(findings.items(), sign.key)) for sign in SIGNS}
    slowing, status = found["deceleration"], all_of(*found.values())
    denied = next(
        ((sign, found[sign.key]) for sign in SIGNS if found[sign.key].status is Status.REFUTED), None
    )
    said = scope(problem, AXLE_PLANT)
    bounded = [sign for sign in SIGNS if isfinite(found[sign.key].low)]
    values = "; ".join(f"{sign.name} >= {found[sign.key].low:.4g} {sign.unit}" for sign in bounded)
    meaning = {
        Status.PROVED: "The train slows down at every point, adhesion brakes it, more torque always means more slip, "
        "and the input gain grows during a stop",
        Status.REFUTED: ""
        if denied is None
        else f"The sign of the {denied[0].name} is wrong at slip "
        f"{denied[1].values['slip']:.3g}, so that no proof that needs it holds there",
        Status.UNDECIDED: f"Open: {left_open(found.values())}",
    }[status]

    def at(finding: Finding) -> tuple[Point, ...]:
        return place(finding.values, tuple(name for name in said.names if name in finding.values))

    return Certificate(
        claim=f"a = (f_d + {wheels(problem.vehicle)} f)/m >= 0 and G' = G a/v >= 0 for wheels at static load, f >= 0 "
        f"and G > 0 {said.text}.",
        status=status,
        explanation=f"{meaning}. Found: {values or 'no bound'}.",
        margin=slowing.margin,
        worst_point=at(slowing) if slowing.values else (),
        witness=()
        if denied is None
        else (*at(denied[1]), Point(name=denied[0].name, value=denied[1].high, unit=denied[0].unit)),
        hypotheses=tuple(
            hypothesis(f"{sign.name} {'>' if sign.least else '>='} 0", found[sign.key]) for sign in SIGNS
        ),
        assumptions=("level track",),
        domain=said.domain,
        varied=said.varied,
        held=said.held,
        method="interval branch and bound on the edges of the box where the adhesion is least, replayed by the "
        "independent checker",
        reference="eqs. (1), (4)-(7), (19); docs/theory.md#slip-equation",
    )


WELL_POSED = Theorem(
    name="well_posed",
    title="Signs of the model",
    claim="a >= 0, f >= 0, G > 0 and G' >= 0 on the domain.",
    speaks_about=every_law,
    obligations=sign_obligations,
    tell=_tell,
    assumes={Assumption.EQUAL_BRAKES, Assumption.EQUAL_LOADS, Assumption.ADHESION_ALONE},
)
