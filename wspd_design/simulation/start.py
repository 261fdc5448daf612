"""Where a stop may start that does not start rolling: the torques there, and when the slip has left it."""

import math
from dataclasses import replace

from wspd_design.model.brake import demand_time, demanded_pressure
from wspd_design.model.generated import motion
from wspd_design.model.slip import slip_dynamics
from wspd_design.parameters.loading import constants
from wspd_design.parameters.records import Brake, Rail, Vehicle
from wspd_design.simulation.runs import Run

_FULL = 40.0  # time constants of the supply (8), after which it lacks less than the last digit of a float


def full_supply_time(brake: Brake) -> float:
    """Time after which the build-up of the brake demands the full pressure [s]."""
    if brake.build_up == "main-pipe":
        return _FULL / brake.supply_rate
    return float(demand_time(brake, brake.max_pressure))


def available_torque(brake: Brake, braking_time: float) -> float:
    """Torque per wheelset that the build-up allows at a time [s] since the brake was applied [N m]."""
    unit = replace(brake, max_pressure=1.0)
    return brake.max_torque * float(demanded_pressure(unit, braking_time))


def holding_torque(
    vehicle: Vehicle, rail: Rail, *, slip: float, speed: float, braking_time: float = 0.0, grade: float = 0.0
) -> float:
    """Torque per wheelset that keeps the slip where it is, -F/G of eq. (19) [N m].

    Parameters
    ----------
    vehicle, rail : Vehicle, Rail
        The quarter model and its friction.
    slip : float
        Slip ratio [-].
    speed : float
        Train speed, positive [m/s].
    braking_time : float
        Time since the brake was applied, by which the damping of the wheels has decayed [s].
    grade : float
        Rise over run, positive uphill [-].

    Returns
    -------
    float
        Above the largest torque of the brake where that cannot hold the slip, and negative where only a driven
        wheel would keep it.
    """
    damping = motion.wheel_damping(braking_time, vehicle.wheel_damping, vehicle.wheel_damping_decay)
    climbing = vehicle.mass * constants().gravity * grade
    present = replace(
        vehicle,
        wheel_damping=float(damping),
        resistance_constant=vehicle.resistance_constant + climbing,
    )
    found = slip_dynamics(present, rail, slip, speed)
    return -float(found.drift) / float(found.gain)


def leaving_time(run: Run, distance: float) -> float:
    """Time after which the slip of a wheelset is first so far from where it began [s]; NaN if it never is.

    Parameters
    ----------
    run : Run
        The stop.
    distance : float
        In slip [-].
    """
    import numpy as np

    away = np.flatnonzero((abs(run.slip - run.slip[0]) > distance).any(axis=1))
    return float(run.time[away[0]]) if away.size else math.nan
