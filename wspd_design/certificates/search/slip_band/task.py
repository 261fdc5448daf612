"""What the inequalities of an ellipsoid are made of: the loop about where it settles, in coordinates, in doubles."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from wspd_design.certificates.kernel.arb import point
from wspd_design.certificates.setting.slip_loop import (
    DISTURBANCES,
    STATES,
    LoopLaw,
    LoopRanges,
    Way,
    numbers_at_corners,
    sample,
    with_reference,
)
from wspd_design.certificates.theorems.slip_band.center import Lengths, about, way_at
from wspd_design.certificates.theorems.slip_band.checker import drifting
from wspd_design.certificates.theorems.slip_band.loop import Loop, Steady, spread_of
from wspd_design.certificates.theorems.slip_band.pulses import loop_law
from wspd_design.certificates.theorems.slip_band.statement import BandLaw

if TYPE_CHECKING:
    from wspd_design.certificates.search.matrix_inequalities import Array

SPREAD = 0.1  # of the room at the tightest limit, that the coordinates of the inequalities reach at least
SETTLING = 4  # times that what a loop settles at is looked for
WITHIN = 0.99  # of the errors between which the fading is bounded
LONGER = 0.04  # of the sample, by which the longest pulse at the center is longer than the shortest at least
BACK = 0.2  # of the way at the center, to its other side, that there is room for at least
HEIGHT = 0.95  # of the height that a pulse at the center goes a part of: it may fall to this, or rise to one over it
DIGITS = 7  # of the numbers in the proof


@dataclass(frozen=True, slots=True, kw_only=True)
class Task:
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


def centered(law: BandLaw, loop: Loop) -> tuple[Loop, tuple[Fraction, ...], Lengths]:
    """Return the loop about where it settles, that state, and the lengths of pulses there."""
    center = _center(law, loop)
    exact = [point(each) for each in center]
    lengths = _lengths(loop, exact)
    return about(law, loop, exact, lengths), center, lengths


def task_of(
    law: BandLaw, loop: Loop, center: tuple[Fraction, ...], lengths: Lengths, kept: float
) -> Task | None:
    """Set the inequalities up; None if the center is beyond a limit or the loop does not contract so much."""
    import numpy as np

    ends = np.array([[float(end.mid()) for end in each] for each in loop.disturbances])
    spread = (ends[:, 1] - ends[:, 0]) / 2.0
    used = tuple(int(k) for k in np.flatnonzero(spread > 0.0))
    maps, at_center = _maps(loop_law(law), loop.ranges)
    state, disturbed = maps[:, :, :STATES], maps[:, :, STATES:]
    mean, at = state.mean(axis=0), np.array(center, dtype=float)
    offset = at_center[:, :, :STATES] @ at - at + at_center[:, :, STATES:] @ _middle(loop)
    moves, drifting_columns = _moving(loop, state, disturbed)
    offset = offset - moves * float(loop.steady.rise.mid())
    columns = [offset[:, :, None], disturbed[:, :, used] * spread[list(used)], *drifting_columns]
    added = np.concatenate(columns, axis=2)
    limits = _limits(loop, at, moves)
    contracting = max(abs(np.linalg.eigvals(mean))) ** 2 < kept
    if min(room for _, room in limits) <= 0.0 or not contracting:
        return None
    basis = _basis(mean, added, limits, kept)
    back = np.linalg.inv(basis)
    return Task(
        maps=np.concatenate([back @ state @ basis, back @ added], axis=2),
        center=at,
        drift=_drift(loop),
        moves=moves,
        steady=loop.steady,
        lengths=lengths,
        basis=basis,
        limits=tuple((row @ basis, room) for row, room in limits),
        used=used,
        kept=kept,
    )


def contracts(law: BandLaw, loop: Loop) -> float:
    """Return the square of the largest eigenvalue of the loop at its corners, in size."""
    import numpy as np

    maps, _ = _maps(loop_law(law), loop.ranges)
    return float(np.abs(np.linalg.eigvals(maps[:, :, :STATES])).max()) ** 2


def _away(loop: Loop) -> float:
    """Largest distance of the steady drift from the one that the center is for."""
    return float(loop.steady.away(point(_drift(loop))).mid())


def _moving(loop: Loop, state: "Array", disturbed: "Array") -> "tuple[Array, list[Array]]":
    """Return how the center moves with the steady drift, and the columns that it and its change add, if there is one.

    The center goes to where the loop settles with another drift.
    """
    import numpy as np

    far, change = _away(loop), float(spread_of(loop.steady.change).mid())
    if far <= 0.0:
        return np.zeros(STATES), []
    drifted, mean = disturbed @ _drifting(loop), state.mean(axis=0)
    settles = np.linalg.solve(np.eye(STATES) - mean, drifted.mean(axis=0))
    moves = np.array([float(short(x)) for x in settles])
    left = state @ moves + drifted - moves
    return moves, [left[:, :, None] * far, np.broadcast_to(moves * change, left.shape)[:, :, None]]


def _limits(loop: Loop, at: "Array", moves: "Array") -> "list[tuple[Array, float]]":
    """Rows of the limits and of the error, which between samples is nearly the same, with what they leave."""
    import numpy as np

    error = np.eye(STATES)[0]
    reaching = [
        *(
            (np.array([float(each.mid()) for each in limit.row]), float(limit.bound.mid()))
            for limit in loop.limits
        ),
        *(
            (sign * error, float(sign * (end - point(loop.settled)).mid()))
            for sign, end in zip((1, -1), loop.widest[::-1], strict=True)
        ),
    ]
    far = _away(loop)
    return [(row, bound - float(row @ at) - far * abs(float(row @ moves))) for row, bound in reaching]


def _basis(mean: "Array", added: "Array", limits: "Sequence[tuple[Array, float]]", kept: float) -> "Array":
    """Coordinates in which what disturbs spreads alike in all directions."""
    import numpy as np
    from scipy.linalg import solve_discrete_lyapunov

    stirred = np.einsum("nik,njk->ij", added, added) / len(added) + 1e-12 * np.eye(STATES)
    spreads = solve_discrete_lyapunov(mean / kept**0.5, stirred)
    basis = np.linalg.cholesky((spreads + spreads.T) / 2.0) / (1.0 - kept) ** 0.5
    widest = max(float(np.linalg.norm(row @ basis)) / room for row, room in limits)
    found: Array = basis * max(1.0, SPREAD / widest)
    return found


def settling(law: BandLaw, loops: Callable[[Fraction], Loop]) -> Fraction:
    """Return the error of the wheel speed at which a loop settles; ``loops`` takes what errors are counted from."""
    lowest, highest = (WITHIN * float(end.mid()) for end in loops(Fraction(0)).settles)
    settled = Fraction(0)
    for _ in range(SETTLING):
        beside = float(_center(law, loops(settled))[0])
        settled = short(min(max(float(settled) + beside, lowest), highest))
    return settled


def _center(law: BandLaw, loop: Loop) -> tuple[Fraction, ...]:
    """Return the state in which the loop settles if nothing but the middle of all is there."""
    import numpy as np

    middle, rise = _middle(loop), float(loop.steady.rise.mid())
    center: tuple[Fraction, ...] | None = None
    for _ in range(SETTLING):
        # Once the side of the way is known, so are the parts that the valve goes.
        known = loop
        if center is not None:
            known = about(
                law, loop, [point(each) for each in center], Lengths(Fraction(0), Fraction(1), Fraction(1))
            )
        found = _maps(loop_law(law), known.ranges)[1].mean(axis=0)
        left, disturbed = np.eye(STATES) - found[:, :STATES], found[:, STATES:]
        # The center moves on as the drift changes.
        moved = np.linalg.solve(left, disturbed @ _drifting(loop)) * rise
        at = np.linalg.solve(left, disturbed @ middle - moved)
        center = tuple(short(float(each)) for each in at)
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
    return short(float((loop.steady.low + loop.steady.high).mid()) / 2.0)


def _drifting(loop: Loop) -> "Array":
    import numpy as np

    return np.array([float(each.mid()) for each in drifting(loop.steady)])


def _lengths(loop: Loop, center: Sequence[Any]) -> Lengths:
    """Return pulses of the way at the center if their height does not change much, and to as far on its other side."""
    way = float(way_at(loop, center).mid())
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
        shortest=short(shortest_and_longest[0]),
        longest=min(short(shortest_and_longest[1]), Fraction(longest)),
        back=min(short(back), Fraction(longest)) if loop.beyond == 1 else Fraction(longest),
    )


def _maps(law: LoopLaw, ranges: LoopRanges) -> "tuple[Array, Array]":
    """[A B] and that of the center at all corners, the sample's numbers as columns of an array."""
    import numpy as np

    law, ranges = _doubles(law), _doubles(ranges)
    both = np.array(list(numbers_at_corners(law, ranges)))
    units = with_reference(list(np.eye(STATES + len(DISTURBANCES))), ranges.brought)
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


def short(number: float) -> Fraction:
    """Return a number as the proof writes it."""
    return Fraction(float(f"{number:.{DIGITS}g}"))
