"""What a stop shows of electrodynamic brake, track brake and the temperature of the pads, where a vehicle has them."""

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

from wspd_design.reporting.figure_style import INK
from wspd_design.reporting.figures.drawing import KILO, curve
from wspd_design.simulation.runs import Run

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from wspd_design.simulation.runs import Trace

_MOST = 900  # points of the curve of one wheelset


class Panel(NamedTuple):
    """A panel over the time of a stop."""

    title: str
    draw: Callable[["Axes"], None]
    words: str  # what it shows


def panels(run: Run) -> tuple[Panel, ...]:
    """Return the panels that a stop has, from top to bottom."""
    made = []
    if run.dynamic_torque is not None:
        most = float(run.dynamic_torque.max()) / KILO
        made.append(
            Panel(
                title="Torque of the electrodynamic brake of each wheelset",
                draw=partial(_wheelsets, run=run, trace=run.dynamic_torque / KILO, label="torque [kN m]"),
                words=f"The electrodynamic brake gives at most {most:.3g} kN m of the torque of a wheelset.",
            )
        )
    if run.track_brake_force is not None:
        most = float(run.track_brake_force.max()) / KILO
        made.append(
            Panel(
                title="Force of the track brake",
                draw=partial(_magnets, run=run),
                words=f"The track brake pulls with at most {most:.3g} kN.",
            )
        )
    if run.pad_temperature is not None:
        most = float(run.pad_temperature.max())
        made.append(
            Panel(
                title="Temperature of the pads above that before the stop",
                draw=partial(_wheelsets, run=run, trace=run.pad_temperature, label="temperature [K]"),
                words=f"The pads get warmer by at most {most:.3g} K.",
            )
        )
    return tuple(made)


def height(run: Run) -> float:
    """Height of the figure on paper [in]."""
    return 0.4 + 1.5 * len(panels(run))


def further_brakes(figure: "Figure", run: Run) -> "Figure":
    """Draw the panels of a stop, which has one or more, over one time axis."""
    shown = panels(run)
    rows = figure.subplots(len(shown), 1, sharex=True, squeeze=False)[:, 0]
    for axes, panel in zip(rows, shown, strict=True):
        panel.draw(axes)
        axes.set_title(panel.title)
    rows[-1].set(xlabel="time [s]", xlim=(0.0, float(run.time[-1])))
    return figure


def _wheelsets(axes: "Axes", *, run: Run, trace: "Trace", label: str) -> None:
    for wheelset in range(trace.shape[1]):
        curve(axes, run.time, trace[:, wheelset], wheelset, most=_MOST, linewidth=1.0)
    axes.set(ylabel=label, ylim=(0.0, None))


def _magnets(axes: "Axes", *, run: Run) -> None:
    assert run.track_brake_force is not None
    axes.plot(
        run.time[::20], run.track_brake_force[::20] / KILO, color=INK, linewidth=1.2, label="_track brake"
    )
    axes.set(ylabel="force [kN]", ylim=(0.0, None))
