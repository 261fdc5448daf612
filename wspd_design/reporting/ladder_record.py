"""The same stop on several models as plain data."""

from typing import Any

from wspd_design.studies.ladder import Ladder
from wspd_design.studies.rung import AxleFigures, Rung


def rungs_object(found: Ladder) -> dict[str, Any]:
    """Return the stop on each model and how far each model is from the last one."""
    return {
        "remark": found.remark,
        "rungs": [_rung(each) for each in found.rungs],
        "agreements": [
            {
                "measure": each.measure.name,
                "tolerance": each.measure.tolerance,
                "deviations": list(each.deviations),
                "suffices": found.rungs[each.suffices].title,
            }
            for each in found.agreements
        ],
    }


def _rung(rung: Rung) -> dict[str, Any]:
    return {
        "title": rung.title,
        "plant": rung.plant,
        "distance_m": rung.metrics.distance,
        "stopping_time_s": rung.metrics.stopping_time,
        "slip_mean": rung.metrics.slip_mean,
        "axles": [_axle(each) for each in rung.axles],
        "distance_spread_m": rung.spread,
        "step_change": rung.step_change,
    }


def _axle(axle: AxleFigures) -> dict[str, float]:
    return {
        "slip_mean": axle.slip_mean,
        "slip_max": axle.slip_max,
        "static_load_N": axle.static_load,
        "braking_load_N": axle.braking_load,
        "wheel_load_spread_N": axle.load_spread,
        "least_load_N": axle.least_load,
        "longest_lock_s": axle.lock,
        "vibration_m_s": axle.vibration,
        "vibration_frequency_Hz": axle.vibration_frequency,
        "vibration_speed_m_s": axle.vibration_speed,
        "vibration_slip": axle.vibration_slip,
    }
