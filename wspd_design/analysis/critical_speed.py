"""Speeds from which a rolling vehicle hunts: an oscillation of its wheelsets that no longer dies away."""

from collections.abc import Sequence
from dataclasses import dataclass

from wspd_design.analysis.modes import Mode, modes, poles
from wspd_design.analysis.running import RunningVehicle, steady

STEP = 2.5  # m/s, between the speeds that are tried
_RESOLUTION = 0.01  # m/s


@dataclass(frozen=True, slots=True, kw_only=True)
class CriticalSpeed:
    """The lowest speed of a range, tried in steps, from which a mode that oscillates grows."""

    conicity: float  # -
    speed: float | None  # m/s; None: no mode that oscillates grows at the speeds that were tried
    mode: Mode | None  # that grows there
    tried: tuple[float, float]  # m/s


def critical_speed(vehicle: RunningVehicle, *, speeds: tuple[float, float] = (5.0, 120.0)) -> CriticalSpeed:
    """Find the critical speed of a vehicle that rolls freely, for deviations without size.

    The growth is looked at every :data:`STEP`, and where it first turns positive the speed is halved in to 0.01 m/s. A
    range of growth between two of these speeds would be missed. Flanges and large creepages are not in it: a vehicle
    may keep on hunting below this speed after a large disturbance.

    Parameters
    ----------
    vehicle : RunningVehicle
        With its conicity.
    speeds : tuple of float
        Lowest and highest speed that are tried [m/s].
    """
    import numpy as np

    low, high = speeds
    conicity = float(vehicle.model.numbers["conicity"])
    stable: float | None = None
    for speed in np.append(np.arange(low, high, STEP), high).tolist():
        if _growth(vehicle, speed) > 0.0:
            found = speed if stable is None else _first_growth(vehicle, stable, speed)
            return CriticalSpeed(
                conicity=conicity, speed=found, mode=_growing(vehicle, found), tried=(low, speed)
            )
        stable = speed
    return CriticalSpeed(conicity=conicity, speed=None, mode=None, tried=(low, high))


def critical_speeds(
    vehicle: RunningVehicle, conicities: Sequence[float], *, speeds: tuple[float, float] = (5.0, 120.0)
) -> tuple[CriticalSpeed, ...]:
    """Find the critical speed on each of several cones."""
    return tuple(critical_speed(vehicle.with_conicity(each), speeds=speeds) for each in conicities)


def _growth(vehicle: RunningVehicle, speed: float) -> float:
    """Growth of the fastest growing mode that oscillates [1/s]."""
    found = poles(steady(vehicle, speed).motion)
    return float(max(pole.real for pole in found if pole.imag > 0.0))


def _first_growth(vehicle: RunningVehicle, stable: float, growing: float) -> float:
    while growing - stable > _RESOLUTION:
        middle = 0.5 * (stable + growing)
        if _growth(vehicle, middle) > 0.0:
            growing = middle
        else:
            stable = middle
    return growing


def _growing(vehicle: RunningVehicle, speed: float) -> Mode:
    found = [mode for mode in modes(steady(vehicle, speed).motion) if mode.oscillates]
    return max(found, key=lambda mode: mode.pole.real)
