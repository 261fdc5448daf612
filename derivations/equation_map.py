"""The equation map: every numbered equation of the paper with the verdicts that SymPy computed."""

from functools import cache

from derivations.claim import equation
from derivations.claims import brake, convergence, fuzzy, model, sliding, track
from wspd_design.parameters.equations import Equation

CLAIMS = tuple(claim for part in (model, brake, sliding, fuzzy, convergence, track) for claim in part.CLAIMS)


@cache
def equations() -> tuple[Equation, ...]:
    """Return the whole map in the order of the paper."""
    return tuple(equation(claim) for claim in CLAIMS)
