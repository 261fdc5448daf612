"""How the slip goes on during a stop: what one number for the whole stop does not tell."""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from wspd_design.simulation.loop_input import JUDGING_SPEED
from wspd_design.simulation.runs import Run

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from wspd_design.simulation.runs import Trace

STANDSTILL_SPEED = 1.0 / 3.6  # m/s, below it the slip of any wheel is arbitrary
TORQUE_SWING = 0.1  # of the maximum torque: a smaller movement is no cycle


@dataclass(frozen=True, slots=True, kw_only=True)
class SlipHistory:
    """Slip figures of parts of a stop, over all wheelsets; halves are those of the time above 10 km/h."""

    early_rms: float  # -, about the reference, first half
    late_rms: float  # -, second half
    late_ripple: float  # -, standard deviation about the mean of each wheelset, second half
    standstill_rms: float  # -, about the reference, from 10 to 1 km/h
    front_mean: float  # -, mean slip of the front bogie above 10 km/h
    rear_mean: float
    torque_frequency: float  # 1/s, cycles of the braking torque above 10 km/h


def slip_history(run: Run, *, slip_reference: float, max_torque: float) -> SlipHistory:
    """Work out how the slip of a stop goes on.

    Parameters
    ----------
    run : Run
        The stop.
    slip_reference : float
        Reference of the rms values [-].
    max_torque : float
        Of the brake, per wheelset [N m].
    """
    import numpy as np

    judged = run.speed > JUDGING_SPEED
    end = float(run.time[judged][-1])
    early, late = judged & (run.time <= 0.5 * end), judged & (run.time > 0.5 * end)
    slow = (run.speed <= JUDGING_SPEED) & (run.speed > STANDSTILL_SPEED)
    error = run.slip - slip_reference
    middle = -(-run.slip.shape[1] // 2)
    ripple = [_rms(run.time, column - _mean(run.time, column, late), late) for column in run.slip.T]
    cycles = [_cycles(column, TORQUE_SWING * max_torque) for column in run.torque[judged].T]
    return SlipHistory(
        early_rms=_rms(run.time, error, early),
        late_rms=_rms(run.time, error, late),
        late_ripple=float(np.mean(ripple)),
        standstill_rms=_rms(run.time, error, slow),
        front_mean=float(np.mean([_mean(run.time, column, judged) for column in run.slip.T[:middle]])),
        rear_mean=float(np.mean([_mean(run.time, column, judged) for column in run.slip.T[-middle:]])),
        torque_frequency=float(np.mean(cycles)) / end,
    )


def _mean(time: "Trace", values: "Trace", during: "NDArray[np.bool_]") -> float:
    import numpy as np

    return float(np.trapezoid(values[during], time[during]) / np.ptp(time[during]))


def _rms(time: "Trace", values: "Trace", during: "NDArray[np.bool_]") -> float:
    """Root mean square over a part of the time, over all columns."""
    import numpy as np

    squares = np.square(values) if values.ndim == 1 else np.mean(np.square(values), axis=1)
    return math.sqrt(_mean(time, squares, during)) if np.count_nonzero(during) > 1 else math.nan


def _cycles(values: "Trace", swing: float) -> float:
    """Count rises and falls by more than the swing, as whole cycles."""
    turns, low, high, rising = 0, values[0], values[0], True
    for value in values.tolist():
        if rising and value < high - swing:
            turns, low, rising = turns + 1, value, False
        elif not rising and value > low + swing:
            turns, high, rising = turns + 1, value, True
        low, high = min(low, value), max(high, value)
    return turns / 2.0
