"""The plant of the paper in equations of its own: nothing of the package is imported here.

Written from eqs. (1) to (14), (19) and the data book. SI units; every number may be an array. The slip is positive when
braking, torque and inertia are those of a wheelset, a creep force is that of one wheel.
"""

from dataclasses import dataclass, fields
from typing import Any

import numpy as np

GRAVITY = 9.81  # m/s2
STEP = 1e-30  # of the derivatives by a complex step


@dataclass(frozen=True, slots=True, kw_only=True)
class Plant:
    """Numbers of vehicle and rail under the names of their files; each is a float or an array."""

    mass: Any  # kg
    wheel_radius: Any  # m
    wheelset_inertia: Any  # kg m2
    wheel_damping: Any  # N m s
    resistance_constant: Any  # N
    resistance_linear: Any  # N s/m
    resistance_quadratic: Any  # N s2/m2
    max_torque: Any  # N m
    supply_rate: Any  # 1/s
    fill_time: Any  # s
    vent_time: Any  # s
    shear_modulus: Any  # Pa
    semi_axis_rolling: Any  # m
    semi_axis_lateral: Any  # m
    kalker_c11: Any  # -
    reference_load: Any  # N
    mu0: Any  # -
    friction_ratio: Any  # -, A
    friction_decay: Any  # s/m, B
    adhesion_reduction: Any  # -, kA
    slip_reduction: Any  # -, kS
    wheelsets: float = 4.0
    load_share: Any = 1.0  # -, load of the wheels of this axle over the static one
    train_deceleration: Any = None  # m/s2; by default that of a train whose wheels all do the same

    def with_numbers(self, numbers: dict[str, Any]) -> "Plant":
        """Return the plant with some numbers replaced."""
        own = {each.name: getattr(self, each.name) for each in fields(self)}
        return Plant(**{**own, **{name: numbers[name] for name in numbers if name in own}})


def static_load(plant: Plant) -> Any:
    """Load of one wheel at rest [N]."""
    return plant.mass * GRAVITY / (2.0 * plant.wheelsets)


def creep_force(plant: Plant, slip: Any, speed: Any, load: Any) -> Any:
    """Force of one wheel on the rail, eqs. (5) to (7) [N]; the contact ellipse grows with the load."""
    size = np.where(np.real(slip) < 0.0, -slip, slip)
    falling = (1.0 - plant.friction_ratio) * np.exp(-plant.friction_decay * speed * size)
    friction = plant.mu0 * (plant.friction_ratio + falling)
    area = (
        np.pi * plant.semi_axis_rolling * plant.semi_axis_lateral * (load / plant.reference_load) ** (2 / 3)
    )
    gradient = plant.shear_modulus * area * plant.kalker_c11 / (4.0 * load * friction) * slip
    adhesion = plant.adhesion_reduction * gradient
    return (
        2.0
        * load
        * friction
        / np.pi
        * (adhesion / (1.0 + adhesion * adhesion) + np.arctan(plant.slip_reduction * gradient))
    )


def resistance(plant: Plant, speed: Any) -> Any:
    """Running resistance of the train, eq. (4) [N]."""
    return plant.resistance_constant + plant.resistance_linear * speed + plant.resistance_quadratic * speed**2


def deceleration(plant: Plant, slip: Any, speed: Any) -> Any:
    """Deceleration of a train whose wheels all run at one slip and at the static load, eq. (1) [m/s2]."""
    force = creep_force(plant, slip, speed, static_load(plant))
    return (resistance(plant, speed) + 2.0 * plant.wheelsets * force) / plant.mass


def slowing(plant: Plant, slip: Any, speed: Any) -> Any:
    """Deceleration of the train: the one that is given, else that of wheels that all do the same [m/s2]."""
    given = plant.train_deceleration
    return deceleration(plant, slip, speed) if given is None else given


def slip_rate(plant: Plant, slip: Any, speed: Any, torque: Any) -> Any:
    """Rate of the slip of one wheelset from (1) to (3), by the quotient rule [1/s]."""
    radius = plant.wheel_radius
    spin = speed * (1.0 - slip) / radius
    force = creep_force(plant, slip, speed, static_load(plant) * plant.load_share)
    torques = 2.0 * radius * force - torque - 2.0 * plant.wheel_damping * spin
    lost = (1.0 - slip) * slowing(plant, slip, speed)
    return -radius / speed * torques / plant.wheelset_inertia - lost / speed


def axle_rates(plant: Plant, shares: Any, slips: Any, speed: Any, torques: Any) -> tuple[Any, Any]:
    """Rates of the slips of all axles, and the deceleration that they have in common, eqs. (1) to (3).

    Axles along the first axis; ``shares`` are their loads over the static one, with a mean of 1.
    """
    load = static_load(plant)
    forces = [
        creep_force(plant, slip, speed, load * share) for slip, share in zip(slips, shares, strict=True)
    ]
    common = (resistance(plant, speed) + 2.0 * sum(forces)) / plant.mass
    rates = [
        slip_rate(
            plant.with_numbers({"load_share": share, "train_deceleration": common}), slip, speed, torque
        )
        for share, slip, torque in zip(shares, slips, torques, strict=True)
    ]
    return np.array(rates), common


