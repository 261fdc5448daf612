"""The same stop with several controllers."""

import math
import textwrap
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from wspd_design.design.records import Specification
from wspd_design.reporting import numbers
from wspd_design.reporting.figure_style import INK, MUTED, SERIES
from wspd_design.reporting.figures.drawing import note
from wspd_design.reporting.figures.stop import named, slip_panel
from wspd_design.reporting.yardsticks import ideal_distance
from wspd_design.simulation.comparison import Trial
from wspd_design.simulation.description import held_slip
from wspd_design.simulation.runs import Ending
from wspd_design.studies.paper.published import PublishedStop

MOST = 320
"""Points of a curve: the panels are small and many."""

TITLE_WIDTH = {2: 44, 3: 28}
"""Characters that fit above a panel, by the number of columns."""

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def distance_bars(
    figure: "Figure",
    trials: Sequence[Trial],
    published: Mapping[str, PublishedStop],
) -> "Figure":
    """Draw the stopping distances, split where the brake is built up.

    Parameters
    ----------
    figure : Figure
        Empty figure.
    trials : sequence of Trial
        Stops; one without standstill has a bar without parts.
    published : mapping of str to PublishedStop
        The paper's stops by controller, marked by a line.
    """
    distance_panel(figure.subplots(), trials, published)
    return figure


def distance_panel(axes: "Axes", trials: Sequence[Trial], published: Mapping[str, PublishedStop]) -> None:
    """Draw the stopping distances on axes; parameters as of :func:`distance_bars`."""
    for row, trial in enumerate(trials):
        distance, build_up = trial.metrics.distance, trial.metrics.build_up_distance
        theirs = published.get(trial.run.controller)
        end = distance if theirs is None else max(distance, theirs.distance_m)
        if trial.run.ending is Ending.STOPPED:
            parted = not math.isnan(build_up)
            built_up = build_up if parted else 0.0
            names = ("brake build-up", "after it") if parted and not row else (None, None)
            axes.barh(row, built_up, color=SERIES[1], height=0.6, label=names[0])
            axes.barh(
                row,
                distance - built_up,
                left=built_up,
                color=SERIES[0],
                height=0.6,
                alpha=0.45,
                label=names[1],
            )
            said = f"{numbers.settled(distance, trial.check.spread, 1)} m"
            note(axes, said, end, row, xytext=(4, 0), va="center")
        else:
            axes.barh(row, distance, color=SERIES[6], height=0.6, alpha=0.4)
            note(axes, f"{distance:.0f} m, still moving", end, row, xytext=(4, 0), va="center")
        if theirs is not None:
            axes.plot(
                [theirs.distance_m] * 2, [row - 0.42, row + 0.42], color=INK, linestyle="-", linewidth=1.6
            )
    ideal = trials[0].metrics.ideal_stop
    if math.isfinite(ideal):
        axes.axvline(ideal, color=MUTED, linestyle="--", linewidth=1.0, label="ideal stop")
    axes.set_yticks(range(len(trials)), [trial.run.controller for trial in trials])
    axes.invert_yaxis()
    if axes.get_legend_handles_labels()[0]:
        axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=3, borderaxespad=0.0)
    axes.grid(visible=False, axis="y")
    axes.set(xlabel="distance [m]", xlim=(0.0, 1.15 * max(trial.metrics.distance for trial in trials)))


def slip_of_all(figure: "Figure", trials: Sequence[Trial], specification: Specification) -> "Figure":
    """Draw the slip of every stop over time, on the same axes.

    Parameters
    ----------
    figure : Figure
        Empty figure.
    trials : sequence of Trial
        Stops.
    specification : Specification
        Slip reference and tolerance.
    """
    columns = 3 if len(trials) > 4 else 2
    rows = -(-len(trials) // columns)
    grid = figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
    for axes, trial in zip(grid.flat, trials, strict=False):
        slip_panel(axes, trial.run, specification, top=1.1, most=MOST)
        axes.set_title(textwrap.fill(trial.run.controller, TITLE_WIDTH[columns]))
        axes.label_outer()
    for axes in grid.flat[len(trials) :]:
        axes.remove()
    last = max(float(trial.run.time[-1]) for trial in trials)
    for index, axes in enumerate(grid.flat[: len(trials)]):
        axes.set_xlim(0.0, last)
        axes.tick_params(labelbottom=index + columns >= len(trials))
    figure.supxlabel("time [s]", fontsize="medium")
    if trials[0].run.slip.shape[1] > 1:
        lines = grid.flat[0].get_legend_handles_labels()
        figure.legend(*lines, loc="outside upper right", ncols=len(named(trials[0].run.slip.shape[1])))
    return figure


def distances_alt(trials: Sequence[Trial]) -> str:
    """Say in words what the bars show."""

    def parts(trial: Trial) -> str:
        build_up = trial.metrics.build_up_distance
        if trial.run.ending is not Ending.STOPPED:
            return ", still moving"
        return "" if math.isnan(build_up) else f", {build_up:.1f} m of it brake build-up"

    said = (f"{trial.run.controller} {trial.metrics.distance:.1f} m{parts(trial)}" for trial in trials)
    return f"Stopping distances: {'; '.join(said)}; ideal stop {ideal_distance(trials[0].metrics)}."


def slips_alt(trials: Sequence[Trial], specification: Specification) -> str:
    """Say in words what the slips show."""
    said = (
        f"{trial.run.controller} rms {trial.metrics.slip_rms:.3f} about {held_slip(trial.run, specification.slip)}, "
        f"a wheelset locked for "
        f"{trial.metrics.lock_time:.2f} s"
        for trial in trials
    )
    return f"Slip over time about the reference: {'; '.join(said)}."
