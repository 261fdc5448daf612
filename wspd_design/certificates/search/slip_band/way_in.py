"""Search for strips of friction and supply rate that cover the way from rolling; nothing here is trusted."""

import math
from collections.abc import Mapping
from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

from wspd_design.certificates.records import Problem
from wspd_design.certificates.setting.plant import plant_with
from wspd_design.certificates.theorems.slip_band.friction import FRICTION
from wspd_design.certificates.theorems.slip_band.way_in import (
    NEAR,
    SUPPLY,
    TILTING,
    Piece,
    Row,
    Strip,
    courses,
    strips_of,
    tilt,
)
from wspd_design.controllers.protection import Protection

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from wspd_design.certificates.theorems.slip_band.arrival import Asked

    Array = NDArray[np.float64]

Powers: TypeAlias = Mapping[str, float]
"""Of each number, in the supply rate of a strip."""

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


class WantedRow(NamedTuple):
    """A row that is to be covered by strips."""

    friction: tuple[float, float]  # -
    supply: tuple[float, float]  # 1/s
    powers: Powers
    later: float  # s, that strips are followed for after they have come to the reference


def powers_of(problem: Problem, law: Protection, share: float) -> dict[tuple[float, float], Powers]:
    """Return the powers of the numbers for each row of the supply rate, about the middle of a share of the friction."""
    low, high = _friction(problem, share)
    return {row: _powers(problem, law, math.sqrt(low * high), row) for row in _supply_rows(problem)}


def _friction(problem: Problem, share: float) -> tuple[float, float]:
    """Return a share of the range of the friction about its nominal value."""
    nominal, (low, high) = problem.nominal(FRICTION), problem.span(FRICTION)
    return (
        (low, high)
        if share == 1.0
        else (nominal + share * (low - nominal), nominal + share * (high - nominal))
    )


def _supply_rows(problem: Problem) -> list[tuple[float, float]]:
    """Divide the range of the supply rate into rows."""
    slowest, fastest = problem.span(SUPPLY)
    return list(pairwise([*(slowest * (fastest / slowest) ** (k / ROWS) for k in range(ROWS)), fastest]))


