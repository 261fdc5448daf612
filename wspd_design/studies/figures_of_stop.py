"""The criteria of a single stop, by the same rules as those of many."""

import math

from wspd_design.design.criteria import CRITERIA
from wspd_design.simulation.comparison import Trial
from wspd_design.simulation.loop_input import JUDGING_SPEED
from wspd_design.simulation.runs import Ending, Run

SHARE = 0.1  # of the torque that a wheelset holds, below which it hardly brakes


def figures_of_stop(trial: Trial, full_adhesion: float) -> dict[str, float]:
    """Return what a stop reaches of each criterion; those that it has no figure for are left out.

    Parameters
    ----------
    trial : Trial
        The stop.
    full_adhesion : float
        Distance of the same stop while no wheel slides [m].
    """
    import numpy as np

    figures, time = trial.metrics, trial.metrics.stopping_time
    columns = {
        "stopped": trial.run.ending is Ending.STOPPED,
        "efficiency": figures.efficiency,
        "distance_m": figures.distance,
        "longest_lock_s": figures.judged_lock,
        "valve_switches_per_s": figures.valve_switches / time if time else math.nan,
        "vented_air": figures.vented_air,
        "slip_band": figures.slip_band,
        "speed_error": figures.speed_error,
        "distance_error": figures.distance_error,
        "held_slip_rms": figures.held_slip_rms,
        "slip_overshoot": figures.slip_overshoot,
        "slip_undershoot": figures.slip_undershoot,
        "adhesion_utilization": figures.adhesion_utilization,
        "extension": figures.distance / full_adhesion - 1.0,
        "longest_release_s": longest_release(trial.run),
    }
    arrays = {name: np.array([value]) for name, value in columns.items()}
    found = {name: rule.of(arrays) for name, rule in CRITERIA.items()}
    return {name: value for name, value in found.items() if value is not None and math.isfinite(value)}


def longest_release(run: Run) -> float:
    """Longest time above 10 km/h for which a wheelset transmits less than a tenth of its median torque [s].

    It counts from the moment at which the wheelset first transmits more.
    """
    import numpy as np

    judged = run.speed > JUDGING_SPEED
    longest = 0.0
    for axle, samples in enumerate(run.axle_samples):
        if not samples or judged.sum() < 2:
            continue
        torque = run.torque[:, axle]
        least = SHARE * float(np.median(torque[judged]))
        built_up = np.arange(len(torque)) >= int(np.argmax(torque > least))
        released = (judged & built_up & (torque < least)).astype(int)
        edges = np.flatnonzero(np.diff(released, prepend=0, append=0)).reshape(-1, 2)
        longest = max((longest, *(float(run.time[end - 1] - run.time[begin]) for begin, end in edges)))
    return longest
