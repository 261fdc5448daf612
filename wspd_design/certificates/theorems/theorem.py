"""The form of a theorem: what it needs shown about a design, and how the verdict is told."""

from collections.abc import Callable, Iterable, Mapping, Set
from dataclasses import dataclass, replace
from typing import TypeAlias

from wspd_design.certificates.kernel.finding import Finding
from wspd_design.certificates.kernel.obligation import Obligation
from wspd_design.certificates.outside import OutsideModel
from wspd_design.certificates.records import Certificate, Hypothesis, Problem, Range, Status
from wspd_design.certificates.setting import assumptions, domain
from wspd_design.certificates.setting.fingerprint import model_hash

Findings: TypeAlias = Mapping[str, Finding]
"""What is known about each obligation, by its key."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Theorem:
    """A statement about a closed loop, made from the design alone.

    Search and replay differ only in where the findings come from; the verdict and every sentence about it come from
    ``tell``, so that a file can be compared word for word with what its proofs show.
    """

    name: str
    title: str
    claim: str  # in general words, for a design that it does not speak about
    speaks_about: Callable[[Problem], str]  # empty, or why it does not
    obligations: Callable[[Problem], tuple[Obligation, ...]]
    tell: Callable[[Problem, Findings], Certificate]
    assumes: Set[assumptions.Assumption] = assumptions.ALL  # about the vehicle


def asked(theorem: Theorem, problem: Problem) -> tuple[Obligation, ...] | Certificate:
    """Return what a theorem needs shown about a design.

    Of a theorem that does not speak about it, or that leaves the model, return the certificate that says so.
    """

    def without_findings(status: Status, explanation: str, method: str) -> Certificate:
        made = Certificate(
            claim=theorem.claim,
            status=status,
            explanation=explanation,
            method=method,
        )
        return _complete(theorem, problem, made)

    reason = theorem.speaks_about(problem)
    if reason:
        said = f"{problem.controller.name} {reason}."
        return without_findings(Status.NOT_APPLICABLE, said, "form of the law")
    said = assumptions.not_met(problem.vehicle, theorem.assumes)
    if said:
        return without_findings(Status.NOT_APPLICABLE, said, "assumptions about the vehicle")
    try:
        return theorem.obligations(problem)
    except OutsideModel as outside:
        return without_findings(Status.UNDECIDED, f"The check could not be evaluated: {outside}.", "none")


def told(theorem: Theorem, problem: Problem, findings: Findings) -> Certificate:
    """Tell the verdict of a theorem that speaks about a design.

    Parameters
    ----------
    theorem : Theorem
        What is told.
    problem : Problem
        The closed loop and its domain.
    findings : mapping of str to Finding
        One for each obligation.
    """
    return _complete(theorem, problem, replace(theorem.tell(problem, findings), findings=findings))


def _complete(theorem: Theorem, problem: Problem, certificate: Certificate) -> Certificate:
    uncertain = domain.uncertain(problem)
    return replace(
        certificate,
        name=theorem.name,
        title=theorem.title,
        model_hash=model_hash(problem),
        varied=tuple(name for name in certificate.varied if name in uncertain),
        held=tuple(name for name in certificate.held if name in uncertain),
    )


ORDER = (Status.REFUTED, Status.UNDECIDED, Status.VACUOUS, Status.EVIDENCE, Status.PROVED)
"""From the weakest support of a theorem to the strongest."""


def all_of(*findings: Finding) -> Status:
    """Return the status of what holds exactly if all its parts do: that of the weakest."""
    return min((finding.status for finding in findings), key=ORDER.index)


def following_from(*findings: Finding) -> Status:
    """Return the status of what follows from hypotheses that are sufficient, not necessary.

    A refuted hypothesis invalidates the argument, not necessarily the conclusion: the theorem is undecided then.
    """
    return max(all_of(*findings), Status.UNDECIDED, key=ORDER.index)


def hypothesis(text: str, *findings: Finding) -> Hypothesis:
    """State in words what some findings decide."""
    return Hypothesis(text=text, status=all_of(*findings))


def smallest_margin(*findings: Finding) -> Range:
    """Smallest margin of claims in one unit; open below where a search had to stop."""
    margins = [finding.margin for finding in findings]
    lows = [each.low for each in margins if each.low is not None]
    highs = [each.high for each in margins if each.high is not None]
    return Range(
        low=min(lows) if len(lows) == len(margins) else None,
        high=min(highs) if highs else None,
        unit=margins[0].unit,
    )


def left_open(findings: Iterable[Finding]) -> str:
    """Say how far searches came that could not decide, or nothing."""
    unfinished = [each for each in findings if each.status is Status.UNDECIDED and each.effort.boxes]
    if not unfinished:
        return ""
    most = max(unfinished, key=lambda each: each.effort.undecided).effort
    how = "the search was cut by its budget" if most.cut else "the search ended"
    return f"{how} with {most.undecided:.2g} of the box undecided after {most.boxes} boxes; more effort may decide it"
