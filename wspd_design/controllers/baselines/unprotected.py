"""No wheel slide protection: the brake fills, whatever the wheel does."""

from dataclasses import dataclass

from wspd_design.controllers.protocol import Command, Measurement, State


@dataclass(frozen=True, slots=True, kw_only=True)
class Unprotected:
    """A brake without WSP; it remembers nothing."""

    name: str
    sample_time: float  # s

    def start(self, measurement: Measurement) -> State:  # noqa: ARG002 - nothing to remember
        """Return the empty state."""
        return ()

    def step(self, state: State, measurement: Measurement) -> tuple[State, Command]:  # noqa: ARG002
        """Fill for the whole sample time."""
        return state, Command(fill=1.0, vent=0.0)
