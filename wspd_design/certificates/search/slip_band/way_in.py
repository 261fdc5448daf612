"""Search for strips of friction and supply rate that cover the way from rolling; nothing here is trusted."""

import math
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING

from wspd_design.certificates.kernel.checker import Refused
from wspd_design.certificates.records import Problem
from wspd_design.certificates.setting.plant import plant_with
from wspd_design.certificates.theorems.slip_band.friction import FRICTION
from wspd_design.certificates.theorems.slip_band.way_in import SUPPLY, Piece, followed
from wspd_design.controllers.protection import Protection
from wspd_design.parameters.records import Rail, Vehicle

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

SHARES = (1.0, 0.5, 0.25, 0.0)  # of the range of the friction about its nominal value
WIDTHS = ((0.025, 0.01), (0.018, 0.008), (0.0125, 0.006), (0.006, 0.003))
"""Relative half width of a piece of the friction, and width of a strip over its supply rate."""
MOST = 400  # strips, with an effort of 1
SETTLED = 0.004  # slip beside the reference
LATER = {False: 0.3, True: 1.7}  # s, what is followed from there, and until the filters have settled as well
STEPS = 8  # strips between two stops that tell how long they are followed
SLIDING = 0.6  # of the reference, where wheels of a strip have the same slip
CHANGE = 0.01  # relative, by which a number is changed to see what it does


def plan(problem: Problem, law: Protection, effort: float, *, settled: bool) -> tuple[Piece, ...] | None:
    """Choose pieces and strips that the budget can follow, for the largest share of the friction; None if none can.

    The outer strips are tried; the checker follows all.
    """
    for share in SHARES:
        for half, width in WIDTHS:
            pieces = _pieces(problem, law, share, (half, width), MOST * effort, LATER[settled])
            if pieces is not None and _corners_hold(problem, law, pieces):
                return pieces
    return None


def _pieces(
    problem: Problem,
    law: Protection,
    share: float,
    widths: tuple[float, float],
    most: float,
    later: float,
) -> tuple[Piece, ...] | None:
    """Divide a share of the friction into pieces with strips, unless they are too many."""
    (half, width), nominal = widths, problem.nominal(FRICTION)
    low, high = problem.span(FRICTION)
    low, high = nominal + share * (low - nominal), nominal + share * (high - nominal)
    count = max(1, math.ceil(math.log(high / low) / (2.0 * half)))
    edges = [low * (high / low) ** (k / count) for k in range(count)] + [high]
    slowest, fastest = problem.span(SUPPLY)
    if count * math.log(fastest / slowest) / width > most:
        return None
    found = []
    for one, other in pairwise(edges):
        slope = _slope(problem, law, 0.5 * (one + other)) if share else 0.0
        shift = abs(slope) * 0.5 * (other - one) * (1.0 + 1e-9) + 1e-9 * slowest
        first, last = slowest - shift, fastest + shift
        number = max(1, math.ceil(math.log(last / first) / width))
        borders = tuple(first * (last / first) ** (k / number) for k in range(number + 1))
        piece = Piece(friction=(one, other), slope=slope, borders=borders, samples=(1,) * number)
        found.append(replace(piece, samples=_samples(problem, law, piece, later)))
    return tuple(found) if sum(len(each.samples) for each in found) <= most else None


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


def _corners_hold(problem: Problem, law: Protection, pieces: Sequence[Piece]) -> bool:
    """Follow the slowest and the fastest strip of the outer pieces."""
    chosen = [
        replace(each, borders=each.borders[k : k + 2], samples=each.samples[k : k + 1])
        for each in {0: pieces[0], len(pieces) - 1: pieces[-1]}.values()
        for k in sorted({0, len(each.samples) - 1})
    ]
    try:
        followed(problem, law, chosen)
    except Refused:
        return False
    return True
