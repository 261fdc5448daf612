"""One number of a parameter file: its table or its short form, checked."""

import math
from collections.abc import Iterator
from typing import Any

from wspd_design.parameters.errors import UserError
from wspd_design.parameters.provenance import Entry
from wspd_design.parameters.schema import Quantity
from wspd_design.parameters.units import dimension_of, nearest_unit, split_quantity, to_si, units_of
from wspd_design.parameters.words import did_you_mean

STATUSES = ("printed", "published", "derived", "calibrated", "assumed")
"""How a number is known, from the firmest to the weakest."""

KEYS = ("value", "unit", "bounds", "source", "at", "status", "note")
"""What the table of a number may hold."""

_TINY = 1e-100  # products and quotients of such numbers leave the range of floating point


def entry_of(name: str, raw: object, quantity: Quantity, where: str, defaults: dict[str, str]) -> Entry:
    """Check one number of a file.

    Parameters
    ----------
    name : str
        Its dotted key.
    raw : object
        What stands there: a table, or the short form, such as ``"45 t"``, ``4`` or ``"orifice"``.
    quantity : Quantity
        What is expected.
    where : str
        Name of the file in sentences.
    defaults : dict
        What holds for the parts of the table that are not there.
    """
    table = raw if isinstance(raw, dict) else _table_of(name, raw, quantity, where)
    return _entry(name, table, quantity, where, defaults)


def _table_of(name: str, raw: object, quantity: Quantity, where: str) -> dict[str, Any]:
    """Return the table that a short form stands for."""
    if quantity.shape in ("word", "words"):
        return {"value": raw}
    if quantity.shape == "number":
        number, unit = _with_unit(raw, quantity, f"{name} in {where}")
        return {"value": number, "unit": unit}
    if quantity.shape == "vector" and isinstance(raw, list) and raw:
        pairs = [_with_unit(item, quantity, f"{name} in {where}") for item in raw]
        units = list(dict.fromkeys(unit for _, unit in pairs))
        if len(units) > 1:
            raise UserError(f"{name} in {where} has several units, {', '.join(units)}; write all in one.")
        return {"value": [number for number, _ in pairs], "unit": units[0]}
    raise UserError(
        f"{name} in {where} must be a table: write [{name}] and below it "
        f'value = ... and unit = "{units_of(quantity.dimension)[0]}".'
    )


def _with_unit(raw: object, quantity: Quantity, what: str) -> tuple[Any, str]:
    """Return number and unit of a text such as ``45 t``; only a ratio may stand without a unit."""
    if isinstance(raw, str):
        return split_quantity(raw, quantity.dimension, what=what)
    if quantity.dimension == "ratio" or isinstance(raw, bool) or not isinstance(raw, (int, float)):
        return raw, units_of(quantity.dimension)[0]
    units = units_of(quantity.dimension)
    low, high = quantity.plausible or (-math.inf, math.inf)
    try:
        meant = next((unit for unit in units if low <= to_si(float(raw), unit) <= high), units[0])
    except OverflowError:
        return raw, units[0]  # which is refused as what it is, a number that is not finite
    raise UserError(
        f'{what} is {raw} without a unit; write it in quotes with its unit, such as "{raw} {meant}".'
    )


def _entry(
    name: str, table: dict[str, Any], quantity: Quantity, where: str, defaults: dict[str, str]
) -> Entry:
    for key in table:
        if key not in KEYS:
            raise UserError(
                f"[{name}] in {where} has an unknown key {key}{did_you_mean(key, KEYS)}; "
                f"allowed: {', '.join(KEYS)}."
            )
    table = ({"unit": "-"} if quantity.shape in ("word", "words") else {}) | defaults | table
    for key in ("value", "unit", "source", "at", "status"):
        if key not in table:
            example = f'"{units_of(quantity.dimension)[0]}"' if key == "unit" else "..."
            raise UserError(f"[{name}] in {where} lacks {key}; add {key} = {example} below it.")
    for key in ("unit", "source", "at", "status", "note"):
        if not isinstance(table.get(key, ""), str):
            raise UserError(f"{key} = {table[key]} of [{name}] in {where} must be text; put it in quotes.")
    if table["status"] not in STATUSES:
        raise UserError(
            f'status = "{table["status"]}" of [{name}] in {where} is unknown'
            f"{did_you_mean(table['status'], STATUSES)}; allowed: {', '.join(STATUSES)}."
        )
    unit = table["unit"]
    _check_unit(name, unit, quantity, where)
    value = _value(table["value"], quantity, unit, f"value of [{name}] in {where}")
    bounds = (
        _bounds(table["bounds"], quantity, unit, f"bounds of [{name}] in {where}")
        if "bounds" in table
        else None
    )
    if bounds is not None and not all(bounds[0] <= number <= bounds[1] for number in _numbers(value)):
        raise UserError(
            f"value = {table['value']} of [{name}] in {where} lies outside its bounds {table['bounds']} "
            f"{unit}; correct one of them."
        )
    return Entry(
        name=name,
        value=value,
        unit=unit,
        bounds=bounds,
        source=table["source"],
        at=table["at"],
        status=table["status"],
        note=table.get("note", ""),
    )


