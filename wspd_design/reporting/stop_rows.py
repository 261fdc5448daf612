"""The figures of one stop as rows: what each is, its value and its unit."""

import math
from collections.abc import Iterator
from dataclasses import dataclass

from wspd_design.codegen.loop_numbers import DISTANCE_TOLERANCE
from wspd_design.simulation.ideal import NO_IDEAL_STOP
from wspd_design.simulation.metrics import Metrics
from wspd_design.simulation.self_check import StepCheck


@dataclass(frozen=True, slots=True, kw_only=True)
class FigureRow:
    """One figure."""

    label: str
    value: float | str  # in the unit; a word where there is no number
    unit: str = ""
    form: str = ".3f"  # of the number

    @property
    def text(self) -> str:
        """The value as it is written; a number that does not exist is a dash."""
        if isinstance(self.value, str):
            return self.value
        return "-" if self.value != self.value else format(self.value, self.form)


def stop_rows(figures: Metrics, *, about: str, check: StepCheck | None) -> tuple[FigureRow, ...]:
    """Return the figures of a stop in the order of reading.

    Parameters
    ----------
    figures : Metrics
        Of the stop.
    about : str
        Slip that the law holds, in words.
    check : StepCheck or None
        How far the integration can be trusted, if it is known.
    """
    return tuple(_rows(figures, about, check))


def _rows(figures: Metrics, about: str, check: StepCheck | None) -> Iterator[FigureRow]:
    yield FigureRow(label="distance", value=figures.distance, unit="m", form=".1f")
    yield _ideal_stop(figures)
    yield _percent("efficiency, ideal stop over distance", figures.efficiency)
    yield FigureRow(label="time", value=figures.stopping_time, unit="s", form=".2f")
    if figures.build_up == figures.build_up:
        label = "build-up of the brake, 90 % of its torque"
        yield FigureRow(label=label, value=figures.build_up, unit="s", form=".2f")
    yield FigureRow(
        label="torque integral, all wheelsets", value=figures.torque_integral / 1e3, unit="kN m s", form=".1f"
    )
    yield _percent("adhesion utilization", figures.adhesion_utilization)
    for label, slip in (
        (f"slip rms about {about}", figures.slip_rms),
        ("the same once it is reached", figures.held_slip_rms),
        ("the same of a perfect law", figures.perfect_slip_rms),
        ("slip overshoot, once reached", figures.slip_overshoot),
        ("slip undershoot, likewise", figures.slip_undershoot),
        ("slip mean", figures.slip_mean),
        ("slip maximum", figures.slip_max),
    ):
        yield FigureRow(label=label, value=slip, unit="-")
    yield from _of_law(figures)
    yield FigureRow(label="wheels locked", value=figures.lock_time, unit="s", form=".2f")
    yield FigureRow(label="longest lock above 10 km/h", value=figures.judged_lock, unit="s", form=".2f")
    yield FigureRow(label="vented air per wheelset", value=figures.vented_air, unit="cylinders", form=".2f")
    yield from _of_brake(figures)
    yield FigureRow(label="valve switches per wheelset", value=figures.valve_switches, form="d")
    yield _percent("samples at a limit", figures.saturated_share, form=".0f")
    yield FigureRow(label="momentum balance, relative", value=figures.momentum_residual, unit="-", form=".1e")
    yield FigureRow(label="energy balance, relative", value=figures.energy_residual, unit="-", form=".1e")
    if check is not None:
        yield FigureRow(label="step check, distance, relative", value=check.distance, unit="-", form=".1e")
        yield FigureRow(label="step check, slip", value=check.slip, unit="-", form=".1e")


def _percent(label: str, share: float, form: str = ".1f") -> FigureRow:
    return FigureRow(label=label, value=100.0 * share, unit="%", form=form)


def _ideal_stop(figures: Metrics) -> FigureRow:
    """Distance of the ideal stop; a word for a train that cannot stop."""
    label = "ideal stop, best slip held"
    if figures.ideal_ending in NO_IDEAL_STOP:
        return FigureRow(label=label, value="none")
    return FigureRow(label=label, value=figures.ideal_stop, unit="m", form=".1f")


def _of_brake(figures: Metrics) -> Iterator[FigureRow]:
    """What only some brakes have: volumes, and watchdogs."""
    if not math.isnan(figures.air_used):
        label = "air from the reservoir, all wheelsets"
        yield FigureRow(label=label, value=figures.air_used, unit="normal litres", form=".0f")
    if not math.isnan(figures.lowest_reservoir):
        label = "lowest reservoir pressure"
        yield FigureRow(label=label, value=figures.lowest_reservoir / 1e5, unit="bar", form=".2f")
    if figures.watchdog_fills is not None:
        yield FigureRow(label="fillings by a watchdog", value=figures.watchdog_fills, form="d")


def _of_law(figures: Metrics) -> Iterator[FigureRow]:
    """What only some laws tell: the slip that they hold, and the train speed that they go by."""
    if not math.isnan(figures.slip_band):
        label = "slip off the law's own reference, once reached"
        yield FigureRow(label=label, value=figures.slip_band, unit="-")
    if not math.isnan(figures.speed_error):
        base, share = DISTANCE_TOLERANCE
        yield _percent("speed of the law, largest error", figures.speed_error)
        label = f"its distance, error over {base:g} m + {100.0 * share:g} %"
        yield FigureRow(label=label, value=figures.distance_error, unit="-", form=".2f")
