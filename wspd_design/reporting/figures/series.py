"""Curves that come with a certificate."""

import re
import textwrap
from collections.abc import Sequence
from dataclasses import replace
from itertools import groupby
from typing import TYPE_CHECKING

from wspd_design.certificates.records import Role, Series
from wspd_design.reporting.figure_style import INK, LINE_STYLES, MUTED, SERIES
from wspd_design.reporting.figures.drawing import curve
from wspd_design.reporting.numbers import MINUS, listing, significant, unit

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

LOGARITHMIC_SPAN = {Role.LYAPUNOV: 1e3, Role.LOOP_GAIN: 10.0}
"""A positive Lyapunov function or gain of the layer that spans more is drawn on a logarithmic scale."""

REGIONS = (Role.OUTLINE, Role.TRIED, Role.FAILED)
FRAME_HEIGHT, PANEL_HEIGHT, STACKED_HEIGHT, REGION_HEIGHT = 0.5, 2.0, 1.55, 3.0  # in
HATCH = "////"  # of a region at which a search ended
LABEL_WIDTH = 22  # characters of a label beside an axis
LEGEND_WIDTH, HANDLE_WIDTH = 105, 10  # characters of a line of the legend, and of what stands before a name


GREEK = {
    "tau": "τ",
    "eta": "η",
    "mu": "μ",
    "psi": "ψ",
    "sigma": "σ",
    "lambda": "λ",
    "omega": "ω",
    "Phi": "Φ",
}
_GREEK = re.compile(rf"\b({'|'.join(GREEK)})(?=\b|[0-9_])")


def panels(series: Sequence[Series]) -> dict[tuple[str, str], list[Series]]:
    """Group curves by their axes; each group becomes one panel."""
    groups: dict[tuple[str, str], list[Series]] = {}
    for each in series:
        groups.setdefault((each.x_label, each.y_label), []).append(each)
    return groups


def curves_height(series: Sequence[Series]) -> float:
    """Return the height of the figure of :func:`certificate_curves` [in]."""
    groups = panels(series)
    if any(each.role in REGIONS for each in series):
        return FRAME_HEIGHT + REGION_HEIGHT * len(groups)
    return FRAME_HEIGHT + (STACKED_HEIGHT if _stacked(groups) else PANEL_HEIGHT) * len(groups)


def certificate_curves(figure: "Figure", series: Sequence[Series]) -> "Figure":
    """Draw curves of a certificate, one panel for each pair of axes; panels over the same quantity share it.

    Parameters
    ----------
    figure : Figure
        Empty figure.
    series : sequence of Series
        At least one.
    """
    groups = panels(series)
    stacked = _stacked(groups)
    rows = figure.subplots(len(groups), 1, squeeze=False, sharex=stacked)[:, 0]
    for axes, ((x_label, y_label), group) in zip(rows, groups.items(), strict=True):
        _panel(axes, group)
        axes.set_ylabel(textwrap.fill(axis_label(y_label), LABEL_WIDTH))
        if axes is rows[-1] or not stacked:
            axes.set_xlabel(axis_label(x_label))
        names = list(dict.fromkeys(each.name for each in group))
        if len(names) > 1 or not y_label.startswith(f"{names[0]} ["):
            axes.legend(loc="lower left", bbox_to_anchor=(-0.01, 0.98), ncols=_columns(names), borderpad=0.2)
    figure.align_ylabels()
    return figure


def series_alt(series: Sequence[Series]) -> str:
    """Say in words what the curves show: where each begins, ends, and its extremes."""
    alike: dict[tuple[str, Role], list[Series]] = {}
    for each in series:
        alike.setdefault((each.name, each.role), []).append(each)
    return "; ".join(map(_all_words, alike.values())) + "."


def _all_words(alike: Sequence[Series]) -> str:
    """Say in words what curves of one name show: all of them as if they were one."""
    first = alike[0]
    if len(alike) == 1:
        return _words(first)
    x, y = (tuple(value for each in alike for value in getattr(each, axis)) for axis in "xy")
    return f"{_words(replace(first, x=x, y=y))}, {len(alike)} of them"


