"""The slip pole over speed."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from wspd_design.analysis.linearization import Linearization
from wspd_design.reporting.figure_style import INK, MUTED, SERIES
from wspd_design.reporting.figures.drawing import KMH, curve, note

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def pole_map(
    figure: "Figure",
    points: Sequence[Linearization],
    speeds: tuple[float, float],
    times: tuple[float, float] | None,
) -> "Figure":
    """Draw the open-loop poles over train speed, and where they exceed the rate of the averaged valve.

    Parameters
    ----------
    figure : Figure
        Empty figure.
    points : sequence of Linearization
        Over rising speed.
    speeds : tuple of float
        Range of operation [m/s].
    times : tuple of float or None
        Fill and vent time of a lag [s]; the rate of the averaged valve lies between theirs. None for orifices.
    """
    import numpy as np
    from matplotlib.ticker import FixedLocator, NullLocator, ScalarFormatter

    axes = figure.subplots()
    speed = np.array([point.speed * KMH for point in points])
    without = np.array([point.poles(with_lag=False)[0] for point in points])
    with_lag = np.array([point.poles() for point in points])
    limit = np.array([1.0 / point.time_constant for point in points])
    highest = 1.0 / min(times) if times else limit.max()
    top = max(1.25 * highest, without.max() + 0.15 * np.ptp(without))
    bottom = min(-1.6 * highest, without.min() - 0.05 * np.ptp(without))
    axes.fill_between(speed, limit, top, color=SERIES[1], alpha=0.12, linewidth=0)
    axes.plot(speed, limit, color=SERIES[1], linestyle="--", linewidth=1.0, label="_1/τ")
    if times and times[0] != times[1]:
        for name, time in zip(("fill", "vent"), times, strict=True):
            axes.axhline(1.0 / time, color=SERIES[1], linestyle=":", linewidth=0.8)
            note(axes, f"1/{name} time", speed[-1], 1.0 / time, xytext=(-46, 2))
    axes.axhline(0.0, color=INK, linewidth=0.6)
    for column in range(with_lag.shape[1]):
        axes.plot(
            speed[::4],
            with_lag[::4, column],
            linestyle="none",
            marker="o",
            markersize=3.5,
            markerfacecolor="none",
            markeredgecolor=SERIES[6],
            markeredgewidth=0.7,
            label="both poles with the valve" if column == 0 else None,
        )
    curve(axes, speed, without, 0, label="slip pole p without the valve")
    for edge in speeds:
        axes.axvline(edge * KMH, color=MUTED, linestyle=":", linewidth=0.8)
    axes.set(xscale="log", xlim=(speed[0], speed[-1] * 1.02), ylim=(bottom, top))
    axes.xaxis.set_major_locator(FixedLocator([5, 10, 20, 50, 100, 200]))
    axes.xaxis.set_minor_locator(NullLocator())
    axes.xaxis.set_major_formatter(ScalarFormatter())
    axes.set(xlabel="train speed [km/h]", ylabel="pole [1/s]")
    inside = "shaded, p > 1/τ: no stable equilibrium without torque feedback"
    note(axes, inside, speed[0], float(limit[0]), xytext=(4, 3))
    axes.legend(loc="lower left", bbox_to_anchor=(-0.01, 0.98), ncols=2)
    return figure


def pole_map_alt(
    points: Sequence[Linearization], speeds: tuple[float, float], times: tuple[float, float] | None
) -> str:
    """Say in words what the pole map shows."""
    highest = max(points, key=lambda point: point.slip_pole)
    lowest = min(points, key=lambda point: point.slip_pole)
    rates = [1.0 / point.time_constant for point in points]
    if times is None:
        line = f"A line marks 1/tau of the averaged orifices, {min(rates):.3g} to {max(rates):.3g} 1/s"
    elif times[0] == times[1]:
        line = f"A line marks 1/tau = {1.0 / times[0]:.3g} 1/s"
    else:
        line = (
            f"A line marks 1/tau of the averaged valve, {min(rates):.3g} to {max(rates):.3g} 1/s, between 1/fill time "
            f"= {1.0 / times[0]:.3g} 1/s and 1/vent time = {1.0 / times[1]:.3g} 1/s"
        )
    return (
        f"Slip pole over train speed from {points[0].speed * KMH:.3g} to {points[-1].speed * KMH:.3g} km/h. "
        f"It is highest, {highest.slip_pole:.3g} 1/s, at {highest.speed * KMH:.3g} km/h and lowest, "
        f"{lowest.slip_pole:.3g} 1/s, at {lowest.speed * KMH:.3g} km/h. "
        f"{line}; dotted lines mark the range of operation, "
        f"{speeds[0] * KMH:.3g} to {speeds[1] * KMH:.3g} km/h."
    )
