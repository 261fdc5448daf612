"""Slip ratio and slip dynamics of the quarter model, eqs. (3) and (19)."""

from typing import NamedTuple

from wspd_design.model import adhesion
from wspd_design.model.generated import motion
from wspd_design.model.generated import slip as generated
from wspd_design.model.number import Number, maximum
from wspd_design.parameters.loading import constants
from wspd_design.parameters.records import Rail, Vehicle


def slip_ratio(speed: Number, wheel_speed: Number, wheel_radius: Number) -> Number:
    """Longitudinal slip ratio, positive when braking, eq. (3) [-].

    This is the one place where the slip is kept finite at standstill: it is referred to the train speed, and
    below ``slip_regularization_speed`` to that speed.

    Parameters
    ----------
    speed : number
        Train speed [m/s].
    wheel_speed : number
        Angular speed of the wheel [rad/s].
    wheel_radius : number
        Radius [m].
    """
    reference_speed = maximum(speed, constants().slip_regularization_speed)
    return generated.slip_ratio(speed, wheel_speed, wheel_radius, reference_speed)


def resistance(vehicle: Vehicle, speed: Number, grade_force: Number = 0.0) -> Number:
    """Running resistance f_d on straight track, eq. (4) [N]; the grade force is positive uphill."""
    return motion.running_resistance(
        speed,
        vehicle.resistance_constant,
        vehicle.resistance_linear,
        vehicle.resistance_quadratic,
        grade_force,
        0.0,
        0.0,
    )


COUNTED = -motion.train_acceleration(1.0, 0.0, 1.0)
"""Wheels that eqs. (1) and (19) count, as they are generated."""


def wheels(vehicle: Vehicle) -> int:
    """Return the number of wheels."""
    return 2 * vehicle.wheelsets


def static_wheel_load(vehicle: Vehicle) -> Number:
    """Wheel load without weight transfer, m g over the number of wheels [N]."""
    return vehicle.mass * constants().gravity / wheels(vehicle)


def train_acceleration(vehicle: Vehicle, creep_force: Number, resistance: Number) -> Number:
    """Acceleration of the train under the mean creep force of its wheels, eq. (1) [m/s2].

    Parameters
    ----------
    vehicle : Vehicle
        Mass and number of wheels.
    creep_force : number
        Mean over all wheels [N].
    resistance : number
        Running resistance [N].
    """
    return motion.train_acceleration(
        creep_force, _counted(vehicle, resistance), _counted(vehicle, vehicle.mass)
    )


def _counted(vehicle: Vehicle, whole: Number) -> Number:
    """Return the part of a mass or force of the train that stands on as many wheels as eqs. (1), (19) count."""
    return whole if wheels(vehicle) == COUNTED else whole * COUNTED / float(wheels(vehicle))


class SlipDynamics(NamedTuple):
    """Eq. (19) at one point: slip' = drift + gain * torque, with the slip derivative of the drift."""

    drift: Number  # 1/s, F
    gain: Number  # 1/(N m s), G
    pole: Number  # 1/s, dF/dslip at fixed speed
    creep_force: Number  # N per wheel
    deceleration: Number  # m/s2, positive when braking


def slip_dynamics(
    vehicle: Vehicle,
    rail: Rail,
    slip: Number,
    speed: Number,
    *,
    wheel_load: Number | None = None,
    deceleration: Number | None = None,
) -> SlipDynamics:
    """Evaluate eq. (19), by default of the quarter model.

    Parameters
    ----------
    vehicle : Vehicle
        Masses, inertia, resistance and contact.
    rail : Rail
        Friction.
    slip : number
        Slip ratio [-].
    speed : number
        Train speed, positive [m/s].
    wheel_load : number, optional
        Vertical load of a wheel [N]; the static load by default. The design model of a controller and the
        bounds of a certificate may fix it apart from the mass.
    deceleration : number, optional
        That of the train [m/s2]; by default eight wheels like this one brake it.
    """
    load = static_wheel_load(vehicle) if wheel_load is None else wheel_load
    stiffness = adhesion.contact_stiffness(vehicle.contact, load)
    force = adhesion.creep_force(slip, speed * slip, load, rail, stiffness)
    force_slope = adhesion.creep_force_slip_derivative(slip, speed, load, rail, stiffness)
    inertia = vehicle.wheel_inertia
    mass = _counted(vehicle, vehicle.mass)
    mechanics = (mass, inertia, vehicle.wheel_radius, vehicle.wheel_damping)
    if deceleration is None:
        resisting = resistance(vehicle, speed)
        slowing = -train_acceleration(vehicle, force, resisting)
        carried = _counted(vehicle, resisting)
    else:
        # The kernels know the deceleration as that by a resistance and their wheels, which change with the slip.
        carried = mass * deceleration - COUNTED * force
        slowing = deceleration
    pole = generated.slip_drift_slip_derivative(slip, speed, force, force_slope, carried, *mechanics)
    if deceleration is not None:
        pole = pole + (1.0 - slip) * COUNTED * force_slope / (mass * speed)
    return SlipDynamics(
        drift=generated.slip_drift(slip, speed, force, carried, *mechanics),
        gain=generated.slip_gain(speed, inertia, vehicle.wheel_radius),
        pole=pole,
        creep_force=force,
        deceleration=slowing,
    )
