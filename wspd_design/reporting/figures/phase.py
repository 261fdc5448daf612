"""The stop in the planes in which a control engineer reads a limit cycle."""

from typing import TYPE_CHECKING

from wspd_design.design.dossier import PhasePlane
from wspd_design.design.records import Specification
from wspd_design.reporting.figure_style import INK, SERIES
from wspd_design.reporting.figures.drawing import KILO, curve
from wspd_design.simulation.loop_input import JUDGING_SPEED
from wspd_design.simulation.records import Run

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from wspd_design.simulation.records import Trace


def phase_planes(figure: "Figure", run: Run, plane: PhasePlane, specification: Specification) -> "Figure":
    """Draw slip error over its integral with the surface, and torque over slip, above the judging speed.

    Parameters
    ----------
    figure : Figure
        Empty figure.
    run : Run
        The stop.
    plane : PhasePlane
        What the law saw at its samples.
    specification : Specification
        Slip reference.
    """
    import numpy as np

    law, plant = figure.subplots(1, 2)
    integral, error = np.array(plane.integral), np.array(plane.error)
    law.plot(integral, error, color=SERIES[0], linewidth=0.9, marker=".", markersize=3)
    ends = np.array([integral.min(initial=0.0), integral.max(initial=0.0)])
    margin = max(0.05 * (ends[1] - ends[0]), 1e-3)
    ends += (-margin, margin)
    surface = -plane.surface_rate * ends
    law.fill_between(
        ends, surface - plane.layer, surface + plane.layer, color=SERIES[1], alpha=0.2, linewidth=0
    )
    law.plot(ends, surface, color=SERIES[1], linestyle="--", linewidth=1.0)
    _start_and_end(law, integral, error)
    law.set(xlabel="integral of the slip error [s]", ylabel="slip error e [-]", title="As the law sees it")
    law.set_xlim(*ends)
    judged = run.speed > JUDGING_SPEED
    slip, torque = run.slip[judged, 0], run.torque[judged, 0] / KILO
    curve(plant, slip, torque, 0, linewidth=0.9)
    plant.axvline(specification.slip, color=INK, linestyle="--", linewidth=0.8)
    _start_and_end(plant, slip, torque)
    plant.set(xlabel="slip [-]", ylabel="torque [kN m]", title="As the wheel moves")
    return figure


def phase_alt(run: Run, plane: PhasePlane) -> str:
    """Say in words what the phase planes show."""
    judged = run.speed > JUDGING_SPEED
    slip, torque = run.slip[judged, 0], run.torque[judged, 0] / KILO
    return (
        f"Two phase planes. Left: slip error from {min(plane.error):.3f} to {max(plane.error):.3f} over its "
        f"integral from {min(plane.integral):.3f} to {max(plane.integral):.3f} s, with the surface of slope "
        f"{-plane.surface_rate:.3g} 1/s and its boundary layer of {plane.layer:.3g}. Right: torque from "
        f"{torque.min():.3g} to {torque.max():.3g} kN m over slip from {slip.min():.3f} to {slip.max():.3f}."
    )


def _start_and_end(axes: "Axes", x: "Trace", y: "Trace") -> None:
    axes.plot(x[0], y[0], "o", color=INK, markersize=4, label="start")
    axes.plot(x[-1], y[-1], "s", color=INK, markersize=4, label="10 km/h")
    axes.legend(loc="best")
