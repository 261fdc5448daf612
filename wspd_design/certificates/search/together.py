"""Parts of one claim: the bound that is proved of all is as tight as the tightest part allows, and no tighter."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction

from wspd_design.certificates.kernel.finding import Stated
from wspd_design.certificates.kernel.obligation import Inequality, proof_of
from wspd_design.certificates.search.budget import budget
from wspd_design.certificates.search.memory import recall
from wspd_design.certificates.search.prover import Outcome, extreme, prove
from wspd_design.certificates.search.settle import settle, stated_of, tightest


def settle_together(parts: Sequence[Inequality], *, tolerance: float) -> Mapping[str, Stated]:
    """Settle parts of one claim, which have its relation and its bound in common.

    Parameters
    ----------
    parts : sequence of Inequality
        On parts of a domain.
    tolerance : float
        Width of the enclosure of the extreme over all parts, in the unit of the claim.
    """
    asked = ["settle", [each.claim.statement() for each in parts], tolerance, budget().effort]
    return recall(asked, lambda: _settled(parts, tolerance))


def _settled(parts: Sequence[Inequality], tolerance: float) -> Mapping[str, Stated]:
    found, worst, target = _common(parts, tolerance)
    enough = target <= worst.claim.bound if worst.claim.relation == "<=" else target >= worst.claim.bound
    if not enough:
        return {each.key: settle(each.claim, tolerance=tolerance) for each in parts}
    return {each.key: _stated(each, found[each.key], target, reuse=each is worst) for each in parts}


def enclose_together(parts: Sequence[Inequality], *, tolerance: float) -> Mapping[str, Stated]:
    """Prove nearly the tightest bound that all parts of a claim have; that of the claim itself does not matter."""
    asked = ["enclose", [each.claim.statement() for each in parts], tolerance, budget().effort]
    return recall(asked, lambda: _enclosed(parts, tolerance))


def _enclosed(parts: Sequence[Inequality], tolerance: float) -> Mapping[str, Stated]:
    found, worst, target = _common(parts, tolerance)
    return {each.key: _stated(each, found[each.key], target, reuse=each is worst) for each in parts}


def _common(
    parts: Sequence[Inequality], tolerance: float
) -> tuple[Mapping[str, Outcome], Inequality, Fraction]:
    """Enclose all parts; return also the tightest and the bound that is to be proved of all."""
    found = {each.key: extreme(each.claim, tolerance=tolerance) for each in parts}
    upper = parts[0].claim.relation == "<="
    worst = max(parts, key=lambda each: found[each.key].high if upper else -found[each.key].low)
    return found, worst, tightest(worst.claim, found[worst.key], tolerance).bound


def _stated(part: Inequality, found: Outcome, bound: Fraction, *, reuse: bool) -> Stated:
    """Prove the common bound of a part, with the place where its own extreme was found."""
    wanted = replace(part.claim, bound=bound)
    shown = found if reuse or not found.tree else prove(wanted)
    proof = proof_of(wanted, shown.tree) if shown.tree else None
    return replace(stated_of(part.claim, found), proof=proof)
