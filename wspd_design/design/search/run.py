"""One search: a method, generations of points, their scores on the same sets, and the best point that holds."""

import math
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeAlias

from wspd_design.design.requirements import Limit
from wspd_design.design.search.evaluation import evaluate
from wspd_design.design.search.journal import Journal
from wspd_design.design.search.methods import METHODS, Point
from wspd_design.design.search.score import Score, rank, score
from wspd_design.design.search.sets import Sets
from wspd_design.design.search.variables import Variable
from wspd_design.parameters.errors import UserError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from wspd_design.controllers.protocol import Law

    Array = NDArray[np.float64]

Claim: TypeAlias = "Callable[[Law], float]"
"""By how much a claim about a law fails that must hold at every point, in scales; 0 where it holds."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Evaluation:
    """One point that was tried."""

    point: Point
    values: tuple[float, ...]  # of the variables
    score: Score
    unproved: float  # scales, by which claims fail; they are asked of points alone that keep all limits


@dataclass(frozen=True, slots=True, kw_only=True)
class Space:
    """What is searched: the numbers that vary, and how a law is built from them."""

    law: str  # its name, in sentences
    variables: tuple[Variable, ...]
    build: "Callable[[tuple[float, ...]], Law]"

    def law_at(self, point: Point) -> "Law":
        """Return the law at a point."""
        return self.build(self.values(point))

    def values(self, point: Point) -> tuple[float, ...]:
        """Return the values of the variables at a point."""
        return tuple(each.value(share) for each, share in zip(self.variables, point, strict=True))

    @property
    def start(self) -> Point:
        """Point that the search starts from."""
        return tuple(each.share(each.start) for each in self.variables)


@dataclass(frozen=True, slots=True, kw_only=True)
class Aim:
    """What counts as better."""

    limits: tuple[Limit, ...]
    claims: tuple[Claim, ...] = ()

    def rank(self, tried: Evaluation) -> tuple[float, float, float]:
        """Return the key of a point, the smallest being the best."""
        return rank(tried.score, self.limits, tried.unproved)

    def holds(self, tried: Evaluation) -> bool:
        """Tell whether a point stops every train, meets all limits and has all claims."""
        return self.rank(tried)[:2] == (0.0, 0.0)

    def unproved(self, law: "Law", reached: Score) -> float:
        """Return by how much claims fail about a law that keeps all limits [scales]."""
        if not self.claims or rank(reached, self.limits)[:2] != (0.0, 0.0):
            return 0.0
        return sum(claim(law) for claim in self.claims)


def search(
    space: Space,
    aim: Aim,
    sets: Sets,
    *,
    method: str,
    evaluations: int,
    seed: int,
    journal: Journal,
    pool: Executor,
    progress: Callable[[int], object] = abs,
) -> list[Evaluation]:
    """Try points; the first is the start.

    The result depends on neither the number of threads nor the order in which they finish: a method is told whole
    generations.

    Parameters
    ----------
    space : Space
        What is searched.
    aim : Aim
        What counts as better.
    sets : Sets
        Stops that every point is judged by.
    method : {"cma", "random"}
        Of the search.
    evaluations : int
        Points in all.
    seed : int
        Of the method.
    journal : Journal
        Points that were evaluated before, and the place for new ones. An interrupt leaves the finished ones there.
    pool : Executor
        Threads.
    progress : callable
        Told the number of points that are done.

    Returns
    -------
    list of Evaluation
        In the order in which they were asked for.
    """
    if len(space.variables) < 2 and method == "cma":
        raise UserError(
            f'method "cma" needs two or more variables, and {space.law} has {len(space.variables)}; '
            'write method = "random"'
        )
    tried = _tried(space, aim, sets, [space.start], journal, pool, lambda: progress(1))
    searcher = METHODS[method](space.start, seed)
    while len(tried) < evaluations:
        points = searcher.ask()
        wanted = points[: evaluations - len(tried)]
        done = len(tried)

        def tell() -> None:
            nonlocal done
            done += 1
            progress(done)

        found = _tried(space, aim, sets, wanted, journal, pool, tell)
        tried += found
        if len(wanted) == len(points):
            searcher.tell(points, _order([aim.rank(each) for each in found]))
    return tried


def _tried(
    space: Space,
    aim: Aim,
    sets: Sets,
    points: Sequence[Point],
    journal: Journal,
    pool: Executor,
    tell: Callable[[], object],
) -> list[Evaluation]:
    """Evaluate points that are not in the journal, all at once."""
    laws = [space.law_at(point) for point in points]
    missing = [k for k, point in enumerate(points) if journal.known(point) is None]
    scores = {k: known for k, point in enumerate(points) if (known := journal.known(point)) is not None}
    for _ in scores:
        tell()
    found = evaluate([laws[k] for k in missing], sets, pool)
    for k, figures in zip(missing, found, strict=True):
        scores[k] = score(figures)
        journal.add(points[k], scores[k])
        tell()
    unproved = pool.map(aim.unproved, laws, [scores[k] for k in range(len(points))])
    return [
        Evaluation(point=point, values=space.values(point), score=scores[k], unproved=missed)
        for k, (point, missed) in enumerate(zip(points, unproved, strict=True))
    ]


def _order(keys: Sequence[tuple[float, float, float]]) -> list[int]:
    """Return the place of each key among all; equal ones keep their order."""
    by_rank = sorted(range(len(keys)), key=lambda k: keys[k])
    return [by_rank.index(k) for k in range(len(keys))]


def ranked(tried: Sequence[Evaluation], aim: Aim) -> list[Evaluation]:
    """Return the points in their order, the best first."""
    return sorted(tried, key=aim.rank)


def front(tried: Sequence[Evaluation]) -> list[Evaluation]:
    """Return the points that no other one beats in objective, switches and air at once, by their objective.

    Points at which a train does not stop, or that gave what is not a number, are left out.
    """
    moving = [each for each in tried if each.score.unstopped == 0.0 and math.isfinite(each.score.objective)]
    return sorted(
        (each for each in moving if not any(_beats(other, each) for other in moving)),
        key=lambda each: each.score.objective,
    )


def _costs(tried: Evaluation) -> tuple[float, float, float]:
    reached: Mapping[str, Any] = tried.score.reached
    return tried.score.objective, reached["valve_switches"], reached["vented_air"]


def _beats(one: Evaluation, other: Evaluation) -> bool:
    first, second = _costs(one), _costs(other)
    return first != second and all(a <= b for a, b in zip(first, second, strict=True))
