"""Which gains a law has, and what form they take."""

from dataclasses import fields
from typing import Any

from wspd_design.controllers.adaptive_fuzzy import AdaptiveFuzzyGains
from wspd_design.controllers.sliding_mode import SlidingModeGains
from wspd_design.controllers.torque_feedback import TorqueFeedbackGains
from wspd_design.design.records import Law

_RECORDS: dict[Law, type] = {
    "afsmc": AdaptiveFuzzyGains,
    "smc": SlidingModeGains,
    "torque-feedback": TorqueFeedbackGains,
}

GAINS_OF: dict[Law, tuple[str, ...]] = {
    law: tuple(field.name for field in fields(record) if field.name != "slip_reference")
    for law, record in _RECORDS.items()
}
"""Names of the gains of each law; the slip reference belongs to the specification."""

FORM_OF: dict[str, Any] = {field.name: field.type for record in _RECORDS.values() for field in fields(record)}
"""Type of each gain: ``float``, ``bool`` or ``tuple[float, ...]``."""

DIVISORS = ("proportional_gain", "boundary_layer", "widths", "torque_unit")
"""Gains that the laws divide by."""

PER_RULE = ("initial_weights", "centres", "widths")
"""Gains with one number for each fuzzy rule."""


def law_of(name: str) -> Law | None:
    """Return the law of a name, or None for what has no gains to design."""
    return next((law for law in GAINS_OF if law == name), None)
