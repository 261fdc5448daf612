"""The figures of a stop whose spread is told, and how to work them out for many stops side by side."""

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeAlias

from wspd_design.controllers.protocol import Law
from wspd_design.simulation.batch import STOPS_SIDE_BY_SIDE, Cases
from wspd_design.simulation.campaign_rows import figures_of, ideal_distances
from wspd_design.simulation.comparison import Trial
from wspd_design.simulation.runs import Ending

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class KeyFigure:
    """One figure of a stop, in a campaign and alone."""

    name: str
    title: str
    short: str
    unit: str
    column: str  # of a campaign; where there is one for each axle, the largest of them counts
    alone: Callable[[Trial], float]
    at_rest: float | None = (
        None  # what counts for a train that does not come to a standstill; None: the figure itself
    )
    least_is_worst: bool = False


KEY_FIGURES: dict[str, KeyFigure] = {
    each.name: each
    for each in (
        KeyFigure(
            name="distance",
            title="stopping distance",
            short="distance",
            unit="m",
            column="distance_m",
            alone=lambda made: made.metrics.distance,
            at_rest=math.inf,
        ),
        KeyFigure(
            name="time",
            title="stopping time",
            short="time",
            unit="s",
            column="stopping_time_s",
            alone=lambda made: made.metrics.stopping_time,
            at_rest=math.inf,
        ),
        KeyFigure(
            name="efficiency",
            title="efficiency",
            short="efficiency",
            unit="-",
            column="efficiency",
            alone=lambda made: made.metrics.efficiency,
            at_rest=0.0,
            least_is_worst=True,
        ),
        KeyFigure(
            name="slip_rms",
            title="slip rms, the build-up included",
            short="slip rms, build-up incl.",
            unit="-",
            column="slip_rms",
            alone=lambda made: made.metrics.slip_rms,
        ),
        KeyFigure(
            name="slip_max",
            title="largest slip above 10 km/h",
            short="largest slip",
            unit="-",
            column="slip_max",
            alone=lambda made: made.metrics.slip_max,
        ),
        KeyFigure(
            name="longest_lock",
            title="longest lock above 10 km/h",
            short="lock",
            unit="s",
            column="longest_lock_s",
            alone=lambda made: made.metrics.judged_lock,
        ),
        KeyFigure(
            name="speed_error",
            title="error of the train speed",
            short="speed error",
            unit="-",
            column="speed_error",
            alone=lambda made: made.metrics.speed_error,
        ),
        KeyFigure(
            name="vented_air",
            title="air vented per wheelset",
            short="air",
            unit="cylinders",
            column="vented_air",
            alone=lambda made: made.metrics.vented_air,
        ),
    )
}
"""In the order of tables."""

Outcome: TypeAlias = tuple[tuple[str, float], ...]
"""The key figures that a stop has, by their names [SI units]; a train that does not stop has no finite distance."""


def outcome_of(made: Trial) -> Outcome:
    """Return the key figures of a stop that was simulated alone."""
    stopped = made.run.ending is Ending.STOPPED
    values = ((name, _counted(rule, rule.alone(made), stopped)) for name, rule in KEY_FIGURES.items())
    return tuple((name, value) for name, value in values if not math.isnan(value))


def key_figures(columns: Mapping[str, Any]) -> "dict[str, Array]":
    """Return the key figures of the stops of a campaign; those that no stop has are left out."""
    import numpy as np

    found = {}
    for name, rule in KEY_FIGURES.items():
        chosen = [key for key in columns if key == rule.column or _is_of_axle(key, rule.column)]
        if not chosen:
            continue
        values = np.fmax.reduce([columns[key] for key in chosen], axis=0)
        if rule.at_rest is not None:
            values = np.where(columns["stopped"], values, rule.at_rest)
        if not np.isnan(values).all():
            found[name] = values
    return found


def outcomes(cases: Cases, law: Law, pool: Executor) -> list[Outcome]:
    """Simulate stops of vehicles of one kind, side by side, and return the key figures of each."""
    side = STOPS_SIDE_BY_SIDE
    filled = [*cases, *([cases[-1]] * (-len(cases) % side))]
    groups = [filled[first : first + side] for first in range(0, len(filled), side)]
    columns = list(pool.map(lambda group: _columns(group, law), groups))
    return [each for group in columns for each in _rows(group, side)][: len(cases)]


def _columns(cases: Sequence[Any], law: Law) -> "dict[str, Array]":
    what = "a stop with other numbers"
    return key_figures(figures_of(cases, law, ideal_distances(cases, what), what))


def _rows(columns: "Mapping[str, Array]", count: int) -> Iterable[Outcome]:
    for row in range(count):
        values = ((name, float(column[row])) for name, column in columns.items())
        yield tuple((name, value) for name, value in values if not math.isnan(value))


def _counted(rule: KeyFigure, value: float, stopped: bool) -> float:
    return value if stopped or rule.at_rest is None else rule.at_rest


def _is_of_axle(name: str, column: str) -> bool:
    return name.startswith(f"{column}_") and name.removeprefix(f"{column}_").isdigit()
