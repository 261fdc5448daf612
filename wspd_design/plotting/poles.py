"""Poles of linearizations: one in the complex plane, many over speed."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from wspd_design.analysis.linearization import Linearization
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.units import KMH
from wspd_design.plotting.axes import on_axes
from wspd_design.reporting.figure_style import INK, SERIES
from wspd_design.reporting.figures.drawing import curve, note

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_ROOM = 0.25  # of the span, beside the outermost pole


def plot_linearization(point: Linearization, *, ax: "Axes | None" = None) -> "Axes":
    """Plot the open-loop poles of a linearization in the complex plane [1/s]."""
    return on_axes(ax, lambda axes: _complex_plane(axes, point), height=1.8)


def plot_poles(points: Sequence[Linearization], *, ax: "Axes | None" = None) -> "Axes":
    """Plot the slip pole of several linearizations over the train speed, beside the rate of the valve.

    Parameters
    ----------
    points : sequence of Linearization
        Of one vehicle, rail and slip, as :func:`wspd_design.linearize` returns them.
    ax : Axes, optional
        Where to draw; new axes by default.

    Returns
    -------
    Axes
        Train speed [km/h] over pole [1/s].

    Raises
    ------
    UserError
        If there are fewer than two.
    """
    kept = sorted(points, key=lambda point: point.speed)
    if len(kept) < 2:
        raise UserError(f"plot_poles takes two linearizations or more, not {len(kept)}")

    def draw(axes: "Axes") -> None:
        import numpy as np

        speeds = np.array([KMH * point.speed for point in kept])
        curve(axes, speeds, np.array([point.slip_pole for point in kept]), 0, label="slip pole")
        curve(
            axes,
            speeds,
            np.array([1.0 / point.time_constant for point in kept]),
            1,
            label="1/time constant of the valve",
        )
        axes.axhline(0.0, color=INK, linewidth=0.6)
        first = kept[0]
        axes.set(
            xlabel="train speed [km/h]",
            ylabel="pole [1/s]",
            title=f"{first.vehicle} on {first.rail} at slip {first.slip:g}",
        )
        axes.legend()

    return on_axes(ax, draw)


def poles_panel(figure: "Figure", point: Linearization) -> "Figure":
    """Draw the poles of a linearization on an empty figure."""
    _complex_plane(figure.subplots(), point)
    return figure


def _complex_plane(axes: "Axes", point: Linearization) -> None:
    valve = -1.0 / point.time_constant
    least, most = min(valve, point.slip_pole, 0.0), max(point.slip_pole, 0.0)
    room = _ROOM * (most - least)
    axes.axvspan(0.0, most + room, color=SERIES[1], alpha=0.1, linewidth=0)
    axes.axvline(0.0, color=INK, linewidth=0.6)
    for place, (name, pole) in enumerate((("slip", point.slip_pole), ("valve", valve))):
        axes.plot([pole], [0.0], "x", color=SERIES[place], markersize=8, markeredgewidth=2.0)
        note(axes, f"{name} {pole:.3g} 1/s", pole, 0.0, xytext=(0, 8), ha="center")
    axes.set(
        xlabel="real part [1/s]; shaded: grows",
        ylabel="imaginary [1/s]",
        xlim=(least - room, most + room),
        ylim=(-1.0, 1.0),
        yticks=[0.0],
    )
