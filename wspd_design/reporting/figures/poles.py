"""The slip pole over speed."""

from collections.abc import Collection, Iterable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from wspd_design.analysis.linearization import Linearization
from wspd_design.certificates.records import Certificate, Role, Series
from wspd_design.reporting.figure_style import INK, MUTED, SERIES
from wspd_design.reporting.figures.drawing import KMH, curve, note
from wspd_design.reporting.figures.series import plain_symbols, series_alt

AXES = ("speed [km/h]", "slip pole [1/s]")
"""Of the curves of certificates that the pole map draws."""

SAME = 1e-6  # relative difference of a limit that is drawn already
FURTHER = 2  # color and line style of the first curve of a check
LIMITS = ("-.", (0, (1, 1)), (0, (5, 1)))  # line styles

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def is_pole_over_speed(series: Series) -> bool:
    """Tell whether a curve of a certificate belongs into the one figure of the slip pole over speed."""
    return (series.x_label, series.y_label) == AXES


def beside_nominal(certificates: Iterable[Certificate], drawn: Collection[float]) -> tuple[Series, ...]:
    """Return what checks show of the slip pole beside its nominal course, each curve once.

    Parameters
    ----------
    certificates : iterable of Certificate
        The checks.
    drawn : collection of float
        Limits that the figure has already [1/s].
    """
    found: dict[tuple[float, ...], Series] = {}
    for certificate in certificates:
        for each in certificate.series:
            if not is_pole_over_speed(each) or each.name == "nominal":
                continue
            if each.role is not Role.LIMIT:
                found.setdefault(each.y, each)
            elif all(abs(each.y[0] - limit) > SAME * abs(limit) for limit in drawn):
                found.setdefault(
                    each.y, replace(each, name=f"{plain_symbols(each.name)}, {each.y[0]:.3g} 1/s")
                )
    return tuple(found.values())


def pole_map(
    figure: "Figure",
    points: Sequence[Linearization],
    speeds: tuple[float, float],
    times: tuple[float, float] | None,
    series: Sequence[Series] = (),
) -> "Figure":
    """Draw the slip pole over train speed, beside the rate of the averaged valve and the limits that checks set it.

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
    series : sequence of Series
        What checks show beside it, as :func:`beside_nominal` returns it.
    """
    import numpy as np
    from matplotlib.ticker import FixedLocator, NullLocator, ScalarFormatter

    axes = figure.subplots()
    speed = np.array([point.speed * KMH for point in points])
    nominal = np.array([point.slip_pole for point in points])
    curves = [each for each in series if each.role is not Role.LIMIT]
    drawn = np.concatenate([nominal, *(np.array(each.y) for each in curves)])
    limit = np.array([1.0 / point.time_constant for point in points])
    highest = 1.0 / min(times) if times else limit.max()
    top = max(1.25 * highest, drawn.max() + 0.15 * np.ptp(drawn))
    bottom = min(-0.5 * highest, nominal.min() - 0.05 * np.ptp(nominal))
    axes.fill_between(speed, limit, top, color=SERIES[1], alpha=0.12, linewidth=0)
    axes.plot(speed, limit, color=SERIES[1], linestyle="--", linewidth=1.0, label="_1/τ")
    if times and times[0] != times[1]:
        for name, time in zip(("fill", "vent"), times, strict=True):
            axes.axhline(1.0 / time, color=SERIES[1], linestyle=":", linewidth=0.8)
            note(axes, f"1/{name} time", speed[-1], 1.0 / time, xytext=(-46, 2))
    axes.axhline(0.0, color=INK, linewidth=0.6)
    curve(axes, speed, nominal, 0, label="nominal slip pole p")
    for place, each in enumerate(curves):
        curve(axes, np.array(each.x), np.array(each.y), FURTHER + place, label=each.name)
    for place, each in enumerate(each for each in series if each.role is Role.LIMIT):
        axes.plot(
            each.x, each.y, color=INK, linestyle=LIMITS[place % len(LIMITS)], linewidth=1.0, label=each.name
        )
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
    points: Sequence[Linearization],
    speeds: tuple[float, float],
    times: tuple[float, float] | None,
    series: Sequence[Series] = (),
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
    further = f" {series_alt(series)}" if series else ""
    return (
        f"Slip pole over train speed from {points[0].speed * KMH:.3g} to {points[-1].speed * KMH:.3g} km/h. "
        f"It is highest, {highest.slip_pole:.3g} 1/s, at {highest.speed * KMH:.3g} km/h and lowest, "
        f"{lowest.slip_pole:.3g} 1/s, at {lowest.speed * KMH:.3g} km/h. "
        f"{line}; dotted lines mark the range of operation, "
        f"{speeds[0] * KMH:.3g} to {speeds[1] * KMH:.3g} km/h.{further}"
    )
