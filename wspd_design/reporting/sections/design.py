"""The design: every gain with its unit and its reason; or where a law without such gains is found."""

from wspd_design.design.records import Design, GainValue
from wspd_design.reporting import numbers
from wspd_design.reporting.blocks import Block, Heading, Paragraph, Table
from wspd_design.reporting.formula_text import with_formulas
from wspd_design.reporting.tables import ColumnOf, build
from wspd_design.reporting.text import escape, rich
from wspd_design.studies.dossier import Dossier
from wspd_design.studies.reported_law import ReportedLaw


def design(dossier: Dossier) -> tuple[Block, ...]:
    """Return the section about the gains, or about a law that has none to explain."""
    if dossier.design is None:
        return (
            Heading(text="The law", anchor="design"),
            Paragraph(text=rich(_without_gains(dossier.law))),
        )
    return (
        Heading(text="The design", anchor="design"),
        Paragraph(
            text=rich(
                "[](#gains) lists the gains, each with the rule that chose it. The attached `design.toml` holds the "
                "same numbers in full length and stands in place of a controller's name in every command."
            )
        ),
        gain_table(
            dossier.design, caption=f"Gains of {dossier.design.name} with their reasons.", anchor="gains"
        ),
    )


def _without_gains(law: ReportedLaw) -> str:
    """Say where a law without gains is found, and what a report cannot say about it."""
    silent = (
        "No rule of this program chose its numbers: the report says what the law does, not why its numbers are what "
        f"they are. It commands {law.acts_on}. {_reads(law)} Fingerprint of all that decides what it does: "
        f"`{law.fingerprint[:16]}`."
    )
    if not law.called:
        return (
            f"`{escape(law.name)}` was made in Python, where its checks can be decided again; commands do not find it, "
            f"and it is not attached. {silent}"
        )
    if law.own:
        file = law.called.rpartition(":")[0]
        return f"The law `{escape(law.called)}` is attached as `{escape(file)}`. {silent}"
    return f"Commands call it `{escape(law.called)}`; its numbers stand in [](#sources). {silent}"


def _reads(law: ReportedLaw) -> str:
    if law.reads is None:
        return "Its step cannot be traced, so that no check tells what its commands depend on."
    return f"Its commands depend on {numbers.listing(list(law.reads)) or 'nothing that it measures'}."


def gain_table(design: Design, *, caption: str, anchor: str) -> Table:
    """Return the gains of a design as a table."""
    return build(
        design.gains,
        (
            ColumnOf(title="Gain", read=lambda gain: gain.name.replace("_", " ")),
            ColumnOf(title="Value", read=lambda gain: value_text(gain.value)),
            ColumnOf(title="Unit", read=lambda gain: numbers.unit(gain.unit) or "-"),
            ColumnOf(title="Why", read=lambda gain: with_formulas(gain.why)),
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
