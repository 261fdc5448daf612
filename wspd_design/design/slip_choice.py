"""Which constant slip loses least distance on a rail: what a perfect brake would need with each."""

import math
from functools import lru_cache
from typing import NamedTuple

from wspd_design.parameters.records import Rail, Vehicle
from wspd_design.simulation.ideal import ideal_stop
from wspd_design.simulation.records import Scenario

MOST = 0.3  # slip beyond which none is tried
_SLIPS = tuple(round(0.01 * each, 2) for each in range(1, round(100 * MOST) + 1))


class BestSlip(NamedTuple):
    """The slip, of whole percents up to 30 %, that stops shortest if it is held all the way."""

    slip: float  # -
    distance: float  # m
    at_the_peak: float  # m, of the stop that follows the adhesion peak at all speeds


@lru_cache(maxsize=128)
def held_distance(vehicle: Vehicle, rail: Rail, speed: float, slip: float | None) -> float:
    """Return the distance of the ideal stop from a speed [m/s] that never exceeds a slip, or the peak of the adhesion.

    It is NaN for a train that does not stop [m].
    """
    return ideal_stop(vehicle, Scenario(rail=rail, initial_speed=speed), slip=slip).distance


@lru_cache(maxsize=32)
def best_constant_slip(vehicle: Vehicle, rail: Rail, speed: float) -> BestSlip:
    """Return the constant slip with the shortest ideal stop from a speed [m/s]; the least of equal ones."""
    distances = {slip: held_distance(vehicle, rail, speed, slip) for slip in _SLIPS}
    best = min(distances, key=lambda slip: (math.isnan(distances[slip]), distances[slip]))
    return BestSlip(
        slip=best, distance=distances[best], at_the_peak=held_distance(vehicle, rail, speed, None)
    )
