"""The Knorr-Bremse controller: slide regions and wheel acceleration, eqs. (17), (18) and Table 4."""

from dataclasses import dataclass

from wspd_design.controllers.protocol import Command, Measurement, State
from wspd_design.model.number import Number, minimum, where
from wspd_design.parameters.records import KnorrBremseTable


@dataclass(frozen=True, slots=True, kw_only=True)
class KnorrBremse:
    """Graded fill and vent pulses from a decision table; its state is (rim speed at the last sample,)."""

    name: str
    sample_time: float  # s
    wheel_radius: float  # m
    table: KnorrBremseTable

    def start(self, measurement: Measurement) -> State:
        """Start with the present rim speed, that is without acceleration."""
        return (self.wheel_radius * measurement.wheel_speed,)

    def step(self, state: State, measurement: Measurement) -> tuple[State, Command]:
        """Look the pulse up by wheel acceleration (row) and slide region (column)."""
        (previous,) = state
        rim = self.wheel_radius * measurement.wheel_speed
        row = _count_below(self.table.acceleration_limits, (rim - previous) / self.sample_time)
        column = _count_below(self._slide_limits(measurement.speed), measurement.speed - rim)
        decision: Number = 0.0
        for i, line in enumerate(self.table.decisions):
            for j, entry in enumerate(line):
                decision = where(row == i, where(column == j, entry, decision), decision)
        pulse: Number = self.table.pulses[0]
        for size, share in enumerate(self.table.pulses):
            pulse = where(abs(decision) == size, share, pulse)
        return (rim,), Command(fill=where(decision > 0.0, pulse, 0.0), vent=where(decision < 0.0, pulse, 0.0))

    def _slide_limits(self, speed: Number) -> tuple[Number, ...]:
        """Limits of the slide regions I to IV at a train speed, eq. (18) [m/s]."""
        lines = zip(self.table.slide_slopes, self.table.slide_offsets, self.table.slide_caps, strict=True)
        return tuple(minimum(slope * speed + offset, cap) for slope, offset, cap in lines)


def _count_below(limits: tuple[Number, ...], value: Number) -> Number:
    """Return how many of the rising limits lie below the value."""
    return sum((where(value > limit, 1.0, 0.0) for limit in limits), 0.0)
