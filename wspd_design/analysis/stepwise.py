"""Stopping distances by small steps in time: wheels that roll, forces that change with speed and time.

The rules of EN 14531 by steps, for brakes that have no mean value: pads that fade over speed, an electrodynamic brake
that is blended in, magnets. Nothing slides here.
"""

import math
from collections import Counter
from collections.abc import Callable

from wspd_design.model import further_brakes
from wspd_design.model.brake import braking_torque, pattern_pressure
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


class _Axle:
    """The brakes of a wheelset that rolls, from one step to the next."""

    def __init__(self, vehicle: Vehicle, axle: int, *, built_up: bool) -> None:
        self.brake, self.dynamic, self.pads = vehicle.brake_of(axle), vehicle.dynamic_of(axle), vehicle.pads
        self.radius, self.built_up = vehicle.wheel_radius, built_up
        self.time = self.pressure = self.warmth = self.level = 0.0

    def force(self, time: float, speed: float) -> float:
        """Force at the rim at a time, up to which the last step goes [N]."""
        turning, dynamic = speed / self.radius, 0.0
        if self.dynamic is not None:
            since, tau = time - self.time, self.dynamic.build_up_time
            self.level = 1.0 if self.built_up else further_brakes.build_up(since, self.level, 1.0, tau)
            dynamic = self.level * further_brakes.dynamic_torque(self.dynamic, turning, self.radius)
        friction = self._friction(time, dynamic, speed)
        self.time = time
        return (friction + dynamic) / self.radius

    def _friction(self, time: float, dynamic: float, speed: float) -> float:
        """Torque of the friction brake [N m]."""
        brake = self.brake
        share = 1.0
        if self.dynamic is not None:
            share = further_brakes.friction_share(dynamic, brake.max_torque)
        if self.built_up:
            self.pressure = share * brake.max_pressure
        else:
            filling = (self.time, self.pressure, time, time, brake.supply_pressure)
            self.pressure, _ = pattern_pressure(brake, time, filling, share=share)
        torque: float = braking_torque(brake, self.pressure)
        if self.pads is not None:
            torque *= further_brakes.pad_factor(self.pads, speed, self.warmth)
            rate = further_brakes.pad_warming(self.pads, torque, speed / self.radius, self.warmth)
            self.warmth += rate * (time - self.time)
        return torque


def _axles(vehicle: Vehicle, *, built_up: bool) -> list[tuple[int, _Axle]]:
    """Axles that differ, each with the number of those that are like it."""
    shares = list(zip(vehicle.brake_shares, vehicle.dynamic_shares, strict=True))
    return [
        (number, _Axle(vehicle, shares.index(each), built_up=built_up))
        for each, number in Counter(shares).items()
    ]


def developed_force(vehicle: Vehicle, speed: float) -> float:
    """Force of all built-up brakes at the rims of the wheels while they roll, with cold pads [N]."""
    return math.fsum(number * axle.force(0.0, speed) for number, axle in _axles(vehicle, built_up=True))


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
    axles = _axles(vehicle, built_up=built_up)
    climbing = vehicle.mass * constants().gravity * grade
    whole = vehicle.mass + vehicle.wheelsets * vehicle.wheelset_inertia / vehicle.wheel_radius**2

    def deceleration(time: float, speed: float) -> float:
        force = math.fsum(number * axle.force(time, speed) for number, axle in axles)
        if vehicle.track_brake is not None:
            since = math.inf if built_up else time
            force += further_brakes.track_brake_force(vehicle.track_brake, speed, since)
        slowed: float = (force + resistance(vehicle, speed, climbing)) / whole
        return slowed

    return march(speed, deceleration, step=step)
