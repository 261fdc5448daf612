"""Sets of states made of square cells, and whether boxes lie inside them.

Cell (i, j) of a grid with n cells per unit covers slip i/n to (i + 1)/n and level j/n to (j + 1)/n. With n a power
of two the edges are exact doubles.
"""

from dataclasses import dataclass
from typing import TYPE_CHECKING

from wspd_design.certificates.records import Problem
from wspd_design.certificates.search.invariant_sets.duals import Interval
from wspd_design.certificates.search.invariant_sets.one_sample import Images, Window

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Mask = NDArray[np.bool_]


@dataclass(frozen=True, slots=True, kw_only=True)
class CellSet:
    """Some of the cells of a rectangle of cells."""

    window: Window
    per_unit: int  # cells per unit of slip and of level, a power of two
    first: tuple[int, int]  # indices of the first cell of the rectangle
    members: "Mask"  # (cells in slip, cells in level)

    def edges(self) -> tuple[Interval, Interval]:
        """Slip and level of all cells of the rectangle, row by row."""
        import ival
        import numpy as np

        rows, columns = np.indices(self.members.shape)
        slip, level = rows.ravel() + self.first[0], columns.ravel() + self.first[1]
        size = 1.0 / self.per_unit
        return (
            ival.Interval(slip * size, (slip + 1) * size),
            ival.Interval(level * size, (level + 1) * size),
        )

    def physical(self, problem: Problem) -> "Mask":
        """Cells that hold a state with a torque that the brake can have, from 0 to T_max."""
        slip, level = self.edges()
        share = level - self.window.tilt * (slip - problem.slip)
        possible: Mask = ((share.sup >= 0.0) & (share.inf <= 1.0)).reshape(self.members.shape)
        return possible


@dataclass(frozen=True, slots=True, kw_only=True)
class CellBoxes:
    """For each box of an image the range of cells that it touches, the last one excluded."""

    slip_first: "NDArray[np.int64]"
    slip_last: "NDArray[np.int64]"
    level_first: "NDArray[np.int64]"
    level_last: "NDArray[np.int64]"
    within: "Mask"  # wholly inside the rectangle of the set


def touched(grid: CellSet, image: Images) -> CellBoxes:
    """Locate images in the rectangle of a set, in whose window they are given."""
    import numpy as np

    bounds = []
    for low, high, axis in (
        (image.slip_low, image.slip_high, 0),
        (image.level_low, image.level_high, 1),
    ):
        count = grid.members.shape[axis]
        # Products with a power of two are exact. At least one cell, also for a single point on an edge.
        first = np.floor(low * grid.per_unit) - grid.first[axis]
        last = np.maximum(np.ceil(high * grid.per_unit) - grid.first[axis], first + 1)
        bounds.append((np.clip(first, -1, count), np.clip(last, 0, count + 1), count))
    (i0, i1, rows), (j0, j1, columns) = bounds
    within = (i0 >= 0) & (i1 <= rows) & (j0 >= 0) & (j1 <= columns)
    rounded = [np.where(within, each, 0).astype(np.int64) for each in (i0, i1, j0, j1)]
    return CellBoxes(
        slip_first=rounded[0],
        slip_last=rounded[1],
        level_first=rounded[2],
        level_last=rounded[3],
        within=within,
    )


def inside(members: "Mask", boxes: CellBoxes) -> "Mask":
    """Tell which boxes touch cells of the set only."""
    import numpy as np

    counts = np.zeros((members.shape[0] + 1, members.shape[1] + 1), dtype=np.int64)
    counts[1:, 1:] = members.cumsum(axis=0).cumsum(axis=1)
    i0, i1, j0, j1 = boxes.slip_first, boxes.slip_last, boxes.level_first, boxes.level_last
    found = counts[i1, j1] - counts[i0, j1] - counts[i1, j0] + counts[i0, j0]
    contained: Mask = boxes.within & (found == (i1 - i0) * (j1 - j0))
    return contained


def largest_kept(members: "Mask", boxes: CellBoxes, free: "Mask") -> "Mask":
    """Remove cells with an image that leaves the set, until nothing changes.

    Parameters
    ----------
    members : array of bool
        The set to begin with.
    boxes : CellBoxes
        Image of each cell, row by row.
    free : array of bool
        Cells that hold no state, so that none can leave; flat.
    """
    import numpy as np

    while True:
        kept: Mask = members & (inside(members, boxes) | free).reshape(members.shape)
        if np.array_equal(kept, members):
            return kept
        members = kept
