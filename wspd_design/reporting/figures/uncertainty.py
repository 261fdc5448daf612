"""How figures of a stop spread over drawn sets, and what single numbers do to one of them."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from wspd_design.reporting import numbers
from wspd_design.reporting.figure_style import INK, MUTED, SERIES
from wspd_design.reporting.figures.drawing import note

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

BINS = 24
BAR, NOMINAL = 0.36, 1.2  # share of a row, width of a line [pt]
TICK = 0.04  # of the height of the axes
SEEN = 1e-3  # of the axis; a shorter bar is none


@dataclass(frozen=True, slots=True, kw_only=True)
class Panel:
    """One figure over all sets, in the unit of its axis."""

    label: str
    values: tuple[float, ...]  # those that are finite
    nominal: float
    p05: float
    p95: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Bar:
    """What one number does alone: its name, its bounds in words, and the figure at both; infinite without a stop."""

    name: str
    low: str
    high: str
    at_low: float
    at_high: float


def distributions(figure: "Figure", panels: Sequence[Panel]) -> "Figure":
    """Draw how often each value comes, with the nominal one and the percentiles.

    Parameters
    ----------
    figure : Figure
        Empty figure.
    panels : sequence of Panel
        Side by side.
    """
    grid = figure.subplots(1, len(panels), squeeze=False)
    for axes, panel in zip(grid.flat, panels, strict=True):
        axes.hist(panel.values, bins=BINS, color=SERIES[0], alpha=0.55)
        for percentile in (panel.p05, panel.p95):
            if math.isfinite(percentile):
                axes.axvline(percentile, color=SERIES[1], linestyle="--", linewidth=NOMINAL)
        if math.isfinite(panel.nominal):
            axes.axvline(panel.nominal, color=INK, linewidth=NOMINAL)
        _ticks(axes, panel.values)
        axes.set(xlabel=panel.label, ylabel="sets [-]")
        axes.label_outer()
    return figure


def _ticks(axes: "Axes", values: Sequence[float]) -> None:
    """Mark each value at the foot of the axes, all with one path, which keeps the page small."""
    places = [place for value in values for place in (value, value, math.nan)]
    heights = [0.0, TICK, math.nan] * len(values)
    axes.plot(places, heights, color=MUTED, linewidth=0.6, transform=axes.get_xaxis_transform())


def tornado(figure: "Figure", bars: Sequence[Bar], nominal: float, numerical: float, label: str) -> "Figure":
    """Draw how far each number alone moves a figure from its nominal value, strongest on top.

    Parameters
    ----------
    figure : Figure
        Empty figure.
    bars : sequence of Bar
        Strongest first.
    nominal : float
        The figure in the nominal stop.
    numerical : float
        Width over which rounding alone moves the figure; drawn as a band.
    label : str
        Of the axis.
    """
    axes = figure.subplots()
    ends = [end for each in bars for end in (each.at_low, each.at_high) if math.isfinite(end)]
    least, most = min([nominal, *ends]), max([nominal, *ends])
    room = 0.12 * (most - least or 1.0)
    if numerical:
        axes.axvspan(
            nominal - numerical / 2.0, nominal + numerical / 2.0, color=MUTED, alpha=0.3, linewidth=0.0
        )
    for row, each in enumerate(bars):
        _ends(axes, row, each, nominal, (least - room, most + room))
    axes.axvline(nominal, color=INK, linewidth=NOMINAL)
    axes.set_yticks(range(len(bars)), [each.name for each in bars])
    axes.invert_yaxis()
    axes.grid(visible=False, axis="y")
    axes.set(xlabel=label, xlim=(least - 1.6 * room, most + 1.6 * room))
    handles, labels = axes.get_legend_handles_labels()
    axes.legend(handles, labels, loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=2, borderaxespad=0.0)
    return figure


def _ends(axes: "Axes", row: int, each: Bar, nominal: float, reach: tuple[float, float]) -> None:
    """Draw a bar to each end, one above the other, with the bound that belongs to it."""
    for place, (end, words, color, name) in enumerate(
        (
            (each.at_low, each.low, SERIES[0], "at the lower bound"),
            (each.at_high, each.high, SERIES[1], "at the upper bound"),
        )
    ):
        shown = end if math.isfinite(end) else reach[1]
        axes.barh(
            row + (place - 0.5) * BAR,
            shown - nominal,
            left=nominal,
            height=BAR,
            color=color,
            hatch="" if place == 0 else "////",
            edgecolor="white",
            linewidth=0.0,
            label=name if row == 0 else None,
        )
        if abs(shown - nominal) < SEEN * (reach[1] - reach[0]):
            continue
        outside = shown >= nominal
        note(
            axes,
            words if math.isfinite(end) else f"{words}: no standstill",
            shown,
            row + (place - 0.5) * BAR,
            xytext=(3 if outside else -3, 0),
            ha="left" if outside else "right",
            va="center",
            fontsize=7.0,
        )


def distributions_alt(panels: Sequence[Panel]) -> str:
    """Say in words what the distributions show."""

    def words(panel: Panel) -> str:
        width = panel.p95 - panel.p05
        least, most, nominal, p05, p95 = (
            numbers.resolved(value, width)
            for value in (min(panel.values), max(panel.values), panel.nominal, panel.p05, panel.p95)
        )
        return (
            f"{panel.label}: {len(panel.values)} sets from {least} to {most}, nominal {nominal}, 90 % of them between "
            f"{p05} and {p95}"
        )

    return f"Histograms. {'; '.join(map(words, panels))}."


def tornado_alt(bars: Sequence[Bar], nominal: float, label: str) -> str:
    """Say in words what the bars show."""

    def end(value: float) -> str:
        return numbers.significant(value) if math.isfinite(value) else "no standstill"

    said = (
        f"{each.name} {each.low} to {each.high}: {end(each.at_low)} to {end(each.at_high)}" for each in bars
    )
    return f"Bars of {label} about {numbers.significant(nominal)}: {'; '.join(said)}."
