"""The adhesion peak of a rail over train speed, as a table."""

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

_SPEEDS, _SLIPS = 241, 1001  # grid of the table of peak slips; the peak is flat


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
    import numpy as np

    load = load_share * float(static_wheel_load(vehicle))
    stiffness = adhesion.contact_stiffness(vehicle.contact, load)
    speeds = log_speeds(top_speed)
    slips = np.geomspace(1e-4, 1.0, _SLIPS)
    v, s = speeds[:, np.newaxis], slips[np.newaxis, :]
    referred = s * np.minimum(v / constants().slip_regularization_speed, 1.0)
    forces = adhesion.creep_force(referred, v * s, load, rail, stiffness)
    best = forces.argmax(axis=1)
    return speeds, slips[best], forces[np.arange(len(speeds)), best] / load
