"""Maps of a margin over speed and one further coordinate of the domain."""

import textwrap
from typing import TYPE_CHECKING

from wspd_design.certificates.records import Map
from wspd_design.reporting.figure_style import INK, SERIES
from wspd_design.reporting.figures.series import LABEL_WIDTH, axis_label, plain_symbols
from wspd_design.reporting.numbers import quantity, significant

if TYPE_CHECKING:
    from matplotlib.figure import Figure

LEVELS = 9
COLORS = "cividis"  # even steps of lightness, also for color-blind readers and in print
TICKS = (1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0)  # km/h
MARKER = SERIES[1]
LINE, HALO = "#101010", "#fefefe"  # on the colors of the map, whatever the page looks like


def margin_map(figure: "Figure", shown: Map) -> "Figure":
    """Draw a map with the line of the limit, where it lies inside, and the tightest point; bright is tight.

    Parameters
    ----------
    figure : Figure
        Empty figure.
    shown : Map
        Over speed.
    """
    import numpy as np
    from matplotlib.artist import Artist
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch
    from matplotlib.patheffects import AbstractPathEffect, withStroke
    from matplotlib.ticker import FixedLocator, MaxNLocator, NullLocator, ScalarFormatter

    axes = figure.subplots()
    values = np.array(shown.values)
    levels = MaxNLocator(nbins=LEVELS).tick_values(values.min(), values.max())
    colors = COLORS if _tight_is_high(shown) else f"{COLORS}_r"
    filled = axes.contourf(shown.x, shown.y, values, levels=levels, cmap=colors)
    bar = figure.colorbar(filled, ax=axes, pad=0.02, aspect=14)
    bar.set_label(axis_label(shown.value_label))
    bar.outline.set_visible(False)
    handles: list[Artist] = []
    if shown.worst is not None:
        handles += axes.plot(
            *shown.worst,
            linestyle="none",
            marker="X",
            markersize=7.5,
            markerfacecolor=MARKER,
            markeredgecolor=HALO,
            markeredgewidth=0.8,
            clip_on=False,
            zorder=4,
            label=plain_symbols(f"tightest: {_spot(shown, shown.worst)}"),
        )
    if shown.limit is not None:
        halo: list[AbstractPathEffect] = [withStroke(linewidth=2.6, foreground=HALO)]
        if _crosses(shown):
            line = axes.contour(shown.x, shown.y, values, levels=[shown.limit], colors=LINE, linewidths=1.3)
            line.set_path_effects(halo)
            bar.add_lines(line)
            beyond = [shown.limit, levels[-1]] if _tight_is_high(shown) else [levels[0], shown.limit]
            fails = axes.contourf(shown.x, shown.y, values, levels=beyond, colors="none", hatches=["////"])
            fails.set(edgecolor=LINE, linewidth=0.0)
            handles.append(
                Patch(facecolor="none", edgecolor=INK, hatch="////", linewidth=0.0, label="the claim fails")
            )
        where = "" if _crosses(shown) else ", reached nowhere" if _holds(shown) else ", passed everywhere"
        label = f"limit {quantity(shown.limit, _unit(shown))}{where}"
        handles.append(Line2D([], [], color=LINE, linewidth=1.3, path_effects=halo, label=label))
    if handles:
        figure.legend(handles=handles, loc="outside upper left", ncols=3)
    axes.grid(visible=False)
    axes.set(
        xscale="log", xlabel=shown.x_label, ylabel=textwrap.fill(plain_symbols(shown.y_label), LABEL_WIDTH)
    )
    low, high = shown.x[0], shown.x[-1]
    axes.xaxis.set_major_locator(FixedLocator([tick for tick in TICKS if low <= tick <= high]))
    axes.xaxis.set_minor_locator(NullLocator())
    axes.xaxis.set_major_formatter(ScalarFormatter())
    return figure


def map_alt(shown: Map) -> str:
    """Say in words what a map shows."""
    low, high = _extremes(shown)
    spelling = _unit(shown)
    words = [
        f"Map of {_name(shown.value_label)} over {_name(shown.x_label)} and {_name(shown.y_label)}: between "
        f"{significant(low, 3)} and {quantity(high, spelling, 3)}"
    ]
    if shown.limit is not None:
        side = (
            "a line inside the map"
            if _crosses(shown)
            else "reached nowhere"
            if _holds(shown)
            else "passed everywhere"
        )
        words.append(f"the limit, {quantity(shown.limit, spelling)}, is {side}")
    if shown.worst is not None:
        words.append(f"a cross marks the tightest point, {_spot(shown, shown.worst)}")
    return "; ".join(words) + "."


def map_caption(shown: Map) -> str:
    """Name what is drawn, and say on which side of the limit the claim fails."""
    name = _name(shown.value_label)
    said = (
        f"{name[0].upper()}{name[1:]} over {_name(shown.x_label)} and {_name(shown.y_label)}, at each point the worst "
        "of the corners of all other ranges; the brighter, the tighter."
    )
    return f"{said} Hatched: there the claim fails." if _crosses(shown) else said


def _name(label: str) -> str:
    """Return a label without its unit."""
    return label.rpartition(" [")[0]


def _unit(shown: Map) -> str:
    return shown.value_label.rpartition(" [")[2].removesuffix("]")


def _extremes(shown: Map) -> tuple[float, float]:
    values = [value for row in shown.values for value in row]
    return min(values), max(values)


def _at(shown: Map, place: tuple[float, float]) -> float:
    """Value at the grid point that is nearest to a place."""
    column, row = (
        min(range(len(grid)), key=lambda index: abs(grid[index] - wanted))
        for grid, wanted in zip((shown.x, shown.y), place, strict=True)
    )
    return shown.values[row][column]


def _spot(shown: Map, place: tuple[float, float]) -> str:
    value = quantity(_at(shown, place), _unit(shown))
    speed = quantity(place[0], shown.x_label.rpartition(" [")[2].removesuffix("]"), 3)
    return f"{value} at {speed}, {_name(shown.y_label)} {significant(place[1], 3)}"


def _tight_is_high(shown: Map) -> bool:
    low, high = _extremes(shown)
    return shown.worst is None or 2.0 * _at(shown, shown.worst) >= low + high


def _crosses(shown: Map) -> bool:
    """Whether the line of the limit lies inside the map."""
    low, high = _extremes(shown)
    return shown.limit is not None and low < shown.limit < high


def _holds(shown: Map) -> bool:
    """Whether a limit that lies outside the values shown is respected by all of them."""
    low, high = _extremes(shown)
    assert shown.limit is not None
    return shown.limit >= high if _tight_is_high(shown) else shown.limit <= low
