"""One braked wheelset on the rail, eqs. (2), (3), (5)-(7).

Its states are the wheel speed and, where the friction of the pads depends on it, the temperature of what they heat.
"""

import math
from typing import Protocol

from wspd_design.model import adhesion, further_brakes
from wspd_design.model import slip as slip_model
from wspd_design.model.generated import motion as generated
from wspd_design.model.number import Number
from wspd_design.parameters.records import Rail, Vehicle
from wspd_design.plants.protocol import AxleCondition, AxleMotion, BrakeTorques


class _OnWheelsets(Protocol):
    @property
    def vehicle(self) -> Vehicle: ...


class _Rigid(_OnWheelsets, Protocol):
    @property
    def transfers(self) -> int: ...

    def wheel_damping(self, time: Number) -> Number: ...

    def brake_torques(
        self, states: tuple[Number, ...], torque: Number, dynamic_level: Number
    ) -> BrakeTorques: ...

    def wheel_loads(self, transfers: tuple[Number, ...]) -> tuple[Number, ...]: ...


class BrakedWheelsets:
    """The wheelsets of any plant, with their brakes; each has its own wheel speed."""

    __slots__ = ()

    @property
    def axles(self: _OnWheelsets) -> int:
        """Number of wheelsets."""
        return self.vehicle.wheelsets

    @property
    def axle_states(self: _OnWheelsets) -> int:
        """Number of states of one wheelset: its wheel speed, and the temperature of its pads where that counts."""
        pads = self.vehicle.pads
        return 1 + (pads is not None and bool(pads.temperatures))

    def wheel_damping(self: _OnWheelsets, time: Number) -> Number:
        """Damping of a wheel some time [s] after the brake was applied [N m s]."""
        vehicle = self.vehicle
        return generated.wheel_damping(time, vehicle.wheel_damping, vehicle.wheel_damping_decay)

    def brake_torques(
        self: _OnWheelsets, states: tuple[Number, ...], torque: Number, dynamic_level: Number
    ) -> BrakeTorques:
        """Torques on one wheelset under the nominal one of its friction brake [N m], and what warms its pads."""
        vehicle, (wheel_speed, *temperature) = self.vehicle, states
        pads, warming = vehicle.pads, []
        friction = torque
        if pads is not None:
            warmth = temperature[0] if temperature else 0.0
            friction = torque * further_brakes.pad_factor(pads, vehicle.wheel_radius * wheel_speed, warmth)
            if temperature:
                warming = [further_brakes.pad_warming(pads, friction, wheel_speed, warmth)]
        if vehicle.dynamic is None:
            return BrakeTorques(friction, 0.0, tuple(warming))
        dynamic = dynamic_level * further_brakes.dynamic_torque(
            vehicle.dynamic, wheel_speed, vehicle.wheel_radius
        )
        return BrakeTorques(friction + dynamic, dynamic, tuple(warming))

    def track_brake_force(self: _OnWheelsets, speed: Number, time: Number) -> Number:
        """Force of the magnets on the train, some time [s] after the brake was applied [N]."""
        brake = self.vehicle.track_brake
        return 0.0 if brake is None else further_brakes.track_brake_force(brake, speed, time)


class RigidWheelsets(BrakedWheelsets):
    """The wheelsets of the plants that split: rigid, and nothing between wheel and brake."""

    __slots__ = ()

    @property
    def rest_states(self: _Rigid) -> int:
        """The load transfers and their rates."""
        return 2 * self.transfers

    @property
    def longest_step(self) -> float:
        """Nothing but the creep curve limits a step."""
        return math.inf

    def rest_at(self: _Rigid, speed: float, wheel_speeds: tuple[float, ...]) -> tuple[float, ...]:  # noqa: ARG002
        """No load has moved where a stop begins."""
        return (0.0,) * (2 * self.transfers)

    def loads_at_rest(self: _Rigid) -> tuple[Number, ...]:
        """Vertical load of one wheel of each axle before any load moves [N]."""
        return self.wheel_loads((0.0,) * (2 * self.transfers))

    def axle_condition(self: _Rigid, *, time: Number, wheel_load: Number) -> AxleCondition:
        """Stiffness of the contact and damping of the wheel."""
        vehicle = self.vehicle
        return AxleCondition(
            stiffness=adhesion.contact_stiffness(vehicle.contact, wheel_load),
            damping=self.wheel_damping(time),
        )

    def axle_motion(
        self: _Rigid,
        rail: Rail,
        *,
        speed: Number,
        states: tuple[Number, ...],
        wheel_load: Number,
        torque: Number,
        condition: AxleCondition,
        dynamic_level: Number = 0.0,
    ) -> AxleMotion:
        """Creep force and rates of one wheelset under the nominal torque of its friction brake [N m]."""
        vehicle, wheel_speed = self.vehicle, states[0]
        braking, dynamic, warming = self.brake_torques(states, torque, dynamic_level)
        slip = slip_model.slip_ratio(speed, wheel_speed, vehicle.wheel_radius)
        sliding = speed - vehicle.wheel_radius * wheel_speed
        force = adhesion.creep_force(slip, abs(sliding), wheel_load, rail, condition.stiffness)
        acceleration = generated.wheel_acceleration(
            force, wheel_speed, braking, vehicle.wheel_inertia, vehicle.wheel_radius, condition.damping
        )
        return AxleMotion(
            rates=(acceleration, *warming),
            creep_force=force,
            slip=slip,
            damping_torque=condition.damping * wheel_speed,
            brake_torque=braking,
            dynamic_torque=dynamic,
        )

    def creep_rate(self: _OnWheelsets, rail: Rail, speed: Number) -> Number:
        """Fastest rate of the slip on the adhering side under the static load [1/s]."""
        vehicle = self.vehicle
        stiffness = adhesion.contact_stiffness(vehicle.contact, slip_model.static_wheel_load(vehicle))
        slope = 2.0 / math.pi * stiffness * (rail.adhesion_reduction + rail.slip_reduction)
        per_slip = vehicle.wheel_radius**2 / vehicle.wheel_inertia + slip_model.wheels(vehicle) / vehicle.mass
        return slope * per_slip / speed
