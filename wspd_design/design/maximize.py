"""Search for the largest value of a function on a box: it finds counterexamples, it proves nothing."""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import product
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

SOBOL_EXPONENT = 13  # 8192 points that fill the box evenly
STARTS = 16  # best of them, from which a local optimization climbs
DIFFERENCE = 1e-6  # of the width of the box, for slopes


@dataclass(frozen=True, slots=True, kw_only=True)
class Maximum:
    """The largest value found: a lower bound of the supremum."""

    value: float
    point: "Array"
    evaluations: int


def maximize(function: "Callable[[Array], Array]", low: "Array", high: "Array", *, seed: int) -> Maximum:
    """Sample a box evenly, add its corners, and climb from the best points.

    Parameters
    ----------
    function : callable
        Takes an array (points, coordinates) and returns one value per point.
    low, high : ndarray
        Corners of the box; a coordinate may be fixed.
    seed : int
        Of the scrambled Sobol sequence.

    Returns
    -------
    Maximum
        Value, point and effort.
    """
    import numpy as np
    from scipy.optimize import minimize
    from scipy.stats import qmc

    width = high - low
    free = np.flatnonzero(width > 0.0)
    evaluations = 0

    def values(unit: "Array") -> "Array":
        """Function on the free coordinates, each scaled to [0, 1]."""
        nonlocal evaluations
        evaluations += len(unit)
        points = np.tile(low, (len(unit), 1))
        points[:, free] = np.clip(low[free] + unit * width[free], low[free], high[free])
        found: Array = function(points)
        return found

    def descent(unit: "Array") -> tuple[float, "Array"]:
        """Negative value and slope, by differences towards the middle of the box."""
        steps = np.where(unit > 0.5, -DIFFERENCE, DIFFERENCE)
        found = values(np.vstack([unit, unit + np.diag(steps)]))
        return -float(found[0]), -(found[1:] - found[0]) / steps

    if free.size == 0:
        return Maximum(value=float(values(np.zeros((1, 0)))[0]), point=low.copy(), evaluations=evaluations)
    sobol = qmc.Sobol(free.size, rng=np.random.default_rng(seed)).random_base2(SOBOL_EXPONENT)
    corners = np.array(list(product((0.0, 1.0), repeat=free.size)))
    candidates = np.vstack([sobol, corners])
    found = values(candidates)
    best, place = float(found.max()), candidates[found.argmax()]
    for start in candidates[np.argsort(found)[-STARTS:]]:
        climbed = minimize(descent, start, jac=True, method="L-BFGS-B", bounds=[(0.0, 1.0)] * free.size)
        if -climbed.fun > best:
            best, place = -float(climbed.fun), climbed.x
    point = low.copy()
    point[free] = np.clip(low[free] + place * width[free], low[free], high[free])
    return Maximum(value=best, point=point, evaluations=evaluations)
