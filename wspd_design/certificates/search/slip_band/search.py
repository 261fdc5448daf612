"""Search for a cover of the box by cells that have an ellipsoid in every window; nothing here is trusted."""

from collections.abc import Sequence
from dataclasses import dataclass

from wspd_design.certificates.records import Problem
from wspd_design.certificates.search.slip_band.ellipsoids import ellipsoid
from wspd_design.certificates.theorems.slip_band.loop import Friction, loop_of
from wspd_design.certificates.theorems.slip_band.proof import Ellipsoid, Proof
from wspd_design.certificates.theorems.slip_band.statement import (
    LETTERS,
    BandLaw,
    Cell,
    box_of,
    halved,
    windows_of,
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Failed:
    """A cell that is not worth halving, or the one at which the budget ended."""

    cell: Cell
    window: int  # in which no ellipsoid was found, the slowest being 0
    tried: int  # cells
    left: float  # share of the box that has no ellipsoids
    cut: bool  # whether the budget ended the search


NARROWEST = 1.02  # ratio of the ends of a range that is not worth halving


def search(problem: Problem, law: BandLaw, friction: Sequence[Friction], most_cells: int) -> Proof | Failed:
    """Find ellipsoids for the whole box.

    Parameters
    ----------
    problem : Problem
        Closed loop and domain.
    law : BandLaw
        Numbers of the law.
    friction : sequence of Friction
        Proved bounds for each window.
    most_cells : int
        That may be tried.
    """
    box = box_of(problem)
    middle = tuple(((low + high) / 2,) * 2 for low, high in box)
    alone = _all_windows(problem, law, middle, friction)
    if isinstance(alone, int):  # no cell around it can do better
        return Failed(cell=middle, window=alone, tried=1, left=1.0, cut=False)
    waiting, steps = [(box, 0)], ""
    cells: list[tuple[Ellipsoid, ...]] = []
    tried = 0
    while waiting:
        cell, depth = waiting.pop()
        tried += 1
        found = _all_windows(problem, law, cell, friction)
        if not isinstance(found, int):
            steps, cells = f"{steps}.", [*cells, found]
            continue
        letter = _widest(cell)
        if letter is None or tried >= most_cells:
            left = 2.0**-depth + sum(2.0**-deep for _, deep in waiting)
            return Failed(cell=cell, window=found, tried=tried, left=left, cut=letter is not None)
        steps += letter
        waiting += [(half, depth + 1) for half in halved(cell, letter)[::-1]]
    return Proof(friction=tuple(friction), steps=steps, cells=tuple(cells))


def _all_windows(
    problem: Problem, law: BandLaw, cell: Cell, friction: Sequence[Friction]
) -> tuple[Ellipsoid, ...] | int:
    """Return the ellipsoids of a cell, or the window in which none was found."""
    windows = windows_of(problem)
    found: list[Ellipsoid] = []
    for k in reversed(range(len(windows))):  # with the speed the train loses the room that venting has
        loop = loop_of(problem, law, cell, windows[k], friction[k])
        each = ellipsoid(law, loop, found[-1] if found else None)
        if each is None:
            return k
        found.append(each)
    return tuple(found[::-1])


def _widest(cell: Cell) -> str | None:
    widths = {letter: high / low for letter, (low, high) in zip(LETTERS, cell, strict=True)}
    letter = max(LETTERS, key=lambda each: widths[each])
    return letter if widths[letter] > NARROWEST else None
