"""What the laws that ask for a braking torque have in common: the error, and the pulses that bring the torque."""

from dataclasses import dataclass
from typing import Annotated

from wspd_design.controllers.gains import Quantity
from wspd_design.controllers.protection import ProtectionGains
from wspd_design.controllers.protocol import Command
from wspd_design.controllers.valve_inversion import ValveInversion
from wspd_design.controllers.wheel_law import WheelView
from wspd_design.model.generated import slip_tracking
from wspd_design.model.number import Number, maximum, minimum, where

_LARGEST_BAND = 0.5  # of the torque that brakes


@dataclass(frozen=True, slots=True, kw_only=True)
class TrackingGains(ProtectionGains):
    """Gains of a law that asks for a torque, with those of its protection."""

    approach_rate: Annotated[float, Quantity(dimension="rate", divisor=True)]  # k of the pull k e
    ahead: float  # -, of a sample: the error is that of so much later
    valve_time_share: Annotated[float, Quantity(dimension="ratio", divisor=True)]  # of the nominal times
    dead_band: Annotated[float, Quantity(dimension="torque")]  # about the torque that is wanted
    dead_band_share: float  # -, of the desired slip: error that the dead band may cause at most


@dataclass(frozen=True, slots=True, kw_only=True)
class Tracking:
    """Error of the wheel speed and torque of one wheelset."""

    valve: ValveInversion
    wheelset_inertia: float  # kg m2
    approach_rate: float  # 1/s
    ahead: float  # -, of a sample
    dead_band: float  # N m
    dead_band_share: float  # -, of the desired slip

    def error(self, view: WheelView) -> Number:
        """Wheel speed above the desired one, a part of the coming sample ahead [rad/s]."""
        return slip_tracking.predicted_error(
            view.wheel_speed - view.desired_speed,
            view.friction_torque,
            view.torque,
            view.desired_acceleration,
            self.wheelset_inertia,
            self.valve.sample_time,
            self.ahead,
        )

    def target(self, view: WheelView, pull: Number) -> Number:
        """Torque at which the error falls by the pull [N m]; the brake may not have it."""
        return slip_tracking.target_torque(
            view.friction_torque, view.desired_acceleration, pull, self.wheelset_inertia
        )

    def command(self, view: WheelView, target: Number) -> Command:
        """Pulse that leads to a torque."""
        # The torque J k e belongs to an error e: where the desired sliding speed is low, so must be the dead band.
        sliding = maximum(view.rolling_speed - view.desired_speed, 0.0)
        of_slip = self.dead_band_share * sliding * self.wheelset_inertia * self.approach_rate
        # On a poor rail all torque is little: a band about the target that contains what brakes now would hold a wheel
        # that locks.
        dead_band = minimum(minimum(self.dead_band, of_slip), _LARGEST_BAND * view.torque)
        return self.valve.command(view.torque, target, view.available, dead_band, view.full_torque)

    def free(self, view: WheelView, target: Number, error: Number) -> Number:
        """Tell (1 or 0) whether an integral of the error may grow: not where the brake has no more to give."""
        above = where(target > view.available, error > 0.0, False)
        below = where(target < 0.0, error < 0.0, False)
        return where(above, 0.0, where(below, 0.0, 1.0))


def tracking(gains: TrackingGains, valve: ValveInversion, wheelset_inertia: float) -> Tracking:
    """Return the tracking of a wheelset with its gains."""
    return Tracking(
        valve=valve,
        wheelset_inertia=wheelset_inertia,
        approach_rate=gains.approach_rate,
        ahead=gains.ahead,
        dead_band=gains.dead_band,
        dead_band_share=gains.dead_band_share,
    )
