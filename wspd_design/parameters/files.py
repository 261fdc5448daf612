"""Parameter files: from TOML to checked entries.

Every number is a table with ``value``, ``unit``, ``bounds``, ``source``, ``at``, ``status`` and ``note``. A
user's own file has the same format; it may start from a shipped one with ``base = "er24pc"`` and then states
only the tables that differ. Such a table replaces that of the base as a whole, bounds included.
"""

import math
import tomllib
from collections.abc import Iterable, Iterator
from difflib import get_close_matches
from importlib.resources import files
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import Any

from wspd_design.parameters.errors import UserError
from wspd_design.parameters.laden import LADEN, laden
from wspd_design.parameters.records import Entry, ParameterSet
from wspd_design.parameters.schema import Kind, Quantity, Schema, schema_of
from wspd_design.parameters.units import dimension_of, nearest_unit, to_si, units_of

STATUSES = ("printed", "published", "derived", "calibrated", "assumed")
"""How a number is known, from the firmest to the weakest."""

_FOLDERS: dict[Kind, str] = {
    "constants": "",
    "vehicle": "vehicles",
    "rail": "rails",
    "controller": "controllers",
    "track": "track",
}
_TINY = 1e-100  # products and quotients of such numbers leave the range of floating point
_ENTRY_KEYS = ("value", "unit", "bounds", "source", "at", "status", "note")
_FILE_KEYS = ("title", "base")


def data_file(*parts: str) -> Traversable:
    """Return a file or folder of the data that ships with the program."""
    return files("wspd_design").joinpath("data", *parts)


def available(kind: Kind) -> list[str]:
    """Return the names of the shipped parameter files of one kind, sorted."""
    if kind == "constants":
        return ["constants"]
    entries = data_file(_FOLDERS[kind]).iterdir()
    return sorted(entry.name.removesuffix(".toml") for entry in entries if entry.name.endswith(".toml"))


def load_entries(kind: Kind, name_or_path: str | Path) -> ParameterSet:
    """Load all entries of a shipped parameter file or of a user's own one.

    Parameters
    ----------
    kind : {"constants", "vehicle", "rail", "controller", "track"}
        What the file describes.
    name_or_path : str or Path
        Name of a shipped file, such as ``er24pc``, or for vehicles and rails the path of a ``.toml`` file; with
        ``:laden`` after it the laden vehicle.

    Returns
    -------
    ParameterSet
        Entries in the order of the schema, values and bounds in SI units.

    Raises
    ------
    UserError
        If the name is unknown or anything in the file is wrong; the sentence names file and key.
    """
    text = str(name_or_path)
    if kind == "vehicle" and text.endswith(LADEN):
        return laden(load_entries(kind, text.removesuffix(LADEN)))
    if kind in ("vehicle", "rail") and text.endswith(".toml"):
        return _load_own(kind, Path(text))
    if text not in available(kind):
        remedy = f"available: {', '.join(available(kind))}"
        if kind in ("vehicle", "rail"):
            remedy += ", or the path of a .toml file"
        raise UserError(f'unknown {kind} "{text}"{_did_you_mean(text, available(kind))}; {remedy}.')
    schema = schema_of(kind, text)
    source = f"{text}.toml"
    document = read_toml(data_file(_FOLDERS[kind], source), source)
    entries = _entries(document, schema, source, {})
    return _parameter_set(kind, text, document, schema, entries, source)


def read_toml(file: Traversable | Path, where: str) -> dict[str, Any]:
    """Read a TOML file; whatever is wrong with it becomes one sentence about ``where``."""
    try:
        return tomllib.loads(
            file.read_bytes().decode("utf-8-sig")
        )  # some editors begin with a byte order mark
    except RecursionError:
        raise UserError(f"{where} is nested too deeply; a file has tables in tables, no more.") from None
    except tomllib.TOMLDecodeError as error:
        raise UserError(f"{where} is not valid TOML: {error}; correct that place.") from None
    except UnicodeDecodeError:
        raise UserError(f"{where} is not a text file in UTF-8; save it as such.") from None
    except ValueError:  # of the integers alone: Python reads no more than some thousand digits
        raise UserError(f"{where} has a number of thousands of digits; write it with an exponent.") from None
    except FileNotFoundError:
        raise UserError(f"{where} does not exist; check the path.") from None
    except OSError as error:
        raise UserError(
            f"{where} cannot be read ({error.strerror}); check the path and its permissions."
        ) from None


def _load_own(kind: Kind, path: Path) -> ParameterSet:
    where = str(path)
    document = read_toml(path, where)
    schema = schema_of(kind, path.stem)
    # A user may leave out the history of a number, but then it says so itself.
    entries = _entries(document, schema, where, {"source": "own file", "at": path.name, "status": "assumed"})
    if "base" in document:
        base, shipped = document["base"], available(kind)
        if base not in shipped:
            raise UserError(
                f"base = {_text(base)} in {where} is not a shipped {kind}"
                f"{_did_you_mean(str(base), shipped)}; available: {', '.join(shipped)}."
            )
        entries = load_entries(kind, base).entries | entries
    return _parameter_set(kind, path.stem, document, schema, entries, where)


