"""Parameter files as text: what :func:`load_entries` reads, with comments."""

import json
from collections.abc import Iterable
from fractions import Fraction
from typing import Any

from wspd_design.parameters.provenance import Entry
from wspd_design.parameters.units import factor, to_si

_DIGITS = 12  # that people read; a number that needs more gets all that it has


def parameter_file(title: str, comments: Iterable[str], entries: Iterable[Entry]) -> str:
    """Write a parameter file as TOML.

    Parameters
    ----------
    title : str
        Its title.
    comments : iterable of str
        Lines below the title.
    entries : iterable of Entry
        The numbers in SI units; they are written in the units that they name.
    """
    lines = [f"title = {_text(title)}", "", *(f"# {line}".rstrip() for line in comments)]
    for entry in entries:
        lines += [
            "",
            f"[{entry.name}]",
            f"value = {_value(entry.value, entry.unit)}",
            f"unit = {_text(entry.unit)}",
        ]
        if entry.bounds is not None:
            lines.append(f"bounds = {_value(entry.bounds, entry.unit)}")
        lines += [f"{key} = {_text(getattr(entry, key))}" for key in ("source", "at", "status")]
        if entry.note:
            lines.append(f"note = {_text(entry.note)}")
    return "\n".join(lines) + "\n"


def _value(value: Any, unit: str) -> str:
    match value:
        case str():
            return _text(value)
        case tuple():
            return f"[{', '.join(_value(item, unit) for item in value)}]"
    number = float(Fraction(repr(float(value))) / Fraction(repr(factor(unit))))
    short = f"{number:.{_DIGITS}g}"
    return short if to_si(float(short), unit) == value else repr(number)


def _text(text: str) -> str:
    return json.dumps(text, ensure_ascii=False)
