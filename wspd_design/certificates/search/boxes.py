"""Boxes that wait for the prover."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]
    Numbers = NDArray[np.intp]


@dataclass(slots=True)
class Boxes:
    """Boxes that wait: corners (variables, boxes) in [0, 1], upper bounds, nodes and shares."""

    low: "Array"
    high: "Array"
    upper: "Array"
    node: "Numbers"
    share: "Array"

    def take(self, which: "Numbers") -> "Boxes":
        """Return some of them, in the order that is asked for."""
        return Boxes(
            self.low[:, which], self.high[:, which], self.upper[which], self.node[which], self.share[which]
        )


def joined(a: Boxes, b: Boxes) -> Boxes:
    """Return all boxes of two collections."""
    import numpy as np

    return Boxes(
        np.concatenate([a.low, b.low], axis=1),
        np.concatenate([a.high, b.high], axis=1),
        np.concatenate([a.upper, b.upper]),
        np.concatenate([a.node, b.node]),
        np.concatenate([a.share, b.share]),
    )