def _parameter_set(
    kind: Kind, name: str, document: dict[str, Any], schema: Schema, entries: dict[str, Entry], where: str
) -> ParameterSet:
    missing = [key for key, quantity in schema.items() if key not in entries and not quantity.optional]
    if missing:
        remedy = "add it" if len(missing) == 1 else "add them"
        if kind in ("vehicle", "rail"):
            remedy += f' or start from base = "{available(kind)[0]}"'
        raise UserError(f"{where} lacks {', '.join(f'[{key}]' for key in missing)}; {remedy}.")
    title = document.get("title", name)
    if not isinstance(title, str):
        raise UserError(f"title = {title} in {where} must be text; put it in quotes.")
    return ParameterSet(
        kind=kind, name=name, title=title, entries={key: entries[key] for key in schema if key in entries}
    )


def _entries(
    document: dict[str, Any], schema: Schema, where: str, defaults: dict[str, str]
) -> dict[str, Entry]:
    tables = {key: value for key, value in document.items() if key not in _FILE_KEYS}
    return {
        name: _entry(name, table, schema[name], where, defaults)
        for name, table in _named_tables(tables, schema, where, "")
    }


def _named_tables(
    tables: dict[str, Any], schema: Schema, where: str, prefix: str
) -> Iterator[tuple[str, dict[str, Any]]]:
    """Walk through nested tables and yield those that the schema knows, by their dotted name."""
    for key, table in tables.items():
        name = prefix + key
        is_group = any(known.startswith(f"{name}.") for known in schema)
        if name not in schema and not is_group:
            raise UserError(
                f"{where} has an unknown key {name}{_did_you_mean(name, _known_names(schema))}; "
                "correct or remove it."
            )
        if not isinstance(table, dict):
            example = (
                name if name in schema else next(known for known in schema if known.startswith(f"{name}."))
            )
            unit = units_of(schema[example].dimension)[0]
            raise UserError(
                f"{name} in {where} must be a table: write [{example}] and below it "
                f'value = ... and unit = "{unit}".'
            )
        if is_group:
            yield from _named_tables(table, schema, where, f"{name}.")
        else:
            yield name, table


def _known_names(schema: Schema) -> Iterable[str]:
    return [*schema, *{known.rpartition(".")[0] for known in schema if "." in known}, *_FILE_KEYS]


def _entry(
    name: str, table: dict[str, Any], quantity: Quantity, where: str, defaults: dict[str, str]
) -> Entry:
    for key in table:
        if key not in _ENTRY_KEYS:
            raise UserError(
                f"[{name}] in {where} has an unknown key {key}{_did_you_mean(key, _ENTRY_KEYS)}; "
                f"allowed: {', '.join(_ENTRY_KEYS)}."
            )
    table = ({"unit": "-"} if quantity.shape == "word" else {}) | defaults | table
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
            f"{_did_you_mean(table['status'], STATUSES)}; allowed: {', '.join(STATUSES)}."
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
            return _number(raw, quantity, unit, what)
        case "word":
            if raw not in quantity.words:
                raise UserError(
                    f"{what} is {_text(raw)}{_did_you_mean(str(raw), quantity.words)} but must be one of "
                    f"{', '.join(_text(word) for word in quantity.words)}; correct it."
                )
            return raw
        case "vector":
            return tuple(_number(item, quantity, unit, what) for item in _list(raw, what, "numbers"))
        case "matrix":
            rows = _rows(raw, what, "numbers")
            return tuple(tuple(_number(item, quantity, unit, what) for item in row) for row in rows)
        case "word matrix":
            words = _rows(raw, what, "words")
            if not all(isinstance(word, str) for row in words for word in row):
                raise UserError(f"{what} must consist of words; put each one in quotes.")
            return tuple(tuple(row) for row in words)


def _list(raw: object, what: str, content: str) -> list[Any]:
    if not isinstance(raw, list) or not raw:
        raise UserError(f"{what} is {_text(raw)} but must be a list of {content}; write [ ... ].")
    return raw


def _rows(raw: object, what: str, content: str) -> list[list[Any]]:
    rows = [_list(row, what, f"rows of {content}") for row in _list(raw, what, f"rows of {content}")]
    if len({len(row) for row in rows}) > 1:
        raise UserError(f"{what} has rows of different length; make them equal.")
    return rows


def _number(raw: object, quantity: Quantity, unit: str, what: str) -> float:
    if isinstance(raw, bool) or not isinstance(raw, (int, float)):
        raise UserError(
            f"{what} is {_text(raw)} but must be a number; write it without quotes and with a point."
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
        raise UserError(f"{what} is {raw} {unit}; {_implausible(float(raw), unit, quantity)}")
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
    low, high = (_number(item, quantity, unit, what) for item in pair)
    if low > high:
        raise UserError(f"{what} has the lower one above the upper one; write [lower, upper].")
    return low, high


def _numbers(value: Any) -> Iterator[float]:
    if isinstance(value, float):
        yield value
    elif isinstance(value, tuple):
        for item in value:
            yield from _numbers(item)


def _text(raw: object) -> str:
    return f'"{raw}"' if isinstance(raw, str) else str(raw)


def _did_you_mean(word: str, known: Iterable[str]) -> str:
    close = get_close_matches(word.lower(), list(known), n=1, cutoff=0.5)
    return f' (did you mean "{close[0]}"?)' if close else ""
