"""Methods of search: each asks for a generation of points in the unit cube and is told how they rank."""

from collections.abc import Callable, Sequence
from typing import Protocol, TypeAlias

Point: TypeAlias = tuple[float, ...]
"""Shares of the ranges of all variables, each in [0, 1]."""

FIRST_SPREAD = 0.25  # of the ranges: standard deviation of the first generation


class Method(Protocol):
    """A method of search."""

    def ask(self) -> list[Point]:
        """Return the points of the next generation."""

    def tell(self, points: Sequence[Point], order: Sequence[int]) -> None:
        """Take in a generation; ``order`` is the place of each point among them, 0 for the best."""


class CovarianceAdaptation:
    """CMA-ES, which learns from the order of the points alone: rules for limits need no weights."""

    def __init__(self, start: Point, seed: int) -> None:
        import numpy as np
        from cmaes import CMA

        bounds = np.tile([0.0, 1.0], (len(start), 1))
        self._search = CMA(mean=np.array(start), sigma=FIRST_SPREAD, bounds=bounds, seed=seed % 2**32)

    def ask(self) -> list[Point]:
        """Draw a generation from the present distribution."""
        return [
            tuple(float(share) for share in self._search.ask()) for _ in range(self._search.population_size)
        ]

    def tell(self, points: Sequence[Point], order: Sequence[int]) -> None:
        """Move the distribution towards the better half."""
        import numpy as np

        self._search.tell(
            [(np.array(point), float(place)) for point, place in zip(points, order, strict=True)]
        )


class RandomSearch:
    """Even draws from all ranges, the control that any other method has to beat."""

    GENERATION = 8

    def __init__(self, start: Point, seed: int) -> None:
        import numpy as np

        self._dimensions, self._generator = len(start), np.random.default_rng(seed)

    def ask(self) -> list[Point]:
        """Draw some points."""
        drawn = self._generator.random((self.GENERATION, self._dimensions))
        return [tuple(map(float, row)) for row in drawn]

    def tell(self, points: Sequence[Point], order: Sequence[int]) -> None:
        """Learn nothing."""


METHODS: dict[str, Callable[[Point, int], Method]] = {"cma": CovarianceAdaptation, "random": RandomSearch}
"""By name: what begins a search at a point with a seed."""
