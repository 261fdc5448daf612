"""The largest open-loop slip pole over the speeds of operation, and what the rate of the valve says about it."""

from typing import NamedTuple

from wspd_design.codegen.functions import slip_plant
from wspd_design.parameters.records import Rail, Vehicle

SPEEDS = 60  # on which it is looked for, in a geometric row


class LargestPole(NamedTuple):
    """The fastest growth of the slip, of the nominal vehicle and rail."""

    pole: float  # 1/s, negative where the slip returns by itself at all speeds
    speed: float  # m/s


def largest_slip_pole(
    vehicle: Vehicle, rail: Rail, *, slip: float, speeds: tuple[float, float]
) -> LargestPole:
    """Return the largest slip pole at a slip, on a row of speeds; nothing is said about those between.

    Parameters
    ----------
    vehicle, rail : Vehicle, Rail
        Quarter model and friction, with their nominal numbers.
    slip : float
        Slip ratio in (0, 1).
    speeds : (float, float)
        Range of train speeds [m/s].
    """
    import numpy as np

    plant, found = slip_plant(vehicle, rail), []
    for speed in np.geomspace(*speeds, SPEEDS):
        drift, gain = (float(x) for x in plant.drift_and_gain(slip, speed))
        a, _ = plant.jacobians(slip, -drift / gain, speed, 0.5)  # the pole does not depend on the duty
        found.append(LargestPole(pole=float(a[0, 0]), speed=float(speed)))
    return max(found)


def valve_rate(vehicle: Vehicle) -> float:
    """Return the largest rate with which the pressure follows the averaged valve [1/s]: no share makes it faster."""
    return 1.0 / min(vehicle.brake.fill_time, vehicle.brake.vent_time)
