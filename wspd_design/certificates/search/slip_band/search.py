"""Search for a cover of the box by cells that have an ellipsoid in every window; nothing here is trusted."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import product

from wspd_design.certificates.records import Problem
from wspd_design.certificates.search.slip_band.ellipsoids import ellipsoid
from wspd_design.certificates.theorems.slip_band.checker import least_delay
from wspd_design.certificates.theorems.slip_band.loop import Conditions, Friction, Loop, loop_of
from wspd_design.certificates.theorems.slip_band.proof import Ellipsoid, Proof
from wspd_design.certificates.theorems.slip_band.statement import (
    LETTERS,
    BandLaw,
    Cell,
    box_of,
    halved,
    windows_of,
)

NARROWEST = 1.02  # ratio of the ends of a range that is not worth halving
SHARES = tuple(Fraction(k, 8) for k in range(1, 9))
CORNERS = tuple(
    (load, inertia, 1, load, torque, fill, vent)
    for load, torque, inertia, fill, vent in product((1, 0), (0, 1), (0, 1), (1, 0), (0, 1))
)
"""Ends of the ranges, in the order of the names: mass and friction together, and the largest wheel."""
PULSES = (Fraction(1, 2), Fraction(1), Fraction(1, 4))  # longest ones that are tried
MATTERS = {"m": 1.0, "i": 1.0, "r": 1.0, "u": 1.0, "t": 0.6, "f": 0.2, "v": 0.2}
"""How much a halved range tightens an ellipsoid; the drift of the friction spreads with mass, inertia and friction."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Failed:
    """A cell that is not worth halving, or the one at which the budget ended."""

    share: Fraction  # of the box
    cell: Cell
    window: int  # in which no ellipsoid was found, the slowest being 0
    tried: int  # cells, for this share
    cut: bool  # whether the budget ended the search


def largest_share(
    problem: Problem, law: BandLaw, friction: Sequence[Friction], most_cells: int
) -> Proof | Failed:
    """Find ellipsoids for the largest share of the box, in steps of :data:`SHARES`; none below the first.

    Parameters
    ----------
    problem : Problem
        Closed loop and domain.
    law : BandLaw
        Numbers of the law.
    friction : sequence of Friction
        Proved bounds for each window.
    most_cells : int
        That may be tried for each share.
    """
    exact = exactly(problem, law)
    whole = all_windows(problem, law, box_of(problem, SHARES[-1]), friction, exact)
    if not isinstance(whole, int):
        return proof_of(SHARES[-1], exact, friction, ".", (whole,))
    middle = _middle(box_of(problem, SHARES[-1]))
    alone = all_windows(problem, law, middle, friction, exact)
    if isinstance(alone, int):  # no box around it can do better
        return Failed(share=SHARES[-1], cell=middle, window=alone, tried=2, cut=False)
    low, high = 0, len(SHARES)  # numbers of shares: one that is covered, and one that may be
    best: Proof | Failed | None = None
    while low < high and (best := _failing_corner(problem, law, friction, SHARES[high - 1])) is not None:
        high -= 1
    while low < high:
        number = (low + high + 1) // 2
        found = cover(problem, law, friction, SHARES[number - 1], most_cells)
        if isinstance(found, Proof):
            low, best = number, found
        else:
            high = number - 1
            best = found if best is None else best
    assert best is not None
    return best


def exactly(problem: Problem, law: BandLaw) -> Conditions:
    """Return a stop with the vehicle's dead time and exact speeds.

    The pressure of a main pipe comes close to the full one and never reaches it.
    """
    supply = Fraction(63, 64) if problem.vehicle.brake.build_up == "main-pipe" else Fraction(1)
    return Conditions(supply=supply, delay=least_delay(problem, law), noise=Fraction(0))


def proof_of(
    share: Fraction,
    conditions: Conditions,
    friction: Sequence[Friction],
    steps: str,
    cells: Sequence[tuple[Ellipsoid, ...]],
) -> Proof:
    """Put a proof together."""
    return Proof(
        share=share,
        delay=conditions.delay,
        noise=conditions.noise,
        friction=tuple(friction),
        steps=steps,
        cells=tuple(cells),
    )


