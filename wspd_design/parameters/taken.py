"""What functions take: records, not their names, and numbers that fit together."""

import math
from collections.abc import Iterator, Mapping
from functools import lru_cache
from pathlib import Path
from typing import Any

from wspd_design.parameters.brake_checks import check_further_brakes
from wspd_design.parameters.contradictions import tell
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.gear import contradiction, masses_contradict
from wspd_design.parameters.records import Rail, Vehicle
from wspd_design.parameters.schema import Kind, Quantity, schema_of
from wspd_design.parameters.units import KMH, format_quantity, units_of

_LOADED = {Vehicle: "load_vehicle", Rail: "load_rail"}
_NUMERALS_OF_KMH = 56.0  # m/s, 200 km/h: above it a number is more often one of km/h
_FASTEST = 100.0  # m/s, 360 km/h: no train on wheels runs faster in service
_MAY_VANISH = "_height"  # a vehicle without heights transfers no load
_SHOWN = 40  # characters of a text that a sentence repeats


def check_vehicle(vehicle: object, *, by: str, whole: bool = True) -> None:
    """Refuse what is not a vehicle, and one whose numbers no vehicle has.

    Parameters
    ----------
    vehicle : object
        What a function was given.
    by : str
        Name of the function, for the sentence.
    whole : bool
        Whether body and bogies count as well, which a quarter of a vehicle does not have.

    Raises
    ------
    UserError
        With what is wrong in one sentence.
    """
    if not isinstance(vehicle, Vehicle):
        raise UserError(_other(vehicle, Vehicle, by))
    wrong = _wrong_numbers(vehicle, "vehicle") or (_contradicting(vehicle) if whole else "")
    if wrong:
        raise UserError(wrong)


def check_rail(rail: object, *, by: str) -> None:
    """Refuse what is not a rail, and one whose numbers no rail has; as :func:`check_vehicle`."""
    if not isinstance(rail, Rail):
        raise UserError(_other(rail, Rail, by))
    wrong = _wrong_numbers(rail, "rail")
    if wrong:
        raise UserError(wrong)


def check_record(value: object, kind: type, *, by: str, remedy: str) -> None:
    """Refuse what is not a record of a kind.

    Parameters
    ----------
    value : object
        What a function was given.
    kind : type
        What it takes.
    by : str
        Name of the function.
    remedy : str
        How to make such a record.
    """
    if not isinstance(value, kind):
        raise UserError(f"{by} takes a {kind.__name__}, not {described(value)}; {remedy}")


def check_kinds(vehicle: object, rail: object, *, by: str) -> None:
    """Refuse what is not a vehicle and a rail, whatever their numbers are."""
    for value, kind in ((vehicle, Vehicle), (rail, Rail)):
        if not isinstance(value, kind):
            raise UserError(_other(value, kind, by))


def check_numbers(record: str, values: Mapping[str, tuple[object, str]]) -> None:
    """Refuse texts and other things in place of numbers.

    Parameters
    ----------
    record : str
        What the numbers are of, for the sentence.
    values : mapping
        Value and unit by name; None is a number that is not given.
    """
    for name, (value, unit) in values.items():
        for each in value if isinstance(value, tuple | list) else (value,):
            if each is not None and (isinstance(each, bool | str) or not hasattr(each, "__float__")):
                wanted = f"a number in {unit}" if unit else "a number"
                raise UserError(f"{name} of {record} is {described(each)}; give {wanted}")


def notice_of_speed(speed: float, what: str, remedy: str) -> None:
    """Warn about a speed that is more likely one in km/h [m/s]."""
    if speed > _NUMERALS_OF_KMH:
        tell(f"{what} = {speed:g} m/s is {KMH * speed:.4g} km/h; {remedy}")


