"""The ladder of models in tables, for a page and for the terminal."""

import math
from collections.abc import Callable
from typing import TypeAlias

from wspd_design.reporting import numbers
from wspd_design.reporting.blocks import Table
from wspd_design.reporting.figures.drawing import KILO, KMH
from wspd_design.reporting.tables import ColumnOf, build
from wspd_design.studies.ladder import Agreement, Ladder
from wspd_design.studies.rung import AxleFigures, Rung

PERCENT = 100.0

_Read: TypeAlias = Callable[[AxleFigures], float]
_Row: TypeAlias = tuple[Rung, int, AxleFigures]


def stops_table(found: Ladder, *, caption: str = "", anchor: str = "") -> Table:
    """List the stop on each model, with the worst wheelset of each figure."""

    def worst(title: str, unit: str, decimals: int, read: _Read) -> ColumnOf[Rung]:
        return ColumnOf(
            title=title, unit=unit, decimals=decimals, read=lambda rung: max(map(read, rung.axles))
        )

    return build(
        found.rungs,
        (
            ColumnOf(title="Model", read=lambda rung: rung.title),
            ColumnOf(title="Distance", unit="m", decimals=2, read=lambda rung: rung.metrics.distance),
            ColumnOf(title="Time", unit="s", decimals=2, read=lambda rung: rung.metrics.stopping_time),
            ColumnOf(title="Mean slip", decimals=3, read=lambda rung: rung.metrics.slip_mean),
            worst("Largest slip", "", 3, lambda axle: axle.slip_max),
            ColumnOf(title="Lock", unit="s", decimals=2, read=lambda rung: rung.lock),
            worst("Spread of load", "%", 1, lambda axle: PERCENT * axle.relative_spread),
            worst("Vibration", "m/s", 3, lambda axle: axle.vibration),
            ColumnOf(title="Spread", unit="m", significant=2, read=lambda rung: rung.spread or math.nan),
            ColumnOf(title="Half steps", unit="relative", significant=1, read=lambda rung: rung.step_change),
        ),
        caption=caption,
        anchor=anchor,
    )


def axles_table(found: Ladder, *, caption: str = "", anchor: str = "") -> Table:
    """List every wheelset on every model."""
    rows = [(rung, number, axle) for rung in found.rungs for number, axle in enumerate(rung.axles, start=1)]

    def of_axle(title: str, unit: str, decimals: int, read: _Read) -> ColumnOf[_Row]:
        return ColumnOf(title=title, unit=unit, decimals=decimals, read=lambda row: read(row[2]))

    return build(
        rows,
        (
            ColumnOf(title="Model", read=lambda row: row[0].title if row[1] == 1 else ""),
            ColumnOf(title="Wheelset", decimals=0, read=lambda row: float(row[1])),
            of_axle("Slip, mean", "", 3, lambda axle: axle.slip_mean),
            of_axle("largest", "", 3, lambda axle: axle.slip_max),
            of_axle("Load at rest", "kN", 2, lambda axle: axle.static_load / KILO),
            of_axle("braking", "kN", 2, lambda axle: axle.braking_load / KILO),
            of_axle("least", "kN", 2, lambda axle: axle.least_load / KILO),
            of_axle("spread", "kN", 2, lambda axle: axle.load_spread / KILO),
            of_axle("Vibration", "m/s", 3, lambda axle: axle.vibration),
            of_axle("at", "Hz", 1, lambda axle: axle.vibration_frequency),
            of_axle("speed", "km/h", 0, lambda axle: axle.vibration_speed * KMH),
        ),
        caption=caption,
        anchor=anchor,
    )


def agreements_table(found: Ladder, *, caption: str = "", anchor: str = "") -> Table:
    """List how far each model is from the largest one, and which of them suffices."""
    below = range(len(found.rungs) - 1)
    return build(
        found.agreements,
        (
            ColumnOf(title="Worst wheelset", read=lambda each: each.measure.name),
            *(_deviation(found, rung) for rung in below),
            ColumnOf(title="Tolerance", flush_right=True, read=lambda each: _tolerance(each)),
            ColumnOf(title="Suffices", read=lambda each: found.rungs[each.suffices].title),
        ),
        caption=caption,
        anchor=anchor,
    )


def _deviation(found: Ladder, rung: int) -> ColumnOf[Agreement]:
    return ColumnOf(
        title=found.rungs[rung].title,
        flush_right=True,
        read=lambda each: _size(each, each.deviations[rung]),
    )


def _tolerance(agreement: Agreement) -> str:
    measure = agreement.measure
    unit = f"% {measure.unit}" if measure.share else measure.unit
    return f"{_size(agreement, measure.tolerance)} {unit}".rstrip()


def _size(agreement: Agreement, value: float) -> str:
    return numbers.significant(value * (PERCENT if agreement.measure.share else 1.0), 2)


def sensitivity(found: Ladder) -> str:
    """Say what a sensitive loop makes of small differences; nothing where no loop is."""
    if not found.spread:
        return ""
    return (
        f" The closed loop is sensitive: starts that nobody can tell apart spread its distance by up to "
        f"{numbers.significant(found.spread, 2)} m, and differences between models below that say nothing."
    )


def sufficiency(found: Ladder) -> str:
    """Say which model suffices for what."""
    by_rung: dict[int, list[str]] = {}
    for each in found.agreements:
        by_rung.setdefault(each.suffices, []).append(each.measure.name)
    return "; ".join(
        f"{found.rungs[rung].title}: {numbers.listing(by_rung[rung])}" for rung in sorted(by_rung)
    )
