"""Ideal stops: simulations of a brake that holds the best slip, the yardstick of every simulated stop.

An ideal brake never lets the slip exceed a given one. It fills until the slip gets there and from then on passes
on what keeps it there, unless even the filling brake cannot give that. Its electrodynamic part never drops out, and its
pads warm up as if they took all that it offers. By default it holds the slip of the adhesion
peak. Nothing is proved here: what no controller can beat is decided by the check ``stop_bound``.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import TYPE_CHECKING

from wspd_design.codegen.loop_numbers import LoopInput
from wspd_design.controllers.baselines.unprotected import Unprotected
from wspd_design.model.slip import static_wheel_load
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.records import Vehicle
from wspd_design.parameters.taken import check_record
from wspd_design.plants.names import DEFAULT_PLANT, plant_of
from wspd_design.plants.protocol import Plant, is_coupled
from wspd_design.simulation.loop_input import loop_input
from wspd_design.simulation.peak import best_slips, log_speeds
from wspd_design.simulation.records import Scenario, Start
from wspd_design.simulation.runaway import runs_away
from wspd_design.simulation.runs import Ending, Run
from wspd_design.simulation.stop import run_loop, run_record, traced

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

_LONGEST_STEP = 20e-3  # s; a wheel that is held at a slip has no fast motion of its own
_AT_ONCE = 1e9  # 1/s: a supply that is there at once
_INSTANT = 1e-6  # s: a cylinder that fills at once

FILLING = Unprotected(name="ideal", sample_time=0.1)
"""Law of an ideal brake, which fills whatever it samples."""
NO_IDEAL_STOP = {
    Ending.TIME_LIMIT: "even a brake that holds the best slip is still moving at the time limit",
    Ending.RUNAWAY: "the grade pulls harder than rail and resistance can hold",
}
"""What to say of a train that cannot stop, in place of a distance."""


@dataclass(frozen=True, slots=True, kw_only=True)
class IdealStop:
    """Time and distance of an idealized stop; NaN where even the ideal brake does not stop the train.

    Attributes
    ----------
    name : str
    ending : Ending
    distance : float [m]
    stopping_time : float [s]
    """

    name: str
    ending: Ending
    distance: float
    stopping_time: float


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
    plant : {"planar", "quarter", "locomotive", "locomotive-linear"}
        With load transfer, without, or with all degrees of freedom.

    Returns
    -------
    IdealStop
        Without ``slip`` its distance is that of the brake that holds the best slip. A train that cannot stop, or
        is still moving at the time limit, has neither distance nor time.

    Raises
    ------
    UserError
        For a change of rail along the track: its peak slip is not known in advance. For a stop that does not
        start rolling with empty cylinders, and for a coupled plant, whose wheelsets no brake of the loop holds.
    """
    import numpy as np

    check_record(vehicle, Vehicle, by="ideal_stop", remedy='load it with load_vehicle("er24pc")')
    remedy = "make one with Scenario.stop(from_kmh=120, rail=rail)"
    check_record(scenario, Scenario, by="ideal_stop", remedy=remedy)
    if is_coupled(plant_of(plant, vehicle)):
        raise UserError(f'the ideal stop is not known on plant "{plant}"; take the plant "{DEFAULT_PLANT}"')
    if scenario.start != Start():
        raise UserError(
            "the ideal stop is known where a stop starts rolling with empty cylinders; leave start out"
        )
    if scenario.patches:
        raise UserError(
            "the ideal stop is not known for a change of rail along the track; leave the patches out"
        )
    what = "adhesion peak" if slip is None else f"constant slip {slip:g}"
    name = f"{what}, {'full torque at once' if instantaneous else 'with brake build-up'}"
    if runs_away(vehicle, scenario):
        return IdealStop(name=name, ending=Ending.RUNAWAY, distance=math.nan, stopping_time=math.nan)
    if instantaneous:
        brake = replace(
            vehicle.brake,
            build_up="main-pipe",
            valve="lag",
            supply_rate=_AT_ONCE,
            fill_time=_INSTANT,
            reservoir_volume=0.0,
        )
        vehicle = replace(vehicle, brake=brake)
    braked = plant_of(plant, vehicle)
    given = ideal_input([(braked, scenario)], slip=slip)
    if instantaneous:  # full from the start, so that no step has to find the filling
        given = replace(given, pressures=np.full(len(given.pressures), vehicle.brake.max_pressure))
    output, _ = run_loop(braked, FILLING, scenario, given)
    stopped = bool(output.stopped[0])
    return IdealStop(
        name=name,
        ending=Ending.STOPPED if stopped else Ending.TIME_LIMIT,
        distance=float(output.stop_totals["distance"][0]) if stopped else math.nan,
        stopping_time=float(output.stop_totals["time"][0]) if stopped else math.nan,
    )


def ideal_run(vehicle: Vehicle, scenario: Scenario, *, slip: float, plant: str = DEFAULT_PLANT) -> Run | None:
    """Return the traces of the stop whose slip is not exceeded; None where none is known."""
    braked = plant_of(plant, vehicle)
    if scenario.start != Start() or scenario.patches or is_coupled(braked) or runs_away(vehicle, scenario):
        return None
    calm = replace(scenario, faults=())
    output, engine = run_loop(braked, FILLING, calm, traced(ideal_input([(braked, calm)], slip=slip)))
    return run_record(braked, FILLING, calm, output, engine)


def ideal_input(cases: Sequence[tuple[Plant, Scenario]], *, slip: float | None = None) -> LoopInput:
    """Numbers of one or several ideal stops for the closed loop; those of one campaign share a table of speeds."""
    import numpy as np

    speeds = log_speeds(max(scenario.initial_speed for _, scenario in cases))
    rails = [scenario.axle_rails or (scenario.rail,) * plant.axles for plant, scenario in cases]
    loads = [_load_shares(plant) for plant, _ in cases]
    lanes = [
        (plant.vehicle, rails[k][axle], loads[k][axle])
        for axle in range(len(rails[0]))
        for k, (plant, _) in enumerate(cases)
    ]
    if slip is None:
        alike = list(dict.fromkeys(lanes))
        found = dict(zip(alike, best_slips(alike, speeds)[0], strict=True))
        held = np.array([found[lane] for lane in lanes])
    else:
        held = np.full((len(lanes), len(speeds)), slip)
    staying = [
        (plant.on(_without_drop_out(plant.vehicle)), replace(scenario, faults=()))
        for plant, scenario in cases
    ]
    numbers = loop_input(staying, FILLING, longest_step=_LONGEST_STEP)
    return replace(numbers, held_slips=held, held_speeds=(float(speeds[0]), float(speeds[1])))


def _without_drop_out(vehicle: Vehicle) -> Vehicle:
    """The same vehicle with an electrodynamic brake that stays whatever the slip, which is never above 1."""
    dynamic = vehicle.dynamic
    return vehicle if dynamic is None else replace(vehicle, dynamic=replace(dynamic, drop_slip=1.0))


def _load_shares(plant: Plant) -> list[float]:
    """Load of each axle before any load moves, over the mean static load."""
    mean = static_wheel_load(plant.vehicle)
    return [load / mean for load in plant.loads_at_rest()]
