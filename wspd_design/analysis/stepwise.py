"""Stopping distances by small steps in time: wheels that roll, forces that change with speed and time.

The rules of EN 14531 by steps, for brakes that have no mean value: pads that fade over speed, an electrodynamic brake
that is blended in, magnets. Nothing slides here.
"""

import math
from collections.abc import Callable
from dataclasses import replace

from wspd_design.model import further_brakes
from wspd_design.model.brake import Valve, braking_torque, pressure_after
from wspd_design.model.slip import resistance
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import constants
from wspd_design.parameters.records import Vehicle

STEP = 0.02
"""Of the steps [s]: halving it changes a distance by less than 1e-4."""


def march(
    speed: float, deceleration: Callable[[float, float], float], *, step: float = STEP
) -> tuple[float, float]:
    """Stop from a speed under a deceleration that depends on time and speed.

    Parameters
    ----------
    speed : float
        Initial speed [m/s].
    deceleration : callable
        (time [s], speed [m/s]) -> m/s2, called once at the beginning of every step and once at its end.
    step : float
        Length of the steps [s].

    Returns
    -------
    tuple of float
        Distance [m] and time [s].

    Raises
    ------
    UserError
        If the vehicle does not stop within the time limit of a stop.
    """
    time = distance = 0.0
    limit = constants().time_limit
    while time < limit:
        first = deceleration(time, speed)
        second = deceleration(time + step, max(speed - first * step, 0.0))
        slowed = 0.5 * (first + second)
        if slowed * step >= speed:
            last = speed / slowed
            return distance + 0.5 * speed * last, time + last
        distance += (speed - slowed * step / 2.0) * step
        speed, time = speed - slowed * step, time + step
    raise UserError(
        f"the vehicle still runs at {3.6 * speed:.3g} km/h after {limit:g} s: the brake does not hold it; choose a "
        "stronger brake or a smaller grade"
    )


class _Brakes:
    """The brakes of a vehicle whose wheels roll, from one step to the next."""

    def __init__(self, vehicle: Vehicle, *, built_up: bool) -> None:
        self.vehicle, self.built_up = vehicle, built_up
        self.time = self.pressure = self.warmth = 0.0
        self.level = 0.0

    def force(self, time: float, speed: float) -> float:
        """Force at the rims and of the magnets at a time, up to which the last step goes [N]."""
        vehicle = self.vehicle
        wheel_speed, elapsed = speed / vehicle.wheel_radius, time - self.time
        dynamic = 0.0
        if vehicle.dynamic is not None:
            tau = vehicle.dynamic.build_up_time
            self.level = 1.0 if self.built_up else further_brakes.build_up(elapsed, self.level, 1.0, tau)
            dynamic = self.level * further_brakes.dynamic_torque(
                vehicle.dynamic, wheel_speed, vehicle.wheel_radius
            )
        friction = self._friction(time, dynamic, speed)
        self.time = time
        pull = 0.0
        if vehicle.track_brake is not None:
            since = math.inf if self.built_up else time
            pull = further_brakes.track_brake_force(vehicle.track_brake, speed, since)
        braked = sum(vehicle.brake_shares)
        return braked * (friction + dynamic) / vehicle.wheel_radius + pull

    def _friction(self, time: float, dynamic: float, speed: float) -> float:
        """Torque of the friction brake of one wheelset [N m]."""
        vehicle, brake = self.vehicle, self.vehicle.brake
        share = further_brakes.friction_share(dynamic, brake.max_torque)
        asked = replace(brake, max_pressure=share * brake.max_pressure)
        if self.built_up:
            self.pressure = asked.max_pressure
        else:
            self.pressure = pressure_after(asked, Valve.FILL, time, self.time, self.pressure)
        torque: float = braking_torque(brake, self.pressure)
        if vehicle.pads is None:
            return torque
        torque *= further_brakes.pad_factor(vehicle.pads, speed, self.warmth)
        if vehicle.pads.temperatures:
            turning = speed / vehicle.wheel_radius
            rate = further_brakes.pad_warming(vehicle.pads, torque, turning, self.warmth)
            self.warmth += rate * (time - self.time)
        return torque


def rolling_stop(
    vehicle: Vehicle, speed: float, *, grade: float = 0.0, built_up: bool = False, step: float = STEP
) -> tuple[float, float]:
    """Stop a vehicle whose wheels roll.

    Parameters
    ----------
    vehicle : Vehicle
        With all its brakes fully applied, each of them braking every axle that has a brake.
    speed : float
        Initial speed [m/s].
    grade : float
        Rise over run, positive uphill [-].
    built_up : bool
        All brakes are built up from the start.
    step : float
        Length of the steps [s].

    Returns
    -------
    tuple of float
        Distance [m] and time [s].

    Raises
    ------
    UserError
        If the brakes do not hold the vehicle on the grade.
    """
    brakes = _Brakes(vehicle, built_up=built_up)
    climbing = vehicle.mass * constants().gravity * grade
    whole = vehicle.mass + vehicle.wheelsets * vehicle.wheelset_inertia / vehicle.wheel_radius**2

    def deceleration(time: float, speed: float) -> float:
        return (brakes.force(time, speed) + resistance(vehicle, speed, climbing)) / whole

    return march(speed, deceleration, step=step)
