"""What the checks need to know of a law: what it feeds back, and whom a claim does not speak about."""

from collections.abc import Iterable

from wspd_design.certificates.records import Certificate, Hypothesis, Problem, Status
from wspd_design.certificates.setting.traced_law import memory

_WEAKNESS = (Status.UNDECIDED, Status.VACUOUS, Status.EVIDENCE, Status.PROVED)
"""From the weakest support of a theorem to the strongest."""


def of_theorem(hypotheses: Iterable[Hypothesis]) -> Status:
    """Status of what follows from hypotheses: that of the weakest.

    A hypothesis that is refuted invalidates the argument, not necessarily the conclusion: the theorem is undecided
    then.
    """
    found = [each.status for each in hypotheses]
    return min((s if s in _WEAKNESS else Status.UNDECIDED for s in found), key=_WEAKNESS.index)


def not_applicable(problem: Problem, name: str, claim: str, reason: str) -> Certificate:
    """Say that a claim does not speak about the controller, and why."""
    return Certificate(
        name=name,
        title=name,
        claim=claim,
        status=Status.NOT_APPLICABLE,
        explanation=f"{problem.controller.name} {reason}.",
        method="form of the law",
    )


def no_surface(problem: Problem, name: str, claim: str) -> Certificate:
    """Say that a claim speaks about laws with a sliding surface."""
    reason = "decides by what it measures, without a sliding surface"
    return not_applicable(problem, name, claim, reason)


def slip_feedback_only(problem: Problem) -> Hypothesis:
    """Decide on the graph of the law whether it feeds back the slip and the speed alone.

    It does if its command does not depend on the torque and its memory holds integrals alone: an earlier wheel speed
    in the memory would be feedback of acceleration, a model of the valve or a filter in it feedback of what the no-go
    theorem leaves out.
    """
    law = problem.controller
    text = (
        f"{law.name} feeds back neither torque nor wheel acceleration, and its memory holds integrals alone"
    )
    found = memory(law)
    if isinstance(found, str):
        return Hypothesis(text=f"{text}: undecided, since {found}", status=Status.UNDECIDED)
    faults = []
    if found.command_reads_torque or found.memory_reads_torque:
        faults.append("it reads the torque")
    if not found.integrals_alone:
        faults.append(f"its memory has dynamics of its own in: {', '.join(found.own_dynamics)}")
    if faults:
        return Hypothesis(text=f"{text}: false, since {' and '.join(faults)}", status=Status.REFUTED)
    return Hypothesis(text=text, status=Status.PROVED)
