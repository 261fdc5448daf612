"""The stop of a design under other conditions: rails, speeds, loads, worn wheels, sensors, dead time."""

import math

from wspd_design.reporting import numbers
from wspd_design.reporting.blocks import Block, Paragraph
from wspd_design.reporting.spreads import capitalized, shown, unit_of
from wspd_design.reporting.tables import ColumnOf, build
from wspd_design.studies.key_figures import KEY_FIGURES, Outcome
from wspd_design.studies.uncertainty import Uncertainty, Variant

VARIANTS = "uncertainty-variants"
"""Anchor of the table."""


def other_conditions(found: Uncertainty) -> tuple[Block, ...]:
    """Tell single stops under other conditions; those that change no digit in a sentence."""
    told = [name for name in KEY_FIGURES if found.spread_of(name) is not None]
    nominal: Outcome = tuple((each.name, each.nominal) for each in found.spreads)

    def cells(outcome: Outcome) -> list[str]:
        return [shown(found, name, dict(outcome).get(name, math.nan)) for name in told]

    def column(name: str, place: int) -> ColumnOf[tuple[str, list[str]]]:
        rule = KEY_FIGURES[name]
        return ColumnOf(
            title=capitalized(rule.short),
            unit=unit_of(rule),
            flush_right=True,
            read=lambda row: row[1][place],
        )

    usual = cells(nominal)
    rows = [(_words(each), cells(each.outcome)) for each in found.variants]
    changed = [("nominal stop", usual), *(row for row in rows if row[1] != usual)]
    same = [words for words, row in rows if row == usual]
    table = build(
        changed,
        (
            ColumnOf(title="Condition", read=lambda row: row[0]),
            *(column(name, place) for place, name in enumerate(told)),
        ),
        caption="One stop under each condition, in which only this differs from the nominal stop. The sizes of sensor "
        "errors and dead times are chosen, not measured. All numbers: each at the end of its bounds that shortens, or "
        "lengthens, the stop alone.",
        anchor=VARIANTS,
    )
    if not same:
        return (table,)
    return (table, Paragraph(text=f"No digit of these figures changes with: {'; '.join(same)}."))


def _words(variant: Variant) -> str:
    """Name a condition; those of sensors and valves name their subject themselves."""
    words = numbers.unit(variant.words).replace(" -", f" {numbers.MINUS}")
    return f"{variant.subject}, {words}" if variant.subject in ("rail", "all numbers") else words
