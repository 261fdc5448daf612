"""Every check in full: claim, finding, margin, worst point, hypotheses, assumptions, method and curves."""

from collections.abc import Sequence
from functools import partial

from wspd_design.certificates.kernel.file import certificate_text, file_name
from wspd_design.certificates.records import Certificate, Map
from wspd_design.certificates.records import Status as Finding
from wspd_design.reporting import numbers
from wspd_design.reporting.blocks import (
    Attachment,
    Block,
    Cell,
    Definition,
    Definitions,
    Figure,
    Heading,
    Paragraph,
    Status,
    Table,
    Verdict,
)
from wspd_design.reporting.figures.drawing import picture
from wspd_design.reporting.figures.maps import map_alt, map_caption, margin_map
from wspd_design.reporting.figures.series import (
    certificate_curves,
    curves_height,
    series_alt,
    series_caption,
)
from wspd_design.reporting.tables import ColumnOf, build
from wspd_design.reporting.text import rich
from wspd_design.studies.dossier import Dossier

MAP_HEIGHT = 2.6  # in

MEANINGS = {
    Status.REFUTED: Finding.REFUTED.value,
    Status.LIMITATION: Finding.LIMITATION.value,
    Status.UNDECIDED: Finding.UNDECIDED.value,
    Status.EVIDENCE: Finding.EVIDENCE.value,
    Status.PROVED: Finding.PROVED.value,
    Status.VACUOUS: Finding.VACUOUS.value,
    Status.NOT_APPLICABLE: Finding.NOT_APPLICABLE.value,
}
"""What each finding means, from the worst to those that say nothing."""


def status_of(certificate: Certificate) -> Status:
    """Return the finding as the report shows it."""
    return Status[certificate.status.name]


def is_bad_news(certificate: Certificate) -> bool:
    """Tell whether a verdict speaks against the closed loop: a claim refuted, or a limitation proved."""
    return status_of(certificate) in (Status.REFUTED, Status.LIMITATION)


def check_anchor(certificate: Certificate) -> str:
    """Return the anchor of the section of a check."""
    return f"check-{certificate.name.replace('_', '-')}"


def finding_anchor(status: Status) -> str:
    """Return the anchor of the checks with a finding."""
    return f"finding-{status.word.replace(' ', '-')}"


def certificate_files(dossier: Dossier) -> tuple[Attachment, ...]:
    """Return what ``wspd check`` can decide about, proofs and witnesses, each as the file that it reads."""
    return tuple(
        Attachment(
            name=file_name(certificate),
            media_type="application/json",
            content=certificate_text(certificate),
            description=f"certificate of the check {certificate.name}",
        )
        for certificate in _kept(dossier)
    )


def _kept(dossier: Dossier) -> tuple[Certificate, ...]:
    """Return the certificates that have a file, as ``wspd certify`` writes them."""
    return tuple(each for each in dossier.certificates if each.status is not Finding.NOT_APPLICABLE)


def checks(dossier: Dossier) -> tuple[Block, ...]:
    """Return the section about the stability checks."""
    found: list[Block] = [
        Heading(text="Stability checks", anchor="stability-checks"),
        Paragraph(
            text=rich(
                "Each check states a claim with its domain and the numbers that it varies and holds, under the "
                "assumptions that it names. The worst findings stand first. Nobody has to trust the programs that "
                "found the proofs: [one command](#replay) lets the checkers decide again about all of them."
            )
        ),
    ]
    for status, meaning in MEANINGS.items():
        group = [each for each in dossier.certificates if status_of(each) is status]
        if group:
            word = status.word.capitalize()
            found += [
                Heading(text=word, anchor=finding_anchor(status), level=2),
                Paragraph(text=f"{word}: {meaning}."),
            ]
        if status is Status.NOT_APPLICABLE:
            found += [_not_applicable(group)] if group else []
            continue
        for certificate in group:
            found += _check(certificate)
    return tuple(found)


def _not_applicable(group: Sequence[Certificate]) -> Table:
    """List the checks that do not speak about this design, with the reasons."""
    return build(
        group,
        (
            ColumnOf(title="Check", read=lambda each: each.name),
            ColumnOf(title="What is checked", read=lambda each: each.title),
            ColumnOf(title="Why it does not speak about this design", read=lambda each: each.explanation),
        ),
        caption="Checks that say nothing here.",
        anchor="not-applicable",
    )


def _check(certificate: Certificate) -> list[Block]:
    anchor = check_anchor(certificate)
    found: list[Block] = [
        Heading(text=certificate.title, anchor=anchor, level=3),
        Verdict(status=status_of(certificate), sentence=certificate.claim),
        Paragraph(text=certificate.explanation),
    ]
    if certificate.hypotheses:
        found.append(
            build(
                certificate.hypotheses,
                (
                    ColumnOf(title="Hypothesis", read=lambda each: each.text),
                    ColumnOf(title="Finding", read=lambda each: Cell(status=Status[each.status.name])),
                ),
                caption="What the claim needs.",
                anchor=f"{anchor}-hypotheses",
            )
        )
    found.append(Definitions(rows=_details(certificate)))
    if certificate.proved:
        found.append(_proofs(certificate))
    found += _figures(certificate, anchor)
    return found


def _figures(certificate: Certificate, anchor: str) -> list[Block]:
    found: list[Block] = [
        _map(shown, f"{anchor}-map-{number}") for number, shown in enumerate(certificate.maps, 1)
    ]
    if certificate.series:
        found.append(
            Figure(
                svg=picture(
                    partial(certificate_curves, certificate=certificate),
                    height=curves_height(certificate.series),
                ),
                caption=series_caption(certificate),
                alt=series_alt(certificate.series),
                anchor=f"{anchor}-curves",
            )
        )
    return found


def _map(shown: Map, anchor: str) -> Figure:
    return Figure(
        svg=picture(partial(margin_map, shown=shown), height=MAP_HEIGHT),
        caption=map_caption(shown),
        alt=map_alt(shown),
        anchor=anchor,
    )


def _proofs(certificate: Certificate) -> Table:
    """List what the checker accepted; times are left out, because they change from run to run."""
    return build(
        tuple(certificate.proved.values()),
        (
            ColumnOf(title="Proved", read=lambda each: each.shown),
            ColumnOf(title="Boxes", decimals=0, read=lambda each: each.leaves),
        ),
        caption="What the independent checker accepted, and the boxes that it decided. Attached as "
        f"{file_name(certificate)}.",
        anchor=f"{check_anchor(certificate)}-proofs",
    )


def _details(certificate: Certificate) -> tuple[Definition, ...]:
    open_share = f"{numbers.significant(100.0 * certificate.undecided, 2)} % of the box"
    rows = (
        ("Margin", "" if certificate.margin is None else numbers.margin(certificate.margin)),
        ("Tightest point", numbers.point(certificate.worst_point)),
        ("Witness", numbers.point(certificate.witness)),
        ("Assumptions", "; ".join(certificate.assumptions)),
        ("Left open", open_share if certificate.undecided else ""),
        ("Search", "ended by its budget" if certificate.cut else ""),
        ("Samples", certificate.remark),
        ("Held", ", ".join(certificate.held)),
        ("Method", certificate.method),
        ("Reference", certificate.reference),
        ("Name, model", f"{certificate.name}, {certificate.model_hash[:16]}"),
    )
    return tuple(Definition(term=term, text=text) for term, text in rows if text)
