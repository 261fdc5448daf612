"""Four axles under one train mass, with the load transfer of body and bogie pitch.

The axles are numbered from the front in the direction of travel. Braking loads the front axle of each bogie and
the front bogie. Pitch is a second-order response about the quasi-static load transfer; with both heights at zero
and equal rails the plant is four times the quarter locomotive.
"""

import math
from typing import NamedTuple

from wspd_design.model import adhesion
from wspd_design.model import slip as slip_model
from wspd_design.model.generated import motion as generated
from wspd_design.model.number import Number
from wspd_design.parameters.records import Rail, Vehicle

AXLES = 4


class Pitch(NamedTuple):
    """Load transfer of the three pitch motions and its rate of change; all zero before braking."""

    body: Number  # N, to the front bogie
    front_bogie: Number  # N, to the front axle of the bogie
    rear_bogie: Number
    body_rate: Number  # N/s
    front_bogie_rate: Number
    rear_bogie_rate: Number


class AxleCondition(NamedTuple):
    """What an integrator may hold over one step, taken at its middle."""

    stiffness: Number  # N, initial slope of the creep force
    damping: Number  # N m s per wheel


class AxleMotion(NamedTuple):
    """One wheelset at one instant; forces and torques of the damping are per wheel."""

    wheel_acceleration: Number  # rad/s2, while rolling
    creep_force: Number  # N
    slip: Number  # -
    damping_torque: Number  # N m


class TrainMotion(NamedTuple):
    """The train at one instant."""

    acceleration: Number  # m/s2
    resistance: Number  # N
    pitch: Pitch  # rates of change


def wheel_loads(vehicle: Vehicle, pitch: Pitch) -> tuple[Number, ...]:
    """Vertical load of one wheel of each axle [N]."""
    static = slip_model.static_wheel_load(vehicle)
    by_body = pitch.body / 4.0
    front, rear = pitch.front_bogie / 2.0, pitch.rear_bogie / 2.0
    return (
        static + by_body + front,
        static + by_body - front,
        static - by_body + rear,
        static - by_body - rear,
    )


def axle_condition(vehicle: Vehicle, *, time: Number, wheel_load: Number) -> AxleCondition:
    """What changes slowly at one wheelset: stiffness of the contact and damping of the wheel."""
    return AxleCondition(
        stiffness=adhesion.contact_stiffness(vehicle.contact, wheel_load),
        damping=generated.wheel_damping(time, vehicle.wheel_damping, vehicle.wheel_damping_decay),
    )


def axle_motion(
    vehicle: Vehicle,
    rail: Rail,
    *,
    speed: Number,
    wheel_speed: Number,
    wheel_load: Number,
    torque: Number,
    condition: AxleCondition,
) -> AxleMotion:
    """Creep force and acceleration of one wheelset, eqs. (2), (3), (5)-(7); torque per wheelset."""
    slip = slip_model.slip_ratio(speed, wheel_speed, vehicle.wheel_radius)
    sliding = speed - vehicle.wheel_radius * wheel_speed
    force = adhesion.creep_force(slip, abs(sliding), wheel_load, rail, condition.stiffness)
    return AxleMotion(
        wheel_acceleration=generated.wheel_acceleration(
            force, wheel_speed, torque, vehicle.wheel_inertia, vehicle.wheel_radius, condition.damping
        ),
        creep_force=force,
        slip=slip,
        damping_torque=condition.damping * wheel_speed,
    )


def train_motion(
    vehicle: Vehicle,
    *,
    speed: Number,
    creep_forces: tuple[Number, ...],
    pitch: Pitch,
    grade_force: Number = 0.0,
) -> TrainMotion:
    """Acceleration of the train and pitch response, eq. (1) with one creep force per wheel of each axle."""
    resistance = slip_model.resistance(vehicle, speed, grade_force)
    mean_force = sum(creep_forces) / AXLES
    acceleration = generated.train_acceleration(mean_force, resistance, vehicle.mass)
    front = 2.0 * (creep_forces[0] + creep_forces[1])
    rear = 2.0 * (creep_forces[2] + creep_forces[3])
    body_target = vehicle.body_mass * -acceleration * (vehicle.body_height - vehicle.traction_rod_height)
    body = vehicle.body_pitch_frequency
    bogie = vehicle.bogie_pitch_frequency
    damping = vehicle.pitch_damping_ratio
    return TrainMotion(
        acceleration=acceleration,
        resistance=resistance,
        pitch=Pitch(
            body=pitch.body_rate,
            front_bogie=pitch.front_bogie_rate,
            rear_bogie=pitch.rear_bogie_rate,
            body_rate=_response(
                body_target / vehicle.bogie_spacing, pitch.body, pitch.body_rate, body, damping
            ),
            front_bogie_rate=_response(
                _bogie_target(vehicle, front, -acceleration),
                pitch.front_bogie,
                pitch.front_bogie_rate,
                bogie,
                damping,
            ),
            rear_bogie_rate=_response(
                _bogie_target(vehicle, rear, -acceleration),
                pitch.rear_bogie,
                pitch.rear_bogie_rate,
                bogie,
                damping,
            ),
        ),
    )


def _bogie_target(vehicle: Vehicle, force: Number, deceleration: Number) -> Number:
    """Quasi-static load transfer within a bogie: its own inertia, and the body's pull on the traction rod [N]."""
    own = vehicle.bogie_mass * deceleration
    moment = own * vehicle.bogie_height + (force - own) * vehicle.traction_rod_height
    return moment / vehicle.wheelbase


def _response(target: Number, value: Number, rate: Number, frequency: Number, damping: Number) -> Number:
    """Second derivative of a second-order response to its target."""
    omega = 2.0 * math.pi * frequency
    return omega * omega * (target - value) - 2.0 * damping * omega * rate
