"""Which gains a law has, and what form they take."""

from dataclasses import fields
from typing import Any

from wspd_design.controllers.adaptive_fuzzy import AdaptiveFuzzyGains
from wspd_design.controllers.sliding_mode import SlidingModeGains
from wspd_design.design.records import Law

GAINS_OF: dict[Law, tuple[str, ...]] = {
    "afsmc": tuple(field.name for field in fields(AdaptiveFuzzyGains) if field.name != "slip_reference"),
    "smc": tuple(field.name for field in fields(SlidingModeGains) if field.name != "slip_reference"),
}
"""Names of the gains of each law; the slip reference belongs to the specification."""

FORM_OF: dict[str, Any] = {
    field.name: field.type for record in (AdaptiveFuzzyGains, SlidingModeGains) for field in fields(record)
}
"""Type of each gain: ``float``, ``bool`` or ``tuple[float, ...]``."""

DIVISORS = ("proportional_gain", "boundary_layer", "widths", "torque_unit")
"""Gains that the laws divide by."""

PER_RULE = ("initial_weights", "centres", "widths")
"""Gains with one number for each fuzzy rule."""
