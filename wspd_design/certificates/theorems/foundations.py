"""Theorems about the model itself: equations, signs, existence."""

from collections.abc import Mapping
from fractions import Fraction

from wspd_design.certificates.kernel.finding import Finding, above, below
from wspd_design.certificates.kernel.obligation import Sign
from wspd_design.certificates.records import Certificate, Point, Problem, Range, Status
from wspd_design.certificates.setting import domain
from wspd_design.certificates.theorems.theorem import Theorem, all_of, hypothesis
from wspd_design.parameters.units import KMH

USED = ("speed", "wheelset inertia", "wheel radius")
"""Quantities of the table that G depends on."""


def _always(problem: Problem) -> str:  # noqa: ARG001 - the theorem speaks about every design
    return ""


def _factors(problem: Problem) -> tuple[Sign, ...]:
    """Return the factors of G, each at its smallest: a quotient of positive factors is positive on the box."""
    factors = (
        ("wheel radius", problem.span("wheel radius")[0], "m"),
        ("wheelset inertia", problem.span("wheelset inertia")[0], "kg m2"),
        ("speed", problem.speeds[0], "m/s"),
    )
    return tuple(
        Sign(key=name, quantity=name, value=Fraction(least), unit=unit) for name, least, unit in factors
    )


def _tell_gain_positive(problem: Problem, findings: Mapping[str, Finding]) -> Certificate:
    factors = _factors(problem)
    status = all_of(*findings.values())
    wrong = [each for each in factors if findings[each.key].status is Status.REFUTED]
    # The inertia of the bounds is that of a wheelset, 2 I; G is smallest where both inertia and speed are largest.
    largest = Fraction(problem.span("wheelset inertia")[1]) * Fraction(problem.speeds[1])
    smallest = Fraction(problem.span("wheel radius")[0]) / largest if status is Status.PROVED else None
    within = domain.domain_of(problem, USED)
    return Certificate(
        claim=f"G = R/(2 I v) > 0 on {within.text}.",
        status=status,
        explanation=(
            "A factor of G is zero or negative in the box, so that G has no sign there; correct the bounds."
            if smallest is None
            else "More torque means more slip wherever the train is. G is smallest at the highest "
            f"speed and inertia and the smallest wheel, {float(smallest) * 1e6:.4g} 1/s per MN m."
        ),
        method="exact rational arithmetic at the end points of the monotone quotient",
        margin=None
        if smallest is None
        else Range(low=below(smallest), high=above(smallest), unit="1/(N m s)"),
        worst_point=()
        if smallest is None
        else (
            Point(name="wheelset inertia", value=problem.span("wheelset inertia")[1], unit="kg m2"),
            Point(name="speed", value=problem.speeds[1] * KMH, unit="km/h"),
        ),
        witness=tuple(_point(each) for each in wrong),
        hypotheses=tuple(hypothesis(each.text, findings[each.key]) for each in factors),
        domain=within,
        varied=USED[1:],
        reference="eq. (19); docs/theory.md#slip-equation",
    )


def _point(factor: Sign) -> Point:
    scale, unit = domain.SHOWN.get(factor.unit, (1.0, factor.unit))
    return Point(name=factor.quantity, value=float(factor.value) * scale, unit=unit)


GAIN_POSITIVE = Theorem(
    name="gain_positive",
    title="Sign of the input gain",
    claim="The input gain G of (19) is positive.",
    speaks_about=_always,
    obligations=_factors,
    tell=_tell_gain_positive,
    assumes=frozenset(),
)
