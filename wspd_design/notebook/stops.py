"""Stops: figures with their units, and pictures of slip and distance."""

import math
from collections.abc import Sequence

from wspd_design.notebook.html import card, small_picture
from wspd_design.parameters.table import Column, Table, table_of
from wspd_design.parameters.units import KMH
from wspd_design.plotting.stops import slip_picture
from wspd_design.reporting.figures.comparison import distance_bars, distances_alt
from wspd_design.reporting.stop_rows import FigureRow, stop_rows
from wspd_design.simulation.comparison import Trial
from wspd_design.simulation.description import held_slip
from wspd_design.simulation.ideal import NO_IDEAL_STOP
from wspd_design.simulation.metrics import Metrics
from wspd_design.simulation.released import released_sentence
from wspd_design.simulation.runs import Ending, Run
from wspd_design.simulation.trace_table import Traces

_FIGURES: tuple[Column[FigureRow], ...] = (
    Column(title="figure", read=lambda row: row.label),
    Column(title="value", read=lambda row: row.text, flush_right=True),
    Column(title="unit", read=lambda row: row.unit.removeprefix("-")),
)
_STOPS: tuple[Column[Trial], ...] = (
    Column(title="controller", read=lambda trial: trial.run.controller),
    Column(title="distance", unit="m", decimals=1, read=lambda trial: trial.metrics.distance),
    Column(title="time", unit="s", decimals=2, read=lambda trial: trial.metrics.stopping_time),
    Column(title="efficiency", unit="%", decimals=0, read=lambda trial: 100.0 * trial.metrics.efficiency),
    Column(title="slip rms", unit="-", decimals=3, read=lambda trial: trial.metrics.slip_rms),
    Column(title="slip max", unit="-", decimals=3, read=lambda trial: trial.metrics.slip_max),
    Column(title="locked", unit="s", decimals=2, read=lambda trial: trial.metrics.lock_time),
    Column(title="valve switches", read=lambda trial: trial.metrics.valve_switches),
    Column(title="cylinders vented", decimals=1, read=lambda trial: trial.metrics.vented_air),
    Column(title="remark", read=lambda trial: "; ".join(_remarks(trial))),
)
"""The last one stands where a stop has a remark alone."""
_PICTURE = 2.1  # in


def trial_table(trial: Trial) -> Table:
    """Return the figures of a stop."""
    rows = stop_rows(trial.metrics, about=held_slip(trial.run, trial.slip_reference), check=trial.check)
    return table_of(rows, _FIGURES, caption=_title(trial.run), notes=[*_notes([trial]), _JUDGED])


def metrics_table(figures: Metrics) -> Table:
    """Return figures alone."""
    rows = stop_rows(figures, about="the reference", check=None)
    return table_of(rows, _FIGURES, caption="Figures of a stop", notes=[_JUDGED])


def comparison_table(trials: Sequence[Trial]) -> Table:
    """Return a row for each stop."""
    if not trials:
        return table_of(trials, _STOPS, caption="No stop")
    run, ideal = trials[0].run, trials[0].metrics.ideal_stop
    known = (
        f"Efficiency: distance of the brake that holds the best slip, {ideal:.1f} m, over distance."
        if math.isfinite(ideal)
        else ""
    )
    return table_of(
        trials,
        _columns(trials),
        caption=f"{run.train} on {run.rail}, from {KMH * run.initial_speed:g} km/h",
        notes=[known, *_notes(trials), _JUDGED],
    )


_JUDGED = "Slip figures count above 10 km/h."


def run_card(run: Run) -> str:
    """Return what a notebook shows of a run, which nobody judged yet."""
    return card(
        _title(run),
        verdict=_ending(run),
        lines=(
            f"{run.totals.distance:.1f} m in {float(run.time[-1]):.2f} s; traces of {len(run.time)} rows: "
            "run.plot(...), run.resampled(every=0.01).",
        ),
        pictures=[_slips(run, None)],
    )


