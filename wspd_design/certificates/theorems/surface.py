"""Theorem about the sliding surface itself: on it the slip error decays, e' + c e = 0 with c = K_I / K_P > 0."""

import math
from fractions import Fraction

from wspd_design.certificates.kernel.finding import above, below
from wspd_design.certificates.kernel.obligation import Condition, Sign
from wspd_design.certificates.records import Certificate, Point, Problem, Range, Status
from wspd_design.certificates.theorems.theorem import Findings, Theorem, hypothesis
from wspd_design.certificates.theorems.whom import surface_of, with_surface


def surface_obligations(problem: Problem) -> tuple[Sign | Condition, ...]:
    """Return the claim that c is positive, or that the gains define a surface where they do not."""
    rate = _rate(problem)
    if rate is None:
        return (Condition(key="rate", text="both gains are finite, and K_P is not 0", holds=False),)
    return (Sign(key="rate", quantity="c = K_I/K_P", value=rate, unit="1/s"),)


def _rate(problem: Problem) -> Fraction | None:
    numerator, denominator = surface_of(problem).surface_gains
    if not (math.isfinite(numerator) and math.isfinite(denominator) and denominator != 0.0):
        return None
    return Fraction(numerator) / Fraction(denominator)


def _tell(problem: Problem, findings: Findings) -> Certificate:
    numerator, denominator = surface_of(problem).surface_gains
    found, rate = findings["rate"], _rate(problem)
    speed = f" = {float(rate):.4g} 1/s" if rate is not None else ""
    halving = math.log(2.0) / float(rate) if rate is not None and float(rate) > 0.0 else math.inf
    return Certificate(
        claim=f"While the state is on the surface, the slip error decays: e' + c e = 0 with c = K_I/K_P{speed} > 0.",
        status=found.status,
        explanation={
            Status.PROVED: f"The error halves every {halving:.3g} s while the state stays on the surface.",
            Status.REFUTED: "The two gains define no surface: both must be finite and K_P must not be 0."
            if rate is None
            else "The error does not decay on the surface: K_I and K_P must have the same sign.",
            Status.UNDECIDED: "Nothing is stated.",
        }[found.status],
        margin=None if rate is None else Range(low=below(rate), high=above(rate), unit="1/s"),
        witness=(
            Point(name="K_I", value=numerator, unit="1/s"),
            Point(name="K_P", value=denominator, unit="-"),
        )
        if found.status is Status.REFUTED
        else (),
        hypotheses=(hypothesis(found.asked, found),),
        assumptions=("the state is on the surface",),
        method="exact rational arithmetic on the stored gains",
        reference="eqs. (21), (22), (28) with the error in place of the slip; docs/theory.md#layer",
    )


SURFACE_HURWITZ = Theorem(
    name="surface_hurwitz",
    title="Sliding surface",
    claim="On its surface the slip error decays.",
    speaks_about=with_surface,
    obligations=surface_obligations,
    tell=_tell,
    assumes=frozenset(),
)
