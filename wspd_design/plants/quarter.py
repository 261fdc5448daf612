"""The quarter locomotive: eight equal wheels, one train mass, eqs. (1)-(7).

All wheels carry the static load, so one wheelset stands for all of them.
"""

import math
from dataclasses import dataclass
from typing import NamedTuple

from wspd_design.model import adhesion
from wspd_design.model import slip as slip_model
from wspd_design.model.generated import motion as generated
from wspd_design.model.number import Number
from wspd_design.parameters.records import Rail, Vehicle


class Motion(NamedTuple):
    """Accelerations and forces of the quarter locomotive at one instant."""

    acceleration: Number  # m/s2, train
    wheel_acceleration: Number  # rad/s2
    slip: Number  # -
    creep_force: Number  # N per wheel
    resistance: Number  # N
    wheel_damping: Number  # N m s per wheel


@dataclass(frozen=True, slots=True, kw_only=True)
class Quarter:
    """A vehicle on a rail, with what does not change during a stop worked out once."""

    vehicle: Vehicle
    rail: Rail
    wheel_load: float  # N
    stiffness: float  # N, initial slope of the creep force

    def motion(self, time: Number, speed: Number, wheel_speed: Number, torque: Number) -> Motion:
        """Accelerations while the wheel rolls, eqs. (1), (2).

        Parameters
        ----------
        time : number
            Since the start of braking [s].
        speed : number
            Train speed [m/s].
        wheel_speed : number
            Angular speed [rad/s].
        torque : number
            Braking torque per wheelset [N m].
        """
        vehicle = self.vehicle
        slip = slip_model.slip_ratio(speed, wheel_speed, vehicle.wheel_radius)
        sliding = speed - vehicle.wheel_radius * wheel_speed
        force = adhesion.creep_force(slip, abs(sliding), self.wheel_load, self.rail, self.stiffness)
        resistance = slip_model.resistance(vehicle, speed)
        damping = generated.wheel_damping(time, vehicle.wheel_damping, vehicle.wheel_damping_decay)
        return Motion(
            acceleration=generated.train_acceleration(force, resistance, vehicle.mass),
            wheel_acceleration=generated.wheel_acceleration(
                force, wheel_speed, torque, vehicle.wheel_inertia, vehicle.wheel_radius, damping
            ),
            slip=slip,
            creep_force=force,
            resistance=resistance,
            wheel_damping=damping,
        )

    def creep_rate(self, speed: Number) -> Number:
        """Fastest rate of the slip on the adhering side, which limits an explicit step [1/s]."""
        vehicle = self.vehicle
        slope = 2.0 / math.pi * self.stiffness * (self.rail.adhesion_reduction + self.rail.slip_reduction)
        per_slip = vehicle.wheel_radius**2 / vehicle.wheel_inertia + 8.0 / vehicle.mass
        return slope * per_slip / speed


def quarter(vehicle: Vehicle, rail: Rail) -> Quarter:
    """Put a vehicle on a rail."""
    load = slip_model.static_wheel_load(vehicle)
    return Quarter(
        vehicle=vehicle,
        rail=rail,
        wheel_load=load,
        stiffness=adhesion.contact_stiffness(vehicle.contact, load),
    )
