"""Profiles of wheel and rail as a wheelset meets them: rolling radius and contact angle over its lateral displacement.

Of one wheel; a displacement is positive towards its own flange, so that the wheel on the other side of the axle has the
same functions of the displacement with the other sign. All functions run on floats, arrays and symbols.
"""

from dataclasses import dataclass
from typing import Protocol

from wspd_design.model.number import Number


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
