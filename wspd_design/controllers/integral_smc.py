"""Integral sliding mode: the surface e + k (integral of e) = 0 is reached against what the observer does not see."""

from dataclasses import dataclass
from typing import Annotated

from wspd_design.controllers.gains import Quantity
from wspd_design.controllers.protocol import Command, State
from wspd_design.controllers.tracking import Tracking, TrackingGains
from wspd_design.controllers.wheel_law import WheelView
from wspd_design.model.number import clip, saturation


@dataclass(frozen=True, slots=True, kw_only=True)
class IntegralSmcGains(TrackingGains):
    """Gains of the law."""

    switching_gain: Annotated[float, Quantity(dimension="acceleration")]  # W, of the rim
    layer: Annotated[float, Quantity(dimension="speed", divisor=True)]  # Phi, of the rim


@dataclass(frozen=True, slots=True, kw_only=True)
class IntegralSmc:
    """The law of one wheelset; its state is (integral of the error,)."""

    tracking: Tracking
    switching_gain: float  # rad/s2
    layer: float  # rad/s

    @property
    def memory(self) -> tuple[str, ...]:
        """Integral of the error."""
        return ("error_integral",)

    def start(self, view: WheelView) -> State:
        """Start without integral."""
        return (0.0 * view.speed,)

    def step(self, state: State, view: WheelView) -> tuple[State, Command]:
        """Ask for the torque that leads to the surface and along it."""
        (integral,) = state
        tracking = self.tracking
        error, rate = tracking.error(view), tracking.approach_rate
        surface = error + rate * integral
        target = tracking.target(view, rate * error + self.switching_gain * saturation(surface / self.layer))
        grown = integral + tracking.valve.sample_time * error * tracking.free(view, target, error)
        # Beyond the layer the switching is saturated: a larger integral would only have to be taken back.
        most = self.layer / rate
        return (clip(grown, -most, most),), tracking.command(view, target)
