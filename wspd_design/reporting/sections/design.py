"""The design: every gain with its unit and its reason."""

from wspd_design.design.records import Design, GainValue
from wspd_design.reporting import numbers
from wspd_design.reporting.blocks import Block, Heading, Paragraph, Table
from wspd_design.reporting.tables import ColumnOf, build
from wspd_design.reporting.text import rich
from wspd_design.studies.dossier import Dossier


def design(dossier: Dossier) -> tuple[Block, ...]:
    """Return the section about the gains."""
    return (
        Heading(text="The design", anchor="design"),
        Paragraph(
            text=rich(
                "The gains, each with the rule that chose it. The attached `design.toml` holds the same "
                "numbers in full length and stands in place of a controller's name in every command."
            )
        ),
        gain_table(
            dossier.design, caption=f"Gains of {dossier.design.name} with their reasons.", anchor="gains"
        ),
    )


def gain_table(design: Design, *, caption: str, anchor: str) -> Table:
    """Return the gains of a design as a table."""
    return build(
        design.gains,
        (
            ColumnOf(title="Gain", read=lambda gain: gain.name.replace("_", " ")),
            ColumnOf(title="Value", read=lambda gain: value_text(gain.value)),
            ColumnOf(title="Unit", read=lambda gain: numbers.unit(gain.unit) or "-"),
            ColumnOf(title="Why", read=lambda gain: gain.why),
        ),
        caption=caption,
        anchor=anchor,
    )


def value_text(value: GainValue) -> str:
    """Write the value of a gain; equal numbers of a list are written once."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, tuple):
        if len(set(value)) == 1:
            return f"{len(value)} × {numbers.significant(value[0])}"
        return ", ".join(numbers.significant(each) for each in value)
    return numbers.significant(value)
