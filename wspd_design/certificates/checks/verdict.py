"""What the findings about several claims say together."""

from wspd_design.certificates.records import Hypothesis, Proof, Range, Status
from wspd_design.certificates.search.settle import Finding

ORDER = (Status.REFUTED, Status.UNDECIDED, Status.PROVED)


def status(*findings: Finding) -> Status:
    """Refuted if one is, else undecided if one is; proved only if all are."""
    return min((finding.status for finding in findings), key=ORDER.index)


def hypothesis(text: str, finding: Finding) -> Hypothesis:
    """State a claim in words with its verdict."""
    return Hypothesis(text=text, status=finding.status)


def condition(text: str, holds: bool) -> Hypothesis:
    """State a condition that comparing numbers decides."""
    return Hypothesis(text=text, status=Status.PROVED if holds else Status.REFUTED)


def margin(*findings: Finding) -> Range:
    """Smallest margin of claims in one unit; open below where a search had to stop."""
    margins = [finding.margin for finding in findings]
    lows = [each.low for each in margins if each.low is not None]
    highs = [each.high for each in margins if each.high is not None]
    return Range(low=min(lows) if len(lows) == len(margins) else None, high=min(highs), unit=margins[0].unit)


def proofs(*findings: Finding) -> tuple[Proof, ...]:
    """Return what the checker accepted."""
    return tuple(finding.proof for finding in findings if finding.proof is not None)


def undecided(*findings: Finding) -> float:
    """Largest share of a box that was left open."""
    return max(finding.undecided for finding in findings)
