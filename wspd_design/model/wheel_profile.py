"""Profiles of wheel and rail as a wheelset meets them: rolling radius and contact angle over its lateral displacement.

Of one wheel; a displacement is positive towards its own flange, so that the wheel on the other side of the axle has the
same functions of the displacement with the other sign. All functions run on floats, arrays and symbols.
"""

import math
from dataclasses import dataclass
from typing import Protocol

from wspd_design.model.number import Number, maximum
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.files import data_file, read_toml


class WheelProfile(Protocol):
    """What the motion of a wheelset needs of the profiles of wheel and rail."""

    def radius_growth(self, displacement: Number) -> Number:
        """Rolling radius at this displacement less that in the middle of the track [m]."""

    def contact_slope(self, displacement: Number) -> Number:
        """Tangent of the contact angle [-]."""

    def lift(self, displacement: Number) -> Number:
        """Height by which the rail lifts the wheel, the integral of the contact slope [m]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Quasilinear:
    """Rolling radius and contact slope that are linear in the displacement."""

    conicity: Number  # -, slope of the rolling radius
    slope: Number  # -, contact slope in the middle of the track
    slope_gain: Number = 0.0  # 1/m, growth of the contact slope with the displacement

    def radius_growth(self, displacement: Number) -> Number:
        """Rolling radius at this displacement less that in the middle of the track [m]."""
        return self.conicity * displacement

    def contact_slope(self, displacement: Number) -> Number:
        """Tangent of the contact angle [-]."""
        return self.slope + self.slope_gain * displacement

    def lift(self, displacement: Number) -> Number:
        """Height by which the rail lifts the wheel, the integral of the contact slope [m]."""
        return displacement * (self.slope + 0.5 * self.slope_gain * displacement)


def cone(conicity: Number) -> Quasilinear:
    """Profile of a coned wheel on a rounded rail: its contact slope is its conicity everywhere."""
    return Quasilinear(conicity=conicity, slope=conicity)


@dataclass(frozen=True, slots=True, kw_only=True)
class TableProfile:
    """Rolling radius and contact slope from a table, straight between its rows and beyond its ends."""

    displacements: tuple[float, ...]  # m, rising
    radius_growths: tuple[float, ...]  # m
    slopes: tuple[float, ...]  # -

    def __post_init__(self) -> None:
        """Refuse what is no table."""
        rows = len(self.displacements)
        if rows < 2 or not len(self.radius_growths) == len(self.slopes) == rows:
            raise UserError(
                "table of a wheel profile: it needs two or more rows, each with displacement, radius and slope"
            )
        if not all(map(math.isfinite, (*self.displacements, *self.radius_growths, *self.slopes))):
            raise UserError("table of a wheel profile: every number must be finite")
        if sorted(set(self.displacements)) != list(self.displacements):
            raise UserError("table of a wheel profile: the displacements must rise from row to row")

    def radius_growth(self, displacement: Number) -> Number:
        """Rolling radius at this displacement less that in the middle of the track [m]."""
        table = self.radius_growths
        return _straight(self.displacements, table, displacement) - _straight(self.displacements, table, 0.0)

    def contact_slope(self, displacement: Number) -> Number:
        """Tangent of the contact angle [-]."""
        return _straight(self.displacements, self.slopes, displacement)

    def lift(self, displacement: Number) -> Number:
        """Height by which the rail lifts the wheel, the integral of the contact slope [m]."""
        return _integral(self.displacements, self.slopes, displacement) - _integral(
            self.displacements, self.slopes, 0.0
        )


def s1002_on_uic60() -> TableProfile:
    """Wheel S1002 on rail UIC60 at 1:40, from the Manchester contact benchmark."""
    table = read_toml(data_file("s1002-uic60.toml"), "s1002-uic60.toml")
    return TableProfile(
        displacements=tuple(1e-3 * value for value in table["displacement_mm"]),
        radius_growths=tuple(1e-3 * value for value in table["radius_growth_mm"]),
        slopes=tuple(math.tan(value) for value in table["contact_angle_rad"]),
    )


def _bends(x: tuple[float, ...], y: tuple[float, ...]) -> list[tuple[float, float]]:
    """Places between the rows, and by how much the line is steeper after them."""
    steep = [(y[k + 1] - y[k]) / (x[k + 1] - x[k]) for k in range(len(x) - 1)]
    return [(x[k + 1], steep[k + 1] - steep[k]) for k in range(len(steep) - 1)]


def _straight(x: tuple[float, ...], y: tuple[float, ...], at: Number) -> Number:
    """Straight lines between points, as a sum of bends that runs on symbols too."""
    value = y[0] + (y[1] - y[0]) / (x[1] - x[0]) * (at - x[0])
    for place, bend in _bends(x, y):
        value = value + bend * maximum(at - place, 0.0)
    return value


def _integral(x: tuple[float, ...], y: tuple[float, ...], at: Number) -> Number:
    """Integral of straight lines between points, from the first point on."""
    length = at - x[0]
    value = length * (y[0] + 0.5 * (y[1] - y[0]) / (x[1] - x[0]) * length)
    for place, bend in _bends(x, y):
        beyond = maximum(at - place, 0.0)
        value = value + 0.5 * bend * beyond * beyond
    return value
