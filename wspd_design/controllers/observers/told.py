"""The train speed of a source of its own, scaled so that the wheels have no slip while they roll.

A radar or a wheel without a brake gives a speed whose scale, or the radius of the braked wheels, is known within some
percent only. What a law controls is the slip, in which only their ratio counts: the wheels show it before they brake.
"""

from dataclasses import dataclass

from wspd_design.controllers.observers.protocol import TRAIN_ACCELERATION, SpeedEstimate
from wspd_design.controllers.observers.rolling import RELEASED_DEMAND, mean_rim_speed, total
from wspd_design.controllers.protocol import TRAIN_SPEED, State, VehicleMeasurement
from wspd_design.model.number import Number, exp, maximum, where
from wspd_design.parameters.loading import constants

SOURCE_ERROR = 0.05
"""Of a told speed, for wheels of nominal radius; that of worn wheels comes on top [-]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ToldSpeed:
    """The told speed times a scale from the start, and its acceleration by a filtered difference."""

    sample_time: float  # s
    wheel_radius: float  # m, nominal
    wheelsets: int
    largest_scale_error: float = (
        SOURCE_ERROR  # -, beyond it the wheels do not roll: they slide, and say nothing
    )
    acceleration_time: float = 0.3  # s, of the filter: noise of .05 m/s becomes some .15 m/s2

    @property
    def memory(self) -> tuple[str, ...]:
        """Speed and acceleration of the train, and scale of the speed."""
        return (TRAIN_SPEED, TRAIN_ACCELERATION, "speed_scale")

    def start(self, seen: VehicleMeasurement) -> State:
        """Take the scale from the wheels if the brake is released and they can be rolling."""
        scale = mean_rim_speed(seen, self.wheel_radius) / maximum(
            seen.speed, constants().slip_regularization_speed
        )
        rolling = (
            (seen.demand <= RELEASED_DEMAND)
            * (total(seen.healthy) > 0.0)
            * (abs(scale - 1.0) <= self.largest_scale_error)
        )
        scale = where(rolling, scale, 1.0)
        return (scale * seen.speed, 0.0 * scale, scale)

    def step(
        self,
        state: State,
        seen: VehicleMeasurement,
        friction_torques: tuple[Number, ...],  # noqa: ARG002 - the source is not the wheels
        slip_references: tuple[Number, ...],  # noqa: ARG002 - likewise
    ) -> tuple[State, SpeedEstimate]:
        """Scale what is told now; nothing has to be released for it."""
        before, acceleration, scale = state
        speed = scale * seen.speed
        new = 1.0 - exp(-self.sample_time / self.acceleration_time)
        acceleration = acceleration + new * ((speed - before) / self.sample_time - acceleration)
        nobody = (0.0,) * self.wheelsets
        return (speed, acceleration, scale), SpeedEstimate(speed, acceleration, nobody, nobody)
