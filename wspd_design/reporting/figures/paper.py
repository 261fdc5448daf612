"""Figures 3 and 9 to 21 of the paper with our own runs: the same quantities on the same axes.

Panels (a) are dry and (b) wet, as in the paper; the left column has the friction that reproduces Table 10, the right
one that of Polach (2005).
"""

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING

from wspd_design.reporting.figure_style import INK, SERIES
from wspd_design.reporting.figures.drawing import KILO, KMH, curve, note
from wspd_design.reporting.figures.stop import TRAIN, name
from wspd_design.simulation.comparison import Trial
from wspd_design.simulation.runs import Run
from wspd_design.studies.paper.evidence import CONSTANT_RAILS, FALLING_RAILS, RAILS
from wspd_design.studies.paper.reproduction import FrictionCurve

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MOST = 320
"""Points of a curve: a panel is 8 cm wide, and a page has many of them."""

NAMED = 0.35
"""Share of a panel's width that the name of a wheelset takes."""

PAPER_WHEELSET_1 = -1
"""The paper counts its wheelsets from the rear: 3 and 4 are in front. Its wheelset 1 is our last one."""

Trials = Mapping[tuple[str, str], Trial]


def friction_curves(figure: "Figure", curves: Sequence[FrictionCurve]) -> "Figure":
    """Draw the friction force of one wheel over its slip at several speeds, a panel for each rail: Figure 3."""
    grid = figure.subplots(2, 2, sharex=True, sharey=True)
    for axes, rail in zip(grid.T.flat, RAILS, strict=True):
        for index, each in enumerate(each for each in curves if each.rail == rail):
            label = f"{each.speed * KMH:.0f} km/h"
            curve(axes, each.slip, each.force / KILO, index, label=label)
        axes.set_title(_title(rail))
        _outer(axes, x="slip ratio [-]", y="friction force [kN]")
    grid[0, 0].set(xlim=(0.0, 1.0), ylim=(0.0, None))
    grid[1, 1].legend(loc="upper right")
    return figure


def slips(figure: "Figure", trials: Trials, controller: str, slip_reference: float) -> "Figure":
    """Draw the slip of every wheelset over time: Figures 9, 11, 13, 15."""

    def draw(axes: "Axes", run: Run) -> None:
        axes.axhline(slip_reference, color=INK, linestyle="--", linewidth=0.7)
        for wheelset in range(run.slip.shape[1]):
            label = name(run, wheelset)
            curve(axes, run.time, run.slip[:, wheelset], wheelset, most=MOST, linewidth=0.9, label=label)
        axes.set_ylim(0.0, 1.02)

    return _dry_and_wet(figure, trials, controller, draw, "slip ratio [-]")


def velocities(figure: "Figure", trials: Trials, controller: str, wheel_radius: float) -> "Figure":
    """Draw the speed of every wheel rim and of the locomotive over time: Figures 10, 12, 14, 16."""

    def draw(axes: "Axes", run: Run) -> None:
        for wheelset in range(run.slip.shape[1]):
            rim = run.wheel_speed[:, wheelset] * wheel_radius * KMH
            curve(axes, run.time, rim, wheelset, most=MOST, linewidth=0.9, label=name(run, wheelset))
        curve(axes, run.time, run.speed * KMH, TRAIN, most=60, linewidth=1.5, label="locomotive")
        axes.lines[-1].set_linestyle("-")
        axes.set_ylim(0.0, None)

    return _dry_and_wet(figure, trials, controller, draw, "velocity [km/h]")


def torques(figure: "Figure", trials: Trials, controllers: Sequence[str], rails: tuple[str, str]) -> "Figure":
    """Draw the braking torque of the paper's wheelset 1 with several controllers: Figures 17, 18."""
    grid = figure.subplots(len(controllers), 2, sharey=True, sharex="col", squeeze=False)
    for letter, row, controller in zip("abc", grid, controllers, strict=False):
        for axes, rail in zip(row, rails, strict=True):
            run = trials[controller, rail].run
            _torque(axes, run)
            axes.set_title(f"({letter}) {controller}, {rail}")
            axes.set_xlim(0.0, None)
            _outer(axes, x="time [s]", y="torque [kN m]")
    return figure


