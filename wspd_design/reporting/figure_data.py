"""What the script of the page reads from a figure: panels with their scales, and which line is which."""

import json
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D

_SCALES = ("linear", "log")


@dataclass(frozen=True, slots=True, kw_only=True)
class MarkedFigure:
    """Panels of a figure that have curves over x, and the names of its lines; some have none."""

    panels: tuple["Axes", ...]
    names: tuple[str, ...]


def mark(figure: "Figure") -> MarkedFigure:
    """Give panels and curves ids by which :func:`wspd_design.reporting.svg.canonical` knows them.

    A line without a label is what the labelled line of the same look is in another panel.
    """
    drawn = {axes: _curves(axes) for axes in figure.axes}
    # A panel without a curve moves with the others of its axis.
    curves = {
        axes: lines
        for axes, lines in drawn.items()
        if lines or any(drawn.get(each) for each in axes.get_shared_x_axes().get_siblings(axes))
    }
    labels: dict[tuple[Any, ...], str] = {}
    for line in (line for lines in curves.values() for line in lines if _label(line)):
        labels.setdefault(_look(line), _label(line))
    names: list[tuple[tuple[Any, ...], str]] = []
    for place, (axes, lines) in enumerate(curves.items()):
        axes.set_gid(f"panel-{place}")
        for line in lines:
            look = _look(line)
            name = (look, _label(line) or labels.get(look, ""))
            if name not in names:
                names.append(name)
            line.set_gid(f"curve-{names.index(name)}")
    return MarkedFigure(panels=tuple(curves), names=tuple(name for _, name in names))


def data(marked: MarkedFigure) -> str:
    """Return where the panels stand and what they scale, as JSON; empty for a figure without any.

    Each axis is its name, its limits and whether it is logarithmic; y of a panel without a curve has no name.

    Call it when the figure has been drawn: only then nothing moves any more.
    """
    if not marked.panels:
        return ""
    names = [axes.get_ylabel() for axes in marked.panels]
    if len(set(names)) < len(names) or not all(names):
        names = [axes.get_title(loc="left") or axes.get_ylabel() for axes in marked.panels]
    readable = [bool(_curves(axes)) for axes in marked.panels]
    panels = [
        {
            "box": _box(axes),
            "x": [_x_label(axes), *_limits(axes.get_xlim()), int(axes.get_xscale() == "log")],
            "y": [name if is_read else "", *_limits(axes.get_ylim()), int(axes.get_yscale() == "log")],
        }
        for axes, name, is_read in zip(marked.panels, names, readable, strict=True)
    ]
    return json.dumps({"lines": marked.names, "panels": panels}, ensure_ascii=False, separators=(",", ":"))


def _curves(axes: "Axes") -> list["Line2D"]:
    """Return the lines over x that are drawn in the coordinates of the data, if one of them is no straight line."""
    import numpy as np

    if axes.get_xscale() not in _SCALES or axes.get_yscale() not in _SCALES:
        return []
    lines = [
        line
        for line in axes.get_lines()
        if line.get_transform() == axes.transData
        and str(line.get_linestyle()) != "None"
        and len(x := np.asarray(line.get_xdata(), dtype=float)) > 1
        and np.all(np.diff(x[np.isfinite(x)]) >= 0.0)
        and x[-1] > x[0]
    ]
    return lines if any(np.size(line.get_xdata()) > 2 for line in lines) else []


def _look(line: "Line2D") -> tuple[Any, ...]:
    return line.get_color(), line.get_linestyle(), line.get_gid()


def _label(line: "Line2D") -> str:
    """Return the label of a line, also one that the legend leaves out; empty where nobody gave one."""
    label = str(line.get_label())
    return "" if label.startswith("_child") else label.removeprefix("_")


def _x_label(axes: "Axes") -> str:
    """Return what stands under the lowest of the panels that share the axis, or under the figure."""
    shared = (axes, *axes.get_shared_x_axes().get_siblings(axes), axes.get_figure())
    return next((label for each in shared if (label := _written_below(each))), "")


def _written_below(place: Any) -> str:
    return str(place.get_xlabel() if hasattr(place, "get_xlabel") else place.get_supxlabel())


def _box(axes: "Axes") -> list[float]:
    """Return left, top, right and bottom in points of the SVG, whose y counts downwards."""
    box, height = axes.get_window_extent(), axes.get_figure().bbox.height  # type: ignore[union-attr]
    return [round(float(each), 2) for each in (box.x0, height - box.y1, box.x1, height - box.y0)]


def _limits(limits: tuple[float, float]) -> list[float]:
    return [float(f"{limit:.7g}") for limit in limits]
