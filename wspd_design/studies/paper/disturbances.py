"""What the disturbances of the paper's simulations change: vibrating pads and an irregular track."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import Enum
from typing import TYPE_CHECKING

from wspd_design.controllers.protocol import Law
from wspd_design.parameters.records import TrackSpectrum, Vehicle
from wspd_design.simulation.comparison import Trial
from wspd_design.simulation.ideal import ideal_stop
from wspd_design.simulation.records import LoadIrregularity, Scenario
from wspd_design.simulation.stop import simulate
from wspd_design.simulation.track import (
    SPACING,
    band,
    spectrum,
    standard_deviation,
    synthesize,
    welch_spectrum,
)

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]


class ChannelKind(Enum):
    """What a channel of the track measures."""

    OFFSET = "offset"
    HEIGHT = "height"
    ANGLE = "angle"


CHANNELS = {
    "lateral-high": ChannelKind.OFFSET,
    "vertical-high": ChannelKind.HEIGHT,
    "cross-level-high": ChannelKind.ANGLE,
}
"""The rows of Table 9, in its order: horizontal, vertical and "lateral", which is the cross level."""

LOAD_SPREAD = 0.04
"""Assumed standard deviation of the relative wheel load: multibody simulations of this track give 0.03 to 0.05."""

SHOWN = 300.0  # m of the profile
WELCH_PERIOD, WELCH_SEGMENT = 6800.0, 200.0  # m
MARGIN = 0.06  # rad/m, two lines of the estimate, which the edges of the band blur


@dataclass(frozen=True, slots=True, kw_only=True)
class TrackChannel:
    """A synthesized channel and its spectrum, stated by eq. (49) and estimated from the profile."""

    channel: str
    kind: ChannelKind
    sigma: float  # m or rad, from the spectrum, in the band
    found_sigma: float  # of the profile
    ratio: float  # estimated over stated density, mean over the band
    wavenumber: "Array"  # rad/m
    density: "Array"  # stated
    found: "Array"  # estimated by Welch's method
    distance: "Array"  # m, of the profile that is shown
    profile: "Array"  # m or rad


@dataclass(frozen=True, slots=True, kw_only=True)
class Disturbance:
    """What disturbances change in one stop."""

    controller: str
    rail: str
    spread: float  # m, of the distance without any; 0 unless the closed loop is sensitive
    by_pads: float  # m, change of the distance with T_d of Section 7
    by_track: float  # m, with irregular wheel loads


def track_channel(track: TrackSpectrum, channel: str, *, seed: int) -> TrackChannel:
    """Synthesize a channel and estimate its spectrum from a long profile."""
    import numpy as np

    long = synthesize(track, (channel,), seed=seed, period=WELCH_PERIOD, spacing=SPACING)
    values = long.values[0, long.lead :]
    wavenumber, found = welch_spectrum(values, SPACING, WELCH_SEGMENT)
    low, high = band(track)
    inside = (wavenumber > low + MARGIN) & (wavenumber < high - MARGIN)
    stated = spectrum(track, channel, wavenumber[inside])
    short = synthesize(track, (channel,), seed=seed)
    distance = np.arange(0.0, SHOWN, SPACING)
    return TrackChannel(
        channel=channel,
        kind=CHANNELS[channel],
        sigma=standard_deviation(track, channel),
        found_sigma=float(values.std()),
        ratio=float(np.mean(found[inside] / stated)),
        wavenumber=wavenumber[inside],
        density=stated,
        found=found[inside],
        distance=distance,
        profile=short.at(distance)[0][0],
    )


def disturbance(
    vehicle: Vehicle, controller: Law, undisturbed: Trial, scenario: Scenario, load: LoadIrregularity
) -> Disturbance:
    """Simulate a stop again with each disturbance alone."""

    def change(disturbed: Scenario) -> float:
        distance = simulate(vehicle, controller, disturbed).totals.distance
        return distance - undisturbed.metrics.distance

    return Disturbance(
        controller=controller.name,
        rail=scenario.rail.name,
        spread=undisturbed.check.spread,
        by_pads=change(replace(scenario, pad_vibration=True)),
        by_track=change(replace(scenario, load_irregularity=load)),
    )


def ideal_change(vehicle: Vehicle, scenario: Scenario, load: LoadIrregularity) -> float:
    """Change of the ideal stop by irregular wheel loads: what the track costs a perfect brake [m]."""
    disturbed = ideal_stop(vehicle, replace(scenario, load_irregularity=load))
    return disturbed.distance - ideal_stop(vehicle, scenario).distance


def largest_change(disturbances: Sequence[Disturbance], *, sensitive: bool) -> float:
    """Largest change of a distance among the sensitive stops or among the others; 0 where there are none [m]."""
    changes = (
        max(abs(each.by_pads), abs(each.by_track))
        for each in disturbances
        if (each.spread > 0.0) == sensitive
    )
    return max(changes, default=0.0)
