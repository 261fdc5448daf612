"""One number of a new vehicle: where it comes from, how it is rounded, and how far it is uncertain."""

from dataclasses import replace

from wspd_design.parameters.provenance import Entry
from wspd_design.parameters.units import factor, to_si

RULE, ANSWER = "wspd new vehicle", "own answer"
"""Sources of the numbers: a rule of ``new_vehicle.py``, or what the user wrote."""

_DIGITS = 4
_SPREAD = {
    "mass": (0.97, 1.03),
    "wheel_radius": (0.925, 1.0),
    "wheelset_inertia": (0.85, 1.15),
    "resistance_constant": (0.5, 1.5),
    "resistance_linear": (0.5, 1.5),
    "resistance_quadratic": (0.5, 2.0),
    "body_height": (0.9, 1.1),
    "bogie_height": (0.8, 1.2),
    "traction_rod_height": (0.8, 1.2),
    "body_pitch_frequency": (0.7, 1.3),
    "bogie_pitch_frequency": (0.7, 1.3),
    "pitch_damping_ratio": (0.3, 2.0),
    "brake.max_torque": (0.85, 1.15),
    "brake.supply_rate": (0.7, 1.3),
    "brake.build_up_delay": (0.7, 1.3),
    "brake.build_up_ramp": (0.7, 1.3),
    "brake.fill_time": (0.75, 1.25),
    "brake.vent_time": (0.75, 1.25),
    "contact.semi_axis_rolling": (0.9, 1.3),
    "contact.semi_axis_lateral": (0.9, 1.3),
    "laden.mass": (0.97, 1.03),
    "laden.body_height": (0.9, 1.1),
    "laden.max_torque": (0.85, 1.15),
}
"""Bounds of the numbers over their values: worn wheels, pads within 15 %, contacts of other profiles, and estimates."""


def ruled(name: str, value: float, unit: str, rule: str) -> Entry:
    """Return a number that follows from the answers by a rule."""
    return stated(name, _rounded(value, unit), unit, RULE, rule, "derived")


def taken(entry: Entry, kind: str) -> Entry:
    """Return a number of the shipped vehicle, which is an assumption about this one."""
    return replace(
        entry, source=f"vehicle {kind}", at=f"as of {kind}, there {entry.status}", status="assumed", note=""
    )


def stated(name: str, value: float, unit: str, source: str, at: str, status: str) -> Entry:
    """Return a number with its bounds."""
    spread = _SPREAD.get(name)
    bounds = spread and (_rounded(spread[0] * value, unit), _rounded(spread[1] * value, unit))
    return Entry(
        name=name, value=value, unit=unit, bounds=bounds, source=source, at=at, status=status, note=""
    )


def _rounded(value: float, unit: str) -> float:
    """Round to four digits in the unit, masses to kilograms."""
    if unit == "kg":
        return float(round(value))
    return to_si(float(f"{value / factor(unit):.{_DIGITS}g}"), unit)
