"""Parameters of a vehicle or rail that was made in Python: what a file would state about each of its numbers."""

from dataclasses import fields
from typing import Any

from wspd_design.parameters.bounds import Ends
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.files import available, load_entries
from wspd_design.parameters.laden import LADEN
from wspd_design.parameters.provenance import Entry, ParameterSet
from wspd_design.parameters.records import Rail, Vehicle
from wspd_design.parameters.schema import Kind, Quantity, schema_of
from wspd_design.parameters.units import units_of

SOURCE = "given in Python"


def given_entries(record: Vehicle | Rail) -> ParameterSet:
    """Return the entries of a record.

    A number that a shipped file of the same name states just so keeps its history; any other one was given in Python.

    Parameters
    ----------
    record : Vehicle or Rail
        However it was made.

    Raises
    ------
    UserError
        If a number is physically impossible or lies outside its bounds.
    """
    kind: Kind = "vehicle" if isinstance(record, Vehicle) else "rail"
    shipped = load_entries(kind, record.name) if record.name.removesuffix(LADEN) in available(kind) else None
    known = {} if shipped is None else shipped.entries
    entries: dict[str, Entry] = {}
    for name, quantity in schema_of(kind, record.name).items():
        stated = known.get(name)
        part, dot, field = name.rpartition(".")
        owner: Any = getattr(record, part, None) if dot else record
        value, ends = getattr(owner, field, None), owner.bounds.get(field) if owner is not None else None
        if stated is not None and (part == "laden" or (stated.value, stated.bounds) == (value, ends)):
            entries[name] = stated  # the load of a laden vehicle is in its other numbers
        elif value is not None and not _is_default(owner, field, value):
            _check(value, ends, quantity, f"{name} = {{}} of {kind} {record.name}")
            entries[name] = Entry(
                name=name,
                value=float(value) if quantity.shape == "number" else value,
                unit=units_of(quantity.dimension)[0],
                bounds=ends,
                source=SOURCE,
                at=f"record of the {kind}",
                status="assumed",
                note="",
            )
    title = record.name if shipped is None else shipped.title
    changed = shipped is not None and entries != dict(known)
    return ParameterSet(
        kind=kind,
        name=record.name,
        title=f"{title}, changed in Python" if changed else title,
        entries=entries,
    )


def given_in_python(parameters: ParameterSet) -> bool:
    """Tell whether a set has numbers that no file states."""
    return any(entry.source == SOURCE for entry in parameters.entries.values())


def _is_default(owner: Any, field: str, value: object) -> bool:
    """Tell whether a number is the default by which a record says that there is no such thing."""
    return any(each.name == field and each.default == value for each in fields(owner))


def _check(value: Any, ends: Ends | None, quantity: Quantity, where: str) -> None:
    """Refuse what is physically impossible, or outside its own bounds."""
    unit = units_of(quantity.dimension)[0]
    for number in value if isinstance(value, tuple) else (value,):
        if not isinstance(number, int | float):
            continue
        said = where.format(f"{number:g} {unit}".removesuffix(" -"))
        if not quantity.admits(number):
            raise UserError(f"{said} must be {quantity.range_text}; correct the record")
        if ends is not None and not ends[0] <= number <= ends[1]:
            raise UserError(
                f"{said} lies outside its bounds, {ends[0]:g} to {ends[1]:g}; change the bounds of the record, too"
            )
