"""Gains of the mended adaptive fuzzy law by stated rules.

The law has no model of the vehicle, but its rules know by how much the nominal brake moves the surface in a sample:
g = R T/(J tau) per unit of the command, from which the layer and the rates follow.
"""

import math

from wspd_design.design.protection_gains import protection_gains
from wspd_design.design.records import Gain, Specification
from wspd_design.parameters.records import Rail, Vehicle

RULES = 5  # membership functions
CLOSED = 0.5  # of the surface, that the command takes back in a sample within the layer
WEIGHT_TIME = 2.0  # s, in which one layer beyond the layer adapts a weight by a whole sample
HALF_TORQUE = 0.5  # of the full torque, at which the brake is looked at


def fuzzy_surface_gains(vehicle: Vehicle, rail: Rail, specification: Specification) -> tuple[Gain, ...]:
    """Choose the gains of the mended adaptive fuzzy law.

    Parameters
    ----------
    vehicle : Vehicle
        The vehicle, nominal values.
    rail : Rail
        Design rail, for the table of the peak.
    specification : Specification
        Ranges, sample time and reference.

    Returns
    -------
    tuple of Gain
        Gains of the protection and of the law.
    """
    brake, period = vehicle.brake, specification.sample_time
    lag = max(brake.fill_time, brake.vent_time)
    moved = vehicle.wheel_radius * HALF_TORQUE * brake.max_torque / vehicle.wheelset_inertia / lag
    filter_time = period
    rate = 1.0 / (2.0 * period + lag / 6.0)
    layer = moved * (period + filter_time) / CLOSED
    spacing = layer
    return (
        *protection_gains(vehicle, rail, specification),
        Gain(
            name="surface_rate",
            value=rate,
            unit="1/s",
            why="k = 1/(2 h + tau/6): two samples, of which the filter takes one, and a sixth of the lag",
        ),
        Gain(
            name="rate_filter",
            value=filter_time,
            unit="s",
            why="one sample: noise of the wheel speed is halved",
        ),
        Gain(
            name="layer",
            value=layer,
            unit="m/s^2",
            why=f"Phi = g (h + filter)/{CLOSED:g}: a command takes {CLOSED:.0%} of the surface back; g = {moved:.3g} m/s^3",
        ),
        Gain(
            name="weight_rate",
            value=1.0 / layer / WEIGHT_TIME,
            unit="s/m",
            why="one layer beyond the layer adapts a weight by a whole sample in 2 s",
        ),
        Gain(name="bound_rate", value=1.0 / layer / WEIGHT_TIME, unit="s/m", why="as the weights"),
        Gain(
            name="leakage",
            value=0.2 * layer,
            unit="m/s^2",
            why="a fifth of the layer: without a cause weights fade",
        ),
        Gain(name="initial_weights", value=(0.0,) * RULES, unit="-", why="nothing is known of the rail"),
        Gain(name="initial_bound", value=1.0, unit="-", why="the whole sample beyond the layer"),
        Gain(
            name="centres",
            value=tuple(spacing * (n - RULES // 2) for n in range(RULES)),
            unit="m/s^2",
            why="evenly, a layer apart",
        ),
        Gain(
            name="widths",
            value=(spacing / (2.0 * math.sqrt(math.log(2.0))),) * RULES,
            unit="m/s^2",
            why="spacing/(2 sqrt(ln 2)): neighbors cross at one half",
        ),
    )
