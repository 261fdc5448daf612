"""Every check in full, the worst first: claim, finding, needs, proofs, margin, what it does not say, and curves."""

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial

from wspd_design.certificates.kernel.file import certificate_text, file_name
from wspd_design.certificates.quantities import QUANTITIES, STATE
from wspd_design.certificates.records import Certificate, Map, Point, Proof
from wspd_design.certificates.records import Status as Finding
from wspd_design.certificates.theorems.register import ids_of
from wspd_design.certificates.theorems.simulated_stop import TRACKING
from wspd_design.plants.quarter import Quarter
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
from wspd_design.reporting.figures.poles import is_pole_over_speed
from wspd_design.reporting.figures.series import (
    certificate_curves,
    curves_height,
    series_alt,
    series_caption,
)
from wspd_design.reporting.formula_text import with_formulas
from wspd_design.reporting.proofs import listed
from wspd_design.reporting.sections.domains import domains
from wspd_design.reporting.sections.theory import theorem_anchor, theorems_of
from wspd_design.reporting.statements import Statements, linked, statements_of
from wspd_design.reporting.tables import ColumnOf, build
from wspd_design.reporting.text import Emphasis, Inline, Link, Text, references, rich, spans
from wspd_design.studies.dossier import Dossier

MAP_HEIGHT = 2.6  # in
ASSUMPTIONS = "assumptions"
"""Anchor of the register of the assumptions."""
POLE_MAP, STOP_TRACES = (
    "pole-map",
    "stop-traces",
)  # anchors of figures that show what several checks are about

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
    return anchor_of(certificate.name)


def anchor_of(name: str) -> str:
    """Return the anchor of the section of a check by its name."""
    return f"check-{name.replace('_', '-')}"


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


def worst_first(certificates: Iterable[Certificate]) -> tuple[Certificate, ...]:
    """Sort checks by what they mean for the loop.

    The finding counts first. What fails with the nominal numbers is worse than what fails somewhere within their
    bounds, and what speaks about the whole loop weighs more than what speaks about a part of it: an argument begins
    with the equations and ends with the stop.
    """
    ranks = {status: rank for rank, status in enumerate(MEANINGS)}
    latest = reversed(tuple(certificates))
    return tuple(sorted(latest, key=lambda each: (ranks[status_of(each)], bool(each.varied))))


def checks(dossier: Dossier) -> tuple[Block, ...]:
    """Return the section about the stability checks."""
    statements = statements_of(dossier.certificates)
    found: list[Block] = [
        Heading(text="Stability checks", anchor="stability-checks"),
        Paragraph(
            text=rich(
                "Each check states a claim on a domain, under the assumptions that it names. The worst findings "
                "stand first; among those of one kind, what fails with the nominal numbers comes before what fails "
                "within their bounds, and the whole loop before its parts; [](#evidence-ladder) counts them. Symbols "
                "stand in [](#symbols), terms in [](#glossary). Nobody has to trust the programs that found the "
                "proofs: [one command](#replay) lets the checkers decide again about all of them."
            )
        ),
        *domains(statements, dossier),
    ]
    shown = _Shown(
        statements=statements,
        # A name of one word, such as sampling, is also a word of its sentences.
        anchors={
            each.name: check_anchor(each)
            for each in dossier.certificates
            if is_shown(each) and "_" in each.name
        },
        same_stop=dossier.trials[0].run.plant == Quarter.name,
    )
    ordered = worst_first(dossier.certificates)
    for status, meaning in MEANINGS.items():
        group = [each for each in ordered if status_of(each) is status]
        if not group:
            continue
        word = status.word.capitalize()
        found.append(Heading(text=word, anchor=finding_anchor(status), level=2))
        if status is Status.NOT_APPLICABLE:
            found.append(_silent(group[::-1]))
            continue
        found.append(Paragraph(text=f"{word} \N{EN DASH} {meaning}."))
        for certificate in group:
            found += shown.check(certificate)
    return tuple(found)


def is_shown(certificate: Certificate) -> bool:
    """Tell whether a check has a place of its own in the report."""
    return status_of(certificate) is not Status.NOT_APPLICABLE


