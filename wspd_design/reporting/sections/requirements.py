"""What the design must reach, where each limit comes from, and which check decides what."""

from wspd_design.certificates.records import Certificate
from wspd_design.certificates.theorems.holds_for import HOLDS_FOR
from wspd_design.design.requirements import Requirements
from wspd_design.reporting import numbers
from wspd_design.reporting.blocks import Block, Cell, Heading, Paragraph, Status, Table
from wspd_design.reporting.requirement_words import limit
from wspd_design.reporting.sections.checks import anchor_of, finding_anchor, status_of, worst_first
from wspd_design.reporting.tables import ColumnOf, build
from wspd_design.reporting.text import Inline, Link, Text, escape, rich
from wspd_design.studies.dossier import Dossier
from wspd_design.studies.judgment import Judgment, Outcome, Requirement

REQUIREMENTS = "requirements"
"""Anchor of the section."""


def requirements(dossier: Dossier) -> tuple[Block, ...]:
    """Return the section that traces requirements to checks and stops, and back."""
    judgment = dossier.judgment
    return (
        Heading(text="Requirements", anchor=REQUIREMENTS),
        Paragraph(text=rich(_stops(judgment))),
        _sources(judgment),
        _checks(dossier),
    )


def stops_of(judgment: Judgment) -> str:
    """Name the stops that a design is judged by."""
    wanted = judgment.wanted
    if not isinstance(wanted, Requirements):
        return "the stop of this report"
    held_out = wanted.held_out
    return f"{numbers.count(held_out.sets, 'stop')} that no search has seen, seed {held_out.seed}"


def _stops(judgment: Judgment) -> str:
    wanted = judgment.wanted
    if not isinstance(wanted, Requirements):
        return (
            f"The design is judged on {stops_of(judgment)} and by checks, after the table “{escape(wanted.name)}”. A "
            "requirement that is missed rejects the design; one that is open leaves it undecided. A refuted check that "
            "decides no requirement is told, and rejects nothing. The results stand in [](#requirements-table), where "
            "the limits come from in [](#requirement-sources), and all checks in [](#checks)."
        )
    drawn = [draw.name.partition(".")[2].replace(".", " ").replace("_", " ") for draw in wanted.draws]
    spread = [
        *(f"all numbers with bounds of the {kind}" for kind in wanted.within_bounds),
        *(escape(name) for name in drawn),
    ]
    differ = f"They differ in {numbers.listing(spread)}. " if spread else ""
    return (
        f"The design is judged on {stops_of(judgment)}: vehicle, rail and disturbances are drawn anew for each stop, "
        f"on {escape(numbers.listing(wanted.rails))} in turn. {differ}Efficiency is the ideal stop of the same draw "
        "over the distance. How the gains were found stands beside each of them in [](#design). The results stand in "
        "[](#requirements-table), where the limits come from in [](#requirement-sources), all checks in [](#checks)."
    )


def _sources(judgment: Judgment) -> Table:
    return build(
        judgment.limited,
        (
            ColumnOf(title="", read=lambda each: each.id),
            ColumnOf(title="Requirement", read=lambda each: each.title),
            ColumnOf(title="Limit", flush_right=True, read=limit),
            ColumnOf(title="Source of the limit", read=lambda each: each.source),
            ColumnOf(title="Verified", read=_verified),
            ColumnOf(title="Shown by", read=_shown_by),
        ),
        caption="Where each limit comes from, whether somebody compared it with that source, and what shows it.",
        anchor="requirement-sources",
    )


def _verified(row: Requirement) -> str:
    if row.limit is None:
        return numbers.NONE
    return "yes" if row.verified else "no"


def _shown_by(row: Requirement) -> Text:
    if not row.checks:
        return row.evidence
    links: list[Inline] = [f"{row.evidence}: "]
    for name in row.checks:
        links += [", "] if len(links) > 1 else []
        links.append(Link(anchor=anchor_of(name), text=name))
    return tuple(links)


def decided_by(judgment: Judgment, check: str) -> str:
    """Return the ids of the requirements that a check decides; empty for one that is only told."""
    rows = [each.id for each in judgment.rows if check in each.checks and each.outcome is not Outcome.TOLD]
    return ", ".join(rows)


def _checks(dossier: Dossier) -> Table:
    """List all checks: for which loop each holds, and what it decides."""
    silent = [each for each in dossier.certificates if status_of(each) is Status.NOT_APPLICABLE]

    def rung(certificate: Certificate) -> str:
        found = HOLDS_FOR.get(certificate.name)
        return numbers.NONE if found is None else found.value

    table = build(
        [each for each in worst_first(dossier.certificates) if each not in silent],
        (
            ColumnOf(title="Check", read=lambda each: (Link(anchor=anchor_of(each.name), text=each.name),)),
            ColumnOf(title="Finding", read=lambda each: Cell(status=status_of(each))),
            ColumnOf(title="What is checked", read=lambda each: each.title),
            ColumnOf(title="Holds for", read=rung),
            ColumnOf(
                title="Decides", read=lambda each: decided_by(dossier.judgment, each.name) or "told only"
            ),
            ColumnOf(title="Margin", flush_right=True, read=lambda each: numbers.margin(each.margin)),
        ),
        caption="All checks. A margin is positive where the claim holds, in the unit of the claim; ≤: sampling "
        "bounds it from above only. What holds for an ideal brake is an argument for the law and says nothing "
        "about the brake of the vehicle.",
        anchor="checks",
    )
    if not silent:
        return table
    link = Link(anchor=finding_anchor(Status.NOT_APPLICABLE), text=f"{len(silent)} more")
    names = ", ".join(each.name for each in silent)
    row = ((link,), Cell(status=Status.NOT_APPLICABLE), names, numbers.NONE, numbers.NONE, numbers.NONE)
    return Table(columns=table.columns, rows=(*table.rows, row), caption=table.caption, anchor=table.anchor)