def plan(
    problem: Problem,
    law: Protection,
    effort: float,
    asked: "Asked | None",
    powers: Mapping[tuple[float, float], Powers],
    share: float = 1.0,
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
    powers : mapping of a range of the supply rate to powers
        Of :func:`powers_of`; they do not depend on how far the other numbers reach.
    share : float
        Of the range of the friction about its nominal value.
    """
    most, (low, high) = MOST * effort, _friction(problem, share)
    later = LATER[asked is not None]
    wanted = [WantedRow((low, high), row, powers[row], later) for row in powers]
    tried = [
        (each, half)
        for each in wanted
        for half in HALVES
        if _number(high / low, each.supply[1] / each.supply[0], half) <= most
    ]
    found = courses(problem, law, [_tried(problem, law, each, half) for each, half in tried], asked)
    rows: list[Row] = []
    for each in wanted:
        held = [half for (one, half), there in zip(tried, found.there, strict=True) if one is each and there]
        if not held:
            return None
        rows.append(_row(problem, law, each, held[0]))
        if len(strips_of(rows)) > most:
            return None
    return tuple(rows)


def _number(friction: float, supply: float, half: float) -> float:
    """Strips of a half width for a ratio of the friction and one of the supply rate, at least; slopes add some."""
    pieces = max(1, math.ceil(math.log(friction) / (2.0 * half)))
    return pieces * math.log(supply) / (WIDTH * half)


def _tried(problem: Problem, law: Protection, wanted: WantedRow, half: float) -> Strip:
    """Return a strip at the slow end of a row and the highest friction, wider than it has to be."""
    low, high = wanted.friction
    piece = (low, high)
    if math.log(high / low) > 2.0 * half:
        piece = (high * math.exp(-2.0 * half * MARGIN), high)
    alone = _whole(problem, piece, wanted.supply, wanted.powers)
    slowest = wanted.supply[0] - tilt(problem, alone)
    alone = replace(alone, borders=(slowest, slowest * math.exp(WIDTH * half * MARGIN)))
    return Strip(replace(alone, samples=_samples(problem, law, alone, wanted.later)), 0)


def _row(problem: Problem, law: Protection, wanted: WantedRow, half: float) -> Row:
    """Divide the friction into pieces, and each piece into strips of the supply rates of a row."""
    (low, high), (slowest, fastest) = wanted.friction, wanted.supply
    count = max(1, math.ceil(math.log(high / low) / (2.0 * half)))
    edges = [low * (high / low) ** (k / count) for k in range(count)] + [high]
    found = []
    for ends in pairwise(edges):
        alone = _whole(problem, ends, wanted.supply, wanted.powers)
        shift = tilt(problem, alone) * (1.0 + 1e-9) + 1e-9 * slowest
        first, last = slowest - shift, fastest + shift
        number = max(1, math.ceil(math.log(last / first) / (WIDTH * half)))
        borders = tuple(first * (last / first) ** (k / number) for k in range(number + 1))
        piece = replace(alone, borders=borders, samples=(1,) * number)
        found.append(replace(piece, samples=_samples(problem, law, piece, wanted.later)))
    return Row(supply=wanted.supply, pieces=tuple(found))


def _stop(
    problem: Problem, law: Protection, supply: float, changed: Mapping[str, float]
) -> "tuple[Array, Array]":
    """Times and slips of a simulated stop, with a supply rate and numbers that are not the nominal ones [s, -]."""
    import numpy as np

    from wspd_design.simulation.records import Scenario
    from wspd_design.simulation.stop import simulate

    vehicle, rail = plant_with(problem, changed)
    vehicle = replace(vehicle, brake=replace(vehicle.brake, supply_rate=supply))
    run = simulate(vehicle, law, Scenario(rail=rail, initial_speed=problem.speeds[1]), plant="quarter")
    return np.asarray(run.time), np.asarray(run.slip)[:, 0]


def _whole(
    problem: Problem, friction: tuple[float, float], row: tuple[float, float], powers: Powers
) -> Piece:
    """Return a piece with one strip, whose supply rate follows the powers of its numbers."""
    middles = {name: problem.nominal(name) for name in NEAR} | {FRICTION: 0.5 * (friction[0] + friction[1])}
    supply = math.sqrt(row[0] * row[1])
    slopes = tuple(powers[name] * supply / middles[name] for name in TILTING)
    return Piece(friction=friction, slopes=slopes, borders=row, samples=(1,))


def _powers(problem: Problem, law: Protection, friction: float, row: tuple[float, float]) -> Powers:
    """Powers of the numbers with which the supply rate goes along which wheels slide at the same time.

    Parameters
    ----------
    problem, law : Problem, Protection
        What is followed.
    friction : float
        About which they are worked out [-].
    row : tuple of float
        Range of the supply rate about whose middle they are [1/s].
    """
    nominal = {FRICTION: friction} | {name: problem.nominal(name) for name in NEAR}
    supply = math.sqrt(row[0] * row[1])
    less, more = 1.0 - CHANGE, 1.0 + CHANGE
    by_supply = _slides(problem, law, supply * more, nominal) - _slides(problem, law, supply * less, nominal)
    found = {}
    for name, value in nominal.items():
        later, sooner = (_slides(problem, law, supply, nominal | {name: value * end}) for end in (more, less))
        power = (sooner - later) / by_supply if by_supply else math.inf
        found[name] = power if math.isfinite(power) else 0.0
    return found


def _slides(problem: Problem, law: Protection, supply: float, changed: Mapping[str, float]) -> float:
    """When a wheel of a simulated stop slides [s]."""
    import numpy as np

    time, slip = _stop(problem, law, supply, changed)
    beyond = np.flatnonzero(slip >= SLIDING * problem.slip)
    if not beyond.size:
        return math.inf
    k = int(beyond[0])
    return float(np.interp(SLIDING * problem.slip, slip[k - 1 : k + 1], time[k - 1 : k + 1]))


def _samples(problem: Problem, law: Protection, piece: Piece, later: float) -> tuple[int, ...]:
    """How long each strip is followed: until a stop at its slower end, or that of one before, has settled."""
    import numpy as np

    found: list[int] = []
    for first in range(0, len(piece.samples), STEPS):
        time, slip = _stop(problem, law, piece.borders[first], {FRICTION: piece.friction[1]})
        reached = np.flatnonzero(slip >= problem.slip - SETTLED)
        settled = float(time[reached[0]]) if reached.size else float(time[-1])
        found += [math.ceil((settled + later) / law.sample_time)] * min(STEPS, len(piece.samples) - first)
    return tuple(found)
