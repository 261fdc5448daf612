"""Designs as TOML files, written and read without loss."""

import json
import math
import os
from dataclasses import fields
from pathlib import Path
from typing import Any

from wspd_design.controllers.family import tunable_family, with_numbers
from wspd_design.controllers.gains import GainForm
from wspd_design.controllers.observers.sensors import TOLD, Sensors
from wspd_design.design.older_files import OLDER, as_present
from wspd_design.design.records import Design, Gain, GainValue, Specification, in_the_law
from wspd_design.design.requirements import read_requirements, requirements_text
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.files import read_toml
from wspd_design.parameters.laden import LADEN
from wspd_design.parameters.taken import check_record
from wspd_design.parameters.versions import check_schema
from wspd_design.parameters.words import near_or_allowed
from wspd_design.parameters.writing import write_whole

SCHEMA = "wspd-design/2"
_HEAD = ("schema", "name", "law", "vehicle", "vehicle_hash", "rail", "rail_hash")
_OPTIONAL = (
    "vehicle_file",
    "rail_file",
    "judged_by",
)  # what does not ship with the program, or is not the usual
_REQUIREMENTS = "requirements"
_FORMS = {float: "one number", bool: "true or false", tuple[float, ...]: "a list of numbers"}
_SPECIFICATION = {"slip": "-", "speeds": "m/s", "slips": "-", "slip_tolerance": "-", "sample_time": "s"}


def design_text(design: Design) -> str:
    """Return the TOML text of a design; reading it gives the same design back."""
    lines = [f"schema = {_toml(SCHEMA)}", *(f"{key} = {_toml(getattr(design, key))}" for key in _HEAD[1:])]
    lines += [f"{key} = {_toml(getattr(design, key))}" for key in _OPTIONAL if getattr(design, key)]
    lines += ["", "[specification]"]
    for key, unit in _SPECIFICATION.items():
        lines.append(f"{key} = {_toml(getattr(design.specification, key))}  # {unit}")
    if design.specification.reference is not None:
        lines.append(f"reference = {_toml(design.specification.reference)}")
    sensors = design.specification.sensors
    if sensors != TOLD:
        lines += ["", "[specification.sensors]"]
        lines += [f"{each.name} = {_toml(getattr(sensors, each.name))}" for each in fields(Sensors)]
    for gain in design.gains:
        lines += ["", f"[gains.{gain.name}]", f"value = {_toml(gain.value)}"]
        lines += [f"unit = {_toml(gain.unit)}", f"why = {_toml(gain.why)}"]
    if design.requirements is not None:
        lines += ["", requirements_text(design.requirements).rstrip()]
    return "\n".join(lines) + "\n"


def write_design(design: Design, path: str | Path) -> None:
    """Write a design file; nothing is left behind when that fails.

    Parameters
    ----------
    design : Design
        The design.
    path : str or Path
        The file to be; one of the same name is replaced.

    Raises
    ------
    UserError
        If the folder does not exist or cannot be written.
    """
    check_record(design, Design, by="write_design", remedy="the path of the file comes second")
    write_whole(Path(path), lambda part: part.write_text(design_text(design), encoding="utf-8"))


def seen_from(design_file: Path, name_or_path: str | Path | None) -> str:
    """Return the path of a parameter file as seen from the folder of a design file; nothing for a shipped name."""
    text = str(name_or_path or "")
    path = text.removesuffix(LADEN)
    if not path.endswith(".toml"):
        return ""
    return Path(os.path.relpath(path, design_file.parent)).as_posix() + text.removeprefix(path)


def read_design(path: str | Path) -> Design:
    """Read a design file.

    Parameters
    ----------
    path : str or Path
        The file, as :func:`write_design` or ``wspd design`` wrote it.

    Raises
    ------
    UserError
        If the file is missing, not a design, of a version that is not read, or anything in it is misspelled or no
        number.
    """
    where = str(path)
    document = read_toml(Path(path), where)
    found = document.get("schema")
    check_schema(found, SCHEMA, where, what="a design", remedy="re-run wspd design", older=(OLDER,))
    if found == OLDER:
        document = as_present(document, where)
    optional = (*_OPTIONAL, _REQUIREMENTS)
    _check_keys(document, (*_HEAD, "specification", "gains"), where, "", optional=optional)
    stated = [*_HEAD[1:], *(key for key in _OPTIONAL if key in document)]
    head = {key: _string(document[key], f"{key} in {where}") for key in stated}
    law = head["law"]
    if law not in [family.name for family in with_numbers()]:
        choice = ", ".join(family.name for family in with_numbers())
        raise UserError(f'law = "{law}" in {where} must be one of {choice}')
    forms = tunable_family(law).forms
    table = _table(document["specification"], "specification", where)
    _check_keys(table, tuple(_SPECIFICATION), where, "specification.", optional=("reference", "sensors"))
    values = {key: _value(table[key], f"specification.{key} in {where}") for key in _SPECIFICATION}
    for key, value in values.items():
        pair = key in ("speeds", "slips")
        if isinstance(value, bool) or isinstance(value, tuple) != pair or (pair and len(value) != 2):
            raise UserError(
                f"specification.{key} in {where} must be {'two numbers' if pair else 'one number'}"
            )
    gains = _table(document["gains"], "gains", where)
    needed = tuple(form.name for form in forms if not form.optional)
    free = tuple(form.name for form in forms if form.optional)
    _check_keys(gains, needed, where, "gains.", optional=free)
    read = tuple(_gain(form, gains[form.name], where) for form in forms if form.name in gains)
    per_rule = [form.name for form in forms if form.quantity.per_rule]
    if len({len(gain.value) for gain in read if gain.name in per_rule and isinstance(gain.value, tuple)}) > 1:
        raise UserError(
            f"{', '.join(f'gains.{name}' for name in per_rule)} in {where} must have the same length: "
            "one number for each fuzzy rule"
        )
    wanted = document.get(_REQUIREMENTS)
    return Design(
        **head,
        specification=Specification(**values, **how_seen(table, where, "specification.")),
        gains=read,
        requirements=None if wanted is None else read_requirements(wanted, where),
    )


