"""Traces of stops over time: of every wheelset of one stop, or of one wheelset with several laws."""

from collections.abc import Callable, Mapping, Sequence
from difflib import get_close_matches
from typing import TYPE_CHECKING, Any

from wspd_design.parameters.errors import UserError
from wspd_design.parameters.units import KMH
from wspd_design.plotting.axes import on_axes
from wspd_design.reporting.figure_style import INK
from wspd_design.reporting.figures.comparison import distance_panel
from wspd_design.reporting.figures.drawing import KILO, curve
from wspd_design.reporting.figures.estimate import estimate_panel
from wspd_design.reporting.figures.stop import (
    MOST,
    line_of,
    load_panel,
    name,
    reference_line,
    slip_curves,
    speed_panel,
    torque_panel,
    valve_panel,
    wheelset_legend,
)
from wspd_design.simulation.comparison import Trial
from wspd_design.simulation.law_memory import speed_estimate
from wspd_design.simulation.runs import Run

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from wspd_design.simulation.runs import Trace

_BAR = 1e5  # Pa
_ROOM = 1.15  # above the largest slip
_HIGHEST_SLIP = 1.05
_BARS, _FRAME = 0.32, 1.0  # in, of one bar of a distance and of what is around them

_TRACES: Mapping[str, tuple[str, Callable[[Run], Any]]] = {
    "slip": ("slip [-]", lambda run: run.slip),
    "speed": ("speed of the wheel rim [km/h]", lambda run: KMH * run.wheel_radius * run.wheel_speed),
    "torque": ("torque [kN m]", lambda run: run.torque / KILO),
    "pressure": ("cylinder pressure [bar]", lambda run: run.cylinder_pressure / _BAR),
    "load": ("load of one wheel [kN]", lambda run: run.wheel_load / KILO),
}
"""Label and values of what several laws are compared by."""


def plot_run(run: Run, what: str = "slip", *, ax: "Axes | None" = None) -> "Axes":
    """Plot a trace of every wheelset; parameters as of :meth:`wspd_design.Run.plot`."""
    return _plot_run(run, what, ax, None)


def plot_trial(trial: Trial, what: str = "slip", *, ax: "Axes | None" = None) -> "Axes":
    """Plot a trace of every wheelset, the slip with its reference; as :func:`plot_run`."""
    return _plot_run(trial.run, what, ax, trial.slip_reference)


def plot_comparison(
    trials: Sequence[Trial], what: str = "slip", *, wheelset: int = 1, ax: "Axes | None" = None
) -> "Axes":
    """Plot several laws; parameters as of :meth:`wspd_design.Comparison.plot`."""
    if not trials:
        raise UserError("there is no stop to plot")
    if what == "distance":
        height = _FRAME + _BARS * len(trials)
        return on_axes(ax, lambda axes: distance_panel(axes, trials, {}), height=height)
    _known(what, ("distance", *_TRACES))
    columns = trials[0].run.slip.shape[1]
    if not 1 <= wheelset <= columns:
        raise UserError(f"wheelset = {wheelset} must lie between 1 and {columns}, counted from the front")
    label, read = _TRACES[what]

    def draw(axes: "Axes") -> None:
        for place, trial in enumerate(trials):
            values = read(trial.run)[:, wheelset - 1]
            curve(axes, trial.run.time, values, place, most=MOST, linewidth=1.0, label=trial.run.controller)
        references = {trial.slip_reference for trial in trials}
        if what == "slip" and len(references) == 1:
            axes.axhline(references.pop(), color=INK, linestyle="--", linewidth=0.8)
        end = max(float(trial.run.time[-1]) for trial in trials)
        title = name(trials[0].run, wheelset - 1).capitalize()
        axes.set(xlabel="time [s]", ylabel=label, title=title, xlim=(0.0, end), ylim=(0.0, None))
        axes.legend()

    return on_axes(ax, draw)


def _plot_run(run: Run, what: str, ax: "Axes | None", slip_reference: float | None) -> "Axes":
    _known(what, (*_TRACES, "valve", "estimate"))
    estimate = speed_estimate(run) if what == "estimate" else None
    if what == "estimate" and estimate is None:
        raise UserError(
            f"{run.controller} estimates no train speed: it is told it; there is nothing to compare"
        )

    def draw(axes: "Axes") -> None:
        if what == "slip":
            _slips(axes, run, slip_reference)
        elif what == "speed":
            speed_panel(axes, run, run.wheel_radius)
        elif what == "torque":
            torque_panel(axes, run)
        elif what == "pressure":
            _wheelsets(axes, run, run.cylinder_pressure / _BAR)
            axes.set_ylabel(_TRACES["pressure"][0])
        elif what == "load":
            load_panel(axes, run)
        elif estimate is not None:
            estimate_panel(axes, run, estimate)
        else:
            valve_panel(axes, run)
            axes.set_ylabel("fill [-], by wheelset")
        axes.set(xlabel="time [s]", xlim=(0.0, float(run.time[-1])))
        axes.set_title(f"{run.controller} on {run.rail}, {run.train}")
        if what not in ("speed", "valve", "estimate"):
            _legend(axes, run)

    return on_axes(ax, draw)


def slip_picture(figure: "Figure", run: Run, slip_reference: float | None) -> "Figure":
    """Draw the slip of every wheelset on an empty figure."""
    axes = figure.subplots()
    _slips(axes, run, slip_reference)
    axes.set_xlabel("time [s]")
    wheelset_legend(axes, run)
    return figure


def _slips(axes: "Axes", run: Run, slip_reference: float | None) -> None:
    reference_line(axes, run, slip_reference)
    top = min(max(_ROOM * run.slip_max, 2.0 * (slip_reference or 0.0)), _HIGHEST_SLIP)
    slip_curves(axes, run, top=top)


def _wheelsets(axes: "Axes", run: Run, values: "Trace") -> None:
    for wheelset, column in enumerate(values.T):
        curve(axes, run.time, column, line_of(wheelset), most=MOST, linewidth=1.0)


def _legend(axes: "Axes", run: Run) -> None:
    """Name the wheelsets, whose lines have no label of their own in most panels."""
    lines = [line for line in axes.get_lines() if line.get_gid()]
    for wheelset, line in enumerate(lines):
        line.set_label(name(run, wheelset))
    if len(lines) > 1:
        axes.legend(handles=lines, ncols=2)


def _known(what: str, names: Sequence[str]) -> None:
    if what in names:
        return
    near = get_close_matches(str(what), names, n=1)
    offer = f'did you mean "{near[0]}"? ' if near else ""
    raise UserError(f'there is no trace "{what}" to plot; {offer}There are {", ".join(names)}')
