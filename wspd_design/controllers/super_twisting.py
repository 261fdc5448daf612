"""Super-twisting: the pull grows with the root of the error, and its integral learns what the observer does not see.

Within a layer about the reference the root is replaced by a straight line, because a sampled law cannot switch faster
than its samples.
"""

from dataclasses import dataclass
from typing import Annotated

from wspd_design.controllers.gains import Quantity
from wspd_design.controllers.protocol import Command, State
from wspd_design.controllers.tracking import Tracking, TrackingGains
from wspd_design.controllers.wheel_law import WheelView
from wspd_design.model.number import Number, clip, maximum, saturation, sqrt


@dataclass(frozen=True, slots=True, kw_only=True)
class SuperTwistingGains(TrackingGains):
    """Gains of the law, with k_1 = k sqrt(layer) and k_2 = (integral rate)^2 layer."""

    integral_rate: Annotated[float, Quantity(dimension="rate")]
    layer: Annotated[float, Quantity(dimension="speed", divisor=True)]  # of the rim about the desired speed


@dataclass(frozen=True, slots=True, kw_only=True)
class SuperTwisting:
    """The law of one wheelset; its state is (integral part of the pull,)."""

    tracking: Tracking
    integral_rate: float  # 1/s
    layer: float  # rad/s

    @property
    def memory(self) -> tuple[str, ...]:
        """Integral part of the pull."""
        return ("twisting",)

    def start(self, view: WheelView) -> State:
        """Start without integral."""
        return (0.0 * view.speed,)

    def step(self, state: State, view: WheelView) -> tuple[State, Command]:
        """Ask for the torque that pulls the wheel to its reference."""
        (integral,) = state
        tracking = self.tracking
        error = tracking.error(view)
        target = tracking.target(view, twisting(error, tracking.approach_rate, self.layer) + integral)
        grown = integral + self.integral_rate**2 * self.layer * saturation(error / self.layer) * (
            tracking.valve.sample_time * tracking.free(view, target, error)
        )
        # What the layer can pull, the integral can hold: more is no error of an observer.
        most = tracking.approach_rate * self.layer
        return (clip(grown, -most, most),), tracking.command(view, target)


def twisting(error: Number, rate: Number, layer: Number) -> Number:
    """Pull k sqrt(layer abs(e)) sgn(e), and k e within the layer [rad/s2]."""
    return rate * error * sqrt(layer / maximum(abs(error), layer))
