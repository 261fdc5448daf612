"""Stopping distances by mean values: what a brake office computes before anything slides, after EN 14531-1.

The rules give no distance where wheels slide; the simulation does. Here stand the forces, the equivalent time of the
build-up, the deceleration of the fully developed brake, the distance, the braked weight percentage, and the adhesion
that the brake asks for.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from wspd_design.analysis.stepwise import developed_force, rolling_stop
from wspd_design.model.brake import build_up_delay
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.gear import static_shares
from wspd_design.parameters.loading import constants
from wspd_design.parameters.records import Vehicle

PERCENTAGE_SPEEDS: dict[float, tuple[float, float]] = {
    100.0: (52840.0, 10.0),
    120.0: (83634.0, 19.0),
    140.0: (119179.0, 19.0),
    160.0: (161280.0, 19.0),
}
"""C [m] and D [-] of lambda = C/s - D for single vehicles, by the speed in km/h, EN 16834."""

_SPEEDS = tuple(0.5 * k for k in range(201))
"""Among which the one of the largest force is looked for [m/s]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class FrictionBrake:
    """The friction brakes of some wheelsets that are alike, from the cylinder to the rim."""

    wheelsets: int
    pressure: float  # Pa, in the cylinder
    cylinder_area: float  # m2
    cylinder_efficiency: float  # -
    spring_force: float  # N, of the return spring, against the piston
    rigging_ratio: float  # -
    rigging_efficiency: float  # -
    rigging_force: float  # N, lost in the rigging
    pad_friction: float  # -
    friction_radius: float  # m, mean radius of the swept ring, or of the tread
    wheel_radius: float  # m
    dead_time: float  # s, until the force begins
    build_up_time: float  # s, from there to the full force

    @property
    def retarding_force(self) -> float:
        """Force at the rim of one wheelset with the brake fully applied [N]."""
        piston = self.pressure * self.cylinder_area * self.cylinder_efficiency - self.spring_force
        pads = piston * self.rigging_ratio * self.rigging_efficiency - self.rigging_force
        return pads * self.pad_friction * self.friction_radius / self.wheel_radius

    @property
    def equivalent_time(self) -> float:
        """Time that a sudden full force may come later for the same impulse [s]."""
        return self.dead_time + self.build_up_time / 2.0


@dataclass(frozen=True, slots=True, kw_only=True)
class MeanStop:
    """A stop by mean values."""

    equivalent_time: float  # s, of rolling freely
    deceleration: float  # m/s2, from then on
    distance: float  # m
    time: float  # s


def mean_stop(
    speed: float,
    *,
    forces: Sequence[tuple[float, float]],
    mass: float,
    rotating_mass: float,
    resistance: tuple[float, float, float],
    grade: float = 0.0,
) -> MeanStop:
    """Stop from a speed with forces that do not change once they are built up.

    The resistance counts with its mean over the distance of a uniform deceleration, and acts from the start.

    Parameters
    ----------
    speed : float
        Initial speed [m/s].
    forces : sequence of (float, float)
        Force [N] and equivalent time [s] of each part of the brake.
    mass, rotating_mass : float
        Of the vehicle, and what its rotating parts add [kg].
    resistance : (float, float, float)
        a0 [N], a1 [N s/m], a2 [N s2/m2] of the running resistance, eq. (4).
    grade : float
        Rise over run, positive uphill [-].

    Raises
    ------
    UserError
        If the forces do not hold the vehicle on the grade.

    References
    ----------
    EN 14531-1, stopping and slowing distances by mean values.
    """
    constant, linear, quadratic = resistance
    running = constant + linear * speed * 2.0 / 3.0 + quadratic * speed**2 / 2.0
    steady = running + mass * constants().gravity * grade
    total = sum(force for force, _ in forces) + steady
    if total <= 0.0:
        raise UserError(
            f"the brake gives {total - steady:g} N and grade and resistance take {-steady:g} N: the vehicle does not "
            "stop; choose a stronger brake or a smaller grade"
        )
    delay = sum(force * time for force, time in forces) / total
    deceleration = total / (mass + rotating_mass)
    return MeanStop(
        equivalent_time=delay,
        deceleration=deceleration,
        distance=speed * delay + speed**2 / (2.0 * deceleration),
        time=delay + speed / deceleration,
    )


