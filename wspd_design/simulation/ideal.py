"""Ideal stops: simulations of a brake that holds the best slip, the yardstick of every simulated stop.

An ideal brake never lets the slip exceed a given one. It fills until the slip gets there and from then on passes
on what keeps it there, unless even the filling brake cannot give that. By default it holds the slip of the adhesion
peak. Nothing is proved here: what no controller can beat is decided by the check ``stop_bound``.
"""

import math
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import TYPE_CHECKING

from wspd_design.controllers.baselines.unprotected import Unprotected
from wspd_design.model import adhesion
from wspd_design.model.slip import static_wheel_load
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import constants
from wspd_design.parameters.records import Rail, Vehicle
from wspd_design.plants.names import DEFAULT_PLANT, plant_of
from wspd_design.simulation.loop_input import loop_input
from wspd_design.simulation.records import Ending, Scenario, Start
from wspd_design.simulation.stop import run_loop

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

_SPEEDS, _SLIPS = 241, 1001  # grid of the table of peak slips; the peak is flat
_AT_ONCE = 1e9  # 1/s: a supply that is there at once
_INSTANT = 1e-6  # s: a cylinder that fills at once
_SAMPLE_TIME = 0.1  # s: the unprotected brake fills whatever it samples

NO_IDEAL_STOP = "even a brake that holds the best slip is still moving at the time limit"
"""What to say of a train that cannot stop, in place of a distance."""


@dataclass(frozen=True, slots=True, kw_only=True)
class IdealStop:
    """Time and distance of an idealized stop; NaN where even the ideal brake does not stop the train."""

    name: str
    ending: Ending
    distance: float  # m
    stopping_time: float  # s


@lru_cache(maxsize=64)
def ideal_stop(
    vehicle: Vehicle,
    scenario: Scenario,
    *,
    slip: float | None = None,
    instantaneous: bool = False,
    plant: str = DEFAULT_PLANT,
) -> IdealStop:
    """Stop at the adhesion peak or at a constant slip.

    Parameters
    ----------
    vehicle : Vehicle
        The vehicle.
    scenario : Scenario
        Rails, initial speed and grade.
    slip : float, optional
        Slip that is not exceeded; that of the adhesion peak at each speed by default.
    instantaneous : bool
        Full torque from the start, in place of the build-up of eqs. (8), (9).
    plant : {"four-axle", "quarter"}
        With or without load transfer.

    Returns
    -------
    IdealStop
        Without ``slip`` its distance is that of the brake that holds the best slip. A train that is still moving
        at the time limit has neither distance nor time.

    Raises
    ------
    UserError
        For a change of rail along the track: its peak slip is not known in advance. For a stop that does not
        start rolling with empty cylinders.
    """
    import numpy as np

    if scenario.start != Start():
        raise UserError(
            "the ideal stop is known where a stop starts rolling with empty cylinders; leave start out"
        )
    if scenario.patches:
        raise UserError(
            "the ideal stop is not known for a change of rail along the track; leave the patches out"
        )
    if instantaneous:
        brake = replace(vehicle.brake, supply_rate=_AT_ONCE, fill_time=_INSTANT)
        vehicle = replace(vehicle, brake=brake)
    filling = Unprotected(name="ideal", sample_time=_SAMPLE_TIME)
    braked = plant_of(plant, vehicle)
    given = loop_input([(braked, scenario)], filling)
    rails = scenario.axle_rails or (scenario.rail,) * braked.axles
    speeds = _speeds(scenario.initial_speed)
    slips = {rail: _held_slips(vehicle, rail, speeds, slip) for rail in set(rails)}
    given = replace(
        given,
        held_slips=np.array([slips[rail] for rail in rails]),
        held_speeds=(float(speeds[0]), float(speeds[1])),
    )
    output, _ = run_loop(braked, filling, scenario, given)
    what = "adhesion peak" if slip is None else f"constant slip {slip:g}"
    build_up = "full torque at once" if instantaneous else "with brake build-up"
    stopped = bool(output.stopped[0])
    return IdealStop(
        name=f"{what}, {build_up}",
        ending=Ending.STOPPED if stopped else Ending.TIME_LIMIT,
        distance=float(output.stop_totals["distance"][0]) if stopped else math.nan,
        stopping_time=float(output.stop_totals["time"][0]) if stopped else math.nan,
    )


def _speeds(initial_speed: float) -> "Array":
    import numpy as np

    return np.geomspace(0.5 * constants().stop_speed, 1.01 * initial_speed, _SPEEDS)


def _held_slips(vehicle: Vehicle, rail: Rail, speeds: "Array", slip: float | None) -> "Array":
    """Slip to be held over speed: constant, or where the adhesion under the static load is greatest."""
    import numpy as np

    return np.full(len(speeds), slip) if slip is not None else peak_adhesion(vehicle, rail, speeds)[0]


def peak_adhesion(vehicle: Vehicle, rail: Rail, speeds: "Array") -> "tuple[Array, Array]":
    """Slip at which the rail gives most, and the adhesion f/Q there, over train speed under the static load.

    Below the regularization speed the slip is referred to that speed, as in the plant.
    """
    import numpy as np

    table, slips, peaks = _peak_table(vehicle, rail, max(float(np.max(speeds)), 1.0))
    logs = np.log(np.maximum(speeds, table[0]))
    return np.interp(logs, np.log(table), slips), np.interp(logs, np.log(table), peaks)


@lru_cache(maxsize=64)
def _peak_table(vehicle: Vehicle, rail: Rail, top_speed: float) -> "tuple[Array, Array, Array]":
    """Train speeds, the slips of their adhesion peaks and the peaks."""
    import numpy as np

    load = float(static_wheel_load(vehicle))
    stiffness = adhesion.contact_stiffness(vehicle.contact, load)
    speeds = _speeds(top_speed)
    slips = np.geomspace(1e-4, 1.0, _SLIPS)
    v, s = speeds[:, np.newaxis], slips[np.newaxis, :]
    referred = s * np.minimum(v / constants().slip_regularization_speed, 1.0)
    forces = adhesion.creep_force(referred, v * s, load, rail, stiffness)
    best = forces.argmax(axis=1)
    return speeds, slips[best], forces[np.arange(len(speeds)), best] / load
