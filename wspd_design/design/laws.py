"""Which gains a law has."""

from dataclasses import fields

from wspd_design.controllers.adaptive_fuzzy import AdaptiveFuzzyGains
from wspd_design.controllers.sliding_mode import SlidingModeGains
from wspd_design.design.records import Law

GAINS_OF: dict[Law, tuple[str, ...]] = {
    "afsmc": tuple(field.name for field in fields(AdaptiveFuzzyGains) if field.name != "slip_reference"),
    "smc": tuple(field.name for field in fields(SlidingModeGains) if field.name != "slip_reference"),
}
"""Names of the gains of each law; the slip reference belongs to the specification."""
