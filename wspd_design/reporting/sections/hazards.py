"""Hazards, what the report shows of each, and what it does not."""

from wspd_design.reporting.blocks import Block, Heading, Paragraph
from wspd_design.reporting.tables import ColumnOf, build
from wspd_design.reporting.text import rich
from wspd_design.studies.dossier import Dossier
from wspd_design.studies.hazards import hazards as found_hazards

HAZARDS = "hazards"
"""Anchor of the section."""


def hazards(dossier: Dossier) -> tuple[Block, ...]:
    """Return the section about hazards."""
    return (
        Heading(text="Hazards", anchor=HAZARDS),
        Paragraph(
            text=rich(
                "[](#hazard-table) lists what can go wrong with a protection that releases brakes, and what this "
                "report shows of it. It is no hazard analysis: causes, rates and severities are not judged."
            )
        ),
        build(
            found_hazards(dossier.trials[0], dossier.robustness, dossier.vehicle),
            (
                ColumnOf(title="", read=lambda each: each.id),
                ColumnOf(title="Hazard", read=lambda each: each.title),
                ColumnOf(title="Shown by simulation", read=lambda each: each.shown or "nothing"),
                ColumnOf(title="Not shown", read=lambda each: each.left),
            ),
            caption="Hazards and what is known of each in this report.",
            anchor="hazard-table",
        ),
    )