def how_seen(table: dict[str, Any], where: str, prefix: str) -> dict[str, Any]:
    """Read reference and sensors of a specification, as far as a table of a file states them.

    Parameters
    ----------
    table : dict
        As TOML gives it.
    where : str
        The file, in sentences.
    prefix : str
        What stands before the keys in sentences.
    """
    stated: dict[str, Any] = {}
    if "reference" in table:
        stated["reference"] = _string(table["reference"], f"{prefix}reference in {where}")
    if "sensors" in table:
        sensors = _table(table["sensors"], f"{prefix}sensors", where)
        _check_keys(sensors, (), where, f"{prefix}sensors.", optional=tuple(f.name for f in fields(Sensors)))
        for each in fields(Sensors):
            value = sensors.get(each.name, each.default)
            if type(value) is not type(each.default):
                kind = "text" if isinstance(each.default, str) else "true or false"
                raise UserError(f"{prefix}sensors.{each.name} = {value} in {where} must be {kind}")
        stated["sensors"] = Sensors(**sensors)
    return stated


def _gain(form: GainForm, table: object, where: str) -> Gain:
    name = form.name
    entry = _table(table, f"gains.{name}", where)
    _check_keys(entry, ("value", "unit", "why"), where, f"gains.{name}.")
    value = _value(entry["value"], f"gains.{name}.value in {where}")
    _check_gain(form, value, where)
    gain = Gain(
        name=name,
        value=value,
        unit=_string(entry["unit"], f"gains.{name}.unit in {where}"),
        why=_string(entry["why"], f"gains.{name}.why in {where}"),
    )
    try:
        in_the_law(gain, form, 1.0)
    except UserError as error:
        raise UserError(f"{error} in {where}") from None
    return gain


def _check_gain(form: GainForm, value: GainValue, where: str) -> None:
    """Refuse a value that the law cannot compute with."""
    numbers = value if isinstance(value, tuple) else (value,)
    if form.type == tuple[float, ...]:
        fits = isinstance(value, tuple) and value and all(isinstance(number, float) for number in value)
    else:
        fits = isinstance(value, form.type)
    if not fits:
        raise UserError(f"gains.{form.name} in {where} must be {_FORMS[form.type]}")
    if form.quantity.divisor and min(numbers) <= 0.0:
        raise UserError(f"gains.{form.name} = {min(numbers):g} in {where} must be above 0")


def _table(value: object, name: str, where: str) -> dict[str, Any]:
    if not isinstance(value, dict):
        raise UserError(f"{name} in {where} must be a table: write [{name}]")
    return value


def _check_keys(
    table: dict[str, Any], known: tuple[str, ...], where: str, prefix: str, *, optional: tuple[str, ...] = ()
) -> None:
    for key in table:
        if key not in (*known, *optional):
            raise UserError(f"unknown key {prefix}{key} in {where}; {near_or_allowed(key, known, prefix)}")
    for key in known:
        if key not in table:
            raise UserError(f"{prefix}{key} is missing in {where}; re-run wspd design")


def _string(value: object, what: str) -> str:
    if not isinstance(value, str):
        raise UserError(f"{what} = {value} must be text; put it in quotes")
    return value


def _value(value: object, what: str) -> Any:
    if isinstance(value, bool):
        return value
    if isinstance(value, list):
        return tuple(_value(item, what) for item in value)
    if not isinstance(value, (int, float)) or not math.isfinite(value):
        raise UserError(f"{what} = {value} must be a finite number")
    return float(value)


def _toml(value: str | float | bool | tuple[float, ...]) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, tuple):
        return "[" + ", ".join(_toml(item) for item in value) + "]"
    return repr(value)
