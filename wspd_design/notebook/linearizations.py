"""Linearizations: equilibrium, poles and gain."""

import math

from wspd_design.analysis.linearization import Linearization
from wspd_design.notebook.html import card, small_picture
from wspd_design.parameters.table import Column, Table, table_of
from wspd_design.parameters.units import KMH
from wspd_design.plotting.poles import poles_panel

_COLUMNS: tuple[Column[tuple[str, float, str]], ...] = (
    Column(title="quantity", read=lambda row: row[0]),
    Column(title="value", read=lambda row: row[1]),
    Column(title="unit", read=lambda row: row[2]),
)


def linearization_table(point: Linearization) -> Table:
    """Return the numbers of a linearization."""
    rows = (
        ("slip", point.slip, ""),
        ("train speed", KMH * point.speed, "km/h"),
        ("torque that holds the slip", point.equilibrium_torque / 1e3, "kN m per wheelset"),
        ("duty that holds it; above 1 the brake cannot", point.equilibrium_duty, ""),
        ("slip pole", point.slip_pole, "1/s"),
        ("gain of the torque", point.gain, "1/(N m s)"),
        ("time constant of the valve", point.time_constant, "s"),
    )
    return table_of(rows, _COLUMNS, caption=_title(point), notes=[_sentence(point)[1]])


def linearization_card(point: Linearization) -> str:
    """Return what a notebook shows of a linearization."""
    drawn = small_picture(
        lambda figure: poles_panel(figure, point),
        height=1.5,
        alt=f"Open-loop poles at {', '.join(f'{pole:.4g} 1/s' for pole in point.poles())}.",
    )
    table = linearization_table(point)
    return card(
        _title(point),
        verdict=_sentence(point),
        pictures=[drawn],
        tables=[table_of(table.rows, _COLUMNS)],
    )


def _title(point: Linearization) -> str:
    return f"Linearization of {point.vehicle} on {point.rail} at slip {point.slip:g} and {KMH * point.speed:g} km/h"


def _sentence(point: Linearization) -> tuple[str, str]:
    """Say what the slip pole means at this frozen speed."""
    if point.slip_pole > 0.0:
        doubled = math.log(2.0) / point.slip_pole
        return "bad", f"Unstable without control: a deviation of the slip doubles in {doubled:.3g} s."
    if point.slip_pole < 0.0:
        halved = math.log(2.0) / -point.slip_pole
        return "good", f"Stable without control: a deviation of the slip halves in {halved:.3g} s."
    return "open", "The slip pole is zero: the linearization does not decide about stability."
