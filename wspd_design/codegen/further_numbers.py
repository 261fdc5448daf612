"""Pads, electrodynamic brake and track brake among the numbers of the compiled loop.

Which of them a vehicle has, and which tables, decides what is compiled; their numbers are inputs like all others. A
table is filled up with points beyond its end, where its last value stays.
"""

from collections.abc import Callable, Mapping
from dataclasses import fields
from functools import lru_cache
from typing import Any, Final

from wspd_design.parameters.brake_checks import MOST_POINTS
from wspd_design.parameters.records import DynamicBrake, Pads, TrackBrake, Vehicle

_PARTS: Final[Mapping[str, type]] = {"pads": Pads, "dynamic": DynamicBrake, "track_brake": TrackBrake}
_POINTS: Final = ("speeds", "temperatures")
_FACTORS: Final = ("speed_factors", "temperature_factors")
_NOT_NUMBERS: Final = ("kind", "axle_shares", "bounds")
_ABSENT: Final[Mapping[str, float]] = {"drop_slip": 1.0}  # what the loop asks whether there is a brake or not

PART_NAMES: Final = tuple(_PARTS)
"""Fields of a vehicle that hold them."""


def _elements(part: str, name: str) -> tuple[tuple[str, str], ...]:
    if name in _POINTS + _FACTORS:
        return tuple((part, f"{name} {k}") for k in range(MOST_POINTS))
    return ((part, name),)


FURTHER_PARAMETERS: Final = tuple(
    element
    for part, record in _PARTS.items()
    for field in fields(record)
    if field.name not in _NOT_NUMBERS
    for element in _elements(part, field.name)
)
"""Part and number of every element that they add to the parameter vector."""


def further_values(vehicle: Vehicle) -> list[float]:
    """Return these elements; those of a part that the vehicle does not have say that there is none."""
    return [value for part in _PARTS for value in _part_values(part, getattr(vehicle, part))]


@lru_cache(maxsize=64)  # most stops of a campaign have the same part, or none
def _part_values(part: str, has: Pads | DynamicBrake | TrackBrake | None) -> tuple[float, ...]:
    values: list[float] = []
    for field in fields(_PARTS[part]):
        if field.name in _NOT_NUMBERS:
            continue
        if has is None:
            values += [_ABSENT.get(field.name, 0.0)] * len(_elements(part, field.name))
            continue
        value = getattr(has, field.name)
        values += _filled(field.name, value) if isinstance(value, tuple) else [value]
    return tuple(values)


def _filled(name: str, given: tuple[float, ...]) -> list[float]:
    row = list(given or (0.0,))
    while len(row) < MOST_POINTS:
        row.append(row[-1] + (1.0 if name in _POINTS else 0.0))
    return row


def blank_parts(vehicle: Vehicle) -> dict[str, Any]:
    """Return the parts without their numbers: what is compiled for a vehicle depends on nothing else of them."""
    return {part: _with_numbers(part, getattr(vehicle, part), lambda _: 0.0) for part in _PARTS}


def symbolic_parts(blank: Vehicle, symbols: Mapping[tuple[str, str], Any]) -> dict[str, Any]:
    """Return the parts that a blank vehicle has, with symbols in place of numbers."""
    return {part: _with_numbers(part, getattr(blank, part), symbols.__getitem__) for part in _PARTS}


def _with_numbers(part: str, known: Any, number: Callable[[tuple[str, str]], Any]) -> Any:
    """The same part with other numbers; a table is full, or empty where the part has none."""
    if known is None:
        return None
    made: dict[str, Any] = {}
    for field in fields(_PARTS[part]):
        if field.name not in _NOT_NUMBERS:
            value = getattr(known, field.name)
            numbers = tuple(map(number, _elements(part, field.name)))
            made[field.name] = (numbers if value else ()) if isinstance(value, tuple) else numbers[0]
    return _PARTS[part](**made)
