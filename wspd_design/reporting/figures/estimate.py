"""The train speed that a law estimates beside the true one: speeds, error, and what it makes of the distance."""

from typing import TYPE_CHECKING

from wspd_design.codegen.loop_numbers import DISTANCE_TOLERANCE, ERROR_SPEED
from wspd_design.reporting import numbers
from wspd_design.reporting.figure_style import INK, MUTED, SERIES
from wspd_design.reporting.figures.drawing import KMH, curve, look, note, thinned
from wspd_design.reporting.figures.stop import intervals, line_of
from wspd_design.simulation.law_memory import SpeedEstimate, released, releases
from wspd_design.simulation.runs import Run

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

ESTIMATE = 1  # color and line style of what the law believes
BAR = 0.03  # of the height of the panel, for each wheelset that is released


def estimate_panels(figure: "Figure", run: Run, estimate: SpeedEstimate) -> "Figure":
    """Draw the estimated speed beside the true one, its error, and the error of the distance.

    Parameters
    ----------
    figure : Figure
        Empty figure.
    run : Run
        The stop.
    estimate : SpeedEstimate
        What its law estimated.
    """
    speed, error, distance = figure.subplots(3, 1, sharex=True, height_ratios=(2.4, 1.6, 1.6))
    estimate_panel(speed, run, estimate)
    speed.set_title("Train speed, true and as the law has it; bars: wheelsets released to look")
    curve(error, estimate.time, 100.0 * estimate.error, ESTIMATE, linewidth=1.0)
    error.axhline(0.0, color=INK, linewidth=0.7)
    slow = estimate.time[estimate.true_speed <= ERROR_SPEED]
    if slow.size:
        error.axvspan(slow[0], float(run.time[-1]), color=MUTED, alpha=0.12, linewidth=0)
    error.set(ylabel="error [%]", title="Error of the speed")
    _distances(distance, estimate)
    distance.set(
        xlabel="time [s]", ylabel="error [m]", title="Error of the distance that follows from that speed"
    )
    distance.set_xlim(0.0, float(run.time[-1]))
    figure.align_ylabels()
    return figure


def estimate_alt(run: Run, estimate: SpeedEstimate) -> str:
    """Say in words what the panels show."""
    import numpy as np

    errors, looks = 100.0 * estimate.error, releases(run)
    known = errors[~np.isnan(errors)]
    spread = (
        f"its error lies between {known.min():.2g} and {known.max():.2g} %"
        if known.size
        else "the train is never as fast as that"
    )
    looked = "" if looks is None else f" Wheelsets are released {numbers.count(looks, 'time')}."
    return (
        f"Three panels over {run.time[-1]:.2f} s: the train speed and its estimate from "
        f"{run.initial_speed * KMH:.4g} km/h on; above {ERROR_SPEED * KMH:.3g} km/h {spread}; the distance is "
        f"wrong by {estimate.distance_error.min():.2g} to {estimate.distance_error.max():.2g} m.{looked}"
    )


def estimate_panel(axes: "Axes", run: Run, estimate: SpeedEstimate) -> None:
    """Draw the estimated speed beside the true one; bars at the top edge where a wheelset is released to look."""
    axes.plot(*thinned(run.time, run.speed * KMH), color=INK, linewidth=1.6, label="train")
    curve(axes, estimate.time, estimate.speed * KMH, ESTIMATE, linewidth=1.2, label="estimate")
    flags = released(run)
    if flags is not None:
        for wheelset, column in enumerate(flags.T):
            axes.broken_barh(
                intervals(estimate.time, column),
                (1.0 - BAR * (wheelset + 1), 0.8 * BAR),
                transform=axes.get_xaxis_transform(),
                color=look(line_of(wheelset))[0],
                linewidth=0,
            )
    axes.set(ylabel="speed [km/h]", ylim=(0.0, None))
    axes.legend(loc="lower left")


def _distances(axes: "Axes", estimate: SpeedEstimate) -> None:
    time, allowed = thinned(estimate.time, estimate.allowed)
    axes.fill_between(time, -allowed, allowed, color=SERIES[2], alpha=0.15, linewidth=0)
    curve(axes, estimate.time, estimate.distance_error, ESTIMATE, linewidth=1.0)
    axes.axhline(0.0, color=INK, linewidth=0.7)
    base, share = DISTANCE_TOLERANCE
    note(
        axes,
        f"{base:g} m + {100.0 * share:g} %",
        float(time[-1]),
        float(allowed[-1]),
        ha="right",
        va="top",
        xytext=(0, -2),
    )
