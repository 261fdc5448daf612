"""Decides about a certificate file: asks the checkers, searches nothing, and says in words what was shown.

What a check has to show is made from the design by ``obligations.py``.
"""

import json
import time
from dataclasses import dataclass

from wspd_design.certificates.kernel.counterexample import denials
from wspd_design.certificates.kernel.enclosures import Refused
from wspd_design.certificates.kernel.file import Stated, read_certificate
from wspd_design.certificates.kernel.obligation import Answer, Obligation
from wspd_design.certificates.records import Problem, Status
from wspd_design.certificates.theorems.obligations import OBLIGATIONS, obligations


@dataclass(frozen=True, slots=True, kw_only=True)
class Replayed:
    """What the checker says about a file."""

    check: str  # name, empty if the file tells none
    status: Status | None  # that the file states
    accepted: bool  # every proof, all that the status needs, and the witness as far as it can be checked
    reason: str
    shown: tuple[str, ...]  # statements that were proved
    denied: tuple[str, ...]  # statements that the witness denies
    missing: tuple[str, ...]  # statements that the check needs and the file does not show
    leaves: int
    seconds: float

    @property
    def empty(self) -> bool:
        """Whether the file holds nothing that can be checked."""
        return self.accepted and not self.shown and not self.denied


def replay(problem: Problem, text: str) -> Replayed:
    """Decide whether a certificate file holds for a closed loop.

    Parameters
    ----------
    problem : Problem
        The closed loop and domain that the claims are taken from.
    text : str
        The file; it may be anything.
    """
    started = time.perf_counter()
    stated: Stated | None = None
    answers: list[Answer] = []
    denied: tuple[str, ...] = ()
    missing: tuple[str, ...] = ()
    accepted, reason = True, "every proof holds for this design"
    try:
        stated = read_certificate(text)
        # What kept no proof may be a check whose claims cannot be made again; nothing is shown then.
        known = stated.check in OBLIGATIONS or stated.status is Status.PROVED or stated.proofs
        wanted = obligations(stated.check, problem) if known else ()
        done = set()
        for proof in stated.proofs:
            met, answer = _decide(stated.check, wanted, proof)
            answers.append(answer)
            if answer.enough:
                done.add(met.text)
        missing = tuple(
            each.text for each in wanted if _rests(stated.status) in each.needed and each.text not in done
        )
        if stated.status is Status.VACUOUS and not any(Status.VACUOUS in each.needed for each in wanted):
            raise Refused(f"no proof can show that {stated.check} is vacuous")
        if missing and _rests(stated.status) is stated.status:
            raise Refused(f"no proof of {'; '.join(missing)}")
        if stated.status is Status.REFUTED:
            denied = denials(wanted, stated.witness, problem.speeds)
    except Refused as refusal:
        accepted, reason = False, str(refusal)
    return Replayed(
        check=stated.check if stated else "",
        status=stated.status if stated else None,
        accepted=accepted,
        reason=reason,
        shown=tuple(answer.shown for answer in answers),
        denied=denied,
        missing=missing,
        leaves=sum(answer.leaves for answer in answers),
        seconds=time.perf_counter() - started,
    )


def _rests(status: Status) -> Status:
    """Return the status whose needs are compared: its own if it rests on proofs, else what a proof would need."""
    return status if status in (Status.PROVED, Status.VACUOUS) else Status.PROVED


def _decide(name: str, wanted: tuple[Obligation, ...], proof: str) -> tuple[Obligation, Answer]:
    """Find what a proof shows, or refuse it."""
    content = json.loads(proof)
    concerned = [each for each in wanted if isinstance(content, dict) and each.concerns(content)]
    reason = f"a proof shows nothing that {name} needs"
    for each in concerned:
        answer = each.check(proof)
        if answer.accepted:
            return each, answer
        reason = f"{each.text}: {answer.reason}"
    raise Refused(reason)
