"""What a law of one wheelset is inside the protection of a vehicle, which observes and models what the law goes by."""

from dataclasses import dataclass
from typing import NamedTuple, Protocol

from wspd_design.controllers.protocol import Command, Controller, Measurement, State
from wspd_design.model.number import Number


class WheelView(NamedTuple):
    """What the protection knows about one wheelset at a sample."""

    speed: Number  # m/s, of the train as the source has it
    acceleration: Number  # m/s2, of the train, negative while it brakes
    wheel_speed: Number  # rad/s
    rolling_speed: Number  # rad/s, of a wheel without slip
    desired_speed: Number  # rad/s, of the wheel at the desired slip
    desired_acceleration: Number  # rad/s2
    friction_torque: Number  # N m, with which the rail turns the wheelset, as observed
    torque: Number  # N m, of the brake: nominal torque of the measured pressure, or by the model of the valve
    available: Number  # N m, nominal torque of the pressure that the demand allows now
    full_torque: Number  # N m, nominal torque at full pressure


class WheelLaw(Protocol):
    """A law of one wheelset that commands its valve."""

    @property
    def memory(self) -> tuple[str, ...]:
        """Names of the elements of its state."""

    def start(self, view: WheelView) -> State:
        """Return the state before the first sample."""

    def step(self, state: State, view: WheelView) -> tuple[State, Command]:
        """Return the state after this sample and the command until the next."""


@dataclass(frozen=True, slots=True, kw_only=True)
class OneWheelset:
    """A controller of one wheelset as it is, with the speed and the torque of the protection."""

    law: Controller
    states: int  # length of its state

    @property
    def memory(self) -> tuple[str, ...]:
        """Names of the elements of its state, numbered."""
        return tuple(f"{self.law.name} {number}" for number in range(1, self.states + 1))

    def start(self, view: WheelView) -> State:
        """Start the controller."""
        return self.law.start(_measured(view))

    def step(self, state: State, view: WheelView) -> tuple[State, Command]:
        """Let the controller decide."""
        return self.law.step(state, _measured(view))


def _measured(view: WheelView) -> Measurement:
    return Measurement(view.speed, view.wheel_speed, view.torque)
