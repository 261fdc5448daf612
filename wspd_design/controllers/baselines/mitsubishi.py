"""The Mitsubishi fuzzy controller: Table 5 with max-product inference and center average."""

from dataclasses import dataclass

from wspd_design.controllers.protocol import Command, Measurement, State, pulse_width
from wspd_design.model.number import Number, clip, maximum, minimum
from wspd_design.parameters.records import MitsubishiTable


@dataclass(frozen=True, slots=True, kw_only=True)
class Mitsubishi:
    """Fuzzy duty from the slide and its rate; its state is (slide at the last sample,).

    The rows of Table 5 are read as +d sigma/dt. With the printed sign the rules fill while the slide grows.
    """

    name: str
    sample_time: float  # s
    wheel_radius: float  # m
    table: MitsubishiTable

    def start(self, measurement: Measurement) -> State:
        """Start with the present slide, that is without a rate."""
        return (self._slide(measurement),)

    def step(self, state: State, measurement: Measurement) -> tuple[State, Command]:
        """Weigh the rule levels by the product of the memberships."""
        (previous,) = state
        slide = self._slide(measurement)
        slide_memberships = triangles(self.table.slide_centres, slide)
        rate_memberships = triangles(self.table.rate_centres, (slide - previous) / self.sample_time)
        # Max-product: of all rules that name one output level the strongest counts.
        strengths: dict[float, Number] = {}
        for rate, row in zip(rate_memberships, self.table.rules, strict=True):
            for near, level in zip(slide_memberships, row, strict=True):
                strengths[level] = maximum(strengths.get(level, 0.0), rate * near)
        output = sum(level * weight for level, weight in strengths.items()) / sum(strengths.values())
        return (slide,), pulse_width(clip(self.table.duty_offset + self.table.duty_gain * output, 0.0, 1.0))

    def _slide(self, measurement: Measurement) -> Number:
        """Absolute slide sigma = v - R omega, eq. (17) [m/s]."""
        return measurement.speed - self.wheel_radius * measurement.wheel_speed


def triangles(centres: tuple[float, ...], value: Number) -> tuple[Number, ...]:
    """Memberships of triangles that cross at one half, with shoulders at both ends."""
    inside = clip(value, centres[0], centres[-1])
    memberships = []
    for index, centre in enumerate(centres):
        membership: Number = 1.0
        if index > 0:
            membership = minimum(membership, (inside - centres[index - 1]) / (centre - centres[index - 1]))
        if index < len(centres) - 1:
            membership = minimum(membership, (centres[index + 1] - inside) / (centres[index + 1] - centre))
        memberships.append(maximum(membership, 0.0))
    return tuple(memberships)
