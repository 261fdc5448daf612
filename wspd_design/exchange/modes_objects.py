"""Modes of a vehicle as plain data."""

from typing import TYPE_CHECKING, Any

from wspd_design.exchange.modes_forms import MODES
from wspd_design.exchange.version import program_version

if TYPE_CHECKING:
    from wspd_design.analysis.critical_speed import CriticalSpeed
    from wspd_design.analysis.modes import Mode
    from wspd_design.analysis.vehicle_modes import VehicleModes

_LEAST = 0.01  # share of the energy that is told


def modes_object(found: "VehicleModes") -> dict[str, Any]:
    """Return modes and critical speeds of a vehicle."""
    running = found.running
    return {
        "schema": MODES.schema,
        "vehicle": found.vehicle,
        "rail": found.rail,
        "speed_m_s": running.speed,
        "slip": found.slip,
        "conicity": found.conicity,
        "lateral_slope": found.lateral_slope,
        "acceleration_m_s2": running.acceleration,
        "torques_Nm": running.torques.tolist(),
        "loads_left_N": running.loads[:, 0].tolist(),
        "loads_right_N": running.loads[:, 1].tolist(),
        "modes": [_mode_object(mode) for mode in found.modes],
        "critical_speeds": [_critical_speed_object(each) for each in found.critical],
        "assumed_numbers": list(found.assumed),
        "remarks": list(found.remarks),
        "version": program_version(),
    }


def _mode_object(mode: "Mode") -> dict[str, Any]:
    return {
        "name": mode.name,
        "natural_frequency_Hz": mode.natural_frequency,
        "frequency_Hz": mode.frequency,
        "damping_ratio": mode.damping,
        "growth_per_s": mode.pole.real,
        "shares": [
            {"body": each.kind, "direction": each.direction, "share": each.share}
            for each in mode.shares
            if each.share >= _LEAST
        ],
    }


def _critical_speed_object(found: "CriticalSpeed") -> dict[str, Any]:
    return {
        "conicity": found.conicity,
        "speed_m_s": found.speed,
        "frequency_Hz": None if found.mode is None else found.mode.frequency,
        "mode": None if found.mode is None else found.mode.motion,
        "tried_from_m_s": found.tried[0],
        "tried_to_m_s": found.tried[1],
    }
