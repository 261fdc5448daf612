"""The Trenitalia controller: wheel speed and acceleration bands, eq. (16) and Table 3."""

from dataclasses import dataclass

from wspd_design.controllers.protocol import Command, Measurement, State
from wspd_design.model.number import where
from wspd_design.parameters.records import TrenitaliaTable


@dataclass(frozen=True, slots=True, kw_only=True)
class Trenitalia:
    """Fill, vent or hold by the rim speed; its state is (rim speed at the last sample,)."""

    name: str
    sample_time: float  # s
    wheel_radius: float  # m
    table: TrenitaliaTable

    def start(self, measurement: Measurement) -> State:
        """Start with the present rim speed, that is without acceleration."""
        return (self.wheel_radius * measurement.wheel_speed,)

    def step(self, state: State, measurement: Measurement) -> tuple[State, Command]:
        """Decide by Table 3; the acceleration is the difference over one sample."""
        (previous,) = state
        table = self.table
        rim = self.wheel_radius * measurement.wheel_speed
        acceleration = (rim - previous) / self.sample_time
        inside = where(
            acceleration > table.acceleration_limit,
            1.0,
            where(acceleration < table.deceleration_limit, -1.0, 0.0),
        )
        decision = where(
            rim > table.upper_speed_ratio * measurement.speed,
            1.0,
            where(rim < table.lower_speed_ratio * measurement.speed, -1.0, inside),
        )
        return (rim,), Command(
            fill=where(decision > 0.0, table.fill_pulse, 0.0),
            vent=where(decision < 0.0, table.vent_pulse, 0.0),
        )
