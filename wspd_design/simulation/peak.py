"""The adhesion peak of a rail over train speed, as a table."""

import math
from collections.abc import Sequence
from dataclasses import fields, replace
from functools import lru_cache
from typing import TYPE_CHECKING

from wspd_design.model import adhesion
from wspd_design.model.slip import static_wheel_load
from wspd_design.parameters.loading import constants
from wspd_design.parameters.records import Rail, Vehicle

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

_SPEEDS = 61  # of the table of peak slips: four times as many change a distance by less than 1e-6
_SLIPS = 48  # coarse grid on which the hump that holds the peak is found, evenly spaced in the logarithm
_LOWEST_SLIP = 1e-4
_SECTIONS = 9  # golden sections within the hump: to 0.3 % of the slip, where the peak is flat to 1e-6
_GOLDEN = (math.sqrt(5.0) - 1.0) / 2.0


def log_speeds(initial_speed: float) -> "Array":
    """Speeds of the tables, evenly spaced in their logarithm, from below the stop speed [m/s]."""
    import numpy as np

    return np.geomspace(0.5 * constants().stop_speed, 1.01 * initial_speed, _SPEEDS)


def peak_adhesion(
    vehicle: Vehicle, rail: Rail, speeds: "Array", *, load_share: float = 1.0
) -> "tuple[Array, Array]":
    """Slip at which the rail gives most, and the adhesion f/Q there, over train speed.

    The load is the static one, or a share of it.

    Below the regularization speed the slip is referred to that speed, as in the plant.
    """
    import numpy as np

    table, slips, peaks = _peak_table(vehicle, rail, max(float(np.max(speeds)), 1.0), load_share)
    logs = np.log(np.maximum(speeds, table[0]))
    return np.interp(logs, np.log(table), slips), np.interp(logs, np.log(table), peaks)


@lru_cache(maxsize=64)
def _peak_table(
    vehicle: Vehicle, rail: Rail, top_speed: float, load_share: float
) -> "tuple[Array, Array, Array]":
    """Train speeds, the slips of their adhesion peaks and the peaks."""
    speeds = log_speeds(top_speed)
    slips, peaks = best_slips([(vehicle, rail, load_share)], speeds)
    return speeds, slips[0], peaks[0]


def best_slips(lanes: Sequence[tuple[Vehicle, Rail, float]], speeds: "Array") -> "tuple[Array, Array]":
    """Slips at which rails give most under shares of the mean static load, and the adhesion there, one row a lane.

    The creep force may have two humps over slip: a coarse grid finds the higher one, golden sections its top.
    """
    import numpy as np

    def column(values: list[float]) -> "Array":
        return np.array(values)[:, np.newaxis, np.newaxis]

    loads = [share * float(static_wheel_load(vehicle)) for vehicle, _, share in lanes]
    load = column(loads)
    stiffness = column(
        [
            float(adhesion.contact_stiffness(vehicle.contact, each))
            for (vehicle, *_), each in zip(lanes, loads, strict=True)
        ]
    )
    names = [field.name for field in fields(Rail) if field.name not in ("name", "bounds")]
    numbers = {name: column([getattr(rail, name) for _, rail, _ in lanes]) for name in names}
    rail = replace(lanes[0][1], **numbers)  # type: ignore[arg-type]  # arrays are numbers as well
    v = speeds[np.newaxis, :, np.newaxis]
    referred = np.minimum(v / constants().slip_regularization_speed, 1.0)

    def force(logs: "Array") -> "Array":
        slips = np.exp(logs)
        return np.asarray(adhesion.creep_force(slips * referred, v * slips, load, rail, stiffness))

    grid = np.linspace(math.log(_LOWEST_SLIP), 0.0, _SLIPS)
    highest = force(grid[np.newaxis, np.newaxis, :]).argmax(axis=2, keepdims=True)
    low, high = grid[np.maximum(highest - 1, 0)], grid[np.minimum(highest + 1, _SLIPS - 1)]
    points = [high - _GOLDEN * (high - low), low + _GOLDEN * (high - low)]
    forces = [force(point) for point in points]
    for _ in range(_SECTIONS):
        left = forces[0] >= forces[1]
        low, high = np.where(left, low, points[0]), np.where(left, points[1], high)
        new = np.where(left, high - _GOLDEN * (high - low), low + _GOLDEN * (high - low))
        given = force(new)
        points = [np.where(left, new, points[1]), np.where(left, points[0], new)]
        forces = [np.where(left, given, forces[1]), np.where(left, forces[0], given)]
    left = forces[0] >= forces[1]
    slips, best = np.exp(np.where(left, *points)), np.where(left, *forces)
    return slips[:, :, 0], (best / load)[:, :, 0]
