"""Search for the ellipsoid of one cell and one window, in doubles; the checker decides about it."""

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING, TypeAlias

from wspd_design.certificates.kernel.arb import point
from wspd_design.certificates.kernel.checker import Refused
from wspd_design.certificates.search.common_quadratic import unit_matrices
from wspd_design.certificates.search.matrix_inequalities import Inequalities
from wspd_design.certificates.search.slip_band.task import Task, centered, contracts, short, task_of
from wspd_design.certificates.setting.slip_loop import DISTURBANCES, STATES
from wspd_design.certificates.theorems.slip_band.center import Lengths, about
from wspd_design.certificates.theorems.slip_band.checker import Set, beyond_limit, errors, lies_in
from wspd_design.certificates.theorems.slip_band.loop import Loop, Steady
from wspd_design.certificates.theorems.slip_band.proof import Choice, Ellipsoid
from wspd_design.certificates.theorems.slip_band.statement import BandLaw

if TYPE_CHECKING:
    from wspd_design.certificates.search.matrix_inequalities import Array

KEPT = (0.95, 0.92, 0.85)  # of the function after a sample without disturbance; the first that succeeds
SLOWER = 0.5  # of what the slowest corner takes off it, where that is less than by the first of them
FIRST_CORNERS, MORE_CORNERS, ROUNDS = 8, 8, 8  # of the loop that the inequalities begin with, and are added
SLACK = 1e-3  # what the inequalities ask beyond what is to be shown, so that rounding does not spoil it
LEAST = 1e-6  # of what disturbs most, as which anything else counts at least
# [[x, 1], [1, y]] = x FIRST + y SECOND + CROSS is positive semidefinite if y is at least 1/x.
FIRST, SECOND, CROSS = ((1.0, 0.0), (0.0, 0.0)), ((0.0, 0.0), (0.0, 1.0)), ((0.0, 1.0), (1.0, 0.0))

Faster: TypeAlias = tuple[Ellipsoid, Steady] | None
"""Ellipsoid of the next faster window with the steady drift there."""
Loops: TypeAlias = Callable[[Fraction], Loop]
"""Numbers of cell and window for the least share of the full pressure."""


def ellipsoid(
    law: BandLaw,
    loops: Loops,
    choice: Choice,
    supply: Fraction,
    faster: Faster,
    hints: Sequence[int],
) -> tuple[Ellipsoid, Steady, tuple[int, ...]] | None:
    """Find an ellipsoid with a small band around that of the next faster window, or none.

    It is sought with the room that this share of the full pressure leaves; then the least share is found in which its
    states have room.

    Parameters
    ----------
    law : BandLaw
        Numbers of the law.
    loops : callable
        Returns the numbers of cell and window.
    choice : Choice
        What they are made for.
    supply : Fraction
        Share of the full pressure that the search may ask for.
    faster : tuple of Ellipsoid and Steady, or None
        Of the next faster window.
    hints : sequence of int
        Corners of the loop that mattered in another window or cell.

    Returns
    -------
    tuple of Ellipsoid, Steady and corners, or None
        The ellipsoid, the steady drift there, and the corners that mattered.
    """
    there = centered(law, loops(supply))
    for kept in _kept(law, there[0]):
        task = task_of(law, *there, kept)
        if task is None:
            return None
        solved = _solve(task, faster, hints)
        if solved is None:
            continue
        q, shares, inside, corners_that_matter = solved
        found = _rounded(task, choice, supply, q, shares, inside)
        found = replace(found, supply=_least_supply(law, loops, supply, found))
        loop = loops(found.supply)
        try:
            errors(law, loop, found)
        except Refused:
            continue
        if faster is None or lies_in(faster, (found, loop.steady)):
            return found, loop.steady, corners_that_matter
    return None


def excess(
    law: BandLaw, loops: Loops, supply: Fraction, faster: Faster, hints: Sequence[int]
) -> tuple[float, tuple[float, float]]:
    """Return by how much an ellipsoid would exceed its tightest limit, squared; infinite if there is none at all.

    With it come its errors of the wheel speed, beside the one that errors are counted from, if it were
    made as small as the limits ask for [rad/s].
    """
    there = centered(law, loops(supply))
    for kept in _kept(law, there[0]):
        task = task_of(law, *there, kept)
        solved = None if task is None else _solve(task, faster, hints, beyond=True)
        if task is not None and solved is not None:
            found = max(_used(task, solved[0]))
            return found, _errors(task, solved[0] / max(found, 1.0))
    return math.inf, (-math.inf, math.inf)


