"""Decide about a proof of the way from rolling to the reference: boxes of friction and supply rate, followed in time.

How fast the supply rises decides when a wheel begins to slide, and so do the friction and all other numbers of the
box. A box is therefore a strip: a range of the friction, the other numbers within a share of their ranges, and a supply
rate that changes with all of them so that its wheels slide at the same time. The strips of a piece of the friction lie
side by side and cover the supply rates of a row; the slower the supply, the narrower they have to be.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cache, partial
from itertools import pairwise
from math import exp
from typing import TYPE_CHECKING, Any, NamedTuple

from wspd_design.certificates.kernel.arb import above, below, point
from wspd_design.certificates.kernel.checker import Refused, Work, number
from wspd_design.certificates.kernel.term import text
from wspd_design.certificates.records import Problem
from wspd_design.certificates.theorems.slip_band.checker import checker as checker_of_band
from wspd_design.certificates.theorems.slip_band.checker import inverse, steady_of
from wspd_design.certificates.theorems.slip_band.friction import FRICTION, SLOPES
from wspd_design.certificates.theorems.slip_band.proof import Ellipsoid
from wspd_design.certificates.theorems.slip_band.proof import Proof as BandProof
from wspd_design.certificates.theorems.slip_band.proof import read as read_band
from wspd_design.certificates.theorems.slip_band.statement import (
    NAMES,
    Cell,
    box_of,
    cells_of,
    windows_of,
)
from wspd_design.controllers.protection import Protection
from wspd_design.model.slip import resistance
from wspd_design.parameters.bounds import Bounds
from wspd_design.parameters.loading import constants
from wspd_design.parameters.units import KMH

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from wspd_design.certificates.theorems.slip_band.arrival import Asked

    Array = NDArray[np.float64]

FORMAT = "wspd-way-in/5"
SUPPLY = "supply rate"
VARIED = (FRICTION, SUPPLY)
NEAR = tuple(name for name in NAMES if name not in VARIED)
"""Numbers that stay near their nominal values: within a share of the way to either end of their ranges."""
TILTING = (FRICTION, *NEAR)
"""Numbers with which the supply rate of a strip changes."""
LARGEST_SHARE = Fraction(1, 2)  # for which the friction of the band is bounded
MOST_STRIPS, MOST_SAMPLES, MOST_LETTERS = 20_000, 2_000, 60  # of a proof, of a strip, of a number
AT_ONCE = 256  # strips that are followed together
WORK = 25  # operations that a sample of a strip is worth
OUTWARD = 1e-12  # relative, by which a strip is widened so that rounding leaves no gap


@dataclass(frozen=True, slots=True, kw_only=True)
class Piece:
    """A range of the friction with its strips."""

    friction: tuple[float, float]  # -
    slopes: tuple[float, ...]  # 1/s, of the supply rate over each of the tilting numbers, in their units
    borders: tuple[float, ...]  # 1/s, of the strips where all of these are in the middle, rising
    samples: tuple[int, ...]  # for which each strip is followed

    @property
    def middle(self) -> float:
        """Friction in the middle [-]."""
        return 0.5 * (self.friction[0] + self.friction[1])


@dataclass(frozen=True, slots=True, kw_only=True)
class Row:
    """A range of the supply rate, with pieces of all of the friction."""

    supply: tuple[float, float]  # 1/s
    pieces: tuple[Piece, ...]


class Strip(NamedTuple):
    """A strip of a piece, by its number."""

    piece: Piece
    number: int

    @property
    def samples(self) -> int:
        """For which it is followed at most."""
        return self.piece.samples[self.number]


def strips_of(rows: Sequence[Row]) -> list[Strip]:
    """All strips of some rows."""
    return [Strip(piece, k) for row in rows for piece in row.pieces for k in range(len(piece.samples))]


def write(rows: Sequence[Row], share: Fraction, band: Mapping[str, Any] | None = None) -> dict[str, Any]:
    """Write a proof as JSON, with that of the band that the wheels get into, if there is one."""
    return {
        "format": FORMAT,
        "share": text(share),
        "band": band,
        "rows": [
            {
                "supply": [text(Fraction(end)) for end in row.supply],
                "pieces": [
                    {
                        "friction": [text(Fraction(end)) for end in each.friction],
                        "slopes": [text(Fraction(slope)) for slope in each.slopes],
                        "borders": [text(Fraction(border)) for border in each.borders],
                        "samples": list(each.samples),
                    }
                    for each in row.pieces
                ],
            }
            for row in rows
        ],
    }


def read(proof: Mapping[str, Any]) -> tuple[Fraction, tuple[Row, ...]]:
    """Read the share and the rows of a proof, or refuse it."""
    if proof.keys() != {"format", "share", "band", "rows"} or proof["format"] != FORMAT:
        raise Refused(f"the proof does not have the format {FORMAT}")
    share, rows = _short(proof["share"]), proof["rows"]
    if not 0 <= share <= LARGEST_SHARE:
        raise Refused(f"the share of the ranges is not between 0 and {LARGEST_SHARE}")
    if not isinstance(rows, list) or not rows:
        raise Refused("the proof has no rows")
    found = tuple(_row(each) for each in rows)
    if len(strips_of(found)) > MOST_STRIPS:
        raise Refused(f"the proof has more than {MOST_STRIPS} strips")
    return share, found


def _row(written: object) -> Row:
    if not isinstance(written, dict) or written.keys() != {"supply", "pieces"}:
        raise Refused("a row lacks its supply rates or pieces")
    supply, pieces = written["supply"], written["pieces"]
    if not isinstance(supply, list) or len(supply) != 2 or not isinstance(pieces, list) or not pieces:
        raise Refused("a row needs two ends of the supply rate, and pieces")
    low, high = (_double(end) for end in supply)
    if not low < high:
        raise Refused("the ends of the supply rate of a row do not rise")
    return Row(supply=(low, high), pieces=tuple(_piece(each) for each in pieces))


def _piece(written: object) -> Piece:
    names = ("friction", "slopes", "borders", "samples")
    if not isinstance(written, dict) or written.keys() != {*names}:
        raise Refused("a piece lacks its friction, slopes, borders or samples")
    friction, slopes, borders, samples = (written[name] for name in names)
    if not all(isinstance(each, list) for each in (friction, slopes, borders, samples)):
        raise Refused("friction, slopes, borders and samples of a piece must be lists")
    if len(friction) != 2 or len(borders) != len(samples) + 1 or not samples:
        raise Refused("a piece needs two ends of the friction, and one border more than strips")
    if len(slopes) != len(TILTING):
        raise Refused(f"a piece needs {len(TILTING)} slopes: over {', '.join(TILTING)}")
    if not all(type(each) is int and 0 < each <= MOST_SAMPLES for each in samples):
        raise Refused(f"a strip is followed for 1 to {MOST_SAMPLES} samples")
    low, high = (_double(end) for end in friction)
    edges = tuple(_double(each) for each in borders)
    if not low <= high or any(one >= other for one, other in pairwise(edges)):
        raise Refused("the ends of the friction or the borders of the strips do not rise")
    return Piece(
        friction=(low, high),
        slopes=tuple(_double(each) for each in slopes),
        borders=edges,
        samples=tuple(samples),
    )


def _double(written: object) -> float:
    return float(_short(written))


def _short(written: object) -> Fraction:
    if len(str(written)) > MOST_LETTERS:
        raise Refused(f"a number of the proof has more than {MOST_LETTERS} letters")
    return number(written)


def checker(problem: Problem, law: Protection) -> Callable[[Mapping[str, Any], Work], dict[str, float]]:
    """Return what decides about a proof and tells its numbers, those of the band among them."""

    def check(proof: Mapping[str, Any], work: Work) -> dict[str, float]:
        share, rows = read(proof)
        near = around(problem, share)
        low, high = _covered(near, rows)
        work.spend(WORK * sum(each.samples for each in strips_of(rows)))
        from wspd_design.certificates.theorems.slip_band.computed_law import unlike

        difference = unlike(near, law)
        if difference:
            raise Refused(difference)
        band: dict[str, float] = {}
        asked: Asked | None = None
        of_band: Any = proof["band"]
        if of_band is not None:
            if not isinstance(of_band, dict):
                raise Refused("the proof of the band is no object")
            band = checker_of_band(near, law)(of_band, work)
            asked = asked_of(near, of_band)
        found = followed(near, law, strips_of(rows), asked)
        if asked is not None:
            supply_rises(near, of_band, found["supply"], found["speed"])
        return {**band, "share": float(share), "friction low": low, "friction high": high, **found}

    return check


def around(problem: Problem, share: Fraction = LARGEST_SHARE) -> Problem:
    """Return the problem with all of friction and supply rate, and of other numbers a share of their ranges."""
    ends = {name: problem.span(name) for name in VARIED}
    for name in NEAR if share else ():
        nominal = problem.nominal(name)
        low, high = (nominal + float(share) * (end - nominal) for end in problem.span(name))
        ends[name] = (low, high)
    return replace(problem, bounds=Bounds.of(ends))


def asks_of(problem: Problem, proof: Mapping[str, Any]) -> "list[tuple[Cell, Asked]]":
    """Return what each cell of an accepted proof of a band asks for in each window of speed, the fastest one first."""
    windows = range(len(windows_of(problem)))
    found = read_band(proof, len(windows))
    if found.share != 1:
        raise Refused("the band must be that of the whole box")
    cells = cells_of(box_of(problem, found.share), found.steps)
    return [
        (cell, _asked(problem, found, (cell, k), ellipsoids[k]))
        for k in reversed(windows)
        for cell, ellipsoids in zip(cells, found.cells, strict=True)
    ]


def _asked(problem: Problem, found: BandProof, at: tuple[Cell, int], each: Ellipsoid | None) -> "Asked":
    """Return what an ellipsoid of a cell and a window asks for."""
    from wspd_design.certificates.theorems.slip_band.arrival import Asked

    assert each is not None  # without a reserve no window is left out
    away = above(steady_of(problem, found, at, each).away(point(each.drift)))
    return Asked(
        speeds=windows_of(problem)[at[1]],
        settled=float(each.settled),
        matrix=inverse(each.matrix),
        center=[float(end) for end in each.center],
        moved=[float(end) * away for end in each.moves],
        supply=float(each.supply),
        closer=cache(partial(_closer, problem, found, at, each)),
    )


def _closer(
    problem: Problem,
    found: BandProof,
    at: tuple[Cell, int],
    begin: Ellipsoid,
    numbers: Cell,
    speeds: tuple[float, float],
) -> tuple[list[float], list[float]]:
    """Return the center of an ellipsoid for the middle of the steady drifts of some numbers, and its way to an end."""
    (cell, k), drift = at, float(begin.drift)
    part = tuple(
        (max(one, low), min(other, high)) for (one, other), (low, high) in zip(numbers, cell, strict=True)
    )
    steady = steady_of(problem, found, (part, k), begin, speeds)
    low, high = below(steady.low), above(steady.high)
    middle, half = 0.5 * (low + high) - drift, 0.5 * (high - low) * (1.0 + 1e-9)
    center = [
        float(each) + float(move) * middle for each, move in zip(begin.center, begin.moves, strict=True)
    ]
    return center, [float(each) * half for each in begin.moves]


def asked_of(problem: Problem, proof: Mapping[str, Any]) -> "Asked":
    """Return what an accepted proof of a band asks for at the highest speeds, or refuse a band of more than a cell."""
    last = len(windows_of(problem)) - 1
    found = read_band(proof, last + 1)
    if found.share != 1 or len(found.cells) != 1:
        raise Refused("the band must be that of one cell, which is the whole box")
    (cell,) = cells_of(box_of(problem, found.share), found.steps)
    return _asked(problem, found, (cell, last), found.cells[0][last])


def supply_rises(problem: Problem, proof: Mapping[str, Any], supply: float, speed: float) -> None:
    """Refuse a band that asks for more supply in a slower window than there is when the train gets there.

    Parameters
    ----------
    problem : Problem
        Around the nominal numbers.
    proof : mapping
        Of the band.
    supply, speed : float
        At the end of what is followed, at least [-, m/s].
    """
    windows = windows_of(problem)
    found, vehicle = read_band(proof, len(windows)), problem.vehicle
    mu0, slowest = problem.span(FRICTION)[1], problem.span(SUPPLY)[0]
    supplies = [
        max(each.supply for each in alike if each is not None) for alike in zip(*found.cells, strict=True)
    ]
    lacking = 1.0 - supply
    for k in reversed(range(len(windows) - 1)):  # from the next slower window on
        parts, (_, top) = [each.friction for each in found.friction[k + 1]], windows[k]
        steepest = max(abs(end) for each in parts for ends in each.slopes for end in ends)
        farthest = max(abs(end) for strip in SLOPES for end in strip)
        used = max(each.level[1] for each in parts) + steepest * float(farthest) * problem.speeds[0]
        drag = float(resistance(vehicle, windows[k + 1][1])) / problem.span("mass")[0]
        loss = (constants().gravity * mu0 * used + drag) * (1.0 + OUTWARD)
        lacking *= exp(-slowest * max(speed - top, 0.0) / loss) * (1.0 + OUTWARD)
        speed = min(speed, top)
        if not 1.0 - lacking >= supplies[k]:
            raise Refused(
                f"the supply may have {1.0 - lacking:.3g} of its pressure at {top * KMH:.0f} km/h, and the band asks "
                f"for {float(supplies[k]):.3g}"
            )


def _covered(problem: Problem, rows: Sequence[Row]) -> tuple[float, float]:
    """Range of the friction for which all supply rates are covered, or refuse."""
    slowest, fastest = problem.span(SUPPLY)
    if any(one.supply[1] != other.supply[0] for one, other in pairwise(rows)):
        raise Refused("the rows of the supply rate do not follow each other")
    if rows[0].supply[0] > slowest or rows[-1].supply[1] < fastest:
        raise Refused("the rows do not cover all supply rates")
    ranges = [_friction_of(problem, row) for row in rows]
    return max(low for low, _ in ranges), min(high for _, high in ranges)


def _friction_of(problem: Problem, row: Row) -> tuple[float, float]:
    """Range of the friction for which all supply rates of a row are covered, or refuse."""
    slowest, fastest = row.supply
    end = row.pieces[0].friction[0]
    for each in row.pieces:
        if each.friction[0] != end:
            raise Refused("the pieces of the friction do not follow each other")
        end = each.friction[1]
        shift = (1.0 + OUTWARD) * tilt(problem, each)
        if each.borders[0] + shift > slowest or each.borders[-1] - shift < fastest:
            raise Refused("the strips of a piece do not cover all supply rates")
        if not each.borders[0] - shift > 0.0:
            raise Refused("a strip holds a supply rate that is not positive")
    low = row.pieces[0].friction[0]
    if not low > 0.0:
        raise Refused("a piece holds a friction that is not positive")
    return low, end


def tilt(problem: Problem, piece: Piece) -> float:
    """Largest change of the supply rate within a strip that goes with the numbers of a piece [1/s]."""
    return sum(
        abs(slope) * half for slope, (_, half) in zip(piece.slopes, _ranges(problem, piece), strict=True)
    )


def _ranges(problem: Problem, piece: Piece) -> list[tuple[float, float]]:
    """Middle and half width of each of the tilting numbers."""
    ends = [piece.friction, *(problem.span(name) for name in NEAR)]
    return [(0.5 * (low + high), 0.5 * (high - low)) for low, high in ends]


def followed(
    problem: Problem, law: Protection, strips: Sequence[Strip], asked: "Asked | None" = None
) -> dict[str, float]:
    """Follow all strips, and return the largest slip, when they end and how near to the reference they are then.

    Parameters
    ----------
    problem : Problem
        The box around the nominal numbers, and the speed at which the brake is demanded: the highest of the range.
    law : Protection
        Sliding mode of relative degree two.
    strips : sequence of Strip
        What is followed.
    asked : Asked, optional
        What the wheels must have at the end of what is followed.

    Raises
    ------
    Refused
        If the enclosure of a strip is lost, or its wheels lack what is asked.
    """
    found = courses(problem, law, strips, asked)
    if found.lost.any():
        raise Refused("the enclosure of a strip is lost")
    if not found.there.all():
        raise Refused("wheels of a strip are not in the ellipsoid of the band at its end")
    return {
        "largest slip": float(found.top.max()),
        "time": float(found.samples.max()) * law.sample_time,
        "above": float(found.high.max()) - problem.slip,
        "below": problem.slip - float(found.low.min()),
        "supply": float(found.supply.min()),
        "speed": float(found.speed.min()),
    }


@dataclass(frozen=True, slots=True, kw_only=True)
class Courses:
    """How strips went; each is followed until its wheels have what is asked, or for its samples."""

    lost: "NDArray[np.bool_]"  # whether the enclosure was lost
    there: "NDArray[np.bool_]"  # whether the wheels have what is asked at the end
    samples: "NDArray[np.int_]"  # that were followed
    top: "Array"  # -, largest slip
    low: "Array"  # -, slip at the end
    high: "Array"
    supply: "Array"  # -, of the full pressure at the end, at least
    speed: "Array"  # m/s, at the end, at least


def courses(
    problem: Problem, law: Protection, strips: Sequence[Strip], asked: "Asked | None" = None
) -> Courses:
    """Follow strips, whatever becomes of them; parameters as of :func:`followed`."""
    import numpy as np

    count = len(strips)
    found = Courses(
        lost=np.zeros(count, dtype=bool),
        there=np.zeros(count, dtype=bool),
        samples=np.zeros(count, dtype=int),
        **{name: np.zeros(count) for name in ("top", "low", "high", "supply", "speed")},
    )
    order = np.argsort([each.samples for each in strips], kind="stable")
    for first in range(0, count, AT_ONCE):
        _follow(problem, law, strips, order[first : first + AT_ONCE], found, asked)
    return found


def _follow(
    problem: Problem,
    law: Protection,
    strips: Sequence[Strip],
    going: "NDArray[np.int_]",
    found: Courses,
    asked: "Asked | None",
) -> None:
    """Follow some strips together."""
    import numpy as np

    from wspd_design.certificates.theorems.slip_band.approach import follow
    from wspd_design.certificates.theorems.slip_band.arrival import arrived

    ends = np.array([each.samples for each in strips])
    boxes = _boxes(problem, [strips[k] for k in going])
    course = follow(law, problem.vehicle, problem.rail, boxes, problem.speeds[1])
    sample, kept = 0, None
    with np.errstate(all="ignore"):
        while going.size:
            top, state, plant = next(course) if kept is None else course.send(kept)
            sample += 1
            lost = ~np.isfinite(top)
            there = ~lost & (arrived(law, plant, state, asked) if asked else ends[going] == sample)
            slip = state.sliding / state.speed
            found.lost[going], found.there[going], found.samples[going] = lost, there, sample
            found.top[going] = np.maximum(found.top[going], top)
            found.low[going], found.high[going] = slip.low, slip.high
            found.supply[going], found.speed[going] = state.supply.low, state.speed.low
            kept = ~lost & ~there & (ends[going] > sample)
            going = going[kept]


def _boxes(problem: Problem, strips: Sequence[Strip]) -> "tuple[Array, Array]":
    """Centers of the numbers, and what the symbols do to them: one for each number."""
    import numpy as np

    from wspd_design.certificates.theorems.slip_band.followed_plant import NUMBERS

    middle = np.zeros((len(strips), len(NUMBERS)))
    spread = np.zeros((len(strips), len(NUMBERS), len(NUMBERS)))
    supply = NUMBERS.index(SUPPLY)
    for k, (piece, strip) in enumerate(strips):
        low, high = piece.borders[strip : strip + 2]
        middle[k, supply] = 0.5 * (low + high)
        spread[k, supply, supply] = 0.5 * (high - low) + OUTWARD * (high + tilt(problem, piece))
        for name, slope, (center, half) in zip(TILTING, piece.slopes, _ranges(problem, piece), strict=True):
            number = NUMBERS.index(name)
            middle[k, number] = center
            spread[k, number, number] = half + OUTWARD * (half + center)
            spread[k, supply, number] = slope * spread[k, number, number]
    return middle, spread