def _failing_corner(
    problem: Problem, law: BandLaw, friction: Sequence[Friction], share: Fraction
) -> Failed | None:
    """Look for a corner of the box that has no ellipsoid at the lowest speed, where it is hardest."""
    box, window, exact = box_of(problem, share), windows_of(problem)[0], exactly(problem, law)
    for tried, sides in enumerate(CORNERS, start=1):
        corner = tuple((ends[side], ends[side]) for ends, side in zip(box, sides, strict=True))
        if one_window(problem, law, corner, window, friction[0], exact, None, ()) is None:
            return Failed(share=share, cell=corner, window=0, tried=tried, cut=False)
    return None


def cover(
    problem: Problem, law: BandLaw, friction: Sequence[Friction], share: Fraction, most_cells: int
) -> Proof | Failed:
    """Find ellipsoids for a share of the box.

    Parameters
    ----------
    problem : Problem
        Closed loop and domain.
    law : BandLaw
        Numbers of the law.
    friction : sequence of Friction
        Proved bounds for each window.
    share : Fraction
        Of each range, around its nominal value.
    most_cells : int
        That may be tried.
    """
    exact = exactly(problem, law)
    waiting, steps, tried = [box_of(problem, share)], "", 0
    cells: list[tuple[Ellipsoid, ...]] = []
    while waiting:
        cell = waiting.pop()
        found = all_windows(problem, law, cell, friction, exact)
        tried += 1
        if not isinstance(found, int):
            steps, cells = f"{steps}.", [*cells, found]
            continue
        letter = _widest(cell)
        if letter is None:
            return Failed(share=share, cell=cell, window=found, tried=tried, cut=False)
        middle = _middle(cell)
        alone = all_windows(problem, law, middle, friction, exact)
        tried += 1
        if isinstance(alone, int):  # no cell around it can do better
            return Failed(share=share, cell=middle, window=alone, tried=tried, cut=False)
        if tried >= most_cells:
            return Failed(share=share, cell=cell, window=found, tried=tried, cut=True)
        steps += letter
        waiting += halved(cell, letter)[::-1]
    return proof_of(share, exact, friction, steps, cells)


def all_windows(
    problem: Problem, law: BandLaw, cell: Cell, friction: Sequence[Friction], conditions: Conditions
) -> tuple[Ellipsoid, ...] | int:
    """Return the ellipsoids of a cell, or the window in which none was found."""
    windows = windows_of(problem)
    found: list[Ellipsoid] = []
    hints: tuple[int, ...] = ()
    for k in reversed(range(len(windows))):  # with the speed the train loses the room that venting has
        faster = found[-1] if found else None
        each = one_window(problem, law, cell, windows[k], friction[k], conditions, faster, hints)
        if each is None:
            return k
        found.append(each[0])
        hints = each[1]
    return tuple(found[::-1])


def one_window(
    problem: Problem,
    law: BandLaw,
    cell: Cell,
    window: tuple[float, float],
    friction: Friction,
    conditions: Conditions,
    faster: Ellipsoid | None,
    hints: Sequence[int],
) -> tuple[Ellipsoid, tuple[int, ...]] | None:
    """Find an ellipsoid for one of the longest pulses; shorter ones leave less room and less to be uncertain about."""
    # A pulse ends in its sample, however late it begins.
    for pulse in dict.fromkeys(min(each, 1 - conditions.delay) for each in PULSES):

        def loops(supply: Fraction, pulse: Fraction = pulse) -> Loop:
            return loop_of(problem, law, cell, window, friction, pulse, conditions._replace(supply=supply))

        found = ellipsoid(law, loops, pulse, conditions.supply, faster, hints)
        if found is not None:
            return found
    return None


def _middle(cell: Cell) -> Cell:
    return tuple(((low + high) / 2,) * 2 for low, high in cell)


def _widest(cell: Cell) -> str | None:
    widths = {
        letter: MATTERS[letter] * math.log(high / low)
        for letter, (low, high) in zip(LETTERS, cell, strict=True)
        if high / low > NARROWEST
    }
    return max(widths, key=lambda each: widths[each]) if widths else None