def _kept(law: BandLaw, loop: Loop) -> tuple[float, ...]:
    """Return what of the function may be kept: more where a corner hardly contracts, none if one does not."""
    least = round(1.0 - SLOWER * (1.0 - contracts(law, loop)), 3)
    return tuple(dict.fromkeys(max(each, least) for each in KEPT)) if least < 1.0 else ()


def _errors(task: Task, q: "Array") -> tuple[float, float]:
    """Return between what the errors of an ellipsoid lie, wherever its center is."""
    import numpy as np

    whole = task.basis @ q @ task.basis.T
    moved = float(task.steady.away(point(task.drift)).mid()) * abs(float(task.moves[0]))
    aside = float(np.sqrt(whole[0, 0])) + moved
    return float(task.center[0]) - aside, float(task.center[0]) + aside


def _least_supply(law: BandLaw, loops: Loops, supply: Fraction, found: Ellipsoid) -> Fraction:
    """Return the least share of the full pressure, in steps of what this one lacks, that the states have room in."""
    if supply == 1:
        return supply
    q, center, moves = (
        [[point(each) for each in row] for row in found.matrix],
        *([point(each) for each in row] for row in (found.center, found.moves)),
    )
    step = 1 - supply
    low, high = 1, int(supply / step)
    while low < high:
        middle = (low + high) // 2
        loop = about(
            law,
            loops(middle * step),
            center,
            Lengths(found.shortest, found.longest, found.back),
        )
        if beyond_limit(
            loop, Set(q, center, [each * loop.steady.away(point(found.drift)) for each in moves])
        ):
            low = middle + 1
        else:
            high = middle
    return high * step


