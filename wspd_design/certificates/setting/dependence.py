"""Which quantities a claim depends on, read from its symbols and never typed."""

from collections.abc import Iterable
from dataclasses import replace

from wspd_design.certificates.kernel.claim import Claim, Expression, formula
from wspd_design.certificates.quantities import AXLE, QUANTITIES
from wspd_design.certificates.records import Problem
from wspd_design.certificates.setting import domain


def used(claim: Claim) -> tuple[str, ...]:
    """Names of the variables that a claim depends on, in the order of the claim.

    A variable whose symbol is missing in the expression or in its arranged form does not matter, since the two are
    the same function.
    """
    symbols = _symbols(claim.expression, claim)
    if claim.form is not None:
        symbols &= _symbols(claim.form, claim)
    return tuple(v.name for v in claim.variables if v.name in symbols)


def _symbols(expression: Expression, claim: Claim) -> set[str]:
    return {step[1] for step in formula(expression, claim.variables) if step[0] == "x"}


def trimmed(claim: Claim) -> Claim:
    """Return a claim without the variables that it does not depend on."""
    names = used(claim)
    others = {v.name: float(v.low) for v in claim.variables if v.name not in names}

    def without(expression: Expression) -> Expression:
        return lambda x: expression({**others, **x})

    return replace(
        claim,
        variables=tuple(v for v in claim.variables if v.name in names),
        expression=without(claim.expression),
        form=None if claim.form is None else without(claim.form),
    )


def varied(claims: Iterable[Claim]) -> tuple[str, ...]:
    """Names of the quantities that vary in some claim and matter there, in the order of the table."""
    found = {v.name for claim in claims for v in claim.free if v.name in used(claim)}
    return tuple(name for name in QUANTITIES if name in found)


def held(problem: Problem, claims: Iterable[Claim]) -> tuple[str, ...]:
    """Names of the numbers with a range that some claim depends on and holds at one value."""
    fixed = {v.name for claim in claims for v in claim.variables if not v.free and v.name in used(claim)}
    return tuple(name for name in domain.uncertain(problem) if name in fixed)


def told(problem: Problem, claims: Iterable[Claim]) -> str:
    """Return the domain of some claims in words: what varies, what is held, and for which axles it holds."""
    claims = tuple(claims)
    words = domain.described(problem, varied(claims), held(problem, claims))
    every_axle = any(v.name in AXLE for claim in claims for v in claim.variables)
    return words if every_axle else f"{words}; axle at static load"


def left_out(problem: Problem, claims: Iterable[Claim]) -> str:
    """Return the line that says which numbers with a range vary in none of the claims."""
    names = domain.not_varied(problem, varied(claims))
    return f"not varied: {', '.join(names) if names else 'nothing'}"
