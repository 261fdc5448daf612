"""What a law of a vehicle with an observer of the friction torque says of itself, so that a band of slip can be proved.

It is said, not believed: the check compares the traced ``start`` and ``step`` with the law that these numbers describe
(:mod:`wspd_design.certificates.setting.declared_law`).
"""

from dataclasses import dataclass
from typing import NamedTuple, Protocol, runtime_checkable

from wspd_design.controllers.protocol import State, VehicleController
from wspd_design.model.number import Number


class ObservedWheelset(NamedTuple):
    """What a law remembers of a wheelset."""

    speed: Number  # rad/s, observed
    friction_torque: Number  # N m, observed
    mean_torque: Number  # N m, of its brake over the last sample, by the model of the valve


class Observed(NamedTuple):
    """What a law remembers of the train and of its wheelsets, front first."""

    speed: Number  # m/s, told train speed times the scale
    acceleration: Number  # m/s2, by its filtered difference
    scale: Number  # -, of the told speed, by which rolling wheels have no slip
    wheelsets: tuple[ObservedWheelset, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class ObserverForm:
    """Numbers of a law with observer, surface and inverted valve.

    A sample observes w and tau with r = w_measured - (w + (h/J)(tau - T_mean)), wants the torque
    tau - J (w_r' - k e_p) with e_p = w_measured - w_r + ahead h ((tau - T)/J - w_r'), and commands the pulse that leads
    there with a share of the nominal times.
    """

    slip: float  # -, reference; at 1 m/s where it falls
    falls: bool = False  # as 1/sqrt(v)
    approach_rate: float  # 1/s, k
    ahead: float  # -, of a sample
    observer_rate: float  # 1/s; theta = exp(-rate h)
    acceleration_time: float  # s, of the filter of the train's acceleration
    wheelset_inertia: float  # kg m2, J
    wheel_radius: float  # m, nominal
    full_torque: float  # N m, of a wheelset at full pressure, the same for all
    full_pressure: float  # Pa
    fill_time: float  # s, nominal, as the next
    vent_time: float  # s
    time_share: float  # -, of the nominal times, with which the valve is inverted
    torque_slew: float | None = None  # N m/s, of a braking curve far from the reference, if there is one
    slip_error: float = (
        0.0  # -, by which the slip may differ from the reference, where the train speed is told wrong
    )
    slip_drift: float = 0.0  # m/s2, most of the rate of that difference times the train speed


@runtime_checkable
class TorqueObserver(VehicleController, Protocol):
    """A law of a vehicle that says its form."""

    @property
    def observer_form(self) -> ObserverForm:
        """Its numbers."""

    def observed(self, state: State) -> Observed:
        """Return what the form is about from the law's own state."""
