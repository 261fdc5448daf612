"""Which gains a law has."""

from dataclasses import fields

from wspd_design.controllers.adaptive_fuzzy import AdaptiveFuzzyGains
from wspd_design.controllers.sliding_mode import SlidingModeGains
from wspd_design.design.records import Law

GAINS_OF: dict[Law, tuple[str, ...]] = {
    law: tuple(field.name for field in fields(record) if field.name != "slip_reference")
    for law, record in (("afsmc", AdaptiveFuzzyGains), ("smc", SlidingModeGains))
}
"""Names of the gains of each law; the slip reference belongs to the specification."""
