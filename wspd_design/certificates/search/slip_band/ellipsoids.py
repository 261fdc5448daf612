"""Search for the ellipsoid of one cell and one window, in doubles; the checker decides about it."""

from collections.abc import Sequence
from fractions import Fraction
from typing import TYPE_CHECKING

from wspd_design.certificates.kernel.checker import Refused
from wspd_design.certificates.search.common_quadratic import unit_matrices
from wspd_design.certificates.search.matrix_inequalities import Inequalities
from wspd_design.certificates.setting.slip_loop import DISTURBANCES, STATES, corners
from wspd_design.certificates.theorems.slip_band.checker import largest_error
from wspd_design.certificates.theorems.slip_band.loop import Loop, loop_law
from wspd_design.certificates.theorems.slip_band.proof import Ellipsoid
from wspd_design.certificates.theorems.slip_band.statement import BandLaw

if TYPE_CHECKING:
    from wspd_design.certificates.search.matrix_inequalities import Array

KEPT = (0.96, 0.98)  # of the function after a sample without disturbance; the first that succeeds
FIRST_CORNERS, MORE_CORNERS, ROUNDS = 8, 12, 6  # of the loop that the inequalities begin with, and are added
UNIT = 0.05  # rad/s, in which states are counted, so that the numbers of the inequalities are near 1
SLACK = 1e-3  # what the inequalities ask beyond what is to be shown, so that rounding does not spoil it
LEAST_DISTURBANCE = 0.01  # of the tightest limit of the state, that the inequalities reckon with
DIGITS = 9  # of the numbers in the proof


def ellipsoid(law: BandLaw, loop: Loop, faster: Ellipsoid | None) -> Ellipsoid | None:
    """Find an ellipsoid with a small band around that of the next faster window, or none.

    Parameters
    ----------
    law : BandLaw
        Numbers of the law.
    loop : Loop
        Numbers of cell and window.
    faster : Ellipsoid or None
        Of the next faster window.
    """
    import numpy as np

    if not all(each.bound > 0 for each in loop.limits):
        return None
    bounds = np.array([float(each.mid()) for each in loop.disturbances])
    used = [k for k, bound in enumerate(bounds) if bound > 0.0]
    room = min(float(each.bound.mid()) for each in loop.limits)
    # Ellipsoids far smaller than the room are hard to find, and nobody needs them.
    bounds = np.where(bounds > 0.0, np.maximum(bounds, LEAST_DISTURBANCE * room), 0.0)
    maps = np.array([_doubles(each) for each in corners(loop_law(law), loop.ranges)])
    maps = np.concatenate(
        [maps[:, :, :STATES], maps[:, :, STATES:][:, :, used] * bounds[used] / UNIT], axis=2
    )
    inner = None if faster is None else np.array(faster.matrix, dtype=float) * UNIT**2
    for kept in KEPT:
        found = _solve(loop, maps, used, kept, inner)
        if found is None:
            continue
        try:
            largest_error(law, loop, found)
        except Refused:
            continue
        return found
    return None


def _solve(
    loop: Loop, maps: "Array", used: Sequence[int], kept: float, inner: "Array | None"
) -> Ellipsoid | None:
    """Solve for some corners, and add those that are not met."""
    import numpy as np

    chosen = list(range(0, len(maps), max(1, len(maps) // FIRST_CORNERS)))
    for _ in range(ROUNDS):
        solved = _inequalities(loop, maps[chosen], len(used), kept, inner)
        if solved is None:
            return None
        p, shares = solved
        left = np.array([np.linalg.eigvalsh(_left(p, shares, kept, each))[0] for each in maps])
        worst = [int(k) for k in np.argsort(left)[:MORE_CORNERS] if left[k] < 0.0 and int(k) not in chosen]
        if not worst:
            return _rounded(p, shares, used, kept)
        chosen += worst
    return None


def _inequalities(
    loop: Loop, maps: "Array", disturbances: int, kept: float, inner: "Array | None"
) -> "tuple[Array, Array] | None":
    """Minimize the largest error over P and the shares of the disturbances."""
    import numpy as np

    units = unit_matrices(STATES)
    band, size = len(units) + disturbances, STATES + disturbances
    asked = Inequalities(band + 1)
    for each in maps:
        parts = [
            (k, _padded(kept * (1.0 - SLACK) * unit, size) - each.T @ unit @ each)
            for k, unit in enumerate(units)
        ]
        for k in range(disturbances):
            share = np.zeros((size, size))
            share[STATES + k, STATES + k] = 1.0 - SLACK
            parts.append((len(units) + k, share))
        asked.semidefinite(np.zeros((size, size)), parts)
    total = np.zeros((1, band + 1))
    total[0, len(units) : band] = 1.0
    asked.at_most(total, np.array([1.0 - kept - 1e-9]))
    largest = np.zeros((STATES + 1, STATES + 1))
    largest[STATES, STATES] = 1.0
    blocks = [(k, _padded(unit, STATES + 1)) for k, unit in enumerate(units)]
    asked.semidefinite(_edge([1.0, 0.0, 0.0, 0.0], 0.0), [*blocks, (band, largest)])
    for limit in loop.limits:
        bound = float(limit.bound.mid()) / UNIT * (1.0 - SLACK)
        asked.semidefinite(_edge([float(each.mid()) for each in limit.row], bound**2), blocks)
    if inner is not None:
        asked.semidefinite(inner * (1.0 - SLACK), [(k, -unit) for k, unit in enumerate(units)])
    found = asked.minimize(np.eye(band + 1)[band])
    if found is None:
        return None
    return np.tensordot(found[: len(units)], units, 1), found[len(units) : band]


def _padded(matrix: "Array", size: int) -> "Array":
    import numpy as np

    return np.pad(matrix, (0, size - len(matrix)))


def _edge(row: Sequence[float], corner: float) -> "Array":
    """[[0, row'], [row, corner]]."""
    import numpy as np

    block = np.zeros((STATES + 1, STATES + 1))
    block[STATES, :STATES] = block[:STATES, STATES] = row
    block[STATES, STATES] = corner
    return block


def _left(p: "Array", shares: "Array", kept: float, m: "Array") -> "Array":
    import numpy as np

    left = _padded(kept * p, STATES + len(shares)) - m.T @ p @ m
    left[STATES:, STATES:] += np.diag(shares)
    return left


def _rounded(p: "Array", shares: "Array", used: Sequence[int], kept: float) -> Ellipsoid:
    every = [Fraction(0)] * len(DISTURBANCES)
    for k, share in zip(used, shares, strict=True):
        every[k] = _short(float(share))
    return Ellipsoid(
        matrix=tuple(tuple(_short(float(each) / UNIT**2) for each in row) for row in p),
        alpha=Fraction(kept),
        shares=tuple(every),
    )


def _short(number: float) -> Fraction:
    return Fraction(float(f"{number:.{DIGITS}g}"))


def _doubles(matrix: Sequence[Sequence[object]]) -> "Array":
    import numpy as np

    return np.array([[float(each) for each in row] for row in matrix])  # type: ignore[arg-type]