def _silent(group: Sequence[Certificate]) -> Paragraph:
    """Name the checks that do not speak about this design, those of one reason together."""
    reasons: dict[str, list[str]] = {}
    for each in group:
        reasons.setdefault(each.explanation.rstrip("."), []).append(each.title)
    said: list[Inline] = []
    for reason, titles in reasons.items():
        said += ["; " if said else "", Emphasis(text=numbers.listing(titles)), f" ({reason})"]
    return Paragraph(
        text=(
            f"{numbers.count(len(group), 'check')} {'does' if len(group) == 1 else 'do'} not speak about this design: ",
            *said,
            ".",
        )
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class _Shown:
    """What the blocks of all checks share."""

    statements: Statements
    anchors: Mapping[str, str]  # of the checks, by their names
    same_stop: bool  # whether the stop of the report is the one that the check of the tracking simulates

    def check(self, certificate: Certificate) -> list[Block]:
        """Return the blocks of one check."""
        anchor = check_anchor(certificate)
        tables = self._tables(certificate, anchor)
        figures = self._figures(certificate, anchor)
        return [
            Heading(text=certificate.title, anchor=anchor, level=3),
            Verdict(status=status_of(certificate), sentence=self.statements.claim(certificate)),
            Paragraph(
                text=(*self._words(certificate.explanation), *self._seen(certificate, tables, figures))
            ),
            *tables,
            Definitions(rows=self._details(certificate)),
            *figures,
        ]

    def _words(self, text: str) -> tuple[Inline, ...]:
        return spans(linked(with_formulas(text), self.anchors))

    def _seen(
        self, certificate: Certificate, tables: Sequence[Table], figures: Sequence[Figure]
    ) -> tuple[Inline, ...]:
        """Refer to what stands below, and to curves that another figure has."""
        said: list[Inline] = []
        for table in tables:
            what = "is proved" if table.anchor.endswith("-proofs") else "it needs"
            said += [" ", Link(anchor=table.anchor), f" lists what {what}."]
        if figures:
            said += [" Samples: ", *references([each.anchor for each in figures]), "."]
        if any(map(is_pole_over_speed, certificate.series)):
            said += [" ", Link(anchor=POLE_MAP), " shows the slip pole over speed."]
        if certificate.series and self._is_the_stop(certificate):
            said += [" The stop is that of ", Link(anchor=STOP_TRACES), "."]
        return tuple(said)

    def _tables(self, certificate: Certificate, anchor: str) -> list[Table]:
        found = []
        proved = {each.statement for each in certificate.proofs}
        if any(each.text not in proved for each in certificate.hypotheses):
            found.append(
                build(
                    certificate.hypotheses,
                    (
                        ColumnOf(title="Hypothesis", read=lambda each: self._words(each.text)),
                        ColumnOf(title="Finding", read=lambda each: Cell(status=Status[each.status.name])),
                    ),
                    caption=(*spans(with_formulas(certificate.title)), ": what the claim needs."),
                    anchor=f"{anchor}-hypotheses",
                )
            )
        if certificate.proofs:
            found.append(self._proofs(certificate, anchor))
        return found

    def _proofs(self, certificate: Certificate, anchor: str) -> Table:
        """List what the checker accepted; times are left out, because they change from run to run."""
        some = [each for each in certificate.proofs if each.domain is not None]
        on: tuple[ColumnOf[Proof], ...] = (
            (ColumnOf(title="On", read=lambda each: self.statements.proof(each, certificate)),)
            if some
            else ()
        )
        rows = listed(certificate.proofs)
        alike = (
            ""
            if len(rows) == len(certificate.proofs)
            else f"{len(certificate.proofs)} statements, by their kind. "
        )
        return build(
            rows,
            (
                ColumnOf(title="Proved", read=lambda each: with_formulas(each.statement)),
                *on,
                ColumnOf(title="Boxes", decimals=0, read=lambda each: each.boxes),
            ),
            caption=(
                *spans(with_formulas(certificate.title)),
                f": what the independent checker accepted, and the boxes that it decided. {alike}Attached as "
                f"{file_name(certificate)}.",
            ),
            anchor=f"{anchor}-proofs",
        )

    def _is_the_stop(self, certificate: Certificate) -> bool:
        return self.same_stop and certificate.name == TRACKING.name

    def _figures(self, certificate: Certificate, anchor: str) -> list[Figure]:
        found = [_map(shown, f"{anchor}-map-{number}") for number, shown in enumerate(certificate.maps, 1)]
        series = tuple(each for each in certificate.series if not is_pole_over_speed(each))
        if series and not self._is_the_stop(certificate):
            found.append(
                Figure(
                    svg=picture(partial(certificate_curves, series=series), height=curves_height(series)),
                    caption=with_formulas(series_caption(certificate.title, series)),
                    alt=series_alt(series),
                    anchor=f"{anchor}-curves",
                )
            )
        return found

    def _details(self, certificate: Certificate) -> tuple[Definition, ...]:
        open_share = f"{numbers.significant(100.0 * certificate.undecided, 2)} % of the box"
        rows: tuple[tuple[str, Text], ...] = (
            ("Margin", "" if certificate.margin is None else numbers.margin(certificate.margin)),
            ("Tightest point", with_formulas(numbers.point(_uncertain(certificate)))),
            ("Witness", _witness(certificate)),
            ("Domain", self._domain(certificate)),
            ("Assumptions", self._assumed(certificate)),
            ("Does not say", self._not_said(certificate)),
            ("Left open", open_share if certificate.undecided else ""),
            ("Search", "ended by its budget" if certificate.cut else ""),
            ("Samples", self._words(certificate.remark)),
            ("Method", self._words(certificate.method)),
            ("Reference", reference(certificate)),
            ("Name, model", f"{certificate.name}, {certificate.model_hash[:16]}"),
        )
        return tuple(Definition(term=term, text=text) for term, text in rows if text)

    def _domain(self, certificate: Certificate) -> Text:
        """Say on what the claim is made."""
        if certificate.domain is not None:
            return (self.statements.name(certificate.domain), f": {_size(certificate)}")
        if certificate.held:
            return with_formulas(f"as the claim says; no number varies, held: {', '.join(certificate.held)}")
        return ""

    def _assumed(self, certificate: Certificate) -> Text:
        """Return the assumptions in the words of the theorem, each with its ids in the register."""
        found: list[Inline] = []
        for clause in certificate.assumptions:
            found += ["; " if found else "", *self._words(clause)]
            if ids := ids_of(clause):
                found += [" (", Link(anchor=ASSUMPTIONS, text=", ".join(ids)), ")"]
        return tuple(found)

    def _not_said(self, certificate: Certificate) -> Text:
        """Return the sentences about what nobody may conclude."""
        found: list[Inline] = []
        for each in theorems_of(certificate):
            found += [Link(anchor=theorem_anchor(each.anchor)), ": ", *self._words(each.not_said)]
        return tuple(found)


def _size(certificate: Certificate) -> str:
    """Say how many numbers with bounds vary and how many are held."""
    varied = numbers.count(len(certificate.varied), "number") + " with bounds varied"
    return f"{varied}, {len(certificate.held)} held" if certificate.held else varied


def _uncertain(certificate: Certificate) -> tuple[Point, ...]:
    """Return the tightest point without the numbers that are exactly known."""
    open_ones = {*STATE, *certificate.varied, *certificate.held}
    return tuple(
        each for each in certificate.worst_point if each.name in open_ones or each.name not in QUANTITIES
    )


def _witness(certificate: Certificate) -> Text:
    """Write the witness; where it is the tightest point with something more, only that."""
    shared = set(certificate.worst_point) if certificate.worst_point else set()
    more = tuple(each for each in certificate.witness if each not in shared)
    if not certificate.witness or not shared <= set(certificate.witness):
        return with_formulas(numbers.point(certificate.witness))
    said: list[Inline] = ["the tightest point"]
    if more:
        said += [", with ", *spans(with_formulas(numbers.point(more)))]
    return tuple(said)


def reference(certificate: Certificate) -> Text:
    """Write what a check refers to; a theorem of the theory page as a link to it in this report."""
    found: list[Inline] = []
    for part in re.split(r"(docs/theory\.md#[a-z-]+)", certificate.reference):
        anchor = part.removeprefix("docs/theory.md#")
        found += [] if not part else [part] if anchor == part else [Link(anchor=theorem_anchor(anchor))]
    return tuple(found)


def _map(shown: Map, anchor: str) -> Figure:
    return Figure(
        svg=picture(partial(margin_map, shown=shown), height=MAP_HEIGHT),
        caption=with_formulas(map_caption(shown)),
        alt=map_alt(shown),
        anchor=anchor,
    )
