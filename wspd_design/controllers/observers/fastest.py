"""The train speed of the fastest axle, with a limited fall: what simple units do.

A train cannot slow down faster than rail and brake allow. While some axle rolls, it shows the speed; while all slide,
the speed falls at that limit, away from the true one if the rail gives less.
"""

from dataclasses import dataclass

from wspd_design.controllers.observers.protocol import TRAIN_ACCELERATION, SpeedEstimate
from wspd_design.controllers.protocol import TRAIN_SPEED, State, VehicleMeasurement
from wspd_design.model.number import Number, exp, maximum


@dataclass(frozen=True, slots=True, kw_only=True)
class FastestAxle:
    """The largest rim speed of the healthy axles, but never less than the last speed after the steepest fall."""

    sample_time: float  # s
    wheel_radius: float  # m, nominal
    wheelsets: int
    largest_fall: float = 1.3  # m/s2, emergency braking of a passenger train on a good rail
    acceleration_time: float = 0.3  # s, of the filter of the acceleration

    @property
    def memory(self) -> tuple[str, ...]:
        """Speed and acceleration of the train."""
        return (TRAIN_SPEED, TRAIN_ACCELERATION)

    def start(self, seen: VehicleMeasurement) -> State:
        """Take the fastest axle as it is."""
        fastest = _fastest(self, seen)
        return (fastest, 0.0 * fastest)

    def step(
        self,
        state: State,
        seen: VehicleMeasurement,
        friction_torques: tuple[Number, ...],  # noqa: ARG002 - only speeds count
        slip_references: tuple[Number, ...],  # noqa: ARG002 - likewise
    ) -> tuple[State, SpeedEstimate]:
        """Follow the fastest axle, down as fast as a train can slow down."""
        before, acceleration = state
        speed = maximum(_fastest(self, seen), before - self.largest_fall * self.sample_time)
        speed = maximum(speed, 0.0)
        new = 1.0 - exp(-self.sample_time / self.acceleration_time)
        acceleration = acceleration + new * ((speed - before) / self.sample_time - acceleration)
        nobody = (0.0,) * self.wheelsets
        return (speed, acceleration), SpeedEstimate(speed, acceleration, nobody, nobody)


def _fastest(source: FastestAxle, seen: VehicleMeasurement) -> Number:
    """Rim speed of the fastest axle whose sensor is healthy [m/s]."""
    fastest: Number = 0.0
    for healthy, wheel_speed in zip(seen.healthy, seen.wheel_speeds, strict=True):
        fastest = maximum(fastest, healthy * source.wheel_radius * wheel_speed)
    return fastest
