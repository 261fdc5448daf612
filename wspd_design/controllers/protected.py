"""Protections of vehicles, put together from what a law is built from."""

import math
from collections.abc import Callable

from wspd_design.controllers.given import Given
from wspd_design.controllers.observers.selection import speed_source
from wspd_design.controllers.observers.sensors import Sensors
from wspd_design.controllers.offers import slip_reference_of
from wspd_design.controllers.protection import Protection, ProtectionGains
from wspd_design.controllers.protocol import Controller, Measurement
from wspd_design.controllers.references import ConstantSlip, FallingSlip, Reference, ReferenceKind, SlipTable
from wspd_design.controllers.seeking import PeakSeeking
from wspd_design.controllers.valve_inversion import ValveInversion
from wspd_design.controllers.wheel_law import OneWheelset, WheelLaw
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.records import Vehicle

OBSERVER_NOISE = 10.0
"""Torque over inertia that noise of 1 rad/s of the wheel speed moves the observed friction by [1/s]."""
FASTEST_OBSERVER = 45.0  # 1/s, faster than friction and valve change
_SPEED = 10.0  # m/s, at which a controller is asked how much it remembers
_SHARED = 2  # wheelsets with a brake that a search compares
_SLIP = 0.14  # the paper's, of controllers that do not say which slip they hold


def protection(
    given: Given, core: Callable[[ValveInversion], WheelLaw], *, time_share: float = 1.0
) -> Protection:
    """Put the protection of a law of a vehicle together.

    Parameters
    ----------
    given : Given
        Vehicle, sensors, reference and gains.
    core : callable
        Makes the law of one wheelset from the model of its valve.
    time_share : float
        Of the nominal valve times, that the law inverts the valve with.
    """
    vehicle, gains = given.vehicle, given.numbers
    valve = ValveInversion(
        brake=vehicle.brake,
        sample_time=given.sample_time,
        time_share=time_share,
        least_pulse=gains.least_pulse,
    )
    return Protection(
        name=given.name,
        sample_time=given.sample_time,
        wheel_radius=vehicle.wheel_radius,
        wheelset_inertia=vehicle.wheelset_inertia,
        torque_shares=vehicle.brake_shares,
        source=speed_source(given.sensors, vehicle, given.sample_time),
        reference=reference(given.reference, gains),
        core=core(valve),
        valve=valve,
        pressure_sensors=given.sensors.pressures,
        observer_rate=gains.observer_rate,
        cut_out_speed=gains.cut_out_speed,
        seeking=_seeking(given) if given.reference == "seeking" else None,
    )


def _seeking(given: Given) -> PeakSeeking:
    """Return the search for the peak with its gains."""
    if sum(share > 0.0 for share in given.vehicle.brake_shares) < _SHARED:
        raise UserError(
            f'reference = "seeking" compares wheelsets, and {given.vehicle.name} has not two with a brake; choose '
            '"falling" or "constant"'
        )
    gains = given.numbers
    return PeakSeeking(
        sample_time=given.sample_time,
        amplitude=gains.seeking_amplitude,
        half_period=gains.seeking_period,
        gain=gains.seeking_gain,
        bias=gains.seeking_bias,
    )


def reference(kind: ReferenceKind, gains: ProtectionGains) -> Reference:
    """Return the reference of a kind with its gains."""
    match kind:
        case "constant":
            return ConstantSlip(slip=gains.slip_reference)
        case "peak":
            return SlipTable(speeds=gains.peak_speeds, slips=gains.peak_slips)
        case _:
            return FallingSlip(slip=gains.falling_slip, largest=gains.largest_slip)


def protected(law: Controller, vehicle: Vehicle, sensors: Sensors) -> Protection:
    """Put a controller of one wheelset, as it is, into the protection of a vehicle.

    Parameters
    ----------
    law : Controller
        The controller of every wheelset.
    vehicle : Vehicle
        Nominal values.
    sensors : Sensors
        From which it has train speed and torque.
    """
    seen = Measurement(_SPEED, _SPEED / vehicle.wheel_radius, 0.0)
    valve = ValveInversion(
        brake=vehicle.brake,
        sample_time=law.sample_time,
        time_share=1.0,
        least_pulse=vehicle.brake.shortest_pulse,
    )
    return Protection(
        name=law.name,
        sample_time=law.sample_time,
        wheel_radius=vehicle.wheel_radius,
        wheelset_inertia=vehicle.wheelset_inertia,
        torque_shares=vehicle.brake_shares,
        source=speed_source(sensors, vehicle, law.sample_time),
        reference=ConstantSlip(slip=slip_reference_of(law) or _SLIP),
        core=OneWheelset(law=law, states=len(law.start(seen))),
        valve=valve,
        pressure_sensors=sensors.pressures,
        observer_rate=observer_rate(law.sample_time),
        cut_out_speed=0.0,
    )


def observer_rate(sample_time: float) -> float:
    """Rate of the observer of the friction torque that passes on as much noise at every sample time [1/s].

    Noise of the wheel speed moves the observed torque by (1 - theta)^2 J/h, theta = exp(-rate h).
    """
    left = 1.0 - math.sqrt(min(OBSERVER_NOISE * sample_time, 1.0))
    slowest = math.exp(-FASTEST_OBSERVER * sample_time)
    return -math.log(max(left, slowest)) / sample_time
