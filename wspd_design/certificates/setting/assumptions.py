"""What theorems take for granted about a vehicle, so that no proof speaks about one that it does not model.

A new property of vehicles gets a row here in the same change. Every theorem assumes all rows unless it names those
that it needs (``assumes``), and it may leave out only what its statement stays exactly true without.
"""

from collections.abc import Callable, Iterable, Mapping
from enum import Enum
from typing import Final

from wspd_design.parameters.records import Vehicle


class Assumption(Enum):
    """A property of the vehicle; the value says it as a clause."""

    EQUAL_BRAKES = "every axle has a brake, and all brakes are alike"
    CONSTANT_PADS = "the friction of the pads depends on neither speed nor temperature"
    FRICTION_ALONE = "the friction brake alone brakes the wheels"
    ADHESION_ALONE = "nothing but adhesion and running resistance brakes the train"


ALL: Final = frozenset(Assumption)


def not_met(vehicle: Vehicle, assumes: Iterable[Assumption]) -> str:
    """Say which assumption a vehicle does not meet, and why.

    Parameters
    ----------
    vehicle : Vehicle
        What is asked about.
    assumes : iterable of Assumption
        What is assumed about it.

    Returns
    -------
    str
        One sentence about the first one in the order of the enum that is not met; empty if all are.
    """
    assumed = set(assumes)
    for each in Assumption:
        reason = _REASONS[each](vehicle) if each in assumed else ""
        if reason:
            return f"The theorem takes for granted that {each.value}; {vehicle.name} {reason}."
    return ""


def _unequal_brakes(vehicle: Vehicle) -> str:
    shares = vehicle.brake.axle_shares
    if all(share == 1.0 for share in shares):
        return ""
    return f"has the brake.axle_shares {', '.join(f'{share:g}' for share in shares)}"


def _pads_that_fade(vehicle: Vehicle) -> str:
    pads = vehicle.pads
    over = [name for name in ("speeds", "temperatures") if pads is not None and getattr(pads, name)]
    return f"has pads.{over[0]}" if over else ""


_REASONS: Final[Mapping[Assumption, Callable[[Vehicle], str]]] = {
    Assumption.EQUAL_BRAKES: _unequal_brakes,
    Assumption.CONSTANT_PADS: _pads_that_fade,
    Assumption.FRICTION_ALONE: lambda vehicle: "has an electrodynamic brake" if vehicle.dynamic else "",
    Assumption.ADHESION_ALONE: lambda vehicle: "has a track brake" if vehicle.track_brake else "",
}
"""For each assumption: empty, or what a vehicle has instead, as a clause after its name."""
