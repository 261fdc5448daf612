"""How a stop holds its slip once it has reached the reference, and how long its brake takes to build up.

Before the slip gets to its reference no law can hold it there: what lies before counts for the build-up of the brake,
which even a perfect law waits for.
"""

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

from wspd_design.parameters.records import Vehicle
from wspd_design.plants.names import DEFAULT_PLANT
from wspd_design.simulation.ideal import ideal_run
from wspd_design.simulation.law_memory import slip_references
from wspd_design.simulation.loop_input import JUDGING_SPEED
from wspd_design.simulation.records import Scenario
from wspd_design.simulation.runs import Run

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

REACHED = 0.9  # of the reference
BUILT_UP = 0.9  # of the torque that the brake then holds


@dataclass(frozen=True, slots=True, kw_only=True)
class HeldSlip:
    """Slip less reference of the braked wheelsets, each from the moment it reached its reference to 10 km/h.

    NaN where no wheelset reached it.
    """

    reached: float  # s, of the first wheelset
    wheelsets: int  # that reached it
    rms: float  # -
    overshoot: float  # -, largest excess over the reference
    undershoot: float  # -, largest shortfall


def held_slip_of(run: Run, slip_reference: float) -> HeldSlip:
    """Judge how a stop holds its slip.

    Parameters
    ----------
    run : Run
        The stop.
    slip_reference : float
        Slip to be held [-], unless the law tells the slips that it holds: then those.
    """
    import numpy as np

    columns = [axle for axle, samples in enumerate(run.axle_samples) if samples]
    held = slip_references(run)
    weights = np.diff(run.time, append=run.time[-1])
    judged = run.speed > JUDGING_SPEED
    found: list[tuple[float, Array, Array]] = []
    for axle in columns:
        if held is None:
            wanted = np.full(len(run.time), slip_reference)
        else:
            wanted = np.interp(run.time, [sample.time for sample in run.samples], held[:, axle])
        slip = run.slip[:, axle]
        there = np.flatnonzero(judged & (slip >= REACHED * wanted) & (wanted > 0.0))
        if there.size:
            counted = judged & (np.arange(len(slip)) >= there[0])
            found.append((float(run.time[there[0]]), (slip - wanted)[counted], weights[counted]))
    if not found:
        return HeldSlip(reached=math.nan, wheelsets=0, rms=math.nan, overshoot=math.nan, undershoot=math.nan)
    errors, times = (np.concatenate([each[place] for each in found]) for place in (1, 2))
    total = float(times.sum())
    return HeldSlip(
        reached=min(each[0] for each in found),
        wheelsets=len(found),
        rms=math.sqrt(float((errors**2 * times).sum()) / total) if total else abs(float(errors[-1])),
        overshoot=max(float(errors.max()), 0.0),
        undershoot=max(float(-errors.min()), 0.0),
    )


@lru_cache(maxsize=64)
def perfect_hold(
    vehicle: Vehicle, scenario: Scenario, *, slip: float, plant: str = DEFAULT_PLANT
) -> HeldSlip | None:
    """Judge the brake that fills until a slip is reached and holds it then, in the same stop.

    What it misses no law can reach with this brake on this rail. None where no ideal stop is known.
    """
    run = ideal_run(vehicle, scenario, slip=slip, plant=plant)
    return None if run is None else held_slip_of(run, slip)


def build_up(run: Run) -> tuple[float, float]:
    """Return when the brake is built up, and the distance until then [s, m].

    It is where the torque of all wheelsets first reaches 90 % of its median over the time above 10 km/h. NaN for a stop
    that never is above.
    """
    import numpy as np

    judged = run.speed > JUDGING_SPEED
    if judged.sum() < 2:
        return math.nan, math.nan
    total = run.torque.sum(axis=1)
    even = np.linspace(run.time[0], run.time[judged][-1], len(run.time))  # events crowd the traces
    wanted = BUILT_UP * float(np.median(np.interp(even, run.time, total)))
    first = int(np.argmax(total >= wanted))
    return float(run.time[first]), float(run.distance[first])
