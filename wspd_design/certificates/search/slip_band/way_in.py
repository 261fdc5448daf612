"""Search for strips of friction and supply rate that cover the way from rolling; nothing here is trusted."""

import math
from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING

from wspd_design.certificates.records import Problem
from wspd_design.certificates.setting.plant import plant_with
from wspd_design.certificates.theorems.slip_band.friction import FRICTION
from wspd_design.certificates.theorems.slip_band.way_in import (
    SUPPLY,
    Piece,
    Row,
    Strip,
    courses,
    strips_of,
)
from wspd_design.controllers.protection import Protection
from wspd_design.parameters.records import Rail, Vehicle

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from wspd_design.certificates.theorems.slip_band.arrival import Asked

    Array = NDArray[np.float64]

SHARES = (1.0, 0.5, 0.25, 0.0)  # of the range of the friction about its nominal value
HALVES = (0.04, 0.032, 0.025, 0.02, 0.016, 0.0125, 0.01, 0.008, 0.0063, 0.005, 0.004)
"""Relative half widths of a piece of the friction."""
WIDTH = 2.4  # relative width of a strip over its supply rate, over that half width
ROWS = 4  # of the supply rate; a slower one rises for longer, and wheels of a strip come further apart
MARGIN = 1.06  # by which a strip that is tried is wider
MOST = 400  # strips, with an effort of 1
SETTLED = 0.004  # slip beside the reference
LATER = {False: 0.3, True: 1.5}  # s, what is followed from there, and at most until filters have settled
STEPS = 8  # strips between two stops that tell how long they are followed
SLIDING = 0.6  # of the reference, where wheels of a strip have the same slip
CHANGE = 0.01  # relative, by which a number is changed to see what it does


def plan(
    problem: Problem, law: Protection, effort: float, asked: "Asked | None", share: float = 1.0
) -> tuple[Row, ...] | None:
    """Choose rows, pieces and strips of a share of the friction that the budget can follow; None if none can.

    The widest strips that hold are taken, as tried at the slow end of each row and the highest friction.

    Parameters
    ----------
    problem : Problem
        The box around the nominal numbers.
    law : Protection
        Sliding mode of relative degree two.
    effort : float
        Of the budget.
    asked : Asked, optional
        What a band asks for.
    share : float
        Of the range of the friction about its nominal value.
    """
    most, nominal = MOST * effort, problem.nominal(FRICTION)
    low, high = (end if share == 1.0 else nominal + share * (end - nominal) for end in problem.span(FRICTION))
    slowest, fastest = problem.span(SUPPLY)
    edges = [slowest * (fastest / slowest) ** (k / ROWS) for k in range(ROWS)] + [fastest]
    tried = [
        (row, half)
        for row in pairwise(edges)
        for half in HALVES
        if _number(high / low, row[1] / row[0], half) <= most
    ]
    strips = [_tried(problem, law, (low, high), row, half, asked is not None) for row, half in tried]
    found = courses(problem, law, strips, asked)
    rows: list[Row] = []
    for row in pairwise(edges):
        held = [half for (at, half), there in zip(tried, found.there, strict=True) if at == row and there]
        if not held:
            return None
        rows.append(_row(problem, law, (low, high), row, held[0], asked is not None))
        if len(strips_of(rows)) > most:
            return None
    return tuple(rows)


def _number(friction: float, supply: float, half: float) -> float:
    """Strips of a half width for a ratio of the friction and one of the supply rate, at least; slopes add some."""
    pieces = max(1, math.ceil(math.log(friction) / (2.0 * half)))
    return pieces * math.log(supply) / (WIDTH * half)


def _tried(
    problem: Problem,
    law: Protection,
    friction: tuple[float, float],
    row: tuple[float, float],
    half: float,
    settled: bool,
) -> Strip:
    """Return a strip at the slow end of a row and the highest friction, wider than it has to be."""
    low, high = friction
    piece = (low, high)
    if math.log(high / low) > 2.0 * half:
        piece = (high * math.exp(-2.0 * half * MARGIN), high)
    slope = _slope(problem, law, 0.5 * (piece[0] + piece[1])) if low < high else 0.0
    borders = (row[0], row[0] * math.exp(WIDTH * half * MARGIN))
    alone = Piece(friction=piece, slope=slope, borders=borders, samples=(1,))
    return Strip(replace(alone, samples=_samples(problem, law, alone, LATER[settled])), 0)


