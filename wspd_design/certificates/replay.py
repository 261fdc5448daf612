"""Decide about a certificate file: make the whole certificate again from the design, and compare.

Nothing is searched. The file gives proofs, places and the effort of the search; every sentence comes from the design.
"""

import json
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from functools import partial

from wspd_design.certificates.kernel.checker import Refused, Work
from wspd_design.certificates.kernel.file import HEARSAY, read_certificate, sentences, stated_findings
from wspd_design.certificates.kernel.finding import Finding, Stated
from wspd_design.certificates.kernel.obligation import Inequality, Obligation, Sampled
from wspd_design.certificates.memory import is_remembering, recall
from wspd_design.certificates.records import Certificate, Problem, Status
from wspd_design.certificates.theorems.table import THEOREMS
from wspd_design.certificates.theorems.theorem import Theorem, asked, told
from wspd_design.parameters.later import later

DECIDED = (Status.PROVED, Status.LIMITATION, Status.REFUTED, Status.VACUOUS)
"""Statuses that rest on what the checkers decide."""


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Replayed:
    """What the checkers say about a file.

    Attributes
    ----------
    check : str
        Name, empty if the file tells none.
    accepted : bool
        Every word of the file is what its proofs show about this design.
    reason : str
        Why not.
    certificate : Certificate or None
        As it was made again; none if it is refused.
    """

    check: str
    accepted: bool
    reason: str
    certificate: Certificate | None

    def __repr__(self) -> str:
        """Say in one line whether the file is accepted, and what it shows."""
        said = f"refused: {self.reason}" if self.certificate is None else self.certificate.status.name
        return f"<Replayed {self.check}: {'accepted, ' if self.accepted else ''}{said}>"

    def _repr_html_(self) -> str:
        return str(later("notebook.proofs", "replayed_card")(self))

    @property
    def unchecked(self) -> bool:
        """Whether the file is what the design gives, but nothing in it decides a claim."""
        return self.certificate is not None and self.certificate.status not in DECIDED

    @property
    def leaves(self) -> int:
        """Number of boxes that the checkers decided."""
        return sum(each.leaves for each in self.certificate.findings.values()) if self.certificate else 0


def replay(problem: Problem, text: str) -> Replayed:
    """Decide whether a certificate file holds for a closed loop.

    Parameters
    ----------
    problem : Problem
        The closed loop and domain that every sentence is made from.
    text : str
        The file; it may be anything.
    """
    check = ""
    try:
        check, content = read_certificate(text)
        if check not in THEOREMS:
            raise Refused(f'there is no check "{check}"')
        theorem, stated = THEOREMS[check], stated_findings(content)
        wanted = asked(theorem, problem)
        if not isinstance(wanted, Certificate):
            made = _told(theorem, problem, _findings(wanted, stated))
        elif stated:
            raise Refused(f"{check} is {wanted.status.name} here, but the file states findings")
        else:
            made = wanted
        expected = sentences(made)
        if content.keys() != expected.keys() | set(HEARSAY):
            raise Refused("the file has other entries than a certificate")
        for name, entry in expected.items():
            if _canonical(content[name]) != _canonical(entry):
                raise Refused(f"its {name} is not what the proofs show about this design")
    except Refused as refusal:
        return Replayed(check=check, accepted=False, reason=str(refusal), certificate=None)
    return Replayed(check=check, accepted=True, reason="", certificate=made)


def _told(theorem: Theorem, problem: Problem, findings: Mapping[str, Finding]) -> Certificate:
    """Tell what findings show; a file may state numbers of which no sentence can be made, such as a gain below zero."""
    try:
        return told(theorem, problem, findings)
    except (ArithmeticError, ValueError) as error:
        raise Refused(f"its numbers cannot be those of {theorem.name}: {error}") from None


def _findings(wanted: tuple[Obligation, ...], stated: Mapping[str, Stated]) -> dict[str, Finding]:
    """Decide about all that a file states."""
    known, work = {each.key: each for each in wanted}, Work()
    for key, each in stated.items():
        if key not in known:
            raise Refused(f"the check asks for nothing of the name {key!a}")
        if each.numbers and not isinstance(known[key], Sampled):
            raise Refused(f"{key} rests on no samples, but the file states some")
    return {
        key: decided("decide", each, given := stated.get(key, Stated()), partial(each.decide, given, work))
        for key, each in known.items()
    }


def decided(how: str, obligation: Obligation, given: Stated, decide: Callable[[], Finding]) -> Finding:
    """Decide, unless the same verification has decided in the same way about the same inequality and proof."""
    if not (isinstance(obligation, Inequality) and is_remembering()):
        return decide()
    asked_about = [
        obligation.claim.statement(),
        obligation.text,
        given.proof,
        given.place,
        asdict(given.effort),
    ]
    return recall([how, *asked_about], decide)


def _canonical(entry: object) -> str:
    return json.dumps(entry, sort_keys=True)
