"""Search for the ellipsoid of one cell and one window, in doubles; the checker decides about it."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import TYPE_CHECKING

from wspd_design.certificates.kernel.arb import point
from wspd_design.certificates.kernel.checker import Refused
from wspd_design.certificates.search.common_quadratic import unit_matrices
from wspd_design.certificates.search.matrix_inequalities import Inequalities
from wspd_design.certificates.setting.slip_loop import DISTURBANCES, STATES, corners
from wspd_design.certificates.theorems.slip_band.checker import beyond_limit, errors, lies_in
from wspd_design.certificates.theorems.slip_band.loop import Loop, loop_law
from wspd_design.certificates.theorems.slip_band.proof import Ellipsoid
from wspd_design.certificates.theorems.slip_band.statement import BandLaw

if TYPE_CHECKING:
    from wspd_design.certificates.search.matrix_inequalities import Array

KEPT = (0.93, 0.85, 0.97)  # of the function after a sample without disturbance; the first that succeeds
FIRST_CORNERS, MORE_CORNERS, ROUNDS = 8, 8, 8  # of the loop that the inequalities begin with, and are added
SPREAD = 0.1  # of the room at the tightest limit, that the coordinates of the inequalities reach at least
SLACK = 1e-3  # what the inequalities ask beyond what is to be shown, so that rounding does not spoil it
DIGITS = 9  # of the numbers in the proof


@dataclass(frozen=True, slots=True, kw_only=True)
class _Task:
    """What the inequalities are made of, in coordinates z, X - c = basis z, in which their numbers are near 1."""

    maps: "Array"  # [A o Br] at all corners
    center: "Array"
    basis: "Array"
    limits: tuple[tuple["Array", float], ...]  # rows, and what is left beside the center
    used: tuple[int, ...]  # disturbances


def ellipsoid(
    law: BandLaw,
    loops: Callable[[Fraction], Loop],
    pulse: Fraction,
    supply: Fraction,
    faster: Ellipsoid | None,
    hints: Sequence[int],
) -> tuple[Ellipsoid, tuple[int, ...]] | None:
    """Find an ellipsoid with a small band around that of the next faster window, or none.

    It is sought with the room that this share of the full pressure leaves; then the least share is found in which its
    states have room.

    Parameters
    ----------
    law : BandLaw
        Numbers of the law.
    loops : callable
        Returns the numbers of cell and window with this longest pulse for the least share of the full pressure.
    pulse : Fraction
        Longest pulse over the sample time.
    supply : Fraction
        Share of the full pressure that the search may ask for.
    faster : Ellipsoid or None
        Of the next faster window.
    hints : sequence of int
        Corners of the loop that mattered in another window or cell.

    Returns
    -------
    tuple of Ellipsoid and corners, or None
        The ellipsoid, and the corners that mattered.
    """
    loop = loops(supply)
    for kept in KEPT:
        task = _task(law, loop, kept)
        if task is None:
            return None
        solved = _solve(task, pulse, supply, kept, faster, hints)
        if solved is None:
            continue
        found, corners_that_matter = solved
        found = replace(found, supply=_least_supply(loops, supply, found))
        try:
            errors(law, loops(found.supply), found)
        except Refused:
            continue
        if faster is None or lies_in(faster, found):
            return found, corners_that_matter
    return None


def _least_supply(loops: Callable[[Fraction], Loop], supply: Fraction, found: Ellipsoid) -> Fraction:
    """Return the least share of the full pressure, in steps of what this one lacks, that the states have room in."""
    if supply == 1:
        return supply
    p, center = (
        [[point(each) for each in row] for row in found.matrix],
        [point(each) for each in found.center],
    )
    step = 1 - supply
    low, high = 1, int(supply / step)
    while low < high:
        middle = (low + high) // 2
        if beyond_limit(loops(middle * step), p, center):
            low = middle + 1
        else:
            high = middle
    return high * step


def _task(law: BandLaw, loop: Loop, kept: float) -> _Task | None:
    """Set the inequalities up; None if the center is beyond a limit or the loop does not contract so much."""
    import numpy as np
    from scipy.linalg import solve_discrete_lyapunov

    ends = np.array([[float(end.mid()) for end in each] for each in loop.disturbances])
    middle, spread = ends.mean(axis=1), (ends[:, 1] - ends[:, 0]) / 2.0
    used = tuple(int(k) for k in np.flatnonzero(spread > 0.0))
    maps = np.array([_doubles(each) for each in corners(loop_law(law), loop.ranges)])
    state, disturbed = maps[:, :, :STATES], maps[:, :, STATES:]
    mean = state.mean(axis=0)
    # Where the loop would settle if nothing but the middle of all were there.
    center = np.linalg.solve(np.eye(STATES) - mean, disturbed.mean(axis=0) @ middle)
    center = np.array([float(_short(each)) for each in center])
    offset = state @ center - center + disturbed @ middle
    columns = np.concatenate([offset[:, :, None], disturbed[:, :, used] * spread[list(used)]], axis=2)
    limits = [(np.array([float(each.mid()) for each in limit.row]), limit) for limit in loop.limits]
    rooms = [float(limit.bound.mid()) - float(row @ center) for row, limit in limits]
    contracting = max(abs(np.linalg.eigvals(mean))) ** 2 < kept
    if min(rooms) <= 0.0 or not contracting:
        return None
    # Coordinates in which what disturbs spreads alike in all directions.
    stirred = np.einsum("nik,njk->ij", columns, columns) / len(columns) + 1e-12 * np.eye(STATES)
    spreads = solve_discrete_lyapunov(mean / kept**0.5, stirred)
    basis = np.linalg.cholesky((spreads + spreads.T) / 2.0) / (1.0 - kept) ** 0.5
    rows = [row @ basis for row, _ in limits]
    widest = max(float(np.linalg.norm(row)) / room for row, room in zip(rows, rooms, strict=True))
    basis = basis * max(1.0, SPREAD / widest)
    back = np.linalg.inv(basis)
    return _Task(
        maps=np.concatenate([back @ state @ basis, back @ columns], axis=2),
        center=center,
        basis=basis,
        limits=tuple((row @ basis, room) for (row, _), room in zip(limits, rooms, strict=True)),
        used=used,
    )


def _solve(
    task: _Task,
    pulse: Fraction,
    supply: Fraction,
    kept: float,
    faster: Ellipsoid | None,
    hints: Sequence[int],
) -> tuple[Ellipsoid, tuple[int, ...]] | None:
    """Solve for some corners, and add those that are not met."""
    import numpy as np

    count = len(task.maps)
    chosen = list(hints) or list(range(0, count, max(1, count // FIRST_CORNERS)))
    for _ in range(ROUNDS):
        solved = _inequalities(task, chosen, kept, faster)
        if solved is None:
            return None
        p, shares, inside = solved
        left = _left(p, shares, kept, task.maps)
        worst = [int(k) for k in np.argsort(left)[:MORE_CORNERS] if left[k] < 0.0 and int(k) not in chosen]
        if not worst:
            matter = tuple(int(k) for k in np.argsort(left)[: 2 * FIRST_CORNERS])
            return _rounded(task, pulse, supply, p, shares, kept, inside), matter
        chosen += worst
    return None


def _inequalities(
    task: _Task, chosen: Sequence[int], kept: float, faster: Ellipsoid | None
) -> "tuple[Array, Array, float] | None":
    """Minimize the largest error over P, the shares and the multiplier of the faster ellipsoid."""
    import numpy as np

    units, count = unit_matrices(STATES), len(task.used) + 1
    first, band, size = len(units), len(units) + count, STATES + count
    asked = Inequalities(band + 2)
    for each in task.maps[list(chosen)]:
        parts = [
            (k, _padded(kept * (1.0 - SLACK) * unit, size) - each.T @ unit @ each)
            for k, unit in enumerate(units)
        ]
        for k in range(count):
            share = np.zeros((size, size))
            share[STATES + k, STATES + k] = 1.0 - SLACK
            parts.append((first + k, share))
        asked.semidefinite(np.zeros((size, size)), parts)
    total = np.zeros((1, band + 2))
    total[0, first:band] = 1.0
    asked.at_most(total, np.array([1.0 - kept - 1e-7]))
    largest = np.zeros((STATES + 1, STATES + 1))
    largest[STATES, STATES] = 1.0
    blocks = [(k, _padded(unit, STATES + 1)) for k, unit in enumerate(units)]
    error = task.basis[0] / np.linalg.norm(task.basis[0])
    asked.semidefinite(_edge(error, 0.0), [*blocks, (band, largest)])
    for row, left in task.limits:
        length = float(np.linalg.norm(row))
        asked.semidefinite(_edge(row / length, (left / length * (1.0 - SLACK)) ** 2), blocks)
    if faster is not None:
        _around(asked, task, faster, band + 1)
    found = asked.minimize(np.eye(band + 2)[band], rough=True)
    if found is None or not sum(found[first:band]) > 0.0:
        return None
    return np.tensordot(found[:first], units, 1), found[first:band], float(found[band + 1])


def _around(asked: Inequalities, task: _Task, faster: Ellipsoid, unknown: int) -> None:
    """Ask that the faster ellipsoid lies inside, with its multiplier as the unknown of this number."""
    import numpy as np

    inner = task.basis.T @ np.array(faster.matrix, dtype=float) @ task.basis
    apart = np.linalg.solve(task.basis, np.array(faster.center, dtype=float) - task.center)
    size = float(np.trace(inner))
    shape = np.diag([*[size**-0.5] * STATES, 1.0])  # so that all entries are near 1
    multiplier = _padded(inner, STATES + 1)
    multiplier[STATES, STATES] = -1.0
    parts = [(unknown, shape @ multiplier @ shape)]
    for k, unit in enumerate(unit_matrices(STATES)):
        moved = np.hstack([np.eye(STATES), apart[:, None]])
        parts.append((k, -shape @ moved.T @ unit @ moved @ shape))
    corner = np.zeros((STATES + 1, STATES + 1))
    corner[STATES, STATES] = 1.0
    asked.semidefinite(corner * (1.0 - SLACK), parts)


def _padded(matrix: "Array", size: int) -> "Array":
    import numpy as np

    return np.pad(matrix, (0, size - len(matrix)))


def _edge(row: "Array", corner: float) -> "Array":
    """[[0, row'], [row, corner]]."""
    import numpy as np

    block = np.zeros((STATES + 1, STATES + 1))
    block[STATES, :STATES] = block[:STATES, STATES] = row
    block[STATES, STATES] = corner
    return block


def _left(p: "Array", shares: "Array", kept: float, maps: "Array") -> "Array":
    """Smallest eigenvalue of what is left over at each corner."""
    import numpy as np

    left = _padded(kept * p, STATES + len(shares)) - np.einsum("nki,kl,nlj->nij", maps, p, maps)
    places = np.arange(STATES, STATES + len(shares))
    left[:, places, places] += shares
    smallest: Array = np.linalg.eigvalsh(left)[:, 0]
    return smallest


def _rounded(
    task: _Task,
    pulse: Fraction,
    supply: Fraction,
    p: "Array",
    shares: "Array",
    kept: float,
    inside: float,
) -> Ellipsoid:
    import numpy as np

    back = np.linalg.inv(task.basis)
    shares = shares * min(1.0, (1.0 - kept - 1e-7) / float(shares.sum()))  # where the solver gave up
    every = [Fraction(0)] * len(DISTURBANCES)
    for k, share in zip(task.used, shares[1:], strict=True):
        every[k] = _short(float(share))
    return Ellipsoid(
        pulse=pulse,
        supply=supply,
        matrix=tuple(tuple(_short(float(each)) for each in row) for row in back.T @ p @ back),
        center=tuple(_short(float(each)) for each in task.center),
        alpha=Fraction(kept),
        offset=_short(float(shares[0])),
        shares=tuple(every),
        inside=_short(max(inside, 0.0)),
    )


def _short(number: float) -> Fraction:
    return Fraction(float(f"{number:.{DIGITS}g}"))


def _doubles(matrix: Sequence[Sequence[object]]) -> "Array":
    import numpy as np

    return np.array([[float(each) for each in row] for row in matrix])  # type: ignore[arg-type]
