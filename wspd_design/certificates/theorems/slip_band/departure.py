"""Stops that begin at the reference, with everything settled, and that no band survives.

Whatever set of states a band is proved for holds the reference itself, with the observers and the filter of the
acceleration of the train settled. Where holding it takes more torque than there is, the brake is the limit; and if a
wheel locks from there, no band is narrower than the way to lock.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import product
from typing import NamedTuple, cast

from wspd_design.certificates.kernel.checker import Refused, Work
from wspd_design.certificates.kernel.finding import Place
from wspd_design.certificates.records import Problem
from wspd_design.certificates.setting.plant import plant_with
from wspd_design.certificates.theorems.slip_band.reference import slip_at, turning_at
from wspd_design.certificates.theorems.slip_band.statement import NAMES, law_of
from wspd_design.controllers.observers.protocol import TRAIN_ACCELERATION
from wspd_design.controllers.protection import Protection
from wspd_design.controllers.protocol import TRAIN_SPEED, Command, State, VehicleMeasurement
from wspd_design.model.slip import slip_dynamics
from wspd_design.parameters.bounds import Ends
from wspd_design.parameters.records import Rail, Vehicle
from wspd_design.simulation.records import Scenario, Start
from wspd_design.simulation.start import full_supply_time, holding_torque
from wspd_design.simulation.stop import simulate

STOP_WORK = 2_000_000  # of a budget of operations: what a stop takes
BEYOND = 1e-6  # relative: torques that differ by less are equal
LIMIT = ("holding torque", "full torque")  # N m, numbers of a place where the brake is the limit
LOCK = ("lock time", "lock speed")  # s from the start, m/s; numbers of a place from which wheels lock


@dataclass(frozen=True, slots=True, kw_only=True)
class Settled:
    """A protection that begins as if it had held its reference for long."""

    law: Protection
    turning: float  # -, part of a change of the train speed that the rims at the reference take part in
    acceleration: float  # m/s2, of the train
    wheel_radius: float  # m, true
    held: float  # N m, torque that holds the reference, by nominal pads

    @property
    def name(self) -> str:
        """Name of the protection."""
        return self.law.name

    @property
    def sample_time(self) -> float:
        """Sample time [s]."""
        return self.law.sample_time

    @property
    def wheelsets(self) -> int:
        """Number of wheelsets that it acts on."""
        return self.law.wheelsets

    @property
    def memory(self) -> tuple[str, ...]:
        """Names of the elements of the state."""
        return self.law.memory

    def start(self, measurement: VehicleMeasurement) -> State:
        """Begin one sample back, with the scale of the speed that rolling wheels have shown."""
        law, back = self.law, self.law.sample_time
        scale = law.wheel_radius / self.wheel_radius
        turning = self.acceleration * self.turning / self.wheel_radius
        known = dict(zip(law.memory, law.start(measurement), strict=True))
        settled = {
            TRAIN_SPEED: scale * (measurement.speed - self.acceleration * back),
            TRAIN_ACCELERATION: scale * self.acceleration,
            "speed_scale": scale,
        }
        for axle in range(1, law.wheelsets + 1):
            held = law.torque_shares[axle - 1] * self.held
            settled[f"observed_speed_{axle}"] = measurement.wheel_speeds[axle - 1] - turning * back
            settled[f"friction_torque_{axle}"] = held + law.wheelset_inertia * turning
            settled[f"mean_torque_{axle}"] = held
        return tuple((known | settled).values())

    def step(self, state: State, measurement: VehicleMeasurement) -> tuple[State, tuple[Command, ...]]:
        """Go on as the protection does."""
        return self.law.step(state, measurement)


def place_ranges(problem: Problem) -> dict[str, Ends]:
    """Coordinates of a place, with their ranges: the numbers of the box and the speed [SI units]."""
    return {name: problem.span(name) for name in NAMES} | {"speed": problem.speeds}


def corners(problem: Problem) -> Iterator[Place]:
    """Yield the nominal numbers, then the corners of the box, without a speed."""
    yield {name: problem.nominal(name) for name in NAMES}
    for ends in product((1, 0), repeat=len(NAMES)):
        yield {name: problem.span(name)[end] for name, end in zip(NAMES, ends, strict=True)}


def missing_torque(problem: Problem, place: Place) -> dict[str, float]:
    """Torque that holds the reference at a place and that of the full pressure, if the first is larger [N m]."""
    at = _reference(problem, place)
    full = at.vehicle.brake.max_torque
    return dict(zip(LIMIT, (at.holding, full), strict=True)) if at.holding > full * (1.0 + BEYOND) else {}


def holding_share(problem: Problem, place: Place) -> float:
    """Share of the full pressure that holds the reference at a place [-]."""
    at = _reference(problem, place)
    return at.holding / at.vehicle.brake.max_torque


class SettledStop(NamedTuple):
    """A stop that begins at the reference as if it had been held for long."""

    vehicle: Vehicle
    rail: Rail
    law: Settled
    start: Start
    holding: float  # N m, torque that holds the reference, whether the brake has it or not


def settled_stop(problem: Problem, place: Place) -> SettledStop:
    """Return the stop that begins at the reference at a place."""
    vehicle, rail, braking, slip, turning, holding = _reference(problem, place)
    protection = cast(Protection, problem.controller)
    law = Settled(
        law=protection,
        turning=turning,
        acceleration=-float(slip_dynamics(vehicle, rail, slip, place["speed"]).deceleration),
        wheel_radius=vehicle.wheel_radius,
        held=holding * protection.valve.brake.max_torque / vehicle.brake.max_torque,
    )
    start = Start(slip=slip, torque=min(holding, vehicle.brake.max_torque), braking_time=braking)
    return SettledStop(vehicle, rail, law, start, holding)


def lock(problem: Problem, place: Place) -> dict[str, float]:
    """When and at which speed a wheel first locks after a start at the reference; empty if none does in the range."""
    import numpy as np

    if not isinstance(
        problem.controller, Protection
    ):  # how the observers of another law have settled is not known
        return {}
    at = settled_stop(problem, place)
    scenario = Scenario(rail=at.rail, initial_speed=place["speed"], start=at.start)
    run = simulate(at.vehicle, at.law, scenario, plant="quarter")
    locked = np.flatnonzero((run.wheel_speed[:, 0] <= 0.0) & (run.speed >= problem.speeds[0]))
    if not locked.size:
        return {}
    first = int(locked[0])
    return dict(zip(LOCK, (float(run.time[first]), float(run.speed[first])), strict=True))


def denies(problem: Problem, place: Place, work: Work) -> Mapping[str, float]:
    """Return what is true at a place and denies every band, or refuse."""
    missing = missing_torque(problem, place)
    if missing:
        return missing
    work.spend(STOP_WORK)
    found = lock(problem, place)
    if not found:
        raise Refused("the stop denies nothing: the brake can hold the reference, and no wheel locks")
    return found


class _Reference(NamedTuple):
    """What holds the reference at a place."""

    vehicle: Vehicle
    rail: Rail
    braking: float  # s, since the brake was applied: the supply is full
    slip: float  # -
    turning: float  # -, part of a change of the train speed that the rims take part in
    holding: float  # N m


def _reference(problem: Problem, place: Place) -> _Reference:
    vehicle, rail = plant_with(problem, {name: place[name] for name in NAMES})
    braking = full_supply_time(vehicle.brake)
    law, speed, radius = law_of(problem.controller), place["speed"], vehicle.wheel_radius
    slip, turning = slip_at(law, speed, radius), turning_at(law, speed, radius)
    holding = holding_torque(vehicle, rail, slip=slip, speed=speed, braking_time=braking)
    braked = float(slip_dynamics(vehicle, rail, slip, speed).deceleration)
    holding += vehicle.wheelset_inertia * (turning - (1.0 - slip)) * braked / radius  # of a slip that changes
    return _Reference(vehicle, rail, braking, slip, turning, holding)