def input_and_torque(figure: "Figure", trials: Trials, controller: str, rails: tuple[str, str]) -> "Figure":
    """Draw the input and the braking torque of the paper's wheelset 1: Figures 19, 20."""
    duty, torque = figure.subplots(2, 2, sharex="col", sharey="row", height_ratios=(1.0, 1.4))
    for upper, lower, rail in zip(duty, torque, rails, strict=True):
        run = trials[controller, rail].run
        samples = run.axle_samples[PAPER_WHEELSET_1]
        times = [each.time for each in samples] + [float(run.time[-1])]
        upper.stairs([each.fill for each in samples], times, color=SERIES[0], linewidth=0.9, baseline=None)
        upper.set(title=f"(a) input, {rail}", ylim=(-0.05, 1.05))
        _torque(lower, run)
        lower.set_title(f"(b) torque, {rail}")
        lower.set_xlim(0.0, float(run.time[-1]))
        _outer(upper, x="time [s]", y="duty [-]")
        _outer(lower, x="time [s]", y="torque [kN m]")
    return figure


def vertical_forces(figure: "Figure", trials: Trials, controller: str, rails: tuple[str, str]) -> "Figure":
    """Draw the vertical force on the first and on the last wheelset over time: Figure 21."""
    grid = figure.subplots(1, 2, sharey=True)
    for axes, rail in zip(grid, rails, strict=True):
        run = trials[controller, rail].run
        last = run.wheel_load.shape[1] - 1
        for wheelset in (0, last):
            force = 2.0 * run.wheel_load[:, wheelset] / KILO
            curve(axes, run.time, force, wheelset, most=MOST, linewidth=0.9)
            above = wheelset == 0
            named = force[
                run.time > (1.0 - NAMED) * run.time[-1]
            ]  # the name stands beyond the curve below it
            place = {"xytext": (0, 3 if above else -3), "va": "bottom" if above else "top"}
            edge = float(named.max() if above else named.min())
            note(axes, name(run, wheelset), run.time[-1], edge, ha="right", **place)
        axes.set_title(rail)
        axes.set_xlim(0.0, float(run.time[-1]))
        axes.margins(y=0.15)
        _outer(axes, x="time [s]", y="vertical force [kN]")
    return figure


def _dry_and_wet(
    figure: "Figure", trials: Trials, controller: str, draw: Callable[["Axes", Run], None], y: str
) -> "Figure":
    grid = figure.subplots(2, 2, sharey=True)
    for axes, rail in zip(grid.T.flat, RAILS, strict=True):
        run = trials[controller, rail].run
        draw(axes, run)
        axes.set_title(_title(rail))
        axes.set_xlim(0.0, float(run.time[-1]))
        _outer(axes, x="time [s]", y=y)
    handles, labels = grid[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper right", ncols=len(labels))
    return figure


def _torque(axes: "Axes", run: Run) -> None:
    curve(axes, run.time, run.torque[:, PAPER_WHEELSET_1] / KILO, 0, most=MOST, linewidth=0.9)
    axes.set_ylim(0.0, None)


def _title(rail: str) -> str:
    pairs = (CONSTANT_RAILS, FALLING_RAILS)
    return f"{'(a)' if rail in [dry for dry, _ in pairs] else '(b)'} {rail}"


def _outer(axes: "Axes", *, x: str, y: str) -> None:
    """Label the axes at the edge of the figure only; the ticks of time stay, they differ from panel to panel."""
    spec = axes.get_subplotspec()
    assert spec is not None
    if spec.is_last_row():
        axes.set_xlabel(x)
    if spec.is_first_col():
        axes.set_ylabel(y)
