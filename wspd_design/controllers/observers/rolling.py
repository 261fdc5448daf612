"""What wheels say about the speed of their train while they roll without braking."""

from wspd_design.controllers.protocol import VehicleMeasurement
from wspd_design.model.number import Number, maximum

RELEASED_DEMAND = 0.02
"""Demand up to which a brake counts as released: it asks for less adhesion than any rail gives [-]."""


def mean_rim_speed(seen: VehicleMeasurement, wheel_radius: Number) -> Number:
    """Mean speed of the rims whose sensors are healthy; 0 without any [m/s].

    Parameters
    ----------
    seen : VehicleMeasurement
        What the sensors show.
    wheel_radius : number
        Nominal radius of all wheels [m].
    """
    rims = [h * wheel_radius * w for h, w in zip(seen.healthy, seen.wheel_speeds, strict=True)]
    return total(rims) / maximum(total(seen.healthy), 1.0)


def total(numbers: tuple[Number, ...] | list[Number]) -> Number:
    """Sum of some numbers, at least one."""
    first, *others = numbers
    for number in others:
        first = first + number
    return first
