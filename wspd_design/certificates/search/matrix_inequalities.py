"""Linear matrix inequalities in doubles, by Clarabel; nothing here is trusted."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, TypeAlias

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array: TypeAlias = NDArray[np.float64]


class Inequalities:
    """Minimize c'x under constant + sum of x_i times a matrix, positive semidefinite, for any number of blocks.

    Parameters
    ----------
    unknowns : int
        Length of x.
    """

    def __init__(self, unknowns: int) -> None:
        self.unknowns = unknowns
        self._rows: list[Array] = []
        self._constants: list[Array] = []
        self._cones: list[object] = []

    def semidefinite(self, constant: "Array", parts: Sequence[tuple[int, "Array"]]) -> None:
        """Ask for a positive semidefinite block; ``parts`` are the matrices of single unknowns."""
        import clarabel
        import numpy as np

        size = len(constant)
        columns, rows = np.tril_indices(size)  # the upper triangle column by column, as Clarabel has it
        scale = np.where(rows == columns, 1.0, np.sqrt(2.0))
        block = np.zeros((len(rows), self.unknowns))
        for unknown, matrix in parts:
            block[:, unknown] -= scale * matrix[rows, columns]
        self._rows.append(block)
        self._constants.append(scale * constant[rows, columns])
        self._cones.append(clarabel.PSDTriangleConeT(size))

    def at_most(self, rows: "Array", bounds: "Array") -> None:
        """Ask for ``rows @ x <= bounds``."""
        import clarabel

        self._rows.append(rows)
        self._constants.append(bounds)
        self._cones.append(clarabel.NonnegativeConeT(len(bounds)))

    def minimize(self, costs: "Array", *, rough: bool = False) -> "Array | None":
        """Return x, or None where there is none or the solver does not find it; ``rough``: also where it gave up."""
        import clarabel
        import numpy as np
        from scipy import sparse

        settings = clarabel.DefaultSettings()
        settings.verbose = False
        settings.max_threads = 1  # the same sums in the same order on every machine
        solver = clarabel.DefaultSolver(
            sparse.csc_matrix((self.unknowns, self.unknowns)),
            costs,
            sparse.csc_matrix(np.vstack(self._rows)),
            np.concatenate(self._constants),
            self._cones,
            settings,
        )
        found = solver.solve()
        usable = [clarabel.SolverStatus.Solved, clarabel.SolverStatus.AlmostSolved]
        if rough:
            usable += [clarabel.SolverStatus.NumericalError, clarabel.SolverStatus.InsufficientProgress]
        x = np.array(found.x)
        return x if found.status in usable and bool(np.isfinite(x).all()) else None
