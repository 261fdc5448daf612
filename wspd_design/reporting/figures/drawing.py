"""What the figures share: the report's style, thinned curves, and labels on the curve instead of a legend."""

from collections.abc import Callable
from itertools import pairwise
from typing import TYPE_CHECKING, Any

from wspd_design.reporting.figure_style import LINE_STYLES, SERIES, figure_style, figure_svg, new_figure
from wspd_design.reporting.numbers import significant

if TYPE_CHECKING:
    import numpy as np
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    Trace = NDArray[np.float64]

MOST_POINTS = 2000
"""A curve with more points is thinned: print and screen show no more."""

INK_OF_DOTS = 1.4
"""A dotted line is drawn so many times wider, else it is paler than the others."""

HIDDEN = 0.005
"""Share of the height of a panel by which a curve may leave it without a word: no line is thinner."""

KMH = 3.6
KILO = 1e3


def picture(draw: Callable[["Figure"], "Figure"], *, height: float) -> str:
    """Return what a function draws on an empty figure of this height [in] as SVG, in the report's style."""
    with figure_style():
        figure = draw(new_figure(height=height))
        for axes in figure.axes:
            tell_what_is_cut(axes)
        return figure_svg(figure)


def tell_what_is_cut(axes: "Axes") -> None:
    """Say at the upper and the lower edge how far curves go beyond it, in the stretch of x that is shown."""
    import numpy as np

    (left, right), (low, high) = sorted(axes.get_xlim()), sorted(axes.get_ylim())
    beyond = HIDDEN * (high - low)
    shown = [
        np.asarray(line.get_xydata()) for line in axes.get_lines() if line.get_transform() == axes.transData
    ]
    points = np.concatenate([np.empty((0, 2)), *shown])
    points = points[np.isfinite(points).all(axis=1) & (points[:, 0] >= left) & (points[:, 0] <= right)]
    for sign, edge, arrow, height in ((1.0, high, "▲", 0.93), (-1.0, low, "▼", 0.05)):
        cut = points[sign * (points[:, 1] - edge) > beyond]
        if not cut.size:
            continue
        # Beside the stretch that is cut, on the side with more room.
        first, last = cut[:, 0].min(), cut[:, 0].max()
        before = first - left > right - last
        axes.annotate(
            f"{arrow} to {significant(float(sign * np.max(sign * cut[:, 1])), 3)}",
            (first if before else last, height),
            xycoords=axes.get_xaxis_transform(),
            xytext=(-3 if before else 3, 0),
            textcoords="offset points",
            ha="right" if before else "left",
            va="center",
            fontsize=7.5,
            gid="note-0",
        )


def thinned(x: "Trace", y: "Trace", most: int = MOST_POINTS) -> tuple["Trace", "Trace"]:
    """Thin a curve without losing an extreme: of each stretch its lowest and its highest point stay.

    Parameters
    ----------
    x, y : ndarray
        The curve, in drawing order.
    most : int
        Number of points that may remain, at least 6.

    Returns
    -------
    tuple of ndarray
        The curve itself if it is short enough, else a part of its points in the same order, with both ends.
    """
    import numpy as np

    if len(x) <= most:
        return x, y
    edges = np.linspace(0, len(x), (most - 2) // 2 + 1).astype(int)
    keep = {0, len(x) - 1}
    for start, end in pairwise(edges):
        keep |= {start + int(np.argmin(y[start:end])), start + int(np.argmax(y[start:end]))}
    kept = sorted(keep)
    return x[kept], y[kept]


def curve(
    axes: "Axes", x: "Trace", y: "Trace", index: int, *, most: int = MOST_POINTS, **options: Any
) -> None:
    """Draw a curve, thinned to so many points, in one color and line style of the report."""
    import numpy as np

    thin_x, thin_y = thinned(np.asarray(x), np.asarray(y), most)
    color, style = look(index)
    if style == ":" and "linewidth" in options:
        options["linewidth"] *= INK_OF_DOTS
    axes.plot(thin_x, thin_y, color=color, linestyle=style, gid=f"look-{index}", **options)


def look(index: int) -> tuple[str, Any]:
    """Return color and line style of a curve; beyond the last color all but the last come again with other lines."""
    if index < len(SERIES):
        return SERIES[index], LINE_STYLES[index]
    turn, place = divmod(index - len(SERIES), len(SERIES) - 1)
    return SERIES[place], LINE_STYLES[(place + turn + 1) % len(LINE_STYLES)]


def note(axes: "Axes", text: str, x: float, y: float, **options: Any) -> None:
    """Write beside a curve, a few points away from the data point (x, y)."""
    placed: dict[str, Any] = {"xytext": (0, 3), "ha": "left", "va": "bottom", "fontsize": 7.5} | options
    axes.annotate(text, (x, y), textcoords="offset points", gid="note-0", **placed)
