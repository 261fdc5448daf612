"""What a controller is: a sampled difference equation (state, measurement) -> (state, command).

One controller acts on one wheelset. A user's own controller needs no base class: an object with these four
attributes is one. ``step`` must be written with the functions of :mod:`wspd_design.model.number` in place of
``if``, ``max`` and ``math``, so that the same code runs on floats and can be traced into compiled code.
"""

from typing import NamedTuple, Protocol, TypeAlias

from wspd_design.model.number import Number

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


def pulse_width(duty: Number) -> Command:
    """Fill for the duty and vent for the rest of the sample time, eq. (13)."""
    return Command(fill=duty, vent=1.0 - duty)
