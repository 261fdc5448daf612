"""Gains that every law of a vehicle has, by stated rules.

The slip that is held decides most: a reference that falls as 1/sqrt(v) runs beside the peaks of the rails that are
known here.
"""

from wspd_design.controllers.protected import OBSERVER_NOISE, observer_rate
from wspd_design.design.records import Gain, Specification
from wspd_design.parameters.records import Rail, Vehicle
from wspd_design.parameters.units import KMH
from wspd_design.simulation.peak import peak_adhesion

UNKNOWN_RAIL = (
    0.16  # -, slip at 1 m/s between the peaks of the rails known here, on the side of the small slips
)
SEARCH_START = 0.15  # -, likewise where it is searched for: to grow costs less than to fall back
LARGEST_SLIP = 0.35  # -
CUT_OUT = 5.0 / KMH  # m/s
SEEKING_AMPLITUDE, SEEKING_GAIN, SEEKING_BIAS = 0.1, 3.0, 0.0
SEEKING_PERIOD = 0.75  # s, half of it
PEAK_POINTS = 12  # of the table of the peak


def protection_gains(vehicle: Vehicle, rail: Rail, specification: Specification) -> tuple[Gain, ...]:
    """Choose the gains that every law of a vehicle has.

    Parameters
    ----------
    vehicle : Vehicle
        The vehicle, nominal values.
    rail : Rail
        Design rail, for the table of the peak.
    specification : Specification
        Ranges and reference.
    """
    brake = vehicle.brake
    searched = specification.reference == "seeking"
    slip = SEARCH_START if searched else UNKNOWN_RAIL
    return (
        Gain(
            name="falling_slip",
            value=slip,
            unit="-",
            why=f"c of c/sqrt(v) with v in m/s: the peaks of the known rails lie at c = 0.1 to 0.32; {slip:g} loses "
            + ("least while the search for the peak begins" if searched else "least over all of them"),
        ),
        Gain(
            name="largest_slip",
            value=LARGEST_SLIP,
            unit="-",
            why="limit of c/sqrt(v), which has none at standstill",
        ),
        *(_peak(vehicle, rail, specification) if specification.reference == "peak" else ()),
        *(_seeking() if searched else ()),
        Gain(
            name="observer_rate",
            value=observer_rate(specification.sample_time),
            unit="1/s",
            why=f"w_o with (1 - exp(-w_o h))^2/h = {OBSERVER_NOISE:g} 1/s, but no faster than friction: as much "
            "noise of the wheel speed in the friction torque at every sample time, "
            f"h = {specification.sample_time:g} s",
        ),
        Gain(
            name="least_pulse",
            value=brake.shortest_pulse,
            unit="s",
            why="the shortest pulse that opens the valve"
            if brake.shortest_pulse
            else "the vehicle states no shortest pulse",
        ),
        Gain(
            name="cut_out_speed",
            value=CUT_OUT,
            unit="m/s",
            why=f"below {CUT_OUT * KMH:g} km/h the valves hold: slip poles are faster than any sample there",
        ),
    )


def _peak(vehicle: Vehicle, rail: Rail, specification: Specification) -> tuple[Gain, Gain]:
    """Table of the slip at the peak of the design rail."""
    import numpy as np

    speeds = np.geomspace(CUT_OUT, specification.speeds[1], PEAK_POINTS)
    slips, _ = peak_adhesion(vehicle, rail, speeds)
    why = f"the adhesion of {rail.name} peaks there, under the static load"
    return (
        Gain(name="peak_speeds", value=tuple(map(float, speeds)), unit="m/s", why=why),
        Gain(name="peak_slips", value=tuple(map(float, slips)), unit="-", why=why),
    )


def _seeking() -> tuple[Gain, ...]:
    """Gains of the search for the peak."""
    return (
        Gain(
            name="seeking_amplitude",
            value=SEEKING_AMPLITUDE,
            unit="-",
            why=f"{SEEKING_AMPLITUDE:.0%} of the slip to both sides: costs little where the peak is flat",
        ),
        Gain(
            name="seeking_period",
            value=SEEKING_PERIOD,
            unit="s",
            why="half a period: the slip follows its reference within some tenths of a second, and friction is then "
            "averaged over as long",
        ),
        Gain(
            name="seeking_gain",
            value=SEEKING_GAIN,
            unit="-",
            why="change of ln(slip) per slope of ln(friction)",
        ),
        Gain(
            name="seeking_bias",
            value=SEEKING_BIAS,
            unit="-",
            why="slope of ln(friction) that is sought: that of the peak",
        ),
    )
