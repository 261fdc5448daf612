"""What the findings about several claims say together."""

from wspd_design.certificates.proof.engine import Finding
from wspd_design.certificates.records import Hypothesis, Proof, Status

ORDER = (Status.REFUTED, Status.UNDECIDED, Status.PROVED)


def status(*findings: Finding) -> Status:
    """Refuted if one is, else undecided if one is; proved only if all are."""
    return min((finding.status for finding in findings), key=ORDER.index)


def hypothesis(text: str, finding: Finding) -> Hypothesis:
    """State a claim in words with its verdict."""
    return Hypothesis(text=text, status=finding.status)


def proofs(*findings: Finding) -> tuple[Proof, ...]:
    """Return what the checker accepted."""
    return tuple(finding.proof for finding in findings if finding.proof is not None)


def undecided(*findings: Finding) -> float:
    """Largest share of a box that was left open."""
    return max(finding.undecided for finding in findings)
