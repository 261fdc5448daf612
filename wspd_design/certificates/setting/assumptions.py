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
    CONSTANT_PADS = "the friction of the pads depends on neither speed nor temperature"
    FRICTION_ALONE = "the friction brake alone brakes the wheels"
    ADHESION_ALONE = "nothing but adhesion and running resistance brakes the train"
    EQUAL_LOADS = "all axles carry the same load at rest"
    MAIN_PIPE = "the demanded pressure builds up as that of the main pipe, eq. (8)"
    LAG = "the valves fill and vent as first-order lags, eq. (9)"
    NO_LEAK = "a held cylinder keeps its pressure"
    NO_DEAD_TIME = "the valves follow a command at once"
    ANY_PULSE = "a pulse of any length opens a valve"
    NO_WATCHDOG = "no watchdog fills against the command"
    SUPPLY = "the reservoir does not run low"


ALL: Final = frozenset(Assumption)
OF_VALVES: Final = frozenset(
    {
        Assumption.MAIN_PIPE,
        Assumption.LAG,
        Assumption.NO_LEAK,
        Assumption.NO_DEAD_TIME,
        Assumption.ANY_PULSE,
        Assumption.NO_WATCHDOG,
    }
)
"""What is between the command and the torque: nothing to a theorem that takes the torque as commanded."""
BUILT_UP: Final = ALL - {Assumption.MAIN_PIPE}
"""For theorems about a brake that demands the full pressure, whatever way it got there."""


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


def _unequal_loads(vehicle: Vehicle) -> str:
    loads = static_shares(vehicle)
    if min(loads) == max(loads):
        return ""
    return f"loads them with {min(loads):.3g} to {max(loads):.3g} of the mean, since its bodies share bogies or axles"


def _having(field: str, unit: str, factor: float = 1.0) -> Callable[[Vehicle], str]:
    """Say that a brake has a number that is not 0."""

    def reason(vehicle: Vehicle) -> str:
        value = getattr(vehicle.brake, field)
        return f"has the brake.{field} {factor * value:g} {unit}" if value else ""

    return reason


def _other_build_up(vehicle: Vehicle) -> str:
    word = vehicle.brake.build_up
    return "" if word == "main-pipe" else f'has the brake.build_up "{word}"'


def _other_valve(vehicle: Vehicle) -> str:
    word = vehicle.brake.valve
    return "" if word == "lag" else f'has the brake.valve "{word}"'


_REASONS: Final[Mapping[Assumption, Callable[[Vehicle], str]]] = {
    Assumption.EQUAL_BRAKES: _unequal_brakes,
    Assumption.CONSTANT_PADS: _pads_that_fade,
    Assumption.FRICTION_ALONE: lambda vehicle: "has an electrodynamic brake" if vehicle.dynamic else "",
    Assumption.ADHESION_ALONE: lambda vehicle: "has a track brake" if vehicle.track_brake else "",
    Assumption.EQUAL_LOADS: _unequal_loads,
    Assumption.MAIN_PIPE: _other_build_up,
    Assumption.LAG: _other_valve,
    Assumption.NO_LEAK: _having("hold_leak", "1/s"),
    Assumption.NO_DEAD_TIME: _having("dead_time", "s"),
    Assumption.ANY_PULSE: _having("shortest_pulse", "s"),
    Assumption.NO_WATCHDOG: _having("longest_release", "s"),
    Assumption.SUPPLY: _having("reservoir_volume", "l", 1e3),
}
"""For each assumption: empty, or what a vehicle has instead, as a clause after its name."""
