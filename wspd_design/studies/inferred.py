"""What is published about a multibody vehicle and what is inferred: the mark that goes with every number of it."""

from collections.abc import Iterable

from wspd_design.parameters.provenance import Entry
from wspd_design.plants.multibody.records import Multibody

INFERRED = ("derived", "calibrated", "assumed")
"""Statuses of numbers that no source states."""


def is_inferred(entry: Entry) -> bool:
    """Tell whether no source states the number."""
    return entry.status in INFERRED


def inferred_numbers(entries: Iterable[Entry]) -> tuple[str, ...]:
    """Return the names of the numbers that no source states."""
    return tuple(entry.name for entry in entries if is_inferred(entry))


def mark(model: Multibody) -> str:
    """Say in one sentence how much of a multibody vehicle is inferred."""
    entries = tuple(model.entries.values())
    count = len(inferred_numbers(entries))
    return f"Inferred: {count} of the {len(entries)} numbers of {model.name}, which no source states."
