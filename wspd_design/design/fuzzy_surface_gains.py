"""Gains of the mended adaptive fuzzy law by stated rules.

The law has no model of the vehicle. Its rules know by how much the nominal brake changes the acceleration of the rim,
from which layer and rates follow.
"""

import math
from dataclasses import replace

from wspd_design.design.protection_gains import protection_gains
from wspd_design.design.records import Gain, Specification
from wspd_design.parameters.records import Rail, Vehicle

RULES = 5  # membership functions
LAG_PART = 6.0  # part of the lag of the valve that the surface takes longer than a sample
FILTER_PART = 24.0  # part of the lag that the difference is filtered with
LAYER_SHARE = 0.05  # of the acceleration that the full torque gives the rim
WEIGHT_TIME = 0.5  # s, in which one layer beyond the layer adapts a weight by a whole sample
LEAKAGE = 0.4  # of the layer
PULSE_SHARE = 0.1  # of the sample


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
    strongest = vehicle.wheel_radius * brake.max_torque / vehicle.wheelset_inertia
    layer = LAYER_SHARE * strongest
    rate = 1.0 / layer / WEIGHT_TIME
    common = [
        replace(
            gain,
            value=max(brake.shortest_pulse, PULSE_SHARE * period),
            why=f"{PULSE_SHARE:.0%} of a sample, or the shortest pulse of the valve: the valves rest near the surface",
        )
        if gain.name == "least_pulse"
        else gain
        for gain in protection_gains(vehicle, rail, specification)
    ]
    return (
        *common,
        Gain(
            name="surface_rate",
            value=1.0 / (period + lag / LAG_PART),
            unit="1/s",
            why=f"k = 1/(h + tau/{LAG_PART:g}), h = {period:g} s, tau = {lag:g} s: as fast as sample and valve allow",
        ),
        Gain(
            name="rate_filter",
            value=lag / FILTER_PART,
            unit="s",
            why=f"tau/{FILTER_PART:g}: the difference of two samples is smoothed where the sample is short",
        ),
        Gain(
            name="layer",
            value=layer,
            unit="m/s^2",
            why=f"Phi = {LAYER_SHARE:g} R T_max/J: a twentieth of the {strongest:.3g} m/s^2 that the full torque gives "
            "the rim",
        ),
        Gain(
            name="weight_rate",
            value=rate,
            unit="s/m",
            why=f"one layer beyond the layer adapts a weight by a whole sample in {WEIGHT_TIME:g} s",
        ),
        Gain(name="bound_rate", value=rate, unit="s/m", why="as the weights"),
        Gain(
            name="leakage",
            value=LEAKAGE * layer,
            unit="m/s^2",
            why=f"{LEAKAGE:g} Phi: weights that nothing needs fade",
        ),
        Gain(name="initial_weights", value=(0.0,) * RULES, unit="-", why="nothing is known of the rail"),
        Gain(name="initial_bound", value=1.0, unit="-", why="the whole sample at the edge of the layer"),
        Gain(
            name="centres",
            value=tuple(layer * (number - RULES // 2) for number in range(RULES)),
            unit="m/s^2",
            why="evenly, a layer apart",
        ),
        Gain(
            name="widths",
            value=(layer / (2.0 * math.sqrt(math.log(2.0))),) * RULES,
            unit="m/s^2",
            why="spacing/(2 sqrt(ln 2)): neighbors cross at one half",
        ),
    )
