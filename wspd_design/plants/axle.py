"""One braked wheelset on the rail, eqs. (2), (3), (5)-(7); its one state is the wheel speed."""

import math
from typing import Protocol

from wspd_design.model import adhesion
from wspd_design.model import slip as slip_model
from wspd_design.model.generated import motion as generated
from wspd_design.model.number import Number
from wspd_design.parameters.records import Rail, Vehicle
from wspd_design.plants.protocol import AxleCondition, AxleMotion


class _OnWheelsets(Protocol):
    @property
    def vehicle(self) -> Vehicle: ...


class RigidWheelsets:
    """The wheelsets of the plants: rigid, each with its own wheel speed."""

    __slots__ = ()

    @property
    def axles(self: _OnWheelsets) -> int:
        """Number of wheelsets."""
        return self.vehicle.wheelsets

    @property
    def axle_states(self) -> int:
        """Number of states of one wheelset: its wheel speed."""
        return 1

    def axle_condition(self: _OnWheelsets, *, time: Number, wheel_load: Number) -> AxleCondition:
        """Stiffness of the contact and damping of the wheel."""
        vehicle = self.vehicle
        return AxleCondition(
            stiffness=adhesion.contact_stiffness(vehicle.contact, wheel_load),
            damping=generated.wheel_damping(time, vehicle.wheel_damping, vehicle.wheel_damping_decay),
        )

    def axle_motion(
        self: _OnWheelsets,
        rail: Rail,
        *,
        speed: Number,
        states: tuple[Number, ...],
        wheel_load: Number,
        torque: Number,
        condition: AxleCondition,
    ) -> AxleMotion:
        """Creep force and acceleration of one wheelset; torque per wheelset [N m]."""
        vehicle, (wheel_speed,) = self.vehicle, states
        slip = slip_model.slip_ratio(speed, wheel_speed, vehicle.wheel_radius)
        sliding = speed - vehicle.wheel_radius * wheel_speed
        force = adhesion.creep_force(slip, abs(sliding), wheel_load, rail, condition.stiffness)
        acceleration = generated.wheel_acceleration(
            force, wheel_speed, torque, vehicle.wheel_inertia, vehicle.wheel_radius, condition.damping
        )
        return AxleMotion(
            rates=(acceleration,),
            creep_force=force,
            slip=slip,
            damping_torque=condition.damping * wheel_speed,
        )

    def creep_rate(self: _OnWheelsets, rail: Rail, speed: Number) -> Number:
        """Fastest rate of the slip on the adhering side under the static load [1/s]."""
        vehicle = self.vehicle
        stiffness = adhesion.contact_stiffness(vehicle.contact, slip_model.static_wheel_load(vehicle))
        slope = 2.0 / math.pi * stiffness * (rail.adhesion_reduction + rail.slip_reduction)
        per_slip = vehicle.wheel_radius**2 / vehicle.wheel_inertia + slip_model.wheels(vehicle) / vehicle.mass
        return slope * per_slip / speed
