"""What a design starts from and what it is: a specification, a law and its gains with their reasons."""

import hashlib
from dataclasses import asdict, dataclass
from typing import Literal, TypeAlias

from wspd_design.controllers.adaptive_fuzzy import AdaptiveFuzzy, AdaptiveFuzzyGains
from wspd_design.controllers.sliding_mode import SlidingMode, SlidingModeGains
from wspd_design.controllers.torque_feedback import TorqueFeedback, TorqueFeedbackGains
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.records import Rail, Vehicle

Law: TypeAlias = Literal["afsmc", "smc", "torque-feedback"]
GainValue: TypeAlias = float | bool | tuple[float, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class Specification:
    """What the closed loop shall do; the defaults are the paper's case."""

    slip: float = 0.14  # -, reference
    speeds: tuple[float, float] = (10.0 / 3.6, 120.0 / 3.6)  # m/s, range of operation
    slips: tuple[float, float] = (0.02, 0.6)  # -, range of slip in which the surface shall be reached
    slip_tolerance: float = 0.05  # -, width of the band around the reference
    sample_time: float = 0.1  # s

    def __post_init__(self) -> None:
        """Refuse what no wheel can do, in one sentence each."""
        low, high = self.speeds
        if not 0.0 < self.slip < 1.0:
            raise UserError(f"slip = {self.slip:g} must lie in (0, 1); for percent write for example 14 %")
        if not 0.0 < low < high < 150.0:
            raise UserError(
                f"speed range = {low * 3.6:g} to {high * 3.6:g} km/h must rise and lie above 0 and below 540 km/h"
            )
        if not 0.0 < self.slips[0] < self.slip < self.slips[1] <= 1.0:
            raise UserError(
                f"slip range = {self.slips[0]:g} to {self.slips[1]:g} must lie in (0, 1] "
                f"and contain the slip reference {self.slip:g}"
            )
        if not 0.0 < self.slip_tolerance < 1.0 - self.slip:
            raise UserError(
                f"slip tolerance = {self.slip_tolerance:g} must lie between 0 and {1.0 - self.slip:g}, "
                "the distance of the slip reference from a locked wheel"
            )
        if not 1e-3 <= self.sample_time <= 1.0:
            raise UserError(f"sample time = {self.sample_time:g} s must lie between 1 ms and 1 s")


@dataclass(frozen=True, slots=True, kw_only=True)
class Gain:
    """One number of a design with the rule that chose it."""

    name: str
    value: GainValue
    unit: str
    why: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Design:
    """A controller design: everything that is needed to rebuild the controller, and why it is so."""

    name: str
    law: Law
    vehicle: str
    vehicle_hash: str
    rail: str  # design rail
    specification: Specification
    gains: tuple[Gain, ...]

    def gain(self, name: str) -> GainValue:
        """Return the value of a gain by its name."""
        return next(gain.value for gain in self.gains if gain.name == name)

    def build(self, vehicle: Vehicle, rail: Rail) -> AdaptiveFuzzy | SlidingMode | TorqueFeedback:
        """Build the controller of one wheelset.

        Parameters
        ----------
        vehicle : Vehicle
            The vehicle that the design was made for.
        rail : Rail
            The design rail; sliding mode and torque feedback use it as their friction model.

        Raises
        ------
        UserError
            If the vehicle is another one or its numbers have changed since, or the rail is not the design rail.
        """
        if vehicle.name != self.vehicle:
            raise UserError(
                f"design {self.name} was made for vehicle {self.vehicle}, not for {vehicle.name}; "
                f"use --vehicle {self.vehicle} or make a new design"
            )
        if vehicle_hash(vehicle) != self.vehicle_hash:
            raise UserError(
                f"the numbers of vehicle {vehicle.name} have changed since design {self.name} was made; "
                "make the design again with wspd design"
            )
        if rail.name != self.rail:
            raise UserError(f"design {self.name} was made on rail {self.rail}, not on {rail.name}")
        values = {gain.name: gain.value for gain in self.gains}
        if self.law == "smc":
            return SlidingMode(
                name=self.name,
                sample_time=self.specification.sample_time,
                vehicle=vehicle,
                rail=rail,
                gains=SlidingModeGains(slip_reference=self.specification.slip, **values),  # type: ignore[arg-type]
            )
        if self.law == "torque-feedback":
            return TorqueFeedback(
                name=self.name,
                sample_time=self.specification.sample_time,
                vehicle=vehicle,
                rail=rail,
                gains=TorqueFeedbackGains(slip_reference=self.specification.slip, **values),  # type: ignore[arg-type]
            )
        return AdaptiveFuzzy(
            name=self.name,
            sample_time=self.specification.sample_time,
            wheel_radius=vehicle.wheel_radius,
            max_torque=vehicle.brake.max_torque,
            gains=AdaptiveFuzzyGains(slip_reference=self.specification.slip, **values),  # type: ignore[arg-type]
        )


def vehicle_hash(vehicle: Vehicle) -> str:
    """Fingerprint of all numbers of a vehicle."""
    return hashlib.sha256(repr(sorted(asdict(vehicle).items())).encode()).hexdigest()[:16]