def trial_card(trial: Trial) -> str:
    """Return what a notebook shows of a judged stop."""
    table = trial_table(trial)
    return card(
        table.caption,
        verdict=_ending(trial.run),
        lines=[trial.metrics.brief + "."],
        pictures=[_slips(trial.run, trial.slip_reference)],
        tables=[table_of(table.rows, _PLAIN, notes=table.notes)],
    )


_PLAIN: tuple[Column[tuple[str, ...]], ...] = tuple(
    Column(title=column.title, read=lambda row, place=place: row[place], flush_right=column.flush_right)  # type: ignore[misc]
    for place, column in enumerate(_FIGURES)
)


def metrics_card(figures: Metrics) -> str:
    """Return what a notebook shows of figures alone."""
    return card("Figures of a stop", tables=[table_of(metrics_table(figures).rows, _PLAIN, notes=[_JUDGED])])


def comparison_card(trials: Sequence[Trial]) -> str:
    """Return what a notebook shows of several stops side by side."""
    table = comparison_table(trials)
    if not trials:
        return card(table.caption)
    moving = [trial for trial in trials if trial.run.ending is not Ending.STOPPED]
    drawn = small_picture(
        lambda figure: distance_bars(figure, trials, {}),
        height=0.9 + 0.3 * len(trials),
        alt=distances_alt(trials),
    )
    return card(
        table.caption,
        verdict=("open", f"{len(moving)} of {len(trials)} laws did not stop the train.") if moving else None,
        pictures=[drawn],
        tables=[table_of(trials, _columns(trials), notes=table.notes)],
    )


def traces_card(traces: Traces) -> str:
    """Return what a notebook shows of traces: their columns with units and ranges."""
    columns: tuple[Column[str], ...] = (
        Column(title="column", read=lambda name: name),
        Column(title="unit", read=lambda name: traces.units[name]),
        Column(title="least", read=lambda name: float(traces[name].min())),
        Column(title="largest", read=lambda name: float(traces[name].max())),
    )
    about = ", ".join(f"{key} {value}" for key, value in traces.about.items())
    return card(
        f"Traces of {traces.about['controller']}: {len(traces.table)} rows",
        lines=[about],
        tables=[table_of(traces.units, columns)],
    )


def _slips(run: Run, reference: float | None) -> str:
    return small_picture(
        lambda figure: slip_picture(figure, run, reference),
        height=_PICTURE,
        alt=f"Slip of {run.slip.shape[1]} wheelsets over {float(run.time[-1]):.1f} s, at most {run.slip_max:.3f}.",
    )


def _title(run: Run) -> str:
    return f"{run.controller} on {run.rail}, {run.train}, from {KMH * run.initial_speed:g} km/h"


def _ending(run: Run) -> tuple[str, str]:
    stopped = run.ending is Ending.STOPPED
    said = run.ending.value
    return ("neutral" if stopped else "bad"), f"{said[0].upper()}{said[1:]}."


def _columns(trials: Sequence[Trial]) -> tuple[Column[Trial], ...]:
    return _STOPS if any(map(_remarks, trials)) else _STOPS[:-1]


def _remarks(trial: Trial) -> list[str]:
    """What makes a row less than it seems."""
    return [
        *(["did not stop"] if trial.run.ending is not Ending.STOPPED else []),
        *([f"sensitive, ± {trial.check.spread / 2.0:.2g} m"] if trial.check.sensitive else []),
        *(["steps not resolved"] if trial.check.unresolved else []),
    ]


def _notes(trials: Sequence[Trial]) -> list[str]:
    """Sentences below a table: no ideal stop, brakes that were released, stops that nobody can repeat."""
    ideal = trials[0].metrics.ideal_ending
    named = ", ".join(trial.run.controller for trial in trials if trial.check.sensitive)
    return [
        f"No ideal stop: {NO_IDEAL_STOP[ideal]}." if ideal in NO_IDEAL_STOP else "",
        released_sentence((trial.run.controller, trial.metrics.released_below) for trial in trials),
        f"Sensitive ({named}): a change of the initial speed that nobody can measure moves the distance."
        if named
        else "",
    ]
