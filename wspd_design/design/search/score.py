"""From the stops of a law to what a search compares: figures over all sets, objective, missed limits."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from wspd_design.design.criteria import CRITERIA
from wspd_design.design.requirements import Limit

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

WORST_SHARE = 1.0 / 6.0
WORST_WEIGHT = 0.3


@dataclass(frozen=True, slots=True, kw_only=True)
class Score:
    """What a law reached on all sets."""

    objective: float  # -, mean excess of the distance and WORST_WEIGHT times that of the worst sixth
    unstopped: float  # -, share of trains that did not come to a standstill
    reached: Mapping[str, float]  # by criterion; without those that the law has no figure for


def score(figures: "Mapping[str, Array]") -> Score:
    """Work out what a law reached.

    Parameters
    ----------
    figures : mapping
        Columns of a campaign over all sets, and ``excess``, the distance over that of the ideal stop, less 1. Of a
        train that did not stop it is that at the time limit.
    """
    reached = {name: rule.of(figures) for name, rule in CRITERIA.items()}
    return Score(
        objective=objective(figures["excess"]),
        unstopped=1.0 - float(figures["stopped"].mean()),
        reached={
            name: value for name, value in reached.items() if value is not None and math.isfinite(value)
        },
    )


def score_by_rail(figures: "Mapping[str, Array]", rails: Sequence[str]) -> dict[str, Score]:
    """Work out what a law reached on the sets of each rail, of which set k has number k modulo their number."""
    return {
        rail: score({name: values[place :: len(rails)] for name, values in figures.items()})
        for place, rail in enumerate(rails)
        if place < len(figures["excess"])
    }


def objective(excess: "Array") -> float:
    """Return the mean excess of the distance and ``WORST_WEIGHT`` times that of the worst sixth."""
    import numpy as np

    worst = np.sort(excess)[-math.ceil(len(excess) * WORST_SHARE) :]
    return float(excess.mean() + WORST_WEIGHT * worst.mean())


def violation(reached: Score, limits: Sequence[Limit]) -> float:
    """Return by how much limits are missed in sum, each in the scale of its criterion; 0 where all are met."""
    return math.fsum(
        limit.rule.excess(reached.reached.get(limit.criterion, math.nan), limit.value) for limit in limits
    )


def rank(reached: Score, limits: Sequence[Limit], unproved: float = 0.0) -> tuple[float, float, float]:
    """Return the key by which points are compared, the smallest being the best.

    Trains that do not stop come before everything, missed limits and claims that do not hold before the distance. What
    is not a number comes last.

    Parameters
    ----------
    reached : Score
        What the law reached.
    limits : sequence of Limit
        That it must keep.
    unproved : float
        By how much claims about the law fail that must hold [scales].
    """
    key = (reached.unstopped, violation(reached, limits) + unproved, reached.objective)
    return (math.inf, math.inf, math.inf) if any(map(math.isnan, key)) else key


def plain_score(reached: Score) -> dict[str, Any]:
    """Return a score as plain data."""
    return {
        "objective": reached.objective,
        "unstopped": reached.unstopped,
        "reached": dict(reached.reached),
    }
