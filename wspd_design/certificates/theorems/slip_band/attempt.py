"""Where a search for ellipsoids on a share of the box ended: hearsay, which is told and drawn and proves nothing."""

from dataclasses import dataclass
from fractions import Fraction

from wspd_design.certificates.kernel.checker import Refused, number
from wspd_design.certificates.kernel.finding import Effort
from wspd_design.certificates.kernel.term import text
from wspd_design.certificates.quantities import QUANTITIES
from wspd_design.certificates.records import Interval, Problem
from wspd_design.certificates.theorems.slip_band.proof import MOST_CELLS, MOST_LETTERS
from wspd_design.certificates.theorems.slip_band.statement import (
    LETTERS,
    NAMES,
    Cell,
    box_of,
    halved,
    windows_of,
)
from wspd_design.parameters.units import KMH


@dataclass(frozen=True, slots=True, kw_only=True)
class Attempt:
    """A search that found no ellipsoids for some cell, or was ended by its budget."""

    share: Fraction  # of the box
    steps: str  # as in a proof, up to the cell at which it ended
    window: int  # in which an ellipsoid was sought last, the slowest being 0
    tried: int  # ellipsoids
    cut: bool  # whether the budget ended it


def effort_of(problem: Problem, attempt: Attempt, *, proved: Fraction) -> Effort:
    """Write an attempt as the effort of a search that proved another share of each range, or none."""
    wide = sum(low < high for low, high in box_of(problem, Fraction(1)))
    return Effort(
        boxes=attempt.tried,
        undecided=1.0 - float(proved) ** wide,
        cut=attempt.cut,
        ended={"share": text(attempt.share), "steps": attempt.steps, "window": attempt.window},
    )


def attempt_of(problem: Problem, effort: Effort) -> Attempt | None:
    """Read where a search ended, or refuse what cannot be; none if it is not known."""
    if not effort.ended:
        return None
    if effort.ended.keys() != {"share", "steps", "window"}:
        raise Refused("a search does not say where it ended")
    share, steps, window = (effort.ended[name] for name in ("share", "steps", "window"))
    if not isinstance(share, str) or len(share) > MOST_LETTERS or not 0 < number(share) <= 1:
        raise Refused("a search names no share of the box")
    if not isinstance(steps, str) or len(steps) > 2 * MOST_CELLS:
        raise Refused("a search names no steps, or too many")
    if type(window) is not int or window not in range(len(windows_of(problem))):
        raise Refused("a search names a window that is not there")
    found = Attempt(share=number(share), steps=steps, window=window, tried=effort.boxes, cut=effort.cut)
    if not cells_of(box_of(problem, found.share), steps)[1]:
        raise Refused("a search names no cell at which it ended")
    return found


def cells_of(box: Cell, steps: str) -> tuple[list[Cell], list[Cell]]:
    """Return the cells that steps close, in their order, and those that are left, the next one last."""
    closed: list[Cell] = []
    waiting = [box]
    for step in steps:
        if not waiting or step not in (*LETTERS, "."):
            raise Refused("steps lead to no cells")
        cell = waiting.pop()
        if step == ".":
            closed.append(cell)
        else:
            waiting += halved(cell, step)[::-1]
    return closed, waiting


def how_it_ended(problem: Problem, attempt: Attempt) -> str:
    """Say with the speeds of the window how an attempt ended."""
    low, high = (speed * KMH for speed in windows_of(problem)[attempt.window])
    how = "not decided within the budget" if attempt.cut else "failed"
    return f"{how} at {low:.0f} to {high:.0f} km/h"


def told_attempt(problem: Problem, attempt: Attempt) -> str:
    """Say which cell was the last one, in numbers."""
    closed, waiting = cells_of(box_of(problem, attempt.share), attempt.steps)
    ended = "was cut by its budget" if attempt.cut else "found no ellipsoid"
    count = "1 cell" if len(closed) == 1 else f"{len(closed)} cells"
    low, high = (speed * KMH for speed in windows_of(problem)[attempt.window])
    return (
        f"On {100.0 * float(attempt.share):.3g} % of each range the search closed {count}, and {ended} at "
        f"{low:.0f} to {high:.0f} km/h, where {_ranges(waiting[-1])}; that proves nothing."
    )


def _ranges(cell: Cell) -> str:
    named = zip(NAMES, cell, strict=True)
    return ", ".join(
        Interval(name=name, low=float(low), high=float(high), unit=QUANTITIES[name].unit).text
        for name, (low, high) in named
    )