def _solve(
    task: Task, faster: Faster, hints: Sequence[int], *, beyond: bool = False
) -> "tuple[Array, Array, float, tuple[int, ...]] | None":
    """Solve for some corners, and add those that are not met."""
    import numpy as np

    count = len(task.maps)
    # Where the way at the center has no sign, there are fewer corners.
    chosen = [each for each in hints if each < count] or list(range(0, count, max(1, count // FIRST_CORNERS)))
    for _ in range(ROUNDS):
        solved = _inequalities(task, chosen, faster, beyond=beyond)
        if solved is None:
            return None
        q, shares, inside = solved
        left = _left(q, shares, task.kept, task.maps)
        worst = [int(k) for k in np.argsort(left)[:MORE_CORNERS] if left[k] < 0.0 and int(k) not in chosen]
        if not worst:
            matter = tuple(int(k) for k in np.argsort(left)[: 2 * FIRST_CORNERS])
            return q, shares, inside, matter
        chosen += worst
    return None


def _inequalities(
    task: Task, chosen: Sequence[int], faster: Faster, *, beyond: bool
) -> "tuple[Array, Array, float] | None":
    """Minimize what is reached over what limits leave over Q, the shares and the multiplier of the faster ellipsoid.

    The unknowns are the entries of Q, one over each share, each share, one over the multiplier t and over 1 - t, and
    the square of what is reached over what the tightest limit leaves: at most 1, and minimized in place of the sum over
    all limits if ``beyond``.
    """
    import numpy as np

    kept = task.kept
    units, count = unit_matrices(STATES), task.maps.shape[2] - STATES
    first, second, last = len(units), len(units) + count, len(units) + 2 * count
    sizes = np.linalg.norm(task.maps[:, :, STATES:], axis=1).max(axis=0)
    sizes += LEAST * sizes.max()  # what the shares are counted in, so that their numbers are near each other
    asked = Inequalities(last + 3)
    for each in task.maps[list(chosen)]:
        state, columns = each[:, :STATES], each[:, STATES:].T
        parts = [(k, (1.0 - SLACK) * unit - state @ unit @ state.T / kept) for k, unit in enumerate(units)]
        parts += [(first + k, -np.outer(column, column) / sizes[k]) for k, column in enumerate(columns)]
        asked.semidefinite(np.zeros((STATES, STATES)), parts)
    for k in range(count):
        asked.semidefinite(np.array(CROSS), [(first + k, np.array(FIRST)), (second + k, np.array(SECOND))])
    total = np.zeros((1, last + 3))
    total[0, second:last] = sizes
    asked.at_most(total, np.array([1.0 - kept - 1e-7]))
    for row, left in task.limits:
        length = float(np.linalg.norm(row))
        reached = np.zeros((1, last + 3))
        reached[0, :first] = _reached(row / length)
        reached[0, last + 2] = -((left / length * (1.0 - SLACK)) ** 2)
        asked.at_most(reached, np.zeros(1))
    if not beyond:
        asked.at_most(np.eye(last + 3)[last + 2 :], np.ones(1))
    if faster is not None:
        back = np.linalg.inv(task.basis)
        inner = back @ np.array(faster[0].matrix, dtype=float) @ back.T
        for each in _apart(task, faster):
            apart = back @ each
            parts = [(k, (1.0 - SLACK) * unit) for k, unit in enumerate(units)]
            parts += [(last, -inner), (last + 1, -np.outer(apart, apart))]
            asked.semidefinite(np.zeros((STATES, STATES)), parts)
        one, other = (last, np.array(FIRST)), (last + 1, np.array(SECOND))
        asked.semidefinite(np.array(CROSS) - np.eye(2), [one, other])
    costs = np.zeros(last + 3)
    if beyond:
        costs[last + 2] = 1.0
    else:
        # Slower windows have less room, and their ellipsoids hold this one.
        costs[:first] = sum(_reached(row / left) for row, left in task.limits)
    found = asked.minimize(costs, rough=True)
    if found is None or not min(found[first:second]) > 0.0:
        return None
    inside = 1.0 / float(found[last]) if faster is not None else 0.5
    return np.tensordot(found[:first], units, 1), sizes / found[first:second], inside


def _apart(task: Task, faster: tuple[Ellipsoid, Steady]) -> "list[Array]":
    """Center of the faster ellipsoid less the one that is sought, at the least and at the largest common drift."""
    import numpy as np

    (inner, other), own = faster, task.steady
    center, moves = (np.array(each, dtype=float) for each in (inner.center, inner.moves))
    ends = (
        max(float(each.low.mid()) for each in (other, own)),
        min(float(each.high.mid()) for each in (other, own)),
    )
    return [
        center + moves * (end - float(inner.drift)) - task.center - task.moves * (end - float(task.drift))
        for end in ends
    ]


def _used(task: Task, q: "Array") -> list[float]:
    """Square of what is reached over what each limit leaves."""
    return [float(row @ q @ row) / left**2 for row, left in task.limits]


def _reached(row: "Array") -> "Array":
    """Square of what a row reaches, over the entries of Q."""
    import numpy as np

    return np.array([row @ unit @ row for unit in unit_matrices(STATES)])


def _left(q: "Array", shares: "Array", kept: float, maps: "Array") -> "Array":
    """Smallest eigenvalue of what is left over at each corner."""
    import numpy as np

    state, columns = maps[:, :, :STATES], maps[:, :, STATES:]
    left = q - np.einsum("nij,jk,nlk->nil", state, q / kept, state)
    left -= np.einsum("nik,k,nlk->nil", columns, 1.0 / shares, columns)
    smallest: Array = np.linalg.eigvalsh(left)[:, 0]
    return smallest


def _rounded(
    task: Task,
    choice: Choice,
    supply: Fraction,
    q: "Array",
    shares: "Array",
    inside: float,
) -> Ellipsoid:
    """Return what was found in numbers of the proof, which are shorter."""
    shares = shares * min(1.0, (1.0 - task.kept - 1e-7) / float(shares.sum()))  # where the solver gave up
    every = [Fraction(0)] * (len(DISTURBANCES) + 2)
    last = (len(DISTURBANCES), len(DISTURBANCES) + 1)[: len(shares) - 1 - len(task.used)]
    for k, share in zip((*task.used, *last), shares[1:], strict=True):
        every[k] = short(float(share))
    *every, steady, change = every
    return Ellipsoid(
        pulse=choice.pulse,
        supply=supply,
        near=choice.near,
        settled=choice.settled,
        shortest=task.lengths.shortest,
        longest=task.lengths.longest,
        back=task.lengths.back,
        room=choice.room,
        beyond=choice.beyond,
        curve=choice.curve,
        lag=choice.lag,
        matrix=tuple(tuple(short(float(each)) for each in row) for row in task.basis @ q @ task.basis.T),
        center=tuple(short(float(each)) for each in task.center),
        drift=task.drift,
        moves=tuple(short(float(each)) for each in task.moves),
        alpha=Fraction(task.kept),
        offset=short(float(shares[0])),
        shares=tuple(every),
        steady=steady,
        change=change,
        inside=short(inside),
    )
