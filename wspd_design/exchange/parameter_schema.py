"""JSON Schemas of vehicle and rail files for editors, and the tables of ``docs/vehicle-files.md``."""

import re
from typing import Any, Literal, TypeAlias

from wspd_design.exchange.parameter_keys import KEYS
from wspd_design.parameters.entry import STATUSES
from wspd_design.parameters.files import available
from wspd_design.parameters.schema import Quantity, schema_of
from wspd_design.parameters.units import units_of

FileKind: TypeAlias = Literal["vehicle", "rail"]
KINDS: tuple[FileKind, ...] = ("vehicle", "rail")
_NUMBER = r"^\s*[-+\u2212\u2013]?([0-9]+([.,][0-9]*)?|[.,][0-9]+)([eE][-+]?[0-9]+)?\s*"


def file_schema(kind: FileKind) -> dict[str, Any]:
    """Return the JSON Schema of a vehicle or rail file: keys, units, words and short forms.

    Ranges are left to the program, which knows them in every unit.
    """
    properties: dict[str, Any] = {
        "title": {"type": "string", "description": "what the file is about"},
        "base": {
            "enum": available(kind),
            "description": f"shipped {kind} that gives what is not stated here",
        },
    }
    for name, quantity in schema_of(kind, "").items():
        group, dot, key = name.rpartition(".")
        place = properties
        if dot:
            place = properties.setdefault(
                group, {"type": "object", "additionalProperties": False, "properties": {}}
            )["properties"]
        place[key] = {"description": KEYS[kind][name], **_entry(quantity)}
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "$id": f"urn:wspd-design:wspd-{kind}-file",
        "title": f"wspd {kind} file",
        "type": "object",
        "additionalProperties": False,
        "properties": properties,
    }


def _entry(quantity: Quantity) -> dict[str, Any]:
    """Either the short form or the table with value, unit and history."""
    units = list(units_of(quantity.dimension))
    number: dict[str, Any] = {"type": "number"}
    values = {
        "number": number,
        "word": {"enum": list(quantity.words)} if quantity.words else {"type": "string"},
        "words": {"type": "array", "items": {"type": "string"}, "minItems": 1},
        "vector": {"type": "array", "items": number, "minItems": 1},
    }
    table: dict[str, Any] = {
        "type": "object",
        "additionalProperties": False,
        "required": ["value"],
        "properties": {
            "value": values[quantity.shape],
            "unit": {"type": "string", "description": " or ".join(units)},
            "bounds": {"type": "array", "items": number, "minItems": 2, "maxItems": 2},
            "source": {"type": "string"},
            "at": {"type": "string"},
            "status": {"enum": list(STATUSES)},
            "note": {"type": "string"},
        },
    }
    return {"anyOf": [_short(quantity, values[quantity.shape]), table]}


def _short(quantity: Quantity, value: dict[str, Any]) -> dict[str, Any]:
    if quantity.shape in ("word", "words"):
        return value
    text: dict[str, Any] = {"type": "string", "pattern": _NUMBER}
    one = {"anyOf": [text, {"type": "number"}]} if quantity.dimension == "ratio" else text
    return one if quantity.shape == "number" else {"type": "array", "items": one, "minItems": 1}


def with_key_tables(page: str) -> str:
    """Return a page with the table of keys between its markers, ``<!-- vehicle keys -->`` and ``<!-- end -->``."""
    for kind in KINDS:
        block = re.compile(rf"<!-- {kind} keys -->\n.*?<!-- end -->", re.DOTALL)
        page = block.sub(f"<!-- {kind} keys -->\n{key_table(kind)}\n<!-- end -->", page)
    return page


def key_table(kind: FileKind) -> str:
    """Return the table of the keys of a file: units, what railways have, and the meaning."""
    rows = ["| key | unit | range | meaning |", "|---|---|---|---|"]
    for name, quantity in schema_of(kind, "").items():
        optional = " (optional)" if quantity.optional else ""
        rows.append(f"| `{name}`{optional} | {_units(quantity)} | {_range(quantity)} | {KEYS[kind][name]} |")
    return "\n".join(rows)


def _units(quantity: Quantity) -> str:
    if quantity.shape in ("word", "words"):
        return "word" if quantity.shape == "word" else "list of words"
    units = ", ".join(f"`{unit}`" for unit in units_of(quantity.dimension))
    return f"list, {units}" if quantity.shape == "vector" else units


def _range(quantity: Quantity) -> str:
    if quantity.shape == "word":
        return " or ".join(f"`{word}`" for word in quantity.words)
    if quantity.shape == "words":
        return ""
    if quantity.plausible is not None:
        low, high = quantity.plausible
        return f"{low:g} to {high:g}"
    return quantity.range_text
