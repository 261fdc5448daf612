"""The stop in the planes in which a control engineer reads a limit cycle."""

from typing import TYPE_CHECKING

from wspd_design.design.records import Specification
from wspd_design.reporting.figure_style import INK, SERIES
from wspd_design.reporting.figures.drawing import KILO, curve
from wspd_design.simulation.law_memory import reference_range
from wspd_design.simulation.loop_input import JUDGING_SPEED
from wspd_design.simulation.runs import Run
from wspd_design.studies.dossier import PhasePlane

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from wspd_design.simulation.runs import Trace


def phase_planes(
    figure: "Figure", run: Run, plane: PhasePlane | None, specification: Specification
) -> "Figure":
    """Draw slip error over its integral with the surface, and torque over slip, above the judging speed.

    Parameters
    ----------
    figure : Figure
        Empty figure.
    run : Run
        The stop.
    plane : PhasePlane or None
        What the law saw at its samples; a law without a surface has none, and torque over slip stands alone.
    specification : Specification
        Slip reference.
    """
    if plane is None:
        _wheel(figure.subplots(), run, specification)
    else:
        law, wheel = figure.subplots(1, 2)
        _law(law, plane)
        _wheel(wheel, run, specification)
    return figure


def phase_alt(run: Run, plane: PhasePlane | None) -> str:
    """Say in words what the phase planes show."""
    slip, torque = _judged(run)
    path = (
        f"orque from {torque.min():.3g} to {torque.max():.3g} kN m over slip from {slip.min():.3f} to "
        f"{slip.max():.3f}."
    )
    if plane is None:
        return f"Phase plane: t{path}"
    return (
        f"Two phase planes. Left: slip error from {min(plane.error):.3f} to {max(plane.error):.3f} over its "
        f"integral from {min(plane.integral):.3f} to {max(plane.integral):.3f} s, with the surface of slope "
        f"{-plane.surface_rate:.3g} 1/s and its boundary layer of {plane.layer:.3g}. Right: t{path}"
    )


def _law(axes: "Axes", plane: PhasePlane) -> None:
    import numpy as np

    integral, error = np.array(plane.integral), np.array(plane.error)
    axes.plot(integral, error, color=SERIES[0], linewidth=0.9, marker=".", markersize=3)
    ends = np.array([integral.min(initial=0.0), integral.max(initial=0.0)])
    margin = max(0.05 * (ends[1] - ends[0]), 1e-3)
    ends += (-margin, margin)
    surface = -plane.surface_rate * ends
    axes.fill_between(
        ends, surface - plane.layer, surface + plane.layer, color=SERIES[1], alpha=0.2, linewidth=0
    )
    axes.plot(ends, surface, color=SERIES[1], linestyle="--", linewidth=1.0)
    _start_and_end(axes, integral, error)
    axes.set(xlabel="integral of the slip error [s]", ylabel="slip error e [-]", title="As the law sees it")
    axes.set_xlim(*ends)


def _wheel(axes: "Axes", run: Run, specification: Specification) -> None:
    slip, torque = _judged(run)
    curve(axes, slip, torque, 0, linewidth=0.9)
    if reference_range(run) is None:  # a moving one is no line here
        axes.axvline(specification.slip, color=INK, linestyle="--", linewidth=0.8)
    _start_and_end(axes, slip, torque)
    axes.set(xlabel="slip [-]", ylabel="torque [kN m]", title="As the wheel moves")


def _judged(run: Run) -> tuple["Trace", "Trace"]:
    """Slip [-] and torque [kN m] of the first wheelset with a brake above the judging speed."""
    judged, wheelset = run.speed > JUDGING_SPEED, run.first_braked
    return run.slip[judged, wheelset], run.torque[judged, wheelset] / KILO


def _start_and_end(axes: "Axes", x: "Trace", y: "Trace") -> None:
    axes.plot(x[0], y[0], "o", color=INK, markersize=4, label="start")
    axes.plot(x[-1], y[-1], "s", color=INK, markersize=4, label="10 km/h")
    # Beside the title: the path may go anywhere.
    axes.legend(loc="lower right", bbox_to_anchor=(1.02, 0.98), ncols=2, handlelength=1.0, columnspacing=1.2)
