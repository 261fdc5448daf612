"""How far linear functions reach on a polytope.

Qhull finds corners in doubles, and they only hint: a function q is at most sum of l b if q = sum of l w with l >= 0, of
half-spaces w u <= b. Multipliers that meet at a hinted corner are worked out, those below 0 are left out, and what of q
they miss counts with all that a coordinate may be. So a wrong hint gives a bound that is too large, never too small.
"""

from functools import cached_property
from itertools import product
from math import gcd
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

Array: TypeAlias = NDArray[np.float64]

ROUNDING = 1e-11  # relative: thousands of times what sums of this length are rounded by
UNEVEN = (
    1e-7  # of the extents, by which half-spaces are moved apart for the hints, so that corners are simple
)
THIN = 1e-6  # of the extents: a thinner polytope is bounded by its extents alone


def directions(entries: int, scales: tuple[float, ...]) -> Array:
    """Return all directions with small whole entries, of which none is the opposite or a multiple of another."""
    found = [
        each
        for each in product(range(-entries, entries + 1), repeat=len(scales))
        if gcd(*each) == 1 and next(x for x in each if x) > 0
    ]
    spread: Array = np.array(found, dtype=float) * np.array(scales)
    return spread


class Polytope:
    """All u with low <= rows u <= high and more half-spaces ``cuts``; every coordinate has its row."""

    def __init__(
        self, rows: Array, low: Array, high: Array, cuts: tuple[tuple[Array, float], ...] = ()
    ) -> None:
        self.rows, self.low, self.high, self.cuts = rows, low, high, cuts
        lone = np.count_nonzero(rows, axis=1) == 1
        size = rows.shape[1]
        self.extents = np.zeros((size, 2))
        for k in range(size):
            (i,) = np.flatnonzero(lone & (rows[:, k] != 0.0))
            self.extents[k] = sorted((low[i] / rows[i, k], high[i] / rows[i, k]))

    def cut(self, *cuts: tuple[Array, float]) -> "Polytope":
        """Return the part that lies in more half-spaces: row u <= bound."""
        return Polytope(self.rows, self.low, self.high, (*self.cuts, *cuts))

    @cached_property
    def half_spaces(self) -> tuple[Array, Array]:
        """Rows and bounds in coordinates from -1 to 1."""
        middle, half = self.extents.mean(axis=1), self._half
        rows = np.vstack([self.rows, -self.rows, *(row[None] for row, _ in self.cuts)])
        bounds = np.concatenate([self.high, -self.low, [bound for _, bound in self.cuts]])
        bounds = bounds - rows @ middle
        bounds = bounds + ROUNDING * (np.abs(bounds) + np.abs(rows) @ np.abs(middle))
        return rows * half, bounds

    @property
    def _half(self) -> Array:
        found: Array = np.maximum(0.5 * (self.extents[:, 1] - self.extents[:, 0]), 1e-12)
        return found

    @cached_property
    def _hints(self) -> tuple[Array, NDArray[np.int_], Array] | None:
        """Corners, the half-spaces that meet there, and the inverses of their rows."""
        from scipy.optimize import linprog
        from scipy.spatial import HalfspaceIntersection, QhullError

        rows, bounds = self.half_spaces
        size = rows.shape[1]
        length = np.linalg.norm(rows, axis=1)
        apart = 1.0 + np.modf(np.arange(len(rows)) * 0.6180339887)[0]
        moved = bounds + UNEVEN * apart * length
        inner = linprog(
            [0.0] * size + [-1.0],
            A_ub=np.column_stack([rows, length]),
            b_ub=moved,
            bounds=[(None, None)] * size + [(0.0, None)],
        )
        if inner.status != 0 or inner.x[size] < THIN:
            return None
        try:
            met = HalfspaceIntersection(np.column_stack([rows, -moved]), inner.x[:size])
        except QhullError:
            return None
        which = np.array([each[:size] for each in met.dual_facets if len(each) >= size])
        normals = rows[which]
        good = np.isfinite(met.intersections).all(axis=1)[[len(each) >= size for each in met.dual_facets]]
        good &= np.abs(np.linalg.det(normals / length[which][:, :, None])) > 1e-12
        corners = met.intersections[[len(each) >= size for each in met.dual_facets]][good]
        return corners, which[good], np.linalg.inv(normals[good])

    def most(self, functions: Array) -> Array:
        """Return what functions, one in each row, do not exceed."""
        middle, half = self.extents.mean(axis=1), self._half
        scaled = functions * half
        offset = functions @ middle
        slack = np.abs(functions) @ (np.abs(middle) + half)
        found: Array = np.abs(scaled).sum(axis=1)
        hints = self._hints
        if hints is not None and len(hints[0]):
            corners, which, inverses = hints
            rows, bounds = self.half_spaces
            best = np.argmax(scaled @ corners.T, axis=1)
            shares = np.maximum(np.einsum("ni,nij->nj", scaled, inverses[best]), 0.0)
            missed = scaled - np.einsum("nj,njk->nk", shares, rows[which[best]])
            reached = (shares * bounds[which[best]]).sum(axis=1) + np.abs(missed).sum(axis=1)
            slack = slack + (
                shares * (np.abs(bounds[which[best]]) + np.abs(rows[which[best]]).sum(axis=2))
            ).sum(axis=1)
            found = np.minimum(found, reached)
        return np.asarray(offset + found + ROUNDING * slack)

    def ends(self, functions: Array) -> Array:
        """Return between what functions lie: pairs."""
        count = len(functions)
        found = self.most(np.vstack([functions, -functions]))
        return np.column_stack([-found[count:], found[:count]])
