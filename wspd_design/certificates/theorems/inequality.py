"""Decide whether an expression of the model is positive on a box."""

from dataclasses import replace
from fractions import Fraction

from wspd_design.certificates.kernel.claim import Claim, Expression, Variable
from wspd_design.certificates.records import Status
from wspd_design.certificates.search.settle import Finding, settle

LEAST = Fraction(1, 10**6)
"""What is shown is a bound above zero, so that the expression is positive and not only not negative."""


def positive(
    name: str, variables: tuple[Variable, ...], expression: Expression, form: Expression, unit: str
) -> Claim:
    """Claim that an expression is positive on a box.

    Parameters
    ----------
    name : str
        Of the claim.
    variables : tuple of Variable
        The box.
    expression : callable
        From the variables by name to a number, in functions that run on every number type.
    form : callable
        The same function, arranged for intervals.
    unit : str
        Of the expression.
    """
    return Claim(
        name=name,
        variables=variables,
        expression=expression,
        form=form,
        relation=">=",
        bound=LEAST,
        unit=unit,
    )


def decide(claim: Claim, *, tolerance: float) -> Finding:
    """Settle a claim of :func:`positive`; a value between zero and its bound refutes nothing.

    Parameters
    ----------
    claim : Claim
        From :func:`positive`.
    tolerance : float
        Of the enclosure of the infimum, in the unit of the claim.
    """
    found = settle(claim, tolerance=tolerance)
    if found.status is Status.REFUTED and found.ends[1] > 0.0:
        return replace(found, status=Status.UNDECIDED, reason="the infimum is hardly above zero")
    return found
