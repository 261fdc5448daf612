"""Search for quadratic functions that fall, in doubles; nothing here is trusted.

With P = T'T, T = [[1, s], [0, d]], the function falls by the factor c per sample if T M T^-1 has a norm below c, and
as exp(-r t) if the largest eigenvalue of the symmetric part of T A T^-1 is below -r. Both are searched over (s, d):
on a grid, then by the simplex of Nelder and Mead. The number of steps is fixed; no clock is looked at.
"""

from collections.abc import Callable, Iterable
from fractions import Fraction
from typing import TYPE_CHECKING, TypeAlias

from wspd_design.certificates.search.budget import budget
from wspd_design.certificates.theorems.quadratic import (
    LETTERS,
    Law,
    Matrix,
    Piece,
    Quadratic,
    Ranges,
    Symmetric,
    averaged,
    halved,
    sampled,
)

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array: TypeAlias = NDArray[np.float64]

DENOMINATOR = 10**6
KEPT = 0.9  # of the fall that the search sees is what shall be shown
SHEARS, STRETCHES = 25, 25  # points of the grid
WIDEST = 3.0  # of the grid, in powers of ten on either side of the middle
SIMPLEX_STEPS = 80
PIECES = 100  # of an effort of 1
DEEPEST = 9  # halvings of one piece
NARROWEST = Fraction(101, 100)  # ratio of the ends of a range that is not worth halving


def search(law: Law, ranges: Ranges) -> Quadratic | None:
    """Find functions for all pieces of a box, or none.

    Parameters
    ----------
    law : Law
        Numbers of the law.
    ranges : Ranges
        The box.
    """
    waiting, steps = [(ranges, 0)], ""
    pieces: list[Piece] = []
    most = max(1, round(PIECES * budget().effort))
    while waiting:
        box, depth = waiting.pop()
        piece = _piece(law, box)
        if piece is not None:
            steps, pieces = f"{steps}.", [*pieces, piece]
            continue
        letter = _widest(box)
        if letter is None or depth >= DEEPEST or len(pieces) + len(waiting) >= most:
            return None
        steps += letter
        waiting += [(half, depth + 1) for half in halved(box, letter)[::-1]]
    return Quadratic(poles=ranges[-1], steps=steps, pieces=tuple(pieces))


def _widest(box: Ranges) -> str | None:
    """Return the range that is widest in relation to its numbers."""
    widths = {letter: high / low for letter, (low, high) in zip(LETTERS, box, strict=False)}
    letter = max(LETTERS, key=lambda each: widths[each])
    return letter if widths[letter] > NARROWEST else None


def _unit(law: Law, box: Ranges) -> float:
    """Change of w per y along the line on which the torque follows the slide."""
    g, back = law.slide * box[2][1] / box[3][0], law.torque * box[2][1]
    return float(g / (1 + back)) or 1.0


def _piece(law: Law, box: Ranges) -> Piece | None:
    """Find the functions of one piece, or none if one does not fall."""
    unit = _unit(law, box)
    steps = _floats(sampled(law, box))
    transform, contraction = _best(steps, _norm, unit)
    if not contraction < 1.0:
        return None
    other, growth = _best(_floats(averaged(law, box)), _growth, unit)
    if not growth < 0.0:
        return None
    return Piece(
        continuous=_rational(other),
        decay=_short(-KEPT * growth),
        sampled=_rational(transform),
        contraction=_short(1.0 - KEPT * (1.0 - contraction)),
    )


def _best(matrices: "Array", size: Callable[["Array"], "Array"], unit: float) -> tuple["Array", float]:
    """Find the transform T that makes the largest size of all matrices smallest, and that size."""
    import numpy as np
    from scipy.optimize import minimize

    def largest(shear: float, stretch: float) -> float:
        return float(size(_transformed(matrices, shear, np.exp(stretch))).max())

    middle = -np.log(unit)
    stretches = middle + np.log(10.0) * np.linspace(-WIDEST, WIDEST, STRETCHES)
    grid = [(s * np.exp(d), d) for d in stretches for s in np.linspace(-2.0, 2.0, SHEARS)]
    start = min(grid, key=lambda each: largest(*each))
    scale = np.exp(start[1])
    found = minimize(
        lambda x: largest(x[0] * scale, x[1]),
        (start[0] / scale, start[1]),
        method="Nelder-Mead",
        options={"maxiter": SIMPLEX_STEPS, "initial_simplex": _simplex(start[0] / scale, start[1])},
    )
    shear, stretch = float(found.x[0] * scale), float(np.exp(found.x[1]))
    return np.array([[1.0, shear], [0.0, stretch]]), float(found.fun)


def _simplex(shear: float, stretch: float) -> "Array":
    import numpy as np

    return np.array([(shear, stretch), (shear + 0.1, stretch), (shear, stretch + 0.2)])


def _transformed(matrices: "Array", shear: float, stretch: float) -> "Array":
    """T M T^-1 with T = [[1, shear], [0, stretch]]."""
    import numpy as np

    a, b, c, d = (matrices[:, i, k] for i in (0, 1) for k in (0, 1))
    top, bottom = a + shear * c, b + shear * d
    return np.array(
        [
            [top, (bottom - shear * top) / stretch],
            [stretch * c, d - shear * c],
        ]
    )


def _norm(m: "Array") -> "Array":
    """Largest singular value of matrices [[a, b], [c, d]]."""
    import numpy as np

    (a, b), (c, d) = m
    found: Array = 0.5 * (np.hypot(a + d, c - b) + np.hypot(a - d, b + c))
    return found


def _growth(m: "Array") -> "Array":
    """Largest eigenvalue of the symmetric part."""
    import numpy as np

    (a, b), (c, d) = m
    found: Array = 0.5 * (a + d + np.hypot(a - d, b + c))
    return found


def _floats(matrices: Iterable[Matrix]) -> "Array":
    import numpy as np

    return np.array([[[float(each) for each in row] for row in m] for m in matrices])


def _rational(transform: "Array") -> Symmetric:
    p = transform.T @ transform
    p = p / p.max()
    return Fraction(float(p[0, 0])), Fraction(float(p[0, 1])), Fraction(float(p[1, 1]))


def _short(number: float) -> Fraction:
    return Fraction(round(number * DENOMINATOR), DENOMINATOR)
