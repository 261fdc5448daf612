"""What a controller is: a sampled difference equation (state, measurement) -> (state, command).

A controller acts on one wheelset, and each wheelset has its own; or it acts on all wheelsets of a vehicle. A user's own
controller needs no base class: an object with these attributes is one. ``step`` must be written with the functions of
:mod:`wspd_design.model.number` in place of ``if``, ``max`` and ``math``, so that the same code runs on floats and can
be traced into compiled code.
"""

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple, Protocol, TypeAlias

from wspd_design.model.number import Number

if TYPE_CHECKING:
    from typing_extensions import TypeIs

State: TypeAlias = tuple[Number, ...]
"""All that a controller remembers from one sample to the next."""


class Measurement(NamedTuple):
    """What the controller of one wheelset knows at a sampling instant."""

    speed: Number  # m/s, train
    wheel_speed: Number  # rad/s
    torque: Number  # N m, braking torque of this wheelset, from its cylinder pressure


class Command(NamedTuple):
    """Shares of the coming sample time: fill first, then vent, hold for the rest."""

    fill: Number
    vent: Number


class Controller(Protocol):
    """A wheel slide protection law for one wheelset."""

    @property
    def name(self) -> str:
        """Name in tables and reports."""

    @property
    def sample_time(self) -> float:
        """Sampling interval [s]."""

    def start(self, measurement: Measurement) -> State:
        """Return the state before the first sample."""

    def step(self, state: State, measurement: Measurement) -> tuple[State, Command]:
        """Return the state after this sample and the command until the next."""


class VehicleMeasurement(NamedTuple):
    """What the controller of a vehicle knows at a sampling instant; a tuple has one element for each wheelset.

    Wheelsets count from the front.
    """

    speed: Number  # m/s, of the train, from a source of its own such as a radar
    wheel_speeds: tuple[Number, ...]  # rad/s, 0 where the sensor is lost
    torques: tuple[Number, ...]  # N m, as told to the controllers of one wheelset
    healthy: tuple[Number, ...]  # 1, or 0 where the speed sensor is known to be lost
    pressures: tuple[Number, ...]  # Pa, of the brake cylinders
    acceleration: Number  # m/s2, of an accelerometer: rate of the train speed and gravity along the track
    demand: Number  # -, pressure that the driver's brake asks for over the largest one
    reservoir: Number  # Pa

    def of(self, wheelset: int) -> Measurement:
        """Return what the controller of one wheelset knows, counted from 0 at the front."""
        return Measurement(self.speed, self.wheel_speeds[wheelset], self.torques[wheelset])


class VehicleController(Protocol):
    """A wheel slide protection law for all wheelsets of a vehicle, which share its state."""

    @property
    def name(self) -> str:
        """Name in tables and reports."""

    @property
    def sample_time(self) -> float:
        """Sampling interval [s]."""

    @property
    def wheelsets(self) -> int:
        """Number of wheelsets that it acts on; a controller of one wheelset has no such attribute."""

    def start(self, measurement: VehicleMeasurement) -> State:
        """Return the state before the first sample."""

    def step(self, state: State, measurement: VehicleMeasurement) -> tuple[State, tuple[Command, ...]]:
        """Return the state after this sample and the command of each wheelset until the next."""


Law: TypeAlias = Controller | VehicleController
"""A controller of one wheelset or of a vehicle."""


def acts_on_vehicle(law: Law) -> "TypeIs[VehicleController]":
    """Tell whether a law acts on all wheelsets of a vehicle."""
    return hasattr(law, "wheelsets")


@dataclass(frozen=True, slots=True, kw_only=True)
class ByWheelset:
    """The controller of a vehicle that asks a controller of one wheelset for each of them.

    Its state has the first element of all wheelsets first, then the second one, and so on.
    """

    law: Controller
    wheelsets: int

    @property
    def name(self) -> str:
        """Name of the law."""
        return self.law.name

    @property
    def sample_time(self) -> float:
        """Sampling interval of the law [s]."""
        return self.law.sample_time

    def start(self, measurement: VehicleMeasurement) -> State:
        """Start the controller of every wheelset."""
        starts = [self.law.start(measurement.of(each)) for each in range(self.wheelsets)]
        return tuple(element for elements in zip(*starts, strict=True) for element in elements)

    def step(self, state: State, measurement: VehicleMeasurement) -> tuple[State, tuple[Command, ...]]:
        """Let the controller of every wheelset decide by itself."""
        decided = [
            self.law.step(state[each :: self.wheelsets], measurement.of(each))
            for each in range(self.wheelsets)
        ]
        following = zip(*(after for after, _ in decided), strict=True)
        state = tuple(element for elements in following for element in elements)
        return state, tuple(command for _, command in decided)


TRAIN_SPEED = "train_speed"
"""Name in ``memory`` of the train speed that a controller of a vehicle goes by [m/s]."""


def slip_reference_name(wheelset: int) -> str:
    """Name in ``memory`` of the slip that a controller of a vehicle holds, wheelsets counted from 1."""
    return f"slip_reference_{wheelset}"


def pulse_width(duty: Number) -> Command:
    """Fill for the duty and vent for the rest of the sample time, eq. (13)."""
    return Command(fill=duty, vent=1.0 - duty)
