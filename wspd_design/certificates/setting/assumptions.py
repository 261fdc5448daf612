"""What theorems take for granted about a vehicle, so that no proof speaks about one that it does not model.

A new property of vehicles gets a row here in the same change. Every theorem assumes all rows unless it names those
that it needs (``assumes``), and it may leave out only what its statement stays exactly true without.
"""

from collections.abc import Callable, Iterable, Mapping
from enum import Enum
from typing import Final

from wspd_design.parameters.gear import static_shares
from wspd_design.parameters.records import Vehicle


class Assumption(Enum):
    """A property of the vehicle; the value says it as a clause."""

    EQUAL_BRAKES = "every axle has a brake, and all brakes are alike"
    EQUAL_LOADS = "all axles carry the same load at rest"


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


def _unequal_loads(vehicle: Vehicle) -> str:
    loads = static_shares(vehicle)
    if min(loads) == max(loads):
        return ""
    return f"loads them with {min(loads):.3g} to {max(loads):.3g} of the mean, since its bodies share bogies or axles"


_REASONS: Final[Mapping[Assumption, Callable[[Vehicle], str]]] = {
    Assumption.EQUAL_BRAKES: _unequal_brakes,
    Assumption.EQUAL_LOADS: _unequal_loads,
}
"""For each assumption: empty, or what a vehicle has instead, as a clause after its name."""
