"""What a protection is judged by over many stops: one number for each criterion, and which way is better."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

from wspd_design.parameters.units import Dimension

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

RESERVE = 0.5  # scales

FiguresOfStops: TypeAlias = "Mapping[str, Array]"
"""Columns of a campaign by their names, one value for each stop."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Criterion:
    """One number over many stops."""

    name: str
    title: str
    dimension: Dimension
    figure: str  # column of a campaign; where there is one for each axle, the largest of them counts
    over_stops: "Callable[[Array], float]"
    at_least: bool = False  # a limit is the least allowed, not the largest
    scale: float  # SI, difference that counts as one when a limit is missed
    may_lack: bool = False  # a stop need not have the figure, and those without it do not count
    of_report: bool = False  # known of the stop of a report alone, not of campaigns
    unit: str = "-"  # in which people tell it
    alone: str = ""  # title in a single stop, where it is another one

    def title_of(self, *, one_stop: bool) -> str:
        """Return the title over many stops, or in a single one."""
        return self.alone if one_stop and self.alone else self.title

    def of(self, figures: FiguresOfStops) -> float | None:
        """Return the number over the stops; None for stops that have no such figure.

        A train that does not come to a standstill has no efficiency, which counts as 0.
        """
        import numpy as np

        names = [name for name in figures if name == self.figure or _is_of_axle(name, self.figure)]
        if not names:
            return None
        values = np.fmax.reduce([figures[name] for name in names], axis=0)
        if self.at_least:
            values = np.where(figures["stopped"], values, 0.0)
        if self.may_lack:
            values = values[~np.isnan(values)]
        return float(self.over_stops(values)) if len(values) else None

    def excess(self, reached: float, limit: float) -> float:
        """Return by how much a limit is missed, in scales; 0 where it is met and infinite where nothing was reached."""
        missed = (limit - reached if self.at_least else reached - limit) / self.scale
        return max(missed, 0.0) if missed == missed else float("inf")

    def with_reserve(self, limit: float) -> float:
        """Return the limit that a search keeps so that other stops keep this one: tighter by half a scale."""
        if self.at_least:
            return limit + RESERVE * self.scale
        return max(limit - RESERVE * self.scale, 0.0)


def _is_of_axle(name: str, figure: str) -> bool:
    return name.startswith(f"{figure}_") and name.removeprefix(f"{figure}_").isdigit()


def _mean(values: "Array") -> float:
    return float(values.mean())


def _largest(values: "Array") -> float:
    return float(values.max())


def _smallest(values: "Array") -> float:
    return float(values.min())


def _quantile(share: float) -> "Callable[[Array], float]":
    def quantile(values: "Array") -> float:
        import numpy as np

        return float(np.quantile(values, share))

    return quantile


CRITERIA: dict[str, Criterion] = {
    each.name: each
    for each in (
        Criterion(
            name="efficiency_mean",
            title="mean efficiency",
            dimension="ratio",
            figure="efficiency",
            over_stops=_mean,
            at_least=True,
            scale=0.01,
            unit="%",
        ),
        Criterion(
            name="efficiency_p05",
            title="efficiency, 5th percentile",
            dimension="ratio",
            figure="efficiency",
            over_stops=_quantile(0.05),
            at_least=True,
            scale=0.01,
            unit="%",
        ),
        Criterion(
            name="efficiency_worst",
            title="efficiency, worst stop",
            dimension="ratio",
            figure="efficiency",
            over_stops=_smallest,
            at_least=True,
            scale=0.01,
            unit="%",
            alone="efficiency",
        ),
        Criterion(
            name="stopping_distance",
            title="longest stopping distance",
            dimension="length",
            figure="distance_m",
            over_stops=_largest,
            scale=10.0,
            unit="m",
            alone="stopping distance",
        ),
        Criterion(
            name="longest_lock",
            title="longest lock above 10 km/h",
            dimension="time",
            figure="longest_lock_s",
            over_stops=_largest,
            scale=0.1,
            unit="s",
        ),
        Criterion(
            name="valve_switches",
            title="valve switches per second and axle, mean",
            dimension="rate",
            figure="valve_switches_per_s",
            over_stops=_mean,
            scale=1.0,
            unit="1/s",
            alone="valve switches per second and axle",
        ),
        Criterion(
            name="vented_air",
            title="brake cylinders vented per axle and stop, mean",
            dimension="ratio",
            figure="vented_air",
            over_stops=_mean,
            scale=1.0,
            alone="brake cylinders vented per axle",
        ),
        Criterion(
            name="slip_band",
            title="largest distance of the slip from its reference",
            dimension="ratio",
            figure="slip_band",
            over_stops=_largest,
            may_lack=True,  # of wheels that never reach their reference
            scale=0.01,
        ),
        Criterion(
            name="speed_error_p95",
            title="error of the train speed, 95th percentile",
            dimension="ratio",
            figure="speed_error",
            over_stops=_quantile(0.95),
            scale=0.01,
            unit="%",
        ),
        Criterion(
            name="speed_error",
            title="error of the train speed, largest",
            dimension="ratio",
            figure="speed_error",
            over_stops=_largest,
            scale=0.01,
            unit="%",
        ),
        Criterion(
            name="distance_error",
            title="error of the distance over 5 m + 5 %, largest",
            dimension="ratio",
            figure="distance_error",
            over_stops=_largest,
            scale=0.1,
        ),
        Criterion(
            name="slip_rms",
            title="slip off its reference, rms",
            dimension="ratio",
            figure="held_slip_rms",
            over_stops=_largest,
            of_report=True,
            scale=0.01,
        ),
        Criterion(
            name="slip_overshoot",
            title="overshoot of the slip",
            dimension="ratio",
            figure="slip_overshoot",
            over_stops=_largest,
            of_report=True,
            scale=0.01,
        ),
        Criterion(
            name="slip_undershoot",
            title="undershoot of the slip",
            dimension="ratio",
            figure="slip_undershoot",
            over_stops=_largest,
            of_report=True,
            scale=0.01,
        ),
        Criterion(
            name="adhesion_used",
            title="adhesion used over the whole stop",
            dimension="ratio",
            figure="adhesion_utilization",
            over_stops=_smallest,
            at_least=True,
            of_report=True,
            scale=0.01,
            unit="%",
        ),
        Criterion(
            name="extension",
            title="longer than the stop on full adhesion",
            dimension="ratio",
            figure="extension",
            over_stops=_largest,
            of_report=True,
            scale=0.01,
            unit="%",
        ),
        Criterion(
            name="longest_release",
            title="longest time that a wheelset hardly brakes",
            dimension="time",
            figure="longest_release_s",
            over_stops=_largest,
            of_report=True,
            scale=1.0,
            unit="s",
        ),
    )
}
"""In the order of tables. Vehicle and rails say how far each limit can be met."""
