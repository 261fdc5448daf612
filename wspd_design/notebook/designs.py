"""Designs: what was asked, and the gains with their reasons."""

from wspd_design.design.records import Design, Gain, GainValue
from wspd_design.notebook.html import card
from wspd_design.parameters.table import Column, Table, table_of
from wspd_design.parameters.units import KMH
from wspd_design.reporting.numbers import unit

_COLUMNS: tuple[Column[Gain], ...] = (
    Column(title="gain", read=lambda gain: gain.name),
    Column(title="value", read=lambda gain: _value(gain.value)),
    Column(title="unit", read=lambda gain: unit(gain.unit)),
    Column(title="why", read=lambda gain: gain.why),
)


def design_table(design: Design) -> Table:
    """Return the gains of a design."""
    return table_of(design.gains, _COLUMNS, caption=f"Gains of {design.name}")


def design_card(design: Design) -> str:
    """Return what a notebook shows of a design."""
    asked = design.specification
    low, high = (KMH * speed for speed in asked.speeds)
    lines = (
        f"{design.law} for {design.vehicle} on {design.rail}: slip {asked.slip:g} ± {asked.slip_tolerance:g} at "
        f"{low:g} to {high:g} km/h, sampled every {1e3 * asked.sample_time:g} ms.",
        "Requirements: its specification has some; judge them with wspd report."
        if design.requirements is not None
        else "",
    )
    verdict = ("neutral", "Nothing is proved by a design: certify(design) says what holds.")
    return card(f"Design {design.name}", lines=lines, verdict=verdict, tables=[design_table(design)])


def _value(value: GainValue) -> object:
    """A number, or a list of them as text."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    return ", ".join(f"{each:.6g}" for each in value) if isinstance(value, tuple) else value
