"""Maps of a margin over speed and one further coordinate of the domain."""

from typing import TYPE_CHECKING

from wspd_design.certificates.records import Map
from wspd_design.reporting.figure_style import SERIES
from wspd_design.reporting.numbers import significant

if TYPE_CHECKING:
    from matplotlib.figure import Figure

LEVELS = 9
COLORS = "cividis"  # even steps of lightness, also for color-blind readers and in print
TICKS = (1, 2, 5, 10, 20, 50, 100, 200, 500)  # km/h
MARKER = SERIES[1]
LINE, HALO = "#101010", "#ffffff"  # on the colors of the map, whatever the page looks like


def margin_map(figure: "Figure", shown: Map) -> "Figure":
    """Draw a map with the line of the limit, where it lies inside, and the tightest point.

    Parameters
    ----------
    figure : Figure
        Empty figure.
    shown : Map
        Over speed.
    """
    import numpy as np
    from matplotlib.patheffects import withStroke
    from matplotlib.ticker import FixedLocator, MaxNLocator, NullLocator, ScalarFormatter

    axes = figure.subplots()
    values = np.array(shown.values)
    levels = MaxNLocator(nbins=LEVELS).tick_values(values.min(), values.max())
    filled = axes.contourf(shown.x, shown.y, values, levels=levels, cmap=COLORS)
    bar = figure.colorbar(filled, ax=axes, pad=0.02, aspect=14)
    bar.set_label(shown.value_label)
    bar.outline.set_visible(False)
    if shown.limit is not None and values.min() < shown.limit < values.max():
        line = axes.contour(shown.x, shown.y, values, levels=[shown.limit], colors=LINE, linewidths=1.3)
        line.set_path_effects([withStroke(linewidth=2.6, foreground=HALO)])
        bar.add_lines(line)
    if shown.worst is not None:
        axes.plot(
            *shown.worst,
            linestyle="none",
            marker="X",
            markersize=7.0,
            markerfacecolor=MARKER,
            markeredgecolor=HALO,
            clip_on=False,
            zorder=4,
        )
    axes.grid(visible=False)
    axes.set(xscale="log", xlabel=shown.x_label, ylabel=shown.y_label)
    low, high = shown.x[0], shown.x[-1]
    axes.xaxis.set_major_locator(FixedLocator([tick for tick in TICKS if low <= tick <= high]))
    axes.xaxis.set_minor_locator(NullLocator())
    axes.xaxis.set_major_formatter(ScalarFormatter())
    return figure


def map_alt(shown: Map) -> str:
    """Say in words what a map shows."""
    values = [value for row in shown.values for value in row]
    words = [
        f"{shown.value_label} over {shown.x_label} from {significant(shown.x[0], 3)} to "
        f"{significant(shown.x[-1], 3)} and {shown.y_label} from {significant(shown.y[0], 3)} to "
        f"{significant(shown.y[-1], 3)}: between {significant(min(values), 3)} and {significant(max(values), 3)}"
    ]
    if shown.limit is not None:
        words.append(f"the limit is {significant(shown.limit, 4)}")
    if shown.worst is not None:
        words.append(f"a cross marks the tightest point, {', '.join(significant(x, 3) for x in shown.worst)}")
    return "; ".join(words) + "."


def map_caption(shown: Map) -> str:
    """Name what is drawn, and say whether the limit lies inside."""
    values = [value for row in shown.values for value in row]
    inside = shown.limit is not None and min(values) < shown.limit < max(values)
    limit = (
        ""
        if shown.limit is None
        else (
            f" The line is the limit, {significant(shown.limit, 4)}."
            if inside
            else f" The limit, {significant(shown.limit, 4)}, lies outside the values shown."
        )
    )
    cross = " The cross marks the tightest point that the prover found." if shown.worst is not None else ""
    return (
        f"{shown.value_label} over {shown.x_label} and {shown.y_label}, at each point the worst of the corners of all "
        f"other ranges.{limit}{cross}"
    )