def _row(
    problem: Problem,
    law: Protection,
    friction: tuple[float, float],
    row: tuple[float, float],
    half: float,
    settled: bool,
) -> Row:
    """Divide the friction into pieces, and each piece into strips of the supply rates of a row."""
    (low, high), (slowest, fastest) = friction, row
    count = max(1, math.ceil(math.log(high / low) / (2.0 * half)))
    edges = [low * (high / low) ** (k / count) for k in range(count)] + [high]
    found = []
    for one, other in pairwise(edges):
        slope = _slope(problem, law, 0.5 * (one + other)) if low < high else 0.0
        shift = abs(slope) * 0.5 * (other - one) * (1.0 + 1e-9) + 1e-9 * slowest
        first, last = slowest - shift, fastest + shift
        number = max(1, math.ceil(math.log(last / first) / (WIDTH * half)))
        borders = tuple(first * (last / first) ** (k / number) for k in range(number + 1))
        piece = Piece(friction=(one, other), slope=slope, borders=borders, samples=(1,) * number)
        found.append(replace(piece, samples=_samples(problem, law, piece, LATER[settled])))
    return Row(supply=row, pieces=tuple(found))


def _stop(problem: Problem, law: Protection, friction: float, supply: float) -> "tuple[Array, Array]":
    """Times and slips of a simulated stop [s, -]."""
    import numpy as np

    from wspd_design.simulation.records import Scenario
    from wspd_design.simulation.stop import simulate

    vehicle, rail = _changed(problem, friction, supply)
    run = simulate(vehicle, law, Scenario(rail=rail, initial_speed=problem.speeds[1]), plant="quarter")
    return np.asarray(run.time), np.asarray(run.slip)[:, 0]


def _changed(problem: Problem, friction: float, supply: float) -> tuple[Vehicle, Rail]:
    vehicle, rail = plant_with(problem, {FRICTION: friction})
    return replace(vehicle, brake=replace(vehicle.brake, supply_rate=supply)), rail


def _slope(problem: Problem, law: Protection, friction: float) -> float:
    """Supply rate over the friction along which wheels reach the same slip at the same time [1/s]."""
    import numpy as np

    def reached(friction: float, supply: float) -> float:
        time, slip = _stop(problem, law, friction, supply)
        beyond = np.flatnonzero(slip >= SLIDING * problem.slip)
        if not beyond.size:
            return math.inf
        k = int(beyond[0])
        return float(np.interp(SLIDING * problem.slip, slip[k - 1 : k + 1], time[k - 1 : k + 1]))

    supply = problem.nominal(SUPPLY)
    by_friction = reached(friction * (1.0 + CHANGE), supply) - reached(friction * (1.0 - CHANGE), supply)
    by_supply = reached(friction, supply * (1.0 + CHANGE)) - reached(friction, supply * (1.0 - CHANGE))
    if not math.isfinite(by_friction) or not math.isfinite(by_supply) or by_supply == 0.0:
        return 0.0
    return -(by_friction / friction) / (by_supply / supply)


def _samples(problem: Problem, law: Protection, piece: Piece, later: float) -> tuple[int, ...]:
    """How long each strip is followed: until a stop at its slower end, or that of one before, has settled."""
    import numpy as np

    found: list[int] = []
    for first in range(0, len(piece.samples), STEPS):
        time, slip = _stop(problem, law, piece.friction[1], piece.borders[first])
        reached = np.flatnonzero(slip >= problem.slip - SETTLED)
        settled = float(time[reached[0]]) if reached.size else float(time[-1])
        found += [math.ceil((settled + later) / law.sample_time)] * min(STEPS, len(piece.samples) - first)
    return tuple(found)
