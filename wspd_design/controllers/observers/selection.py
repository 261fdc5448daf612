"""The source of the train speed that sensors allow."""

from wspd_design.controllers.observers.fastest import FastestAxle
from wspd_design.controllers.observers.protocol import SpeedSource
from wspd_design.controllers.observers.sensors import Sensors
from wspd_design.controllers.observers.told import SOURCE_ERROR, ToldSpeed
from wspd_design.controllers.observers.wheel_filter import WheelFilter
from wspd_design.controllers.observers.wheel_filter_numbers import numbers_for
from wspd_design.parameters.records import Vehicle


def speed_source(sensors: Sensors, vehicle: Vehicle, sample_time: float) -> SpeedSource:
    """Return the source of the train speed of a vehicle.

    Parameters
    ----------
    sensors : Sensors
        What the vehicle has.
    vehicle : Vehicle
        Nominal values.
    sample_time : float
        Of the protection [s].
    """
    radius, wheelsets = vehicle.wheel_radius, vehicle.wheelsets
    match sensors.speed:
        case "told":
            return ToldSpeed(
                sample_time=sample_time,
                wheel_radius=radius,
                wheelsets=wheelsets,
                largest_scale_error=SOURCE_ERROR + _wear(vehicle),
            )
        case "fastest-axle":
            return FastestAxle(sample_time=sample_time, wheel_radius=radius, wheelsets=wheelsets)
        case "wheels":
            return WheelFilter(
                vehicle=vehicle,
                sample_time=sample_time,
                accelerometer=sensors.accelerometer,
                grade=sensors.grade,
                numbers=numbers_for(sample_time, sensors),
            )


def _wear(vehicle: Vehicle) -> float:
    """How much faster or slower a wheel of the stated range turns than a nominal one [-]."""
    low, high = vehicle.bounds.around("wheel_radius", vehicle.wheel_radius)
    return max(vehicle.wheel_radius / low - 1.0, 1.0 - vehicle.wheel_radius / high)
