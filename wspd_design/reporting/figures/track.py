"""The synthesized track and its spectra."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from wspd_design.reporting.figure_style import SERIES
from wspd_design.reporting.figures.drawing import KILO, curve
from wspd_design.studies.paper.disturbances import ChannelKind, TrackChannel

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MOST = 400  # points of a profile


def spectra(figure: "Figure", channels: Sequence[TrackChannel]) -> "Figure":
    """Draw the spectrum of eq. (49) and that of the synthesized profile, a panel for each channel."""
    from matplotlib.ticker import FixedLocator, NullLocator, ScalarFormatter

    row = figure.subplots(1, len(channels))
    for axes, each in zip(row, channels, strict=True):
        axes.loglog(
            each.wavenumber,
            each.found,
            color=SERIES[0],
            linestyle="none",
            marker=".",
            markersize=3,
            label="synthesized",
        )
        axes.loglog(each.wavenumber, each.density, color=SERIES[1], linestyle="-", label="eq. (49)")
        axes.set(title=each.channel, xlabel="wavenumber [rad/m]")
        axes.xaxis.set_major_locator(FixedLocator([0.3, 0.5, 1.0, 2.0]))
        axes.xaxis.set_major_formatter(ScalarFormatter())
        axes.xaxis.set_minor_locator(NullLocator())
        unit = "rad²" if each.kind is ChannelKind.ANGLE else "m²"
        axes.set_ylabel(f"density [{unit}/(rad/m)]")
    row[0].legend(loc="lower left")
    return figure


def profiles(figure: "Figure", channels: Sequence[TrackChannel]) -> "Figure":
    """Draw the profiles over distance, a panel for each channel."""
    rows = figure.subplots(len(channels), 1, sharex=True)
    for axes, each in zip(rows, channels, strict=True):
        curve(axes, each.distance, each.profile * KILO, 0, most=MOST, linewidth=0.9)
        axes.set(title=each.channel, ylabel=f"{each.kind.value} [{milli_unit(each)}]")
    rows[-1].set(xlabel="distance [m]", xlim=(0.0, float(channels[0].distance[-1])))
    return figure


def milli_unit(channel: TrackChannel) -> str:
    """Return the unit of a thousandth of a channel's profile."""
    return "mrad" if channel.kind is ChannelKind.ANGLE else "mm"
