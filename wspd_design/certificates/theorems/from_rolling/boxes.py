"""Boxes of states of wheels, of all cells in one list: how they are divided into slices and put together again."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from wspd_design.certificates.kernel.interval import Array, Index, Interval, Where

STATES = ("y", "z", "p", "error", "way", "room")
Y, WAY = STATES.index("y"), STATES.index("way")
SLICE, LEAST = 0.01, 0.0  # rad/s, of y
WAYS = np.array(
    [-np.inf, -0.03, -0.02, -0.01, -0.005, 0.0, 0.005, 0.01, 0.015, 0.02, 0.03, 0.045, 0.07, 0.1, np.inf]
)
NEAR = 3  # rows that boxes come to first, if they are put together


class Boxes(NamedTuple):
    """Boxes of states, each with the number of its cell, the speed of the train and the least supply.

    What joins boxes are largest values: of each state and of the speed [m/s] the lower end with its sign turned and the
    upper one, and at last the supply, over the full pressure, with its sign turned.
    """

    cell: Index
    values: Array  # a row for each box

    @classmethod
    def of(cls, cell: Index, states: Mapping[str, Interval], speed: Interval, supply: Array) -> "Boxes":
        """Return boxes from the ends of their states."""
        columns = [end for name in STATES for end in (-states[name].low, states[name].high)]
        return cls(cell, np.column_stack([*columns, -speed.low, speed.high, -supply]))

    @property
    def states(self) -> dict[str, Interval]:
        """States by their names."""
        v = np.ascontiguousarray(self.values.T)
        return {name: Interval(-v[2 * k], v[2 * k + 1]) for k, name in enumerate(STATES)}

    @property
    def speed(self) -> Interval:
        """Speed of the train."""
        return Interval(-self.values[:, -3], self.values[:, -2])

    @property
    def supply(self) -> Array:
        """Supply at least."""
        found: Array = -self.values[:, -1]
        return found

    def kept(self, where: Where | Index) -> "Boxes":
        """Return some of them."""
        return Boxes(self.cell[where], self.values[where])


def sliced(boxes: Boxes) -> tuple[Boxes, Index]:
    """Divide boxes at the edges of the slices of y and of the way; with the number of the box that each comes from."""
    y, way = (Interval(-boxes.values[:, 2 * k], boxes.values[:, 2 * k + 1]) for k in (Y, WAY))
    first_y, last_y = (
        np.clip(np.floor((end - LEAST) / SLICE), 0, None).astype(int) for end in (y.low, y.high)
    )
    first_x = np.clip(np.searchsorted(WAYS, way.low, side="right") - 1, 0, WAYS.size - 2)
    last_x = np.maximum(np.clip(np.searchsorted(WAYS, way.high, side="left") - 1, 0, WAYS.size - 2), first_x)
    wide = last_x - first_x + 1
    count = (last_y - first_y + 1) * wide
    origin = np.repeat(np.arange(count.size), count)
    place = np.arange(origin.size) - np.repeat(np.cumsum(count) - count, count)
    slice_y = first_y[origin] + place // wide[origin]
    slice_x = first_x[origin] + place % wide[origin]
    values = boxes.values[origin]
    for k, low, high in (
        (Y, LEAST + SLICE * slice_y, LEAST + SLICE * (slice_y + 1)),
        (WAY, WAYS[slice_x], WAYS[slice_x + 1]),
    ):
        np.minimum(values[:, 2 * k], -low, out=values[:, 2 * k])
        np.minimum(values[:, 2 * k + 1], high, out=values[:, 2 * k + 1])
    return Boxes(boxes.cell[origin], values), origin


def together(chunks: Sequence[Boxes]) -> Boxes:
    """Put boxes of one cell and one pair of slices together."""
    if not chunks:
        return Boxes(np.zeros(0, dtype=int), np.zeros((0, 2 * len(STATES) + 3)))
    boxes = Boxes(*(np.concatenate(each) for each in zip(*chunks, strict=True)))
    return joined(boxes, 0 * boxes.cell, 0 * boxes.cell)[0]


def joined(boxes: Boxes, nearest: Index, farthest: Index) -> tuple[Boxes, tuple[Index, Index]]:
    """Put boxes of one cell, one pair of slices and about the same rows together; with the rows that they come to."""
    if not boxes.cell.size:
        return boxes, (nearest, farthest)
    v = boxes.values
    middle_y = 0.5 * (v[:, 2 * Y + 1] - v[:, 2 * Y])
    slice_y = np.floor((middle_y - LEAST) / SLICE).astype(int)
    ends = np.clip(-v[:, 2 * WAY], -1e9, 1e9), np.clip(v[:, 2 * WAY + 1], -1e9, 1e9)
    slice_x = np.searchsorted(WAYS, 0.5 * (ends[0] + ends[1]), side="right")
    key = ((boxes.cell * 4096 + slice_y) * 64 + slice_x) * 64 + nearest // NEAR
    order = np.argsort(key, kind="stable")
    starts = np.flatnonzero(np.diff(key[order], prepend=-1))
    rows = np.minimum.reduceat(nearest[order], starts), np.maximum.reduceat(farthest[order], starts)
    return Boxes(boxes.cell[order[starts]], np.maximum.reduceat(v[order], starts, axis=0)), rows