def _check_unit(name: str, unit: str, quantity: Quantity, where: str) -> None:
    allowed = f"units of {quantity.dimension}: {', '.join(units_of(quantity.dimension))}"
    try:
        dimension = dimension_of(unit)
    except UserError:
        near = nearest_unit(unit, quantity.dimension)
        offer = f' (did you mean "{near}"?)' if near else ""
        raise UserError(f'unit = "{unit}" of [{name}] in {where} is unknown{offer}; {allowed}.') from None
    if dimension != quantity.dimension:
        raise UserError(
            f'unit = "{unit}" of [{name}] in {where} is a unit of {dimension}, not of {quantity.dimension}; '
            f"{allowed}."
        )


def _value(raw: object, quantity: Quantity, unit: str, what: str) -> Any:
    match quantity.shape:
        case "number":
            return number_of(raw, quantity, unit, what)
        case "word":
            if not quantity.words:
                if not isinstance(raw, str):
                    raise UserError(f"{what} is {quoted(raw)} but must be a word; put it in quotes.")
                return raw
            if raw not in quantity.words:
                raise UserError(
                    f"{what} is {quoted(raw)}{did_you_mean(str(raw), quantity.words)} but must be one of "
                    f"{', '.join(quoted(word) for word in quantity.words)}; correct it."
                )
            return raw
        case "words":
            words = _list(raw, what, "words")
            if not all(isinstance(word, str) for word in words):
                raise UserError(f"{what} must consist of words; put each one in quotes.")
            return tuple(words)
        case "vector":
            return tuple(number_of(item, quantity, unit, what) for item in _list(raw, what, "numbers"))
        case "matrix":
            rows = _rows(raw, what, "numbers")
            return tuple(tuple(number_of(item, quantity, unit, what) for item in row) for row in rows)
        case "word matrix":
            table = _rows(raw, what, "words")
            if not all(isinstance(word, str) for row in table for word in row):
                raise UserError(f"{what} must consist of words; put each one in quotes.")
            return tuple(tuple(row) for row in table)


def _list(raw: object, what: str, content: str) -> list[Any]:
    if not isinstance(raw, list) or not raw:
        raise UserError(f"{what} is {quoted(raw)} but must be a list of {content}; write [ ... ].")
    return raw


def _rows(raw: object, what: str, content: str) -> list[list[Any]]:
    rows = [_list(row, what, f"rows of {content}") for row in _list(raw, what, f"rows of {content}")]
    if len({len(row) for row in rows}) > 1:
        raise UserError(f"{what} has rows of different length; make them equal.")
    return rows


def number_of(raw: object, quantity: Quantity, unit: str, what: str) -> float:
    """Return a number in SI units; one that is impossible or that no railway has raises :class:`UserError`."""
    if isinstance(raw, bool) or not isinstance(raw, (int, float)):
        raise UserError(
            f"{what} is {quoted(raw)} but must be a number; write it without quotes and with a point."
        )
    try:
        number = to_si(float(raw), unit)
    except OverflowError:
        number = math.inf
    if not math.isfinite(number):
        raise UserError(f"{what} is not a finite number; write a finite one.")
    if not quantity.admits(number):
        raise UserError(
            f"{what} is {raw} [{unit}] but must be {quantity.range_text} in SI units; correct it."
        )
    if 0.0 < abs(number) < _TINY:
        raise UserError(f"{what} is {raw}, too small to compute with; write 0 if it may vanish.")
    if quantity.plausible is not None and not quantity.plausible[0] <= number <= quantity.plausible[1]:
        raise UserError(f"{what} is {float(raw):.12g} {unit}; {_implausible(float(raw), unit, quantity)}")
    return number


def _implausible(raw: float, unit: str, quantity: Quantity) -> str:
    """Say what railways have, and the unit in which the number would be one of theirs."""
    assert quantity.plausible is not None
    low, high = quantity.plausible
    usual = f"railways have {low:g} to {high:g} {units_of(quantity.dimension)[0]}"
    for other in units_of(quantity.dimension):
        if other != unit and low <= to_si(raw, other) <= high:
            return f"{usual}: did you mean {raw:g} {other}?"
    return f"{usual}; correct it"


def _bounds(raw: object, quantity: Quantity, unit: str, what: str) -> tuple[float, float]:
    pair = _list(raw, what, "two numbers")
    if len(pair) != 2:
        raise UserError(f"{what} has {len(pair)} numbers but must have two; write [lower, upper].")
    low, high = (number_of(item, quantity, unit, what) for item in pair)
    if low > high:
        raise UserError(f"{what} has the lower one above the upper one; write [lower, upper].")
    return low, high


def _numbers(value: Any) -> Iterator[float]:
    if isinstance(value, float):
        yield value
    elif isinstance(value, tuple):
        for item in value:
            yield from _numbers(item)


def quoted(raw: object) -> str:
    """Write a value as a file has it."""
    return f'"{raw}"' if isinstance(raw, str) else str(raw)
