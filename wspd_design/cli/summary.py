"""What many stops come to: how their figures spread, and what the step checks of some of them say."""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from wspd_design.simulation.campaign import Campaign
from wspd_design.simulation.self_check import DISTANCE_TOLERANCE, SLIP_TOLERANCE

if TYPE_CHECKING:
    from numpy.typing import NDArray

SUMMARIZED = (
    "distance_m",
    "stopping_time_s",
    "efficiency",
    "slip_rms",
    "lock_time_s",
    "longest_lock_s",
    "valve_switches_per_s",
    "vented_air",
)
"""Columns of the table; of the longest lock, the largest of the axles."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Spread:
    """Quantiles of one figure; NaN when no train stopped or none has the figure."""

    min: float
    p05: float
    median: float
    p95: float
    max: float


@dataclass(frozen=True, slots=True, kw_only=True)
class StepChecks:
    """What half the integration steps changed in the rows that were checked."""

    rows: int
    failed: int  # beyond the tolerances of a single stop
    distance_change: float  # -, largest, relative; NaN without a row
    slip_change: float  # -, largest


@dataclass(frozen=True, slots=True, kw_only=True)
class Summary:
    """A campaign and the spread of its figures over the trains that came to a standstill."""

    campaign: Campaign
    wanted: int  # stops that were asked for
    not_stopped_share: float  # -, of the stops that were simulated
    spreads: dict[str, Spread]  # by the column of the table
    checks: StepChecks


def summarize(campaign: Campaign, *, wanted: int) -> Summary:
    """Work out how the figures of a campaign spread."""
    table = campaign.table
    stopped = table["stopped"]
    return Summary(
        campaign=campaign,
        wanted=wanted,
        not_stopped_share=1.0 - float(stopped.sum()) / len(table) if len(table) else math.nan,
        spreads={name: _spread(campaign.figure(name)[stopped]) for name in SUMMARIZED},
        checks=_checks(table),
    )


def _spread(values: "NDArray[Any]") -> Spread:
    import numpy as np

    known = values[~np.isnan(values)]
    levels = (0.0, 0.05, 0.5, 0.95, 1.0)
    found = np.quantile(known, levels).tolist() if len(known) else [math.nan] * len(levels)
    return Spread(min=found[0], p05=found[1], median=found[2], p95=found[3], max=found[4])


def _checks(table: "NDArray[Any]") -> StepChecks:
    import numpy as np

    distance, slip = table["step_distance_change"], table["step_slip_change"]
    checked = ~np.isnan(distance)
    bad = (distance[checked] > DISTANCE_TOLERANCE) | (slip[checked] > SLIP_TOLERANCE)
    rows = int(checked.sum())
    return StepChecks(
        rows=rows,
        failed=int(bad.sum()),
        distance_change=float(distance[checked].max()) if rows else math.nan,
        slip_change=float(slip[checked].max()) if rows else math.nan,
    )