def series_caption(title: str, series: Sequence[Series]) -> str:
    """Name what the curves of the certificate of this title show."""
    axes = [tuple(label.rpartition(" [")[0] for label in pair) for pair in panels(series)]
    shown = [
        f"{listing([y for _, y in group])} over {x}" for x, group in groupby(axes, key=lambda pair: pair[0])
    ]
    ended = dict.fromkeys(each.name for each in series if each.role is Role.FAILED)
    return f"{title}: {listing(shown)}{''.join(f'; hatched: {name}' for name in ended)}."


def axis_label(label: str) -> str:
    """Write the unit of a label as people read it, ``[m/s2]`` as ``[m/s²]``."""
    return re.sub(r"\[(.*)\]$", lambda found: f"[{unit(found[1]) or '-'}]", plain_symbols(label))


def plain_symbols(text: str) -> str:
    """Write Greek letters, differences and magnitudes as in the text around the figure."""
    text = _GREEK.sub(lambda found: GREEK[found[1]], text.replace(" - ", f" {MINUS} "))
    return re.sub(r"\babs\(([^()]*)\)", r"|\1|", text)


def _words(each: Series) -> str:
    y, x = (re.sub(r" \[-\]$", "", label) for label in (each.y_label, each.x_label))
    if each.role is Role.LIMIT:
        place = (
            f"{y} {significant(each.y[0], 4)}"
            if each.y[0] == each.y[1]
            else f"{x} {significant(each.x[0], 4)}"
        )
        return f"{each.name}: a line at {place}"
    extremes = f"lowest {significant(min(each.y), 3)}, highest {significant(max(each.y), 3)}"
    if each.role in REGIONS:
        return (
            f"{each.name}: a closed region with {x} from {significant(min(each.x), 3)} to "
            f"{significant(max(each.x), 3)}, {y} {extremes}"
        )
    return (
        f"{each.name}: {y} from {significant(each.y[0], 3)} to {significant(each.y[-1], 3)} over "
        f"{x} from {significant(each.x[0], 3)} to {significant(each.x[-1], 3)}, {extremes}"
    )


def _columns(names: Sequence[str]) -> int:
    """Return how many names fit side by side."""
    widths = [len(name) + HANDLE_WIDTH for name in names]
    return len(names) if sum(widths) <= LEGEND_WIDTH else max(1, LEGEND_WIDTH // max(widths))


def _stacked(groups: dict[tuple[str, str], list[Series]]) -> bool:
    return len({x_label for x_label, _ in groups}) == 1


def _panel(axes: "Axes", group: Sequence[Series]) -> None:
    import numpy as np

    indices: dict[str, int] = {}
    for each in group:
        x, y = np.array(each.x), np.array(each.y)
        # Curves of one name look alike, and stand in the legend once.
        name = "_nolegend_" if each.name in indices else plain_symbols(each.name)
        index = indices.setdefault(each.name, len(indices))
        if each.role is Role.TRIED:
            axes.plot(x, y, color=MUTED, linestyle=LINE_STYLES[index], linewidth=0.7, label=name)
            continue
        if each.role is Role.FAILED:
            axes.fill(x, y, facecolor="none", edgecolor=INK, hatch=HATCH, linewidth=1.3, label=name, zorder=3)
            continue
        if each.role is Role.LIMIT:
            axes.plot(x, y, color=INK, linestyle=LINE_STYLES[index], linewidth=1.0, label=name)
            continue
        curve(axes, x, y, index, label=name)
        if each.role is Role.OUTLINE:
            axes.fill(x, y, color=SERIES[index], alpha=0.12, linewidth=0)
    _scale(axes, group)


def _scale(axes: "Axes", group: Sequence[Series]) -> None:
    """Choose a logarithmic scale where a positive quantity spans decades; below its limit it may do as it likes."""
    import numpy as np

    values = np.concatenate([each.y for each in group])
    limits = [each.y[0] for each in group if each.role is Role.LIMIT]
    lowest = max(float(values.min()), min(limits, default=0.0) / 10.0)
    span = min((LOGARITHMIC_SPAN.get(each.role, np.inf) for each in group), default=np.inf)
    if lowest > 0.0 and values.max() > span * lowest:
        axes.set_yscale("log")
        if values.min() < lowest:
            axes.set_ylim(lowest, 2.0 * values.max())
