"""Ideal stops: simulations of a brake that holds the best slip, the yardstick of every simulated stop.

An ideal brake never lets the slip exceed a given one. It fills until the slip gets there and from then on passes
on what keeps it there, unless even the filling brake cannot give that. By default it holds the slip of the adhesion
peak. Nothing is proved here: what no controller can beat is decided by the check ``stop_bound``.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from functools import lru_cache
from typing import TYPE_CHECKING

from wspd_design.codegen.loop_numbers import LoopInput
from wspd_design.controllers.baselines.unprotected import Unprotected
from wspd_design.model import adhesion
from wspd_design.model.slip import static_wheel_load
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import constants
from wspd_design.parameters.records import Rail, Vehicle
from wspd_design.plants.names import DEFAULT_PLANT, plant_of
from wspd_design.plants.protocol import Plant
from wspd_design.simulation.loop_input import loop_input
from wspd_design.simulation.records import Ending, Scenario, Start
from wspd_design.simulation.stop import run_loop

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

_SPEEDS = 61  # of the table of peak slips: four times as many change a distance by less than 1e-6
_SLIPS = 48  # coarse grid on which the hump that holds the peak is found, evenly spaced in the logarithm
_LOWEST_SLIP = 1e-4
_SECTIONS = 9  # golden sections within the hump: to 0.3 % of the slip, where the peak is flat to 1e-6
_GOLDEN = (math.sqrt(5.0) - 1.0) / 2.0
_AT_ONCE = 1e9  # 1/s: a supply that is there at once
_INSTANT = 1e-6  # s: a cylinder that fills at once

FILLING = Unprotected(name="ideal", sample_time=0.1)
"""Law of an ideal brake, which fills whatever it samples."""
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
    braked = plant_of(plant, vehicle)
    output, _ = run_loop(braked, FILLING, scenario, ideal_input([(braked, scenario)], slip=slip))
    what = "adhesion peak" if slip is None else f"constant slip {slip:g}"
    build_up = "full torque at once" if instantaneous else "with brake build-up"
    stopped = bool(output.stopped[0])
    return IdealStop(
        name=f"{what}, {build_up}",
        ending=Ending.STOPPED if stopped else Ending.TIME_LIMIT,
        distance=float(output.stop_totals["distance"][0]) if stopped else math.nan,
        stopping_time=float(output.stop_totals["time"][0]) if stopped else math.nan,
    )


def ideal_input(cases: Sequence[tuple[Plant, Scenario]], *, slip: float | None = None) -> LoopInput:
    """Numbers of one or several ideal stops for the closed loop; those of one campaign share a table of speeds."""
    import numpy as np

    speeds = _speeds(max(scenario.initial_speed for _, scenario in cases))
    rails = [scenario.axle_rails or (scenario.rail,) * plant.axles for plant, scenario in cases]
    lanes = [
        (plant.vehicle, rails[k][axle]) for axle in range(len(rails[0])) for k, (plant, _) in enumerate(cases)
    ]
    if slip is None:
        alike = list(dict.fromkeys(lanes))
        found = dict(zip(alike, best_slips(alike, speeds)[0], strict=True))
        held = np.array([found[lane] for lane in lanes])
    else:
        held = np.full((len(lanes), len(speeds)), slip)
    return replace(
        loop_input(cases, FILLING), held_slips=held, held_speeds=(float(speeds[0]), float(speeds[1]))
    )


def _speeds(initial_speed: float) -> "Array":
    import numpy as np

    return np.geomspace(0.5 * constants().stop_speed, 1.01 * initial_speed, _SPEEDS)


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
    speeds = _speeds(top_speed)
    slips, peaks = best_slips([(vehicle, rail)], speeds)
    return speeds, slips[0], peaks[0]


def best_slips(lanes: Sequence[tuple[Vehicle, Rail]], speeds: "Array") -> "tuple[Array, Array]":
    """Slips at which rails give most under the static load, and the adhesion there, one row a lane.

    The creep force may have two humps over slip: a coarse grid finds the higher one, golden sections its top.
    """
    import numpy as np

    def column(values: list[float]) -> "Array":
        return np.array(values)[:, np.newaxis, np.newaxis]

    loads = [float(static_wheel_load(vehicle)) for vehicle, _ in lanes]
    load = column(loads)
    stiffness = column(
        [
            float(adhesion.contact_stiffness(vehicle.contact, each))
            for (vehicle, _), each in zip(lanes, loads, strict=True)
        ]
    )
    names = [field.name for field in fields(Rail) if field.name not in ("name", "bounds")]
    numbers = {name: column([getattr(rail, name) for _, rail in lanes]) for name in names}
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