def notice_of_fast_train(speed: float, what: str, remedy: str) -> None:
    """Warn about a speed in m/s that is more likely one in km/h: faster than trains run, or high and a whole number.

    A record cannot know what its speed was converted from, and 80.0 m/s may be the 288 km/h of a fast train. But no
    conversion gives an ``int``: whoever gives one above 200 km/h has typed it.
    """
    fast = speed > _FASTEST
    if fast or (speed > _NUMERALS_OF_KMH and hasattr(speed, "__index__")):
        told = ", faster than trains run" if fast else ""
        tell(f"{what} = {speed:g} m/s is {KMH * speed:.4g} km/h{told}; {remedy}")


def described(value: object) -> str:
    """Say what was given in place of a record."""
    if isinstance(value, str | Path):
        text = str(value)
        return f'the text "{text if len(text) <= _SHOWN else text[:_SHOWN] + "..."}"'
    if isinstance(value, type):
        return f"the class {value.__name__}"
    if value is None or isinstance(value, bool | int | float):
        return str(value)
    name = type(value).__name__
    return f"{'an' if name[0] in 'AEIOUaeiou' else 'a'} {name}"


def _other(value: object, kind: type, by: str) -> str:
    name = str(value) if isinstance(value, str | Path) else "NAME"
    return f'{by} takes a {kind.__name__}, not {described(value)}; load it with {_LOADED[kind]}("{name}")'


@lru_cache(maxsize=256)
def _wrong_numbers(record: Vehicle | Rail, kind: Kind) -> str:
    """Say which number of a record is impossible, or nothing; what no railway has is told by a warning."""
    strange = []
    for name, quantity in schema_of(kind, record.name).items():
        if quantity.shape not in ("number", "vector"):
            continue
        for value, usual in _stated(record, name):
            if value == usual:
                continue
            wrong = _impossible(value, quantity, zero=name.endswith(_MAY_VANISH))
            if wrong:
                return f"{name} of {kind} {record.name} {wrong}"
            strange += [f"{name} of {kind} {record.name} {said}" for said in _implausible(value, quantity)]
    tell("; ".join(strange[:1]))
    return ""


def _stated(record: Vehicle | Rail, name: str) -> "Iterator[tuple[Any, Any]]":
    """Numbers of a record by the name in its file, each with what stands where the file leaves it out."""
    *parts, last = name.split(".")
    owner: Any = record
    for part in parts:
        owner = getattr(owner, part, None)
    if owner is None or not hasattr(owner, last):
        return
    value, usual = getattr(owner, last), type(owner).__dataclass_fields__[last].default
    if isinstance(value, tuple):
        yield from ((each, None) for each in value)
    else:
        yield value, usual


def _impossible(value: Any, quantity: Quantity, *, zero: bool) -> str:
    if isinstance(value, bool | str) or not hasattr(value, "__float__"):
        return f"is {described(value)}; give a number in SI units"
    given = format_quantity(value, units_of(quantity.dimension)[0])
    if not math.isfinite(value):
        return f"= {given} must be finite"
    if not quantity.admits(value) and not (zero and value == 0.0):
        return f"= {given} must be {quantity.range_text}"
    return ""


def _implausible(value: float, quantity: Quantity) -> Iterator[str]:
    low, high = quantity.plausible or (-math.inf, math.inf)
    if not low <= value <= high and value != 0.0:
        unit = units_of(quantity.dimension)[0]
        ends = f"{low:g} to {high:g}{'' if unit == '-' else f' {unit}'}"
        yield f"= {format_quantity(value, unit)}; railways have {ends}"


@lru_cache(maxsize=256)
def _contradicting(vehicle: Vehicle) -> str:
    """Say which numbers of a vehicle contradict each other, or nothing."""
    wrong = contradiction(vehicle)
    if wrong:
        return f"vehicle {vehicle.name}: {wrong}"
    masses = masses_contradict(vehicle)
    if masses:
        return f"{masses}; change the three together, for example with dataclasses.replace"
    try:
        check_further_brakes(vehicle)
    except UserError as error:
        return str(error)
    return ""
