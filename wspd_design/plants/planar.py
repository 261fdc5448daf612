"""A vehicle on two-axle bogies in the plane of the track, with the load transfer of body and bogie pitch.

The axles are numbered from the front in the direction of travel. Braking loads the front axle of each bogie and
the front bogies. Bogies of equal suspension stand at equal distances, so that the body loads them in proportion to
their distance from its middle. Pitch is a second-order response about the quasi-static load transfer; with all
heights at zero and equal rails the plant is that of :mod:`wspd_design.plants.quarter`.
"""

import math
from dataclasses import dataclass, replace
from typing import ClassVar

from wspd_design.model import slip as slip_model
from wspd_design.model.number import Number
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.records import Vehicle
from wspd_design.plants.axle import RigidWheelsets
from wspd_design.plants.protocol import TrainMotion

_AXLES = 2  # of one bogie
_WHEELS = 2 * _AXLES


@dataclass(frozen=True, slots=True)
class Planar(RigidWheelsets):
    """The plant with load transfer: of the body, then within each bogie, front bogie first [N]."""

    vehicle: Vehicle
    name: ClassVar[str] = "four-axle"
    alike: ClassVar[bool] = False

    def __post_init__(self) -> None:
        """Refuse a vehicle that does not stand on two or more bogies of two axles."""
        axles = self.vehicle.wheelsets
        if axles % _AXLES or axles < 2 * _AXLES:
            raise UserError(
                f"wheelsets = {axles} of vehicle {self.vehicle.name} do not stand on two or more bogies of "
                f'{_AXLES} axles, and load transfer is known for those alone; take the plant "quarter"'
            )

    @property
    def bogies(self) -> int:
        """Number of bogies."""
        return bogies(self.vehicle)

    @property
    def transfers(self) -> int:
        """One of the body and one of each bogie."""
        return 1 + self.bogies

    @property
    def offsets(self) -> tuple[Number, ...]:
        """Distance of each axle behind the first one [m]."""
        base, spacing = self.vehicle.wheelbase, self.vehicle.bogie_spacing
        return tuple(bogie * spacing + axle * base for bogie in range(self.bogies) for axle in range(_AXLES))

    def on(self, vehicle: Vehicle) -> "Planar":
        """Return the same plant with the numbers of another vehicle."""
        return replace(self, vehicle=vehicle)

    def wheel_loads(self, transfers: tuple[Number, ...]) -> tuple[Number, ...]:
        """Vertical load of one wheel of each axle [N]."""
        static = slip_model.static_wheel_load(self.vehicle)
        body, *within_bogies = transfers[: self.transfers]
        loads: list[Number] = []
        for share, bogie in zip(_body_shares(self.bogies), within_bogies, strict=True):
            mean, within = static + share * body / _WHEELS, bogie / _AXLES
            loads += [mean + within, mean - within]
        return tuple(loads)

    def train_motion(
        self,
        *,
        speed: Number,
        creep_forces: tuple[Number, ...],
        transfers: tuple[Number, ...],
        time: Number = math.inf,
        grade_force: Number = 0.0,
    ) -> TrainMotion:
        """Acceleration of the train, eq. (1) with one creep force per wheel of each axle, and pitch response.

        What tips body and bogies is the force on them beside gravity: by mass the deceleration less g times the grade.
        The magnets of a track brake hang in the bogies and pull at the height of the rail, as the wheels do.
        """
        vehicle = self.vehicle
        resistance = slip_model.resistance(vehicle, speed, grade_force)
        magnets = self.track_brake_force(speed, time)
        if vehicle.track_brake is not None:
            resistance += magnets
        acceleration = slip_model.train_acceleration(vehicle, sum(creep_forces) / self.axles, resistance)
        held = -acceleration - grade_force / vehicle.mass
        height = vehicle.body_height - vehicle.traction_rod_height
        targets = [vehicle.body_mass * held * height / vehicle.bogie_spacing]
        for bogie in range(self.bogies):
            front, rear = creep_forces[_AXLES * bogie : _AXLES * (bogie + 1)]
            at_rail = 2.0 * (front + rear)
            if vehicle.track_brake is not None:
                at_rail += magnets / self.bogies
            targets.append(_bogie_target(vehicle, at_rail, held))
        frequencies = (vehicle.body_pitch_frequency, *(vehicle.bogie_pitch_frequency,) * self.bogies)
        values, rates = transfers[: self.transfers], transfers[self.transfers :]
        damping = vehicle.pitch_damping_ratio
        responses = (
            _response(*column, damping) for column in zip(targets, values, rates, frequencies, strict=True)
        )
        return TrainMotion(
            acceleration=acceleration, resistance=resistance, transfer_rates=(*rates, *responses)
        )


def bogies(vehicle: Vehicle) -> int:
    """Number of bogies of a vehicle that stands on nothing else."""
    return vehicle.wheelsets // _AXLES


def _body_shares(number: int) -> tuple[float, ...]:
    """Load of each bogie from a pitch moment of the body, over moment by spacing; 1 and -1 for two bogies."""
    places = [0.5 * (number - 1) - bogie for bogie in range(number)]
    squares = sum(place * place for place in places)
    return tuple(place / squares for place in places)


def _bogie_target(vehicle: Vehicle, force: Number, held: Number) -> Number:
    """Quasi-static load transfer within a bogie: what holds its own mass, and the body's pull on the rod [N]."""
    own = vehicle.bogie_mass * held
    moment = own * vehicle.bogie_height + (force - own) * vehicle.traction_rod_height
    return moment / vehicle.wheelbase


def _response(target: Number, value: Number, rate: Number, frequency: Number, damping: Number) -> Number:
    """Second derivative of a second-order response to its target."""
    omega = 2.0 * math.pi * frequency
    return omega * omega * (target - value) - 2.0 * damping * omega * rate