def full_adhesion_stop(vehicle: Vehicle, speed: float, *, grade: float = 0.0) -> MeanStop:
    """Stop of a vehicle whose wheels do not slide, by mean values of its brake.

    The equivalent time is that of build-up and filling together: a demand with ``supply_rate`` and a lag with
    ``fill_time`` are late by 1/supply_rate + fill_time, exactly. Where pads fade, an electrodynamic brake is blended
    in or magnets pull, the stop is worked out by steps, and the mean values are those which give its distance.
    """
    if vehicle.pads or vehicle.dynamic or vehicle.track_brake:
        return _stop_by_steps(vehicle, speed, grade)
    return mean_stop(
        speed,
        forces=[(rim_force(vehicle), build_up_delay(vehicle.brake))],
        mass=vehicle.mass,
        rotating_mass=rotating_mass(vehicle),
        resistance=(
            vehicle.resistance_constant,
            vehicle.resistance_linear,
            vehicle.resistance_quadratic,
        ),
        grade=grade,
    )


def _stop_by_steps(vehicle: Vehicle, speed: float, grade: float) -> MeanStop:
    """The deceleration is that of a stop with all brakes built up; what the whole one takes more is rolling freely."""
    distance, time = rolling_stop(vehicle, speed, grade=grade)
    developed, _ = rolling_stop(vehicle, speed, grade=grade, built_up=True)
    return MeanStop(
        equivalent_time=(distance - developed) / speed,
        deceleration=speed**2 / (2.0 * developed),
        distance=distance,
        time=time,
    )


def demanded_adhesion(vehicle: Vehicle) -> float:
    """Adhesion that the fully applied brake asks for while no wheel slides, over the static wheel load [-].

    The rail slows the train; what slows the turning of the wheelsets comes from the brake alone. Where brakes or
    loads differ, it is that of the axle which asks for most.
    """
    mean = rim_force(vehicle) / ((vehicle.mass + rotating_mass(vehicle)) * constants().gravity)
    shares, loads = vehicle.brake_shares, static_shares(vehicle)
    if len(set(shares)) == 1 and len(set(loads)) == 1:
        return mean
    # Of the force at its rims an axle takes what slows its own turning; that part is the same for all.
    turning = mean * rotating_mass(vehicle) / vehicle.mass
    usual = sum(shares) / len(shares)
    return max(
        (share / usual * (mean + turning) - turning) / load for share, load in zip(shares, loads, strict=True)
    )


def rim_force(vehicle: Vehicle) -> float:
    """Force of the fully applied brake at the rims of all wheels, at the speed where it is largest [N]."""
    if vehicle.pads or vehicle.dynamic:
        return max(developed_force(vehicle, speed) for speed in _SPEEDS)
    return sum(vehicle.brake_shares) * vehicle.brake.max_torque / vehicle.wheel_radius


def rotating_mass(vehicle: Vehicle) -> float:
    """Mass that the turning of the wheelsets adds [kg]."""
    return vehicle.wheelsets * vehicle.wheelset_inertia / vehicle.wheel_radius**2


def braked_weight_percentage(distance: float, speed: float) -> float:
    """Braked weight percentage lambda of a single vehicle that stops within a distance.

    Parameters
    ----------
    distance : float
        Stopping distance [m].
    speed : float
        Initial speed [m/s]: 100, 120, 140 or 160 km/h.

    Raises
    ------
    UserError
        For another speed.

    References
    ----------
    EN 16834, by the constants that RailProfAC/RailwayBrakeCalculation uses.
    """
    for kmh, (length, offset) in PERCENTAGE_SPEEDS.items():
        if abs(speed * 3.6 - kmh) < 1e-6:
            return length / distance - offset
    known = ", ".join(f"{kmh:g}" for kmh in PERCENTAGE_SPEEDS)
    raise UserError(
        f"the braked weight percentage is stated from {known} km/h, not from {speed * 3.6:g}; choose one"
    )
