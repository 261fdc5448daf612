"""Parts of one claim: the bound that is proved of all is as tight as the tightest part allows, and no tighter."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction

from wspd_design.certificates.kernel.finding import Stated
from wspd_design.certificates.kernel.obligation import Inequality, proof_of
from wspd_design.certificates.memory import recall
from wspd_design.certificates.search.budget import budget
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
    """Enclose the part that comes last, and prove its bound of the others; or, if one denies it, settle each."""
    *others, last = parts
    found = extreme(last.claim, tolerance=tolerance)
    target = tightest(last.claim, found, tolerance).bound
    enough = target <= last.claim.bound if last.claim.relation == "<=" else target >= last.claim.bound
    if found.tree and enough:
        shown = {each.key: prove(replace(each.claim, bound=target)) for each in others}
        if all(each.tree for each in shown.values()):
            return {each.key: _stated(each, shown.get(each.key, found), target) for each in parts}
    return _one_by_one(parts, tolerance)


def _one_by_one(parts: Sequence[Inequality], tolerance: float) -> Mapping[str, Stated]:
    """Enclose all parts; prove of all what the tightest allows, if that is enough, else settle each."""
    found = {each.key: extreme(each.claim, tolerance=tolerance) for each in parts}
    upper = parts[0].claim.relation == "<="
    worst = max(parts, key=lambda each: found[each.key].high if upper else -found[each.key].low)
    target = tightest(worst.claim, found[worst.key], tolerance).bound
    enough = target <= worst.claim.bound if upper else target >= worst.claim.bound
    if not enough:
        return {each.key: settle(each.claim, tolerance=tolerance) for each in parts}
    shown = {
        each.key: found[each.key] if each is worst else prove(replace(each.claim, bound=target))
        for each in parts
    }
    return {
        each.key: replace(
            _stated(each, shown[each.key], target), place=stated_of(each.claim, found[each.key]).place
        )
        for each in parts
    }


def _stated(part: Inequality, shown: Outcome, bound: Fraction) -> Stated:
    """Write the proof of the common bound of a part."""
    wanted = replace(part.claim, bound=bound)
    return replace(stated_of(part.claim, shown), proof=proof_of(wanted, shown.tree) if shown.tree else None)
