"""Certificates: the verdict in words, the claim with its domain, margin and worst point."""

import re
from collections import Counter
from collections.abc import Sequence

from wspd_design.certificates.records import Certificate, Status
from wspd_design.certificates.replay import Replayed
from wspd_design.notebook.html import card
from wspd_design.parameters.table import Column, Table, table_of
from wspd_design.reporting import numbers
from wspd_design.reporting.blocks import Status as Sign

_FIRST_SENTENCE = re.compile(r"(?<=\.)\s+(?=[A-Z])")
_COLUMNS: tuple[Column[Certificate], ...] = (
    Column(title="verdict", read=lambda each: _sign(each.status)),
    Column(title="check", read=lambda each: f"{each.name}: {each.title}"),
    Column(title="margin", read=lambda each: "" if each.margin is None else numbers.margin(each.margin)),
    Column(title="why", read=lambda each: _FIRST_SENTENCE.split(each.explanation, maxsplit=1)[0]),
)
_RANK = (Status.REFUTED, Status.LIMITATION, Status.UNDECIDED, Status.EVIDENCE, Status.PROVED, Status.VACUOUS)


def proofs_table(certificates: Sequence[Certificate]) -> Table:
    """Return a row for each check that speaks about the design; of the others their number is told."""
    spoken = [each for each in certificates if each.status is not Status.NOT_APPLICABLE]
    silent = [each.name for each in certificates if each.status is Status.NOT_APPLICABLE]
    notes = (
        f"Not about this controller or vehicle: {', '.join(silent)}." if silent else "",
        "Proved and refuted hold exactly on the domain of the claim; evidence is samples, which prove nothing beyond "
        "them. One certificate alone, .named(NAME), tells domain, assumptions and the rest of its explanation.",
    )
    return table_of(
        spoken,
        _COLUMNS,
        caption=_counted(certificates),
        tone=lambda each: Sign[each.status.name].tone,
        notes=notes,
    )


def proofs_card(certificates: Sequence[Certificate]) -> str:
    """Return what a notebook shows of all certificates of a design."""
    table = proofs_table(certificates)
    return card("Certificates", verdict=(_tone(certificates), table.caption), tables=[table])


def certificate_card(certificate: Certificate) -> str:
    """Return what a notebook shows of one certificate."""
    points = [
        f"{what}: {numbers.point(found)}."
        for what, found in (("Worst point", certificate.worst_point), ("Witness", certificate.witness))
        if found
    ]
    held = f"Held: {', '.join(certificate.held)}." if certificate.held else ""
    assumed = f"Assumed: {'; '.join(certificate.assumptions)}." if certificate.assumptions else ""
    return card(
        f"{certificate.name}: {certificate.title}",
        verdict=(
            Sign[certificate.status.name].tone,
            f"{_sign(certificate.status)}: {certificate.status.value}.",
        ),
        lines=(
            certificate.claim,
            certificate.explanation,
            f"Margin: {numbers.margin(certificate.margin)}." if certificate.margin else "",
            *points,
            held,
            assumed,
        ),
    )


def replayed_card(replayed: Replayed) -> str:
    """Return what a notebook shows of a file that was checked."""
    made = replayed.certificate
    if not replayed.accepted or made is None:
        return card(f"Certificate file of {replayed.check}", verdict=("bad", f"Refused: {replayed.reason}."))
    said = f"Accepted: every word of the file is what its proofs show; {replayed.leaves} boxes were decided."
    return card(
        f"Certificate file of {replayed.check}",
        verdict=(Sign[made.status.name].tone, f"{_sign(made.status)}: {made.status.value}."),
        lines=(said, made.claim),
    )


def _sign(status: Status) -> str:
    sign = Sign[status.name]
    return f"{sign.sign} {sign.word}"


def _counted(certificates: Sequence[Certificate]) -> str:
    """Count the verdicts, the worst first."""
    counts = Counter(each.status for each in certificates)
    said = [f"{counts[status]} {Sign[status.name].word}" for status in _RANK if counts[status]]
    spoken = sum(counts[status] for status in _RANK)
    return (
        f"{numbers.count(spoken, 'check')} of this closed loop: {', '.join(said) or 'none speaks about it'}"
    )


def _tone(certificates: Sequence[Certificate]) -> str:
    """Tone of all together: bad news first, good only where nothing is open."""
    found = {each.status for each in certificates}
    if found & {Status.REFUTED, Status.LIMITATION}:
        return "bad"
    return "good" if found <= {Status.PROVED, Status.NOT_APPLICABLE} and Status.PROVED in found else "open"
