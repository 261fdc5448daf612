"""Table 10 of the paper beside our stops: deviations, brake build-up, and the momentum balance behind it."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from wspd_design.parameters.records import Vehicle
from wspd_design.simulation.comparison import Trial
from wspd_design.simulation.metrics import Metrics
from wspd_design.studies.paper.published import PublishedStop


@dataclass(frozen=True, slots=True, kw_only=True)
class Table10Row:
    """One stop of Table 10 and ours."""

    published: PublishedStop
    metrics: Metrics
    spread: float  # m, of our distance; 0 unless the closed loop is sensitive
    momentum: float  # N m s, what the momentum balance leaves for the torque integral of our stop

    @property
    def deviations(self) -> tuple[float, float, float]:
        """Relative deviation of distance, time and torque integral from the paper [-]."""
        ours, theirs = self.metrics, self.published
        return (
            ours.distance / theirs.distance_m - 1.0,
            ours.stopping_time / theirs.stopping_time_s - 1.0,
            ours.torque_integral / (1e3 * theirs.torque_integral_kNms) - 1.0,
        )


def table10_rows(
    published: Sequence[PublishedStop], trials: Mapping[tuple[str, str], Trial], vehicle: Vehicle
) -> tuple[Table10Row, ...]:
    """Put our stops, by controller and rail, beside those of the paper."""
    return tuple(
        Table10Row(
            published=each,
            metrics=ours.metrics,
            spread=ours.check.spread,
            momentum=momentum_balance(ours, vehicle),
        )
        for each in published
        for ours in (trials[each.controller, each.rail],)
    )


def momentum_balance(trial: Trial, vehicle: Vehicle) -> float:
    """Torque integral that follows from the initial momentum and the resistance alone [N m s].

    sum int T dt = R m v0 + sum J omega0 - R int f_d dt - sum int B omega dt: no controller appears in it.
    """
    run, radius = trial.run, vehicle.wheel_radius
    turning = vehicle.wheelsets * vehicle.wheelset_inertia * run.initial_speed / radius
    lost = radius * run.totals.resistance_impulse + run.totals.damping_impulse
    return radius * vehicle.mass * run.initial_speed + turning - lost


def root_mean_square(rows: Sequence[Table10Row]) -> float:
    """Root mean square of all deviations [-]."""
    deviations = [each for row in rows for each in row.deviations]
    return math.sqrt(sum(each * each for each in deviations) / len(deviations))


def largest(rows: Sequence[Table10Row]) -> float:
    """Largest magnitude of all deviations [-]."""
    return max(abs(each) for row in rows for each in row.deviations)


def relative_range(values: Sequence[float]) -> float:
    """Range of values over their mean [-]."""
    return (max(values) - min(values)) * len(values) / sum(values)
