"""Search for the ellipsoid of one cell and one window, in doubles; the checker decides about it."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace
from fractions import Fraction
from typing import TYPE_CHECKING, Any, TypeAlias

from wspd_design.certificates.kernel.arb import point
from wspd_design.certificates.kernel.checker import Refused
from wspd_design.certificates.search.common_quadratic import unit_matrices
from wspd_design.certificates.search.matrix_inequalities import Inequalities
from wspd_design.certificates.setting.slip_loop import (
    DISTURBANCES,
    STATES,
    LoopLaw,
    LoopRanges,
    Way,
    numbers_at_corners,
    sample,
)
from wspd_design.certificates.theorems.slip_band.center import Lengths, about, way_at
from wspd_design.certificates.theorems.slip_band.checker import (
    Set,
    beyond_limit,
    drifting,
    errors,
    lies_in,
)
from wspd_design.certificates.theorems.slip_band.loop import Choice, Loop, Steady
from wspd_design.certificates.theorems.slip_band.proof import Ellipsoid
from wspd_design.certificates.theorems.slip_band.pulses import loop_law
from wspd_design.certificates.theorems.slip_band.statement import BandLaw

if TYPE_CHECKING:
    from wspd_design.certificates.search.matrix_inequalities import Array

KEPT = (0.95, 0.92, 0.85)  # of the function after a sample without disturbance; the first that succeeds
FIRST_CORNERS, MORE_CORNERS, ROUNDS = 8, 8, 8  # of the loop that the inequalities begin with, and are added
SPREAD = 0.1  # of the room at the tightest limit, that the coordinates of the inequalities reach at least
SLACK = 1e-3  # what the inequalities ask beyond what is to be shown, so that rounding does not spoil it
SETTLING = 4  # times that what a loop settles at is looked for
WITHIN = 0.99  # of the errors between which the fading is bounded
LONGER = 0.04  # of the sample, by which the longest pulse at the center is longer than the shortest at least
BACK = 0.2  # of the way at the center, to its other side, that there is room for at least
HEIGHT = 0.9  # of the height that a pulse at the center goes a part of: it may fall to this, or rise to one over it
DIGITS = 7  # of the numbers in the proof
LEAST = 1e-6  # of what disturbs most, as which anything else counts at least
# [[x, 1], [1, y]] = x FIRST + y SECOND + CROSS is positive semidefinite if y is at least 1/x.
FIRST, SECOND, CROSS = ((1.0, 0.0), (0.0, 0.0)), ((0.0, 0.0), (0.0, 1.0)), ((0.0, 1.0), (1.0, 0.0))


Faster: TypeAlias = tuple[Ellipsoid, Steady] | None
"""Ellipsoid of the next faster window with the steady drift there."""
Loops: TypeAlias = Callable[[Fraction], Loop]
"""Numbers of cell and window for the least share of the full pressure."""


@dataclass(frozen=True, slots=True, kw_only=True)
class _Task:
    """What the inequalities are made of, in coordinates z, X - c = basis z, in which their numbers are near 1."""

    maps: "Array"  # [A o Br] at all corners, with what the steady drift adds as last columns
    center: "Array"
    drift: Fraction  # steady one that the center is for
    moves: "Array"  # of the center with that
    steady: Steady
    lengths: Lengths
    basis: "Array"
    limits: tuple[tuple["Array", float], ...]  # rows, and what is left beside the center
    used: tuple[int, ...]  # disturbances
    kept: float


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
    there = _centered(law, loops(supply))
    for kept in KEPT:
        task = _task(law, *there, kept)
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


def excess(law: BandLaw, loops: Loops, supply: Fraction, faster: Faster, hints: Sequence[int]) -> float:
    """Return by how much an ellipsoid would exceed its tightest limit, squared; infinite if there is none at all."""
    there = _centered(law, loops(supply))
    for kept in KEPT:
        task = _task(law, *there, kept)
        solved = None if task is None else _solve(task, faster, hints, beyond=True)
        if task is not None and solved is not None:
            return max(_used(task, solved[0]))
    return math.inf


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


def _centered(law: BandLaw, loop: Loop) -> tuple[Loop, tuple[Fraction, ...], Lengths]:
    """Return the loop about where it settles, that state, and the lengths of pulses there."""
    center = _center(law, loop)
    exact = [point(each) for each in center]
    lengths = _lengths(law, loop, exact)
    return about(law, loop, exact, lengths), center, lengths


def _task(
    law: BandLaw, loop: Loop, center: tuple[Fraction, ...], lengths: Lengths, kept: float
) -> _Task | None:
    """Set the inequalities up; None if the center is beyond a limit or the loop does not contract so much."""
    import numpy as np
    from scipy.linalg import solve_discrete_lyapunov

    ends = np.array([[float(end.mid()) for end in each] for each in loop.disturbances])
    spread = (ends[:, 1] - ends[:, 0]) / 2.0
    used = tuple(int(k) for k in np.flatnonzero(spread > 0.0))
    maps, at_center = _maps(loop_law(law), loop.ranges)
    state, disturbed = maps[:, :, :STATES], maps[:, :, STATES:]
    mean, at = state.mean(axis=0), np.array(center, dtype=float)
    offset = at_center[:, :, :STATES] @ at - at + at_center[:, :, STATES:] @ _middle(loop)
    columns = [offset[:, :, None], disturbed[:, :, used] * spread[list(used)]]
    drift = _drift(loop)
    far, change = (float(each.mid()) for each in (loop.steady.away(point(drift)), loop.steady.change))
    moves = np.zeros(STATES)
    if far > 0.0:
        # The center goes to where the loop settles with another drift.
        drifted = disturbed @ _drifting(loop)
        moves = np.array(
            [float(_short(x)) for x in np.linalg.solve(np.eye(STATES) - mean, drifted.mean(axis=0))]
        )
        left = state @ moves + drifted - moves
        columns += [left[:, :, None] * far, np.broadcast_to(moves * change, left.shape)[:, :, None]]
    added = np.concatenate(columns, axis=2)
    reaching = [np.array([float(each.mid()) for each in limit.row]) for limit in loop.limits]
    # The error, between samples nearly the same.
    reaching += [np.eye(STATES)[0], -np.eye(STATES)[0]]
    bounds = [
        *(float(limit.bound.mid()) for limit in loop.limits),
        *(
            float(sign * (end - point(loop.settled)).mid())
            for sign, end in zip((1, -1), loop.widest[::-1], strict=True)
        ),
    ]
    rooms = [
        bound - float(row @ at) - far * abs(float(row @ moves))
        for row, bound in zip(reaching, bounds, strict=True)
    ]
    contracting = max(abs(np.linalg.eigvals(mean))) ** 2 < kept
    if min(rooms) <= 0.0 or not contracting:
        return None
    # Coordinates in which what disturbs spreads alike in all directions.
    stirred = np.einsum("nik,njk->ij", added, added) / len(added) + 1e-12 * np.eye(STATES)
    spreads = solve_discrete_lyapunov(mean / kept**0.5, stirred)
    basis = np.linalg.cholesky((spreads + spreads.T) / 2.0) / (1.0 - kept) ** 0.5
    rows = [row @ basis for row in reaching]
    widest = max(float(np.linalg.norm(row)) / room for row, room in zip(rows, rooms, strict=True))
    basis = basis * max(1.0, SPREAD / widest)
    back = np.linalg.inv(basis)
    return _Task(
        maps=np.concatenate([back @ state @ basis, back @ added], axis=2),
        center=at,
        drift=drift,
        moves=moves,
        steady=loop.steady,
        lengths=lengths,
        basis=basis,
        limits=tuple((row @ basis, room) for row, room in zip(reaching, rooms, strict=True)),
        used=used,
        kept=kept,
    )


def _center(law: BandLaw, loop: Loop) -> tuple[Fraction, ...]:
    """Return the state in which the loop settles if nothing but the middle of all is there."""
    import numpy as np

    middle = _middle(loop)
    center: tuple[Fraction, ...] | None = None
    for _ in range(SETTLING):
        # Once the side of the way is known, so are the parts that the valve goes.
        known = loop
        if center is not None:
            known = about(
                law, loop, [point(each) for each in center], Lengths(Fraction(0), Fraction(1), Fraction(1))
            )
        found = _maps(loop_law(law), known.ranges)[1].mean(axis=0)
        at = np.linalg.solve(np.eye(STATES) - found[:, :STATES], found[:, STATES:] @ middle)
        center = tuple(_short(float(each)) for each in at)
    assert center is not None
    return center


def _middle(loop: Loop) -> "Array":
    """Middle of what disturbs, the steady drift among it."""
    import numpy as np

    ends = np.array([[float(end.mid()) for end in each] for each in loop.disturbances])
    middle: Array = ends.mean(axis=1) + float(_drift(loop)) * _drifting(loop)
    return middle


def _drift(loop: Loop) -> Fraction:
    """Middle of the steady drift."""
    return _short(float((loop.steady.low + loop.steady.high).mid()) / 2.0)


def _drifting(loop: Loop) -> "Array":
    import numpy as np

    return np.array([float(each.mid()) for each in drifting(loop.steady)])


def settling(law: BandLaw, loops: Callable[[Fraction], Loop]) -> Fraction:
    """Return the error of the wheel speed at which a loop settles; ``loops`` takes what errors are counted from."""
    lowest, highest = (WITHIN * float(end.mid()) for end in loops(Fraction(0)).settles)
    settled = Fraction(0)
    for _ in range(SETTLING):
        beside = float(_center(law, loops(settled))[0])
        settled = _short(min(max(float(settled) + beside, lowest), highest))
    return settled


def _lengths(law: BandLaw, loop: Loop, center: Sequence[Any]) -> Lengths:
    """Return pulses of the way at the center if their height does not change much, and to as far on its other side."""
    way = float(way_at(law, loop, center).mid())
    side, other = loop.pulses if way > 0.0 else loop.pulses[::-1]
    torque, time = side.rises * float(center[3].mid()), float(side.time.mid())
    longest = float(loop.pulse.mid())
    low, high = (float(end.mid()) + torque for end in side.height)
    shortest_and_longest = [
        -time * math.log1p(-abs(way) / height) if abs(way) < height else longest
        for height in (high / HEIGHT, low * HEIGHT)
    ]
    # Where pulses are short, a longer one makes little difference, and less supply is asked for.
    shortest_and_longest[1] = max(shortest_and_longest[1], shortest_and_longest[0] + LONGER)
    way_back = max(float(side.part(loop.pulse).mid()) * low - 2.0 * abs(way), BACK * abs(way))
    there = float(other.height[0].mid()) + other.rises * float(center[3].mid())
    back = -float(other.time.mid()) * math.log1p(-min(way_back / there, 0.5))
    return Lengths(
        shortest=_short(shortest_and_longest[0]),
        longest=min(_short(shortest_and_longest[1]), Fraction(longest)),
        back=min(_short(back), Fraction(longest)),
    )


def _solve(
    task: _Task, faster: Faster, hints: Sequence[int], *, beyond: bool = False
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
    task: _Task, chosen: Sequence[int], faster: Faster, *, beyond: bool
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


def _apart(task: _Task, faster: tuple[Ellipsoid, Steady]) -> "list[Array]":
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


def _used(task: _Task, q: "Array") -> list[float]:
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
    task: _Task,
    choice: Choice,
    supply: Fraction,
    q: "Array",
    shares: "Array",
    inside: float,
) -> Ellipsoid:

    shares = shares * min(1.0, (1.0 - task.kept - 1e-7) / float(shares.sum()))  # where the solver gave up
    every = [Fraction(0)] * (len(DISTURBANCES) + 2)
    last = (len(DISTURBANCES), len(DISTURBANCES) + 1)[: len(shares) - 1 - len(task.used)]
    for k, share in zip((*task.used, *last), shares[1:], strict=True):
        every[k] = _short(float(share))
    *every, steady, change = every
    return Ellipsoid(
        pulse=choice.pulse,
        supply=supply,
        near=choice.near,
        settled=choice.settled,
        shortest=task.lengths.shortest,
        longest=task.lengths.longest,
        back=task.lengths.back,
        matrix=tuple(tuple(_short(float(each)) for each in row) for row in task.basis @ q @ task.basis.T),
        center=tuple(_short(float(each)) for each in task.center),
        drift=task.drift,
        moves=tuple(_short(float(each)) for each in task.moves),
        alpha=Fraction(task.kept),
        offset=_short(float(shares[0])),
        shares=tuple(every),
        steady=steady,
        change=change,
        inside=_short(inside),
    )


def _short(number: float) -> Fraction:
    return Fraction(float(f"{number:.{DIGITS}g}"))


def _maps(law: LoopLaw, ranges: LoopRanges) -> "tuple[Array, Array]":
    """[A B] and that of the center at all corners, the sample's numbers as columns of an array."""
    import numpy as np

    law, ranges = _doubles(law), _doubles(ranges)
    both = np.array(list(numbers_at_corners(law, ranges)))
    units = list(np.eye(STATES + len(DISTURBANCES)))
    rest, center = (
        np.stack(np.broadcast_arrays(*sample(law, list(numbers.T[:, :, None]), units)), axis=1)
        for numbers in (both[:, 0], both[:, 1])
    )
    return rest, center


def _doubles(record: Any) -> Any:
    """Return the record with doubles in place of balls."""
    return replace(record, **{each.name: _double(getattr(record, each.name)) for each in fields(record)})


def _double(value: Any) -> Any:
    if isinstance(value, Way):
        return Way(*map(float, value))
    return tuple(map(_double, value)) if isinstance(value, tuple) else float(value)
