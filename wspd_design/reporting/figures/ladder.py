"""The same stop on several models of a vehicle."""

from typing import TYPE_CHECKING

from wspd_design.reporting.figures.drawing import KILO, curve
from wspd_design.reporting.figures.stop import line_of, name
from wspd_design.simulation.loop_input import JUDGING_SPEED
from wspd_design.studies.ladder import Ladder
from wspd_design.studies.rung import Rung

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MOST = 320
"""Points of a curve: the panels are small and many."""


def rungs(figure: "Figure", found: Ladder) -> "Figure":
    """Draw slip and wheel load over time, a column for each model on the same axes."""
    slip, load = figure.subplots(2, len(found.rungs), sharex=True, sharey="row", squeeze=False)
    for column, each in enumerate(found.rungs):
        run = each.run
        judged = run.speed > JUDGING_SPEED
        for axes, trace in ((slip[column], run.slip), (load[column], run.wheel_load / KILO)):
            for wheelset, values in enumerate(trace[judged].T):
                label, line = name(run, wheelset), line_of(wheelset)
                curve(axes, run.time[judged], values, line, most=MOST, linewidth=0.9, label=label)
        slip[column].set_title(each.title)
        load[column].set_xlabel("time [s]")
    slip[0].set(ylabel="slip [-]", ylim=(0.0, None))
    load[0].set_ylabel("load of a wheel [kN]")
    slip[0].set_xlim(0.0, max(float(each.run.time[-1]) for each in found.rungs))
    handles, labels = slip[-1].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper right", ncols=len(labels))
    return figure


def rungs_alt(found: Ladder) -> str:
    """Say in words what the panels show."""
    return f"Slip and wheel load over time above 10 km/h: {'; '.join(map(_said, found.rungs))}."


def _said(rung: Rung) -> str:
    loads = ", ".join(f"{each.braking_load / KILO:.1f}" for each in rung.axles)
    slips = ", ".join(f"{each.slip_mean:.3f}" for each in rung.axles)
    return f"{rung.title} mean slip {slips} and mean load while braking {loads} kN, front to rear"
