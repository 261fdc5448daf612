"""How figures look: one Matplotlib style for the screen and for print, and reproducible SVG."""

import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from io import StringIO
from typing import TYPE_CHECKING, Any

from wspd_design.reporting.figure_data import data, mark
from wspd_design.reporting.svg import canonical

if TYPE_CHECKING:
    from matplotlib.figure import Figure

TEXT_WIDTH = 6.53
"""Width of the text on an A4 page of the report [in]."""

FONT_FAMILY = "DejaVu Sans"
"""Ships with Matplotlib, so that every machine can set it."""

POINTS = 72
"""Of an inch: SVG counts in points, and so does the layout."""

INK, MUTED, GRID = "#1b1f24", "#5c6670", "#d9dee3"
SERIES = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", INK)
"""Okabe and Ito's colors, safe for color-blind readers, without the yellow that white paper swallows."""

LINE_STYLES = ("-", "--", "-.", ":", (0, (5, 1)), (0, (3, 1, 1, 1)), (0, (1, 1)))
"""One for each color: a printout in black and white stays legible."""


def parameters() -> dict[str, Any]:
    """Return Matplotlib's settings for a figure of the report, for :func:`matplotlib.rc_context`."""
    from cycler import cycler

    return {
        "svg.fonttype": "none",
        "svg.hashsalt": "wspd_design",
        "font.family": FONT_FAMILY,
        "font.size": 8.0,
        "mathtext.fontset": "dejavusans",
        "axes.titlesize": 8.5,
        "axes.titlelocation": "left",
        "axes.titleweight": "bold",
        "axes.labelsize": 8.0,
        "xtick.labelsize": 7.5,
        "ytick.labelsize": 7.5,
        "legend.fontsize": 7.5,
        "legend.frameon": False,
        "legend.handlelength": 2.6,
        "text.color": INK,
        "axes.labelcolor": INK,
        "axes.edgecolor": MUTED,
        "xtick.color": MUTED,
        "ytick.color": MUTED,
        "xtick.labelcolor": INK,
        "ytick.labelcolor": INK,
        "axes.linewidth": 0.6,
        "xtick.major.width": 0.6,
        "ytick.major.width": 0.6,
        "axes.spines.top": False,
        "axes.spines.right": False,
        "axes.grid": True,
        "axes.axisbelow": True,
        "grid.color": GRID,
        "grid.linewidth": 0.5,
        "lines.linewidth": 1.3,
        "axes.prop_cycle": cycler(color=SERIES) + cycler(linestyle=LINE_STYLES),
        "figure.facecolor": "none",
        "axes.facecolor": "none",
        "savefig.facecolor": "none",
    }


@contextmanager
def figure_style() -> Iterator[None]:
    """Use the style of the report inside a ``with`` block."""
    import matplotlib

    with matplotlib.rc_context(parameters()):
        yield


def new_figure(*, height: float, width: float = TEXT_WIDTH) -> "Figure":
    """Return an empty figure that needs neither pyplot nor a display.

    Parameters
    ----------
    height, width : float
        Size on paper [in].
    """
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height), layout="constrained")


def figure_svg(figure: "Figure") -> str:
    """Return a figure as SVG: the same figure gives the same characters, on every day and every machine."""
    from matplotlib.backends.backend_svg import FigureCanvasSVG

    buffer = StringIO()
    with figure_style(), warnings.catch_warnings():
        # A browser has more fonts, and the PDF says what it lacks.
        warnings.filterwarnings("ignore", message=r"Glyph .* missing from font")
        # Matplotlib would draw every figure with a layout engine twice, the first time for the layout alone.
        FigureCanvasSVG(figure)
        figure.set_dpi(POINTS)
        layout = figure.get_layout_engine()
        if layout is not None:
            layout.execute(figure)
            figure.set_layout_engine("none")
        marked = mark(figure)
        figure.savefig(buffer, format="svg", metadata={"Date": None, "Creator": None})
    return canonical(buffer.getvalue(), FONT_FAMILY, data(marked))
