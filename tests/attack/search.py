"""Look for the least margin of a claim over a box: corners, low-discrepancy points, differential evolution."""

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from itertools import count, product
from typing import Any

import numpy as np

Points = Mapping[str, Any]
Margin = Callable[[Points], Any]

SHARE = 4  # of the evaluations: one part each for corners and scattered points, the rest for the evolution
POPULATION = 40
BATCH = 4096
LEAST = 32  # points, however expensive they are
MOST_AT_ONCE = 4096  # corners or scattered points between two evolutions


@dataclass(frozen=True, slots=True, kw_only=True)
class Attack:
    """A statement to be violated: its margin at points, negative where the statement fails."""

    check: str  # certificate that makes it
    statement: str
    box: Mapping[str, tuple[float, float]]
    margin: Margin
    unit: str = "-"
    cost: int = 1  # evaluations that one point counts for
    slack: float = 0.0  # margin down to which the attacker's own errors reach


@dataclass(slots=True, kw_only=True)
class Found:
    """The least margin and where it was found."""

    attack: Attack
    evaluations: int = 0
    margin: float = np.inf
    point: dict[str, float] = field(default_factory=dict)

    @property
    def broken(self) -> bool:
        """Whether the statement was violated."""
        return self.margin < -self.attack.slack


class Exhausted(Exception):
    """The evaluations or the time are used up."""


def assail(
    attack: Attack, *, evaluations: int, seed: int = 0, deadline: float = np.inf, stop: bool = False
) -> Found:
    """Attack a statement.

    Parameters
    ----------
    attack : Attack
        What to violate.
    evaluations : int
        Points that may be tried, divided by the cost of one; this alone decides about the result.
    seed : int
        Of the draws.
    deadline : float
        CPU time at which to give up [s], for long runs.
    stop : bool
        Stop at the first violation.
    """
    from scipy.optimize import differential_evolution

    budget = max(evaluations // attack.cost, LEAST)
    names = list(attack.box)
    low, high = (np.array([attack.box[name][k] for name in names], float) for k in (0, 1))
    found, rng = Found(attack=attack), np.random.default_rng(seed)

    def tried(points: Any) -> Any:
        """Return the margins of points, one per column; those that say nothing have none."""
        points = points[:, : max(budget - found.evaluations, 0)]
        if points.shape[1] == 0 or time.process_time() > deadline or (stop and found.broken):
            raise Exhausted
        with np.errstate(all="ignore"):
            margins = np.broadcast_to(
                np.asarray(attack.margin(dict(zip(names, points, strict=True))), float), points.shape[1:]
            )
        found.evaluations += points.shape[1]
        margins = np.where(np.isnan(margins), np.inf, margins)
        best = int(np.argmin(margins))
        if margins[best] < found.margin:
            found.margin = float(margins[best])
            found.point = {name: float(points[k, best]) for k, name in enumerate(names)}
        return margins

    def scaled(unit: Any) -> Any:
        return low[:, None] + (high - low)[:, None] * unit

    def for_evolution(unit: Any) -> Any:
        columns = unit if unit.ndim == 2 else unit[:, None]
        margins = tried(scaled(columns))
        filled = np.full(columns.shape[1], np.inf)
        filled[: len(margins)] = margins
        return np.where(np.isinf(filled), 1e30, filled)

    part = min(budget // SHARE, MOST_AT_ONCE)
    try:
        for turn in count():
            best: list[tuple[float, Any]] = []  # of the first points: where the evolution starts
            for points in (_corners(len(names), part, rng), _scattered(len(names), part, seed + 1000 * turn)):
                for chunk in _chunks(points):
                    margins = tried(scaled(chunk))
                    order = np.argsort(margins, kind="stable")[: POPULATION // 2]
                    best += [(margins[k], chunk[:, k]) for k in order]
            best.sort(key=lambda each: each[0])
            elite = np.array([point for _, point in best[: POPULATION // 2]]).reshape(-1, len(names))
            others = rng.random((POPULATION - len(elite), len(names)))
            differential_evolution(
                for_evolution,
                [(0.0, 1.0)] * len(names),
                vectorized=True,
                updating="deferred",
                maxiter=200,
                tol=1e-8,
                polish=False,
                init=np.concatenate([elite, others]),
                rng=rng,
            )
    except Exhausted:
        pass
    return found


def _scattered(dimension: int, most: int, seed: int) -> Any:
    """Sobol's points in the unit box; columns."""
    from scipy.stats import qmc

    return qmc.Sobol(dimension, seed=seed).random_base2(max(most - 1, 1).bit_length())[:most].T


def _corners(dimension: int, most: int, rng: Any) -> Any:
    """Corners of the unit box, all of them if they are few; columns."""
    if 2**dimension <= most:
        return np.array(list(product((0.0, 1.0), repeat=dimension))).T
    return rng.integers(0, 2, (dimension, max(most, 1))).astype(float)


def _chunks(points: Any) -> list[Any]:
    return [points[:, k : k + BATCH] for k in range(0, points.shape[1], BATCH)]
