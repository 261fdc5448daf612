"""A vehicle in the plane of the track, with the load transfer of body and bogie pitch.

The axles are numbered from the front in the direction of travel. What the vehicle stands on, and how a pitch moment
loads it, is told by :mod:`wspd_design.parameters.gear`. Braking loads the front axle of each bogie and the front
supports. Bodies pull at the height of the traction rods; there the running resistance acts too, and the moment by
which turning wheelsets are slowed down is left out. A single axle cannot pitch: its moment goes into the bodies, in
equal parts. Pitch is a second-order response about the quasi-static load transfer; with all heights at zero, equal
loads and equal rails the plant is that of :mod:`wspd_design.plants.quarter`.
"""

import math
from dataclasses import dataclass, replace
from typing import ClassVar

from wspd_design.model import slip as slip_model
from wspd_design.model.number import Number
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.gear import Gear, gear_of, static_shares, wrong_counts
from wspd_design.parameters.records import Vehicle
from wspd_design.plants.axle import RigidWheelsets
from wspd_design.plants.protocol import TrainMotion

_WHEELS = 2  # of one axle


@dataclass(frozen=True, slots=True)
class Planar(RigidWheelsets):
    """The plant with load transfer: of the bodies, then within each bogie, front bogie first [N]."""

    vehicle: Vehicle
    name: ClassVar[str] = "planar"
    alike: ClassVar[bool] = False

    def __post_init__(self) -> None:
        """Refuse a vehicle whose loads are not known."""
        vehicle = self.vehicle
        wrong = wrong_counts(vehicle)
        if not wrong and self.gear.supports < 2:
            wrong = f"wheelsets = {vehicle.wheelsets} make one support, and load moves between two or more"
        if wrong:
            raise UserError(f'vehicle {vehicle.name}: {wrong}; or take the plant "quarter"')

    @property
    def gear(self) -> Gear:
        """What the vehicle stands on."""
        return gear_of(self.vehicle)

    @property
    def bogies(self) -> int:
        """Number of bogies; none where single axles carry the body."""
        return 0 if self.gear.axles == 1 else self.gear.supports

    @property
    def transfers(self) -> int:
        """One of the bodies, which pitch alike, and one of each bogie."""
        return 1 + self.bogies

    @property
    def offsets(self) -> tuple[Number, ...]:
        """Distance of each axle behind the first one [m]."""
        gear, spacing = self.gear, self.vehicle.bogie_spacing
        apart = self.vehicle.wheelbase / (gear.axles - 1) if gear.axles > 1 else 0.0
        return tuple(
            support * spacing + axle * apart for support in range(gear.supports) for axle in range(gear.axles)
        )

    def on(self, vehicle: Vehicle) -> "Planar":
        """Return the same plant with the numbers of another vehicle."""
        return replace(self, vehicle=vehicle)

    def wheel_loads(self, transfers: tuple[Number, ...]) -> tuple[Number, ...]:
        """Vertical load of one wheel of each axle [N]."""
        gear = self.gear
        body, *within_bogies = transfers[: self.transfers]
        within = within_bogies or [0.0] * gear.supports
        loads: list[Number] = []
        mean_load, shares = slip_model.static_wheel_load(self.vehicle), static_shares(self.vehicle)
        for static, share, bogie in zip(shares[:: gear.axles], gear.body_shares, within, strict=True):
            mean = static * mean_load + float(share) * body / (_WHEELS * gear.axles)
            part = bogie / _WHEELS
            pitched = {-1: mean - part, 0: mean, 1: mean + part}  # a third axle stands in the middle
            loads += [pitched[each] for each in gear.axle_shares]
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
        vehicle, gear = self.vehicle, self.gear
        resistance = slip_model.resistance(vehicle, speed, grade_force)
        magnets = self.track_brake_force(speed, time)
        if vehicle.track_brake is not None:
            resistance += magnets
        acceleration = slip_model.train_acceleration(vehicle, sum(creep_forces) / self.axles, resistance)
        held = -acceleration - grade_force / vehicle.mass
        height = vehicle.body_height - vehicle.traction_rod_height
        body = vehicle.body_mass * held * height
        at_rail = [
            2.0 * _total(creep_forces[gear.axles * k : gear.axles * (k + 1)]) for k in range(gear.supports)
        ]
        if vehicle.track_brake is not None:
            at_rail = [force + magnets / gear.supports for force in at_rail]
        supports = [_support_moment(vehicle, force, held) for force in at_rail]
        if self.bogies:
            targets = [body / vehicle.bogie_spacing, *(moment / vehicle.wheelbase for moment in supports)]
        else:
            targets = [(body + sum(supports) / gear.bodies) / vehicle.bogie_spacing]
        frequencies = (vehicle.body_pitch_frequency, *(vehicle.bogie_pitch_frequency,) * self.bogies)
        values, rates = transfers[: self.transfers], transfers[self.transfers :]
        damping = vehicle.pitch_damping_ratio
        responses = (
            _response(*column, damping) for column in zip(targets, values, rates, frequencies, strict=True)
        )
        return TrainMotion(
            acceleration=acceleration, resistance=resistance, transfer_rates=(*rates, *responses)
        )


def _total(forces: tuple[Number, ...]) -> Number:
    first, *others = forces
    for force in others:
        first = first + force
    return first


def _support_moment(vehicle: Vehicle, force: Number, held: Number) -> Number:
    """Quasi-static pitch moment of a support about the rail: of its own mass, and of the body's pull on it [N m]."""
    own = vehicle.bogie_mass * held
    return own * vehicle.bogie_height + (force - own) * vehicle.traction_rod_height


def _response(target: Number, value: Number, rate: Number, frequency: Number, damping: Number) -> Number:
    """Second derivative of a second-order response to its target."""
    omega = 2.0 * math.pi * frequency
    return omega * omega * (target - value) - 2.0 * damping * omega * rate