def drift(plant: Plant, slip: Any, speed: Any) -> Any:
    """F of eq. (19) [1/s]."""
    return slip_rate(plant, slip, speed, 0.0)


def gain(plant: Plant, speed: Any) -> Any:
    """G of eq. (19) [1/s per N m]."""
    return plant.wheel_radius / (plant.wheelset_inertia * speed)


def holding_torque(plant: Plant, slip: Any, speed: Any) -> Any:
    """Torque that holds a slip while the train slows down [N m]."""
    return -drift(plant, slip, speed) / gain(plant, speed)


def slip_pole(plant: Plant, slip: Any, speed: Any) -> Any:
    """Derivative of the rate of the slip by the slip, at fixed speed and torque [1/s]."""
    return np.imag(drift(plant, slip + STEP * 1j, speed)) / STEP


def adhesion_peak(plant: Plant, speed: Any, *, count: int = 240) -> tuple[Any, Any]:
    """Slip of the largest creep force, and that force [N], by golden sections on the logarithm of the slip."""
    shape = np.broadcast(speed, *(getattr(plant, each.name) for each in fields(plant))).shape
    grid = np.geomspace(1e-4, 1.0, count).reshape((count,) + (1,) * len(shape))
    load = static_load(plant)
    best = np.argmax(np.broadcast_to(creep_force(plant, grid, speed, load), (count, *shape)), axis=0)
    log = np.log(np.geomspace(1e-4, 1.0, count))
    low, high = log[np.maximum(best - 1, 0)], log[np.minimum(best + 1, count - 1)]
    section = 2.0 / (1.0 + np.sqrt(5.0))
    for _ in range(40):
        left, right = high - section * (high - low), low + section * (high - low)
        rising = creep_force(plant, np.exp(left), speed, load) < creep_force(
            plant, np.exp(right), speed, load
        )
        low, high = np.where(rising, left, low), np.where(rising, high, right)
    slip = np.exp((low + high) / 2)
    return slip, creep_force(plant, slip, speed, load)


# --- the valve


def filled(plant: Plant, torque: Any, time: Any, *, since: Any = np.inf) -> Any:
    """Torque after filling for a time, eqs. (8) to (10) [N m].

    ``since`` is how long the supply has been building up when the filling starts [s]; at the end of it the pressure is
    full.
    """
    full, lag, rate = plant.max_torque, plant.fill_time, plant.supply_rate
    decay = np.exp(-time / lag)
    steady = full - (full - torque) * decay
    if np.all(np.isinf(since)):
        return steady
    missing = full * np.exp(
        -rate * since
    )  # of the supply at the start; (9) with (8) has a second exponential
    equal = np.abs(rate * lag - 1.0) < 1e-9
    split = np.where(equal, 1.0, 1.0 - rate * lag)
    second = np.where(equal, time / lag * decay, (np.exp(-rate * time) - decay) / split)
    return steady - missing * second


def vented(plant: Plant, torque: Any, time: Any) -> Any:
    """Torque after venting for a time, eq. (11) [N m]."""
    return torque * np.exp(-time / plant.vent_time)


def filling_from_empty(plant: Plant, time: Any) -> Any:
    """Torque of a brake that only fills since the start of a stop [N m]."""
    return filled(plant, 0.0, time, since=0.0)


def filling_duty(plant: Plant, share: Any) -> Any:
    """Duty at which filling and venting balance at a share of T_max."""
    out = share / plant.vent_time
    return out / ((1.0 - share) / plant.fill_time + out)


def averaged_rate(plant: Plant, torque: Any, duty: Any) -> Any:
    """Mean rate of the torque of the bilinear valve: it fills for the duty and vents for the rest [N m/s]."""
    return (plant.max_torque - torque) * duty / plant.fill_time - torque * (1.0 - duty) / plant.vent_time


# --- loads


@dataclass(frozen=True, slots=True, kw_only=True)
class Body:
    """Masses and lengths that move load between the axles of a vehicle with two bogies."""

    body_mass: float  # kg
    bogie_mass: float  # kg
    body_height: float  # m
    bogie_height: float  # m
    traction_rod_height: float  # m
    bogie_spacing: float  # m
    wheelbase: float  # m


def load_shares(plant: Plant, body: Body, adhesion: float, *, rounds: int = 60) -> list[float]:
    """Loads of the four axles over the static one when all use the same adhesion, by moments at rest.

    The body, at its height, pushes the rods of both bogies; each bogie is turned by its own inertia and by its rod.
    """
    axle = 2.0 * float(static_load(plant))
    shares = [1.0] * 4
    for _ in range(rounds):
        forces = [adhesion * axle * share for share in shares]
        slowing = sum(forces) / float(plant.mass)
        over = body.body_mass * slowing * (body.body_height - body.traction_rod_height) / body.bogie_spacing
        shares = []
        for first, sign in ((0, 1.0), (2, -1.0)):
            own = body.bogie_mass * slowing
            rod = forces[first] + forces[first + 1] - own
            turning = (own * body.bogie_height + rod * body.traction_rod_height) / body.wheelbase
            shares += [1.0 + (sign * over / 2 + turning) / axle, 1.0 + (sign * over / 2 - turning) / axle]
    return shares
