"""Linear equations with a sparse symmetric matrix of symbols: M = L D L', in an order that fills little."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, TypeAlias

from wspd_design.model.number import Number

Sparse: TypeAlias = dict[int, Number]
"""What is not zero by structure, by its row."""


@dataclass(frozen=True, slots=True)
class Factors:
    """Pivots in their order: row, reciprocal of the pivot, and the multipliers of the rows that it changes."""

    pivots: tuple[tuple[int, Number, Sparse], ...]

    def solve(self, right: Mapping[int, Number]) -> Sparse:
        """Return the solution of M x = right; both without what is zero by structure."""
        x = dict(right)
        for row, _, multipliers in self.pivots:
            if row in x:
                for other, multiplier in multipliers.items():
                    x[other] = x.get(other, 0.0) - multiplier * x[row]
        for row, reciprocal, multipliers in reversed(self.pivots):
            known = {other: m for other, m in multipliers.items() if other in x}
            if row in x or known:
                x[row] = reciprocal * x.get(row, 0.0) - sum(m * x[other] for other, m in known.items())
        return x


def factors(matrix: Any) -> Factors:
    """Factor a symmetric positive matrix of symbols, the row with the fewest neighbors first.

    Parameters
    ----------
    matrix : casadi.SX
        Sparse, n x n.
    """
    rows = {k: dict[int, Number]() for k in range(matrix.size1())}
    for i, j in zip(*matrix.sparsity().get_triplet(), strict=True):
        rows[i][j] = matrix[i, j]
    pivots = []
    while rows:
        k = min(rows, key=lambda each: (len(rows[each]), -each))
        pivot = rows.pop(k)
        reciprocal = 1.0 / pivot.pop(k)
        multipliers = {i: value * reciprocal for i, value in pivot.items()}
        for i, multiplier in multipliers.items():
            del rows[i][k]
            for j, value in pivot.items():
                if j <= i:
                    rows[i][j] = rows[j][i] = rows[i].get(j, 0.0) - multiplier * value
        pivots.append((k, reciprocal, multipliers))
    return Factors(tuple(pivots))


def sparse(column: Any) -> Sparse:
    """Return what is not zero by structure in a column of symbols."""
    rows, _ = column.sparsity().get_triplet()
    return {k: column[k] for k in rows}
