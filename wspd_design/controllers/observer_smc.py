"""Sliding mode of relative degree two: the pull to the reference, through the observed friction and the valve.

The valve changes the torque, the torque the wheel speed: the error e of the wheel speed knows the valve in its second
derivative only. With the friction torque that is observed, the law asks for the torque at which e' = -y. The pull is
y = k e, and far from the reference that of a braking curve, on which it falls no faster than the valve can make it
fall: a wheel that approaches its reference does not run beyond it.
"""

from dataclasses import dataclass
from typing import Annotated

from wspd_design.controllers.gains import Quantity
from wspd_design.controllers.protocol import Command, State
from wspd_design.controllers.tracking import Tracking, TrackingGains
from wspd_design.controllers.wheel_law import WheelView
from wspd_design.model.generated import slip_tracking
from wspd_design.model.number import Number, maximum, sqrt, where


@dataclass(frozen=True, slots=True, kw_only=True)
class ObserverSmcGains(TrackingGains):
    """Gains of the law."""

    torque_slew: Annotated[float, Quantity(dimension="torque rate", divisor=True)]  # J s of the braking curve


@dataclass(frozen=True, slots=True, kw_only=True)
class ObserverSmc:
    """The law of one wheelset; it remembers nothing."""

    tracking: Tracking
    torque_slew: float  # N m/s

    @property
    def memory(self) -> tuple[str, ...]:
        """Nothing."""
        return ()

    def start(self, view: WheelView) -> State:  # noqa: ARG002 - nothing to remember
        """Start without memory."""
        return ()

    def step(self, state: State, view: WheelView) -> tuple[State, Command]:
        """Ask for the torque that pulls the wheel to its reference."""
        tracking = self.tracking
        slew = self.torque_slew / tracking.wheelset_inertia
        pull = approach(tracking.error(view), tracking.approach_rate, slew)
        return state, tracking.command(view, tracking.target(view, pull))


def approach(error: Number, rate: Number, slew: Number) -> Number:
    """Pull to the reference, k e and beyond e = s/k^2 that of the braking curve [rad/s2].

    Parameters
    ----------
    error : number
        Wheel speed above the desired one [rad/s].
    rate : number
        k [1/s].
    slew : number
        Rate s at which the pull falls on the curve [rad/s3].
    """
    square = maximum(slip_tracking.curve_square(error, rate, slew), 0.0)
    return where(error * rate * rate > slew, sqrt(square), rate * error)
