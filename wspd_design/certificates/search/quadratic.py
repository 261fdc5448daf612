"""Search for a common quadratic Lyapunov function in doubles; nothing here is trusted."""

import warnings
from collections.abc import Callable
from fractions import Fraction
from typing import TYPE_CHECKING

from wspd_design.certificates.kernel.arb import point
from wspd_design.certificates.theorems.quadratic import (
    Interval,
    Loop,
    Matrix,
    Quadratic,
    Symmetric,
    held,
    rates,
)

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

GRID = 17  # values of q between the ends of its interval
KEPT = 0.9  # of the decay that the search sees is what shall be shown
DENOMINATOR = 10**9
HALVINGS = 6  # of the interval of the decay
LEAST_FALL = 1e-3


class NotFound(ValueError):
    """The search found no function; there may be one all the same."""


def search(loop: Loop, poles: Interval) -> Quadratic:
    """Find P for the continuous and for the sampled loop, and how fast V falls.

    Parameters
    ----------
    loop : Loop
        Numbers of the loop.
    poles : tuple of Fraction
        Ends of the interval of q [1/s].

    Raises
    ------
    NotFound
        If the linear matrix inequality has no solution on a grid, or the packages that solve it are missing.
    """
    import numpy as np

    grid = [float(poles[0]) + (float(poles[1]) - float(poles[0])) * k / (GRID - 1) for k in range(GRID)]
    gammas = [float(each) for each in loop.gamma]
    corners = [_floats(rates(loop, q, g)) for q in (grid[0], grid[-1]) for g in gammas]
    steps = [_floats(held(loop, point(q), point(g))) for q in grid for g in gammas]
    # Both coordinates in units in which they act on each other alike.
    unit = np.sqrt(abs(corners[0][1, 0] / corners[0][0, 1]))
    scale = np.diag([unit, 1.0])
    corners, steps = ([scale @ a @ np.linalg.inv(scale) for a in each] for each in (corners, steps))
    continuous, decay = _fastest(
        lambda rate: [a + rate * np.eye(2) for a in corners], _decay(corners), discrete=False
    )
    sampled, loss = _fastest(lambda rate: [a / (1.0 - rate) for a in steps], _loss(steps), discrete=True)
    return Quadratic(
        poles=poles,
        continuous=_rational(scale @ continuous @ scale),
        decay=_short(KEPT * decay),
        sampled=_rational(scale @ sampled @ scale),
        contraction=_short(1.0 - KEPT * loss),
    )


def _fastest(
    family: Callable[[float], list["Array"]], limit: float, *, discrete: bool
) -> tuple["Array", float]:
    """Halve the interval of the decay until the P that shows nearly the fastest one is found."""
    found = _solve(family(0.0), discrete=discrete)
    if found is None:
        kind = "sampled" if discrete else "continuous"
        raise NotFound(f"no quadratic function was found that falls everywhere along the {kind} loop")
    slow, fast = 0.0, limit
    for _ in range(HALVINGS):
        middle = 0.5 * (slow + fast)
        better = _solve(family(middle), discrete=discrete)
        if better is None:
            fast = middle
        else:
            slow, found = middle, better
    return found, slow


def _solve(matrices: list["Array"], *, discrete: bool) -> "Array | None":
    """Solve the linear matrix inequality for the P with the smallest largest eigenvalue."""
    import numpy as np

    try:
        import cvxpy as cp

        p = cp.Variable((2, 2), symmetric=True)
        falls = [p - a.T @ p @ a if discrete else -(a.T @ p + p @ a) for a in matrices]
        wanted = [p >> np.eye(2), *(each >> LEAST_FALL * np.eye(2) for each in falls)]
        problem = cp.Problem(cp.Minimize(cp.lambda_max(p)), wanted)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # an inaccurate solution is as good as any: it is checked exactly
            problem.solve(solver=cp.CLARABEL)
    except ImportError as error:
        raise NotFound(
            f"the package {error.name} is missing, which solves linear matrix inequalities"
        ) from None
    except cp.error.SolverError:
        return None
    if problem.status not in (cp.OPTIMAL, cp.OPTIMAL_INACCURATE):
        return None
    found: Array = p.value / np.abs(p.value).max()
    return found


def _decay(matrices: list["Array"]) -> float:
    """Slowest decay of the frozen loops, which no function can beat [1/s]."""
    import numpy as np

    return max(0.0, min(float(-np.linalg.eigvals(a).real.max()) for a in matrices))


def _loss(matrices: list["Array"]) -> float:
    """Smallest loss per sample of the frozen loops."""
    import numpy as np

    return max(0.0, 1.0 - max(float(np.abs(np.linalg.eigvals(a)).max()) for a in matrices))


def _floats(a: Matrix) -> "Array":
    import numpy as np

    return np.array([[float(each) for each in row] for row in a])


def _rational(p: "Array") -> Symmetric:
    return tuple(Fraction(float(each)).limit_denominator(DENOMINATOR) for each in (p[0, 0], p[0, 1], p[1, 1]))  # type: ignore[return-value]


def _short(number: float) -> Fraction:
    return Fraction(number).limit_denominator(10**6)
