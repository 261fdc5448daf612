"""The brake on full adhesion, by mean values."""

import math

from wspd_design.analysis.brake_sheet import RULES, BrakeSheet
from wspd_design.reporting import numbers
from wspd_design.reporting.blocks import Block, Heading, Paragraph, Table
from wspd_design.reporting.figures.drawing import KILO, KMH
from wspd_design.reporting.formula_text import with_formulas
from wspd_design.reporting.tables import ColumnOf, build
from wspd_design.reporting.text import Link
from wspd_design.studies.dossier import Dossier


def brake(dossier: Dossier) -> tuple[Block, ...]:
    """Return the section about the brake while no wheel slides."""
    sheet = dossier.brake
    return (
        Heading(text="The brake on full adhesion", anchor="brake"),
        Paragraph(
            text=(
                f"{brake_sentence(sheet)} {dossier.adhesion_use} ",
                Link(anchor="brake-table"),
                " lists the stops of a brake that no wheel limits.",
            )
        ),
        brake_table(sheet),
    )


def brake_sentence(sheet: BrakeSheet) -> str:
    """Say what force the brake has, and what turning parts add to the mass."""
    said = (
        f"Fully applied, the friction brake of {sheet.vehicle} has {numbers.significant(sheet.rim_force / KILO, 4)} kN "
        f"at the rims; turning parts add {numbers.significant(sheet.rotating_mass / KILO, 3)} t to the mass."
    )
    if not sheet.by_steps:
        return said
    return (
        f"{said} Its forces change during the stop (pads that fade, an electrodynamic or a magnetic brake): the stops "
        "below are worked out by steps, and their mean values are those that give the same distance."
    )


def brake_table(sheet: BrakeSheet) -> Table:
    """Return the stops by mean values, one row for each speed."""
    return build(
        sheet.stops,
        (
            ColumnOf(
                title="From", unit="km/h", flush_right=True, read=lambda each: f"{each.speed * KMH:.4g}"
            ),
            ColumnOf(
                title=with_formulas("t_e"), unit="s", decimals=3, read=lambda each: each.mean.equivalent_time
            ),
            ColumnOf(
                title=with_formulas("a_e"), unit="m/s²", decimals=3, read=lambda each: each.mean.deceleration
            ),
            ColumnOf(title="Distance", unit="m", decimals=1, read=lambda each: each.mean.distance),
            ColumnOf(title="Time", unit="s", decimals=1, read=lambda each: each.mean.time),
            ColumnOf(
                title="Braked weight",
                unit="%",
                decimals=1,
                read=lambda each: math.nan if each.percentage is None else each.percentage,
            ),
        ),
        caption=with_formulas(RULES),
        anchor="brake-table",
    )
