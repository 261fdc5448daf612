"""Vehicles and rails: all numbers with unit, bounds and meaning."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from wspd_design.exchange.parameter_keys import RAIL_KEYS, VEHICLE_KEYS
from wspd_design.notebook.html import card, small_picture
from wspd_design.parameters.records import Rail, Vehicle
from wspd_design.parameters.schema import Kind, schema_of
from wspd_design.parameters.table import Column, Table, table_of
from wspd_design.parameters.units import factor, units_of
from wspd_design.plotting.rails import friction_panel
from wspd_design.reporting.numbers import unit as spelled_unit

_READ = {"pressure": "bar", "mass": "t", "torque": "kN m", "speed": "km/h"}
"""Units that people read, where they are not the SI unit."""
_LEFT_OUT = "What is not listed has its default, as a file that leaves it out."
_GIGA = 1e9  # Pa: elastic moduli are told in GPa


@dataclass(frozen=True, slots=True, kw_only=True)
class _Row:
    name: str
    value: Any
    unit: str
    bounds: str
    meaning: str


_COLUMNS: tuple[Column[_Row], ...] = (
    Column(title="number", read=lambda row: row.name),
    Column(title="value", read=lambda row: row.value),
    Column(title="unit", read=lambda row: row.unit),
    Column(title="bounds", read=lambda row: row.bounds),
    Column(title="meaning", read=lambda row: row.meaning),
)


def vehicle_table(vehicle: Vehicle) -> Table:
    """Return all numbers of a vehicle."""
    rows = _rows(vehicle, "vehicle", VEHICLE_KEYS)
    return table_of(rows, _COLUMNS, caption=f"Vehicle {vehicle.name}", notes=[_LEFT_OUT])


def rail_table(rail: Rail) -> Table:
    """Return the coefficients of a rail."""
    return table_of(_rows(rail, "rail", RAIL_KEYS), _COLUMNS, caption=f"Rail {rail.name}")


def vehicle_card(vehicle: Vehicle) -> str:
    """Return what a notebook shows of a vehicle."""
    brake = vehicle.brake
    full = sum(vehicle.brake_shares) * brake.max_torque / vehicle.wheel_radius
    lines = (
        f"{vehicle.mass / 1e3:g} t on {vehicle.wheelsets} wheelsets with a wheel radius of "
        f"{1e3 * vehicle.wheel_radius:g} mm; brakes of {brake.max_torque / 1e3:g} kN m per wheelset, "
        f"{full / 1e3:.3g} kN at the rims, {full / vehicle.mass:.3g} m/s² of the whole vehicle.",
    )
    return card(f"Vehicle {vehicle.name}", lines=lines, tables=[vehicle_table(vehicle)])


def rail_card(rail: Rail) -> str:
    """Return what a notebook shows of a rail."""
    drawn = small_picture(
        lambda figure: friction_panel(figure, rail),
        height=1.9,
        alt=f"Friction of {rail.name} over sliding speed, from {rail.mu0:g} down to "
        f"{rail.mu0 * rail.friction_ratio:.3g}.",
    )
    return card(f"Rail {rail.name}", pictures=[drawn], tables=[rail_table(rail)])


def _rows(record: Vehicle | Rail, kind: Kind, meanings: Mapping[str, str]) -> Iterator[_Row]:
    for name, quantity in schema_of(kind, record.name).items():
        *parts, last = name.split(".")
        owner: Any = record
        for part in parts:
            owner = getattr(owner, part, None)
        if owner is None or not hasattr(owner, last):
            continue
        value = getattr(owner, last)
        if quantity.optional and value == type(owner).__dataclass_fields__[last].default:
            continue
        unit = _READ.get(quantity.dimension, units_of(quantity.dimension)[0])
        if unit == "bar" and isinstance(value, float) and value >= _GIGA:
            unit = "GPa"
        bounds = owner.bounds.get(last)
        yield _Row(
            name=name,
            value=_in(value, unit),
            unit="" if quantity.shape == "word" else spelled_unit(unit),
            bounds="" if bounds is None else " to ".join(f"{end / factor(unit):.4g}" for end in bounds),
            meaning=meanings[name],
        )


def _in(value: Any, unit: str) -> Any:
    """Write numbers in a unit; lists as text."""
    if isinstance(value, tuple):
        return ", ".join(f"{each / factor(unit):.4g}" for each in value) or None
    return value / factor(unit) if isinstance(value, float) else value
