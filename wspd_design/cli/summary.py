"""What many stops come to: how their figures spread."""

import math
from dataclasses import dataclass

from wspd_design.simulation.campaign import Campaign

SUMMARIZED = ("distance_m", "stopping_time_s", "lock_time_s")


@dataclass(frozen=True, slots=True, kw_only=True)
class Spread:
    """Quantiles of one figure; NaN when no train stopped."""

    min: float
    p05: float
    median: float
    p95: float
    max: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Summary:
    """A campaign and the spread of its figures over the trains that came to a standstill."""

    campaign: Campaign
    wanted: int  # stops that were asked for
    not_stopped_share: float  # -, of the stops that were simulated
    spreads: dict[str, Spread]  # by the column of the table


def summarize(campaign: Campaign, *, wanted: int) -> Summary:
    """Work out how the figures of a campaign spread."""
    import numpy as np

    stopped = campaign.table[campaign.table["stopped"]]
    levels = (0.0, 0.05, 0.5, 0.95, 1.0)

    def spread(name: str) -> Spread:
        found = np.quantile(stopped[name], levels).tolist() if len(stopped) else [math.nan] * len(levels)
        return Spread(min=found[0], p05=found[1], median=found[2], p95=found[3], max=found[4])

    count = len(campaign.table)
    return Summary(
        campaign=campaign,
        wanted=wanted,
        not_stopped_share=1.0 - len(stopped) / count if count else math.nan,
        spreads={name: spread(name) for name in SUMMARIZED},
    )
