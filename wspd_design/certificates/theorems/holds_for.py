"""For which loop each theorem holds, from the equations alone to a whole stop: rungs of the ladder of evidence.

A statement about an ideal brake, whose torque is what the law commands, says nothing about the brake of a vehicle: it
is an argument for the law, and one that fails does not condemn a design.
"""

from collections.abc import Mapping
from enum import Enum
from typing import Final


class HoldsFor(Enum):
    """What stands between the law and the wheel in a statement; the value says it in words."""

    EQUATIONS = "equations"
    IDEAL_BRAKE = "ideal brake"
    VALVE = "valve"
    SAMPLED = "valve, sampled"
    STOP = "full stop"


HOLDS_FOR: Final[Mapping[str, HoldsFor]] = {
    "derivation": HoldsFor.EQUATIONS,
    "feedback": HoldsFor.EQUATIONS,
    "surface_hurwitz": HoldsFor.IDEAL_BRAKE,
    "gain_positive": HoldsFor.EQUATIONS,
    "well_posed": HoldsFor.EQUATIONS,
    "holding_torque": HoldsFor.IDEAL_BRAKE,
    "sliding_exists": HoldsFor.IDEAL_BRAKE,
    "reaching": HoldsFor.IDEAL_BRAKE,
    "boundary_layer": HoldsFor.IDEAL_BRAKE,
    "lyapunov_surface": HoldsFor.IDEAL_BRAKE,
    "lyapunov_printed": HoldsFor.IDEAL_BRAKE,
    "lyapunov_repaired": HoldsFor.IDEAL_BRAKE,
    "afsmc_energy": HoldsFor.IDEAL_BRAKE,
    "barbalat": HoldsFor.IDEAL_BRAKE,
    "open_loop_pole": HoldsFor.VALVE,
    "no_go": HoldsFor.VALVE,
    "hard_limits": HoldsFor.SAMPLED,
    "sampling": HoldsFor.SAMPLED,
    "routh_lag": HoldsFor.VALVE,
    "margins": HoldsFor.SAMPLED,
    "traced_loop": HoldsFor.SAMPLED,
    "lpv_lyapunov": HoldsFor.SAMPLED,
    "sampled_invariance": HoldsFor.SAMPLED,
    "slip_band": HoldsFor.SAMPLED,
    "slip_limit": HoldsFor.SAMPLED,
    "fuzzy_sector": HoldsFor.SAMPLED,
    "tracking": HoldsFor.STOP,
    "overshoot": HoldsFor.STOP,
    "conservation": HoldsFor.STOP,
    "stop_bound": HoldsFor.STOP,
}
"""By the name of the theorem."""
