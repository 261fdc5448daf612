"""From a claim to what can be stated about it: a proof that the prover found, or a place where the claim fails.

Nothing in here is trusted: what is stated goes through the same checkers as a file.
"""

from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction
from math import floor, inf, isfinite, log10, nextafter

from wspd_design.certificates.kernel.checker import Work
from wspd_design.certificates.kernel.claim import Claim
from wspd_design.certificates.kernel.finding import Effort, Finding, Stated
from wspd_design.certificates.kernel.obligation import Identity, Inequality, Obligation, Sign, proof_of
from wspd_design.certificates.search.prover import Outcome, extreme, prove

GUARD = 1e-12  # relative; what the prover leaves to the rounding of the checker


def settle(claim: Claim, *, tolerance: float) -> Stated:
    """Prove a claim with nearly the tightest bound that holds, or find where it fails, or say how far one got.

    Parameters
    ----------
    claim : Claim
        What is asked.
    tolerance : float
        Width of the enclosure of the extreme value, in the unit of the claim.
    """
    found = extreme(claim, tolerance=tolerance, denied=True)
    target = tightest(claim, found, tolerance)
    denied = found.low > claim.bound if claim.relation == "<=" else found.high < claim.bound
    enough = target.bound <= claim.bound if claim.relation == "<=" else target.bound >= claim.bound
    if not denied and not (enough and found.tree):
        # The bound lies within the tolerance of the extreme value, or the budget was used up.
        target, found = claim, prove(claim)
    return stated_of(target, found)


def enclose(claim: Claim, *, tolerance: float) -> Stated:
    """Prove nearly the tightest bound on a claim's expression; the bound of the claim itself does not matter.

    Parameters
    ----------
    claim : Claim
        Expression, box and direction.
    tolerance : float
        Width of the enclosure of the extreme value, in the unit of the claim.
    """
    found = extreme(claim, tolerance=tolerance)
    return stated_of(tightest(claim, found, tolerance), found)


def settle_all(obligations: Mapping[str, Obligation], tolerances: Mapping[str, float]) -> dict[str, Stated]:
    """Settle the inequalities of a theorem that are named with their tolerance, and state all exact claims."""
    stated = {key: exact(each) for key, each in obligations.items() if isinstance(each, (Identity, Sign))}
    for key, tolerance in tolerances.items():
        obligation = obligations[key]
        assert isinstance(obligation, Inequality)
        stated[key] = settle(obligation.claim, tolerance=tolerance)
    return stated


def exact(obligation: Identity | Sign) -> Stated:
    """State what exact arithmetic alone decides."""
    return Stated(proof=proof_of(obligation))


def finding(obligation: Obligation, stated: Stated) -> Finding:
    """Let the checkers decide about a first part of what a check needs, so that its search can go on from there."""
    return obligation.decide(stated, Work())


def tightest(claim: Claim, found: Outcome, tolerance: float) -> Claim:
    """Return the claim with the bound that the prover reached, rounded outwards to a short decimal."""
    reached = found.high if claim.relation == "<=" else found.low
    if not isfinite(reached):
        return claim  # nothing is known yet
    step = Fraction(1, 10) ** (1 - floor(log10(tolerance)))
    if claim.relation == "<=":
        certain = Fraction(reached) * (1 + Fraction(GUARD) * (1 if reached > 0.0 else -1))
        near = float(-(-certain // step) * step)
        bound = near if Fraction(near) >= certain else nextafter(near, inf)
    else:
        certain = Fraction(reached) * (1 - Fraction(GUARD) * (1 if reached > 0.0 else -1))
        near = float(certain // step * step)
        bound = near if Fraction(near) <= certain else nextafter(near, -inf)
    return replace(claim, bound=Fraction(bound))


def stated_of(claim: Claim, found: Outcome) -> Stated:
    """Write what the prover found; a proof that the checker would refuse is left out, and the claim stays open."""
    place = {v.name: _inside(found.point[v.name], v.low, v.high) for v in claim.free}
    effort = Effort(boxes=found.boxes, undecided=found.undecided, cut=found.cut)
    return Stated(proof=proof_of(claim, found.tree) if found.tree else None, place=place, effort=effort)


def _inside(at: Fraction, low: Fraction, high: Fraction) -> float:
    """Return a double beside a rational that does not leave its range."""
    near = float(at)
    return float(low) if Fraction(near) < low else float(high) if Fraction(near) > high else near
