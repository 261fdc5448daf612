"""Decide about a proof of the way from rolling to the reference: boxes of friction and supply rate, followed in time.

How fast the supply rises decides when a wheel begins to slide, and so does the friction. A box is therefore a strip: a
range of the friction, and a supply rate that changes with the friction so that its wheels slide at the same time. The
strips of a piece of the friction lie side by side and cover all supply rates.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import pairwise
from math import ceil, exp, inf
from typing import TYPE_CHECKING, Any

from wspd_design.certificates.kernel.checker import Refused, Work, number
from wspd_design.certificates.kernel.term import text
from wspd_design.certificates.records import Problem
from wspd_design.certificates.theorems.slip_band.checker import checker as checker_of_band
from wspd_design.certificates.theorems.slip_band.checker import inverse
from wspd_design.certificates.theorems.slip_band.friction import FRICTION, SLOPES
from wspd_design.certificates.theorems.slip_band.proof import read as read_band
from wspd_design.certificates.theorems.slip_band.statement import windows_of
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

FORMAT = "wspd-way-in/2"
SUPPLY = "supply rate"
VARIED = (FRICTION, SUPPLY)
MOST_STRIPS, MOST_SAMPLES, MOST_LETTERS = 20_000, 2_000, 60  # of a proof, of a strip, of a number
AT_ONCE = 256  # strips that are followed together
WORK = 25  # operations that a sample of a strip is worth
AT_END = 0.1  # s, at the end of what is followed, over which the slip is told
OUTWARD = 1e-12  # relative, by which a strip is widened so that rounding leaves no gap


@dataclass(frozen=True, slots=True, kw_only=True)
class Piece:
    """A range of the friction with its strips."""

    friction: tuple[float, float]  # -
    slope: float  # 1/s, of the supply rate over the friction
    borders: tuple[float, ...]  # 1/s, of the strips at the middle friction, rising
    samples: tuple[int, ...]  # for which each strip is followed

    @property
    def middle(self) -> float:
        """Friction in the middle [-]."""
        return 0.5 * (self.friction[0] + self.friction[1])


def write(pieces: Sequence[Piece], band: Mapping[str, Any] | None = None) -> dict[str, Any]:
    """Write a proof as JSON, with that of the band that the wheels get into, if there is one."""
    return {
        "format": FORMAT,
        "band": band,
        "pieces": [
            {
                "friction": [text(Fraction(end)) for end in each.friction],
                "slope": text(Fraction(each.slope)),
                "borders": [text(Fraction(border)) for border in each.borders],
                "samples": list(each.samples),
            }
            for each in pieces
        ],
    }


def read(proof: Mapping[str, Any]) -> tuple[Piece, ...]:
    """Read a proof, or refuse it."""
    if proof.keys() != {"format", "band", "pieces"} or proof["format"] != FORMAT:
        raise Refused(f"the proof does not have the format {FORMAT}")
    pieces = proof["pieces"]
    if not isinstance(pieces, list) or not pieces:
        raise Refused("the proof has no pieces")
    found = tuple(_piece(each) for each in pieces)
    if sum(len(each.samples) for each in found) > MOST_STRIPS:
        raise Refused(f"the proof has more than {MOST_STRIPS} strips")
    return found


def _piece(written: object) -> Piece:
    if not isinstance(written, dict) or written.keys() != {"friction", "slope", "borders", "samples"}:
        raise Refused("a piece lacks its friction, slope, borders or samples")
    friction, borders, samples = (written[name] for name in ("friction", "borders", "samples"))
    if not all(isinstance(each, list) for each in (friction, borders, samples)):
        raise Refused("friction, borders and samples of a piece must be lists")
    if len(friction) != 2 or len(borders) != len(samples) + 1 or not samples:
        raise Refused("a piece needs two ends of the friction, and one border more than strips")
    if not all(type(each) is int and 0 < each <= MOST_SAMPLES for each in samples):
        raise Refused(f"a strip is followed for 1 to {MOST_SAMPLES} samples")
    low, high = (_double(end) for end in friction)
    edges = tuple(_double(each) for each in borders)
    if not low <= high or any(one >= other for one, other in pairwise(edges)):
        raise Refused("the ends of the friction or the borders of the strips do not rise")
    return Piece(friction=(low, high), slope=_double(written["slope"]), borders=edges, samples=tuple(samples))


def _double(written: object) -> float:
    if len(str(written)) > MOST_LETTERS:
        raise Refused(f"a number of the proof has more than {MOST_LETTERS} letters")
    return float(number(written))


def checker(problem: Problem, law: Protection) -> Callable[[Mapping[str, Any], Work], dict[str, float]]:
    """Return what decides about a proof and tells its numbers, those of the band among them."""

    def check(proof: Mapping[str, Any], work: Work) -> dict[str, float]:
        pieces = read(proof)
        low, high = _covered(problem, pieces)
        work.spend(WORK * sum(sum(each.samples) for each in pieces))
        from wspd_design.certificates.theorems.slip_band.computed_law import unlike

        difference = unlike(problem, law)
        if difference:
            raise Refused(difference)
        band: dict[str, float] = {}
        asked: Asked | None = None
        if proof["band"] is not None:
            band, asked = _band(around(problem), law, proof["band"], work)
        found = followed(problem, law, pieces, asked)
        if asked is not None:
            _supply_rises(around(problem), proof["band"], found["supply"], found["speed"])
        return {**band, "friction low": low, "friction high": high, **found}

    return check


def around(problem: Problem) -> Problem:
    """Return the problem with nothing but friction and supply rate uncertain."""
    return replace(problem, bounds=Bounds.of({name: problem.span(name) for name in VARIED}))


def _band(problem: Problem, law: Protection, proof: object, work: Work) -> "tuple[dict[str, float], Asked]":
    """Decide about the band, and return its numbers and what it asks for at the highest speeds."""
    from wspd_design.certificates.theorems.slip_band.arrival import Asked

    if not isinstance(proof, dict):
        raise Refused("the proof of the band is no object")
    numbers = checker_of_band(problem, law)(proof, work)
    windows = windows_of(problem)
    found = read_band(proof, len(windows))
    if found.share != 1 or len(found.cells) != 1:
        raise Refused("the band must be that of one cell, which is the whole box")
    begin = found.cells[0][-1]
    assert begin is not None  # without a reserve no window is left out
    asked = Asked(
        speeds=windows[-1],
        settled=float(begin.settled),
        matrix=inverse(begin.matrix),
        center=[float(each) for each in begin.center],
        supply=float(begin.supply),
    )
    return numbers, asked


def _supply_rises(problem: Problem, proof: Mapping[str, Any], supply: float, speed: float) -> None:
    """Refuse a band that asks for more supply in a slower window than there is when the train gets there.

    Parameters
    ----------
    problem : Problem
        With nothing but friction and supply rate uncertain.
    proof : mapping
        Of the band.
    supply, speed : float
        At the end of what is followed, at least [-, m/s].
    """
    windows = windows_of(problem)
    found, vehicle = read_band(proof, len(windows)), problem.vehicle
    mu0, slowest = problem.span(FRICTION)[1], problem.span(SUPPLY)[0]
    supplies = [each.supply for each in found.cells[0] if each is not None]
    lacking = 1.0 - supply
    for k in reversed(range(len(windows) - 1)):  # from the next slower window on
        halves, (_, top) = found.friction[k + 1], windows[k]
        steepest = max(abs(end) for each in halves for ends in each.slopes for end in ends)
        farthest = max(abs(end) for strip in SLOPES for end in strip)
        used = max(each.level[1] for each in halves) + steepest * float(farthest) * problem.speeds[0]
        drag = float(resistance(vehicle, windows[k + 1][1])) / vehicle.mass
        loss = (constants().gravity * mu0 * used + drag) * (1.0 + OUTWARD)
        lacking *= exp(-slowest * max(speed - top, 0.0) / loss) * (1.0 + OUTWARD)
        speed = min(speed, top)
        if not 1.0 - lacking >= supplies[k]:
            raise Refused(
                f"the supply may have {1.0 - lacking:.3g} of its pressure at {top * KMH:.0f} km/h, and the band asks "
                f"for {float(supplies[k]):.3g}"
            )


def _covered(problem: Problem, pieces: Sequence[Piece]) -> tuple[float, float]:
    """Range of the friction for which all supply rates are covered, or refuse."""
    slowest, fastest = problem.span(SUPPLY)
    end = pieces[0].friction[0]
    for each in pieces:
        if each.friction[0] != end:
            raise Refused("the pieces of the friction do not follow each other")
        end = each.friction[1]
        shifts = [each.slope * (friction - each.middle) for friction in each.friction]
        first, last = each.borders[0] + max(shifts), each.borders[-1] + min(shifts)
        if first > slowest or last < fastest:
            raise Refused("the strips of a piece do not cover all supply rates")
        if not each.borders[0] + min(shifts) > 0.0:
            raise Refused("a strip holds a supply rate that is not positive")
    low = pieces[0].friction[0]
    if not low > 0.0:
        raise Refused("a piece holds a friction that is not positive")
    return low, end


def followed(
    problem: Problem, law: Protection, pieces: Sequence[Piece], asked: "Asked | None" = None
) -> dict[str, float]:
    """Follow all strips, and return the largest slip, when they end and how near to the reference they are then.

    Parameters
    ----------
    problem : Problem
        Nominal numbers, and the speed at which the brake is demanded: the highest of the range.
    law : Protection
        Sliding mode of relative degree two.
    pieces : sequence of Piece
        Strips.
    asked : Asked, optional
        What the wheels must have at the end of what is followed.

    Raises
    ------
    Refused
        If the enclosure of a strip is lost, or its wheels lack what is asked.
    """
    strips = sorted(
        ((count, k, strip) for k, each in enumerate(pieces) for strip, count in enumerate(each.samples)),
        key=lambda each: each[0],
    )
    found = {"largest slip": 0.0, "time": 0.0, "above": -inf, "below": -inf, "supply": inf, "speed": inf}
    for first in range(0, len(strips), AT_ONCE):
        _follow(problem, law, pieces, strips[first : first + AT_ONCE], found, asked)
    return found


def _follow(
    problem: Problem,
    law: Protection,
    pieces: Sequence[Piece],
    strips: Sequence[tuple[int, int, int]],
    found: dict[str, float],
    asked: "Asked | None",
) -> None:
    import numpy as np

    from wspd_design.certificates.theorems.slip_band.approach import follow
    from wspd_design.certificates.theorems.slip_band.arrival import arrived

    ends = np.array([count for count, _, _ in strips])
    boxes = _boxes(problem, [(pieces[k], strip) for _, k, strip in strips])
    last, told = int(ends.max()), max(1, ceil(AT_END / law.sample_time))
    with np.errstate(all="ignore"):
        course = follow(law, problem.vehicle, problem.rail, boxes, problem.speeds[1])
        for sample, (top, state, plant) in enumerate(course, start=1):
            going = ends >= sample
            if not np.all(np.isfinite(top[going])):
                raise Refused("the enclosure of a strip is lost")
            found["largest slip"] = max(found["largest slip"], float(top[going].max()))
            ending = going & (sample > ends - told)
            if ending.any():
                slip = state.sliding / state.speed
                above, below = slip.high[ending] - problem.slip, problem.slip - slip.low[ending]
                found["above"] = max(found["above"], float(above.max()))
                found["below"] = max(found["below"], float(below.max()))
                found["supply"] = min(found["supply"], float(state.supply.low[ending].min()))
                found["speed"] = min(found["speed"], float(state.speed.low[ending].min()))
            if asked is not None and not np.all(arrived(law, plant, state, asked)[ends == sample]):
                raise Refused("wheels of a strip are not in the ellipsoid of the band at its end")
            if sample == last:
                break
    found["time"] = max(found["time"], last * law.sample_time)


def _boxes(problem: Problem, strips: Sequence[tuple[Piece, int]]) -> "tuple[Array, Array]":
    """Centers of the numbers, and what the symbols do to them: one for the friction, one for the supply."""
    import numpy as np

    from wspd_design.certificates.theorems.slip_band.followed_plant import NUMBERS

    middle = np.array([[problem.nominal(name) for name in NUMBERS]] * len(strips))
    spread = np.zeros((len(strips), len(NUMBERS), len(NUMBERS)))
    row, column = NUMBERS.index(FRICTION), NUMBERS.index(SUPPLY)
    for k, (piece, strip) in enumerate(strips):
        low, high = piece.borders[strip], piece.borders[strip + 1]
        half = 0.5 * (piece.friction[1] - piece.friction[0])
        middle[k, row], middle[k, column] = piece.middle, 0.5 * (low + high)
        spread[k, row, row] = half * (1.0 + OUTWARD) + OUTWARD * piece.middle
        spread[k, column, row] = piece.slope * half
        spread[k, column, column] = 0.5 * (high - low) + OUTWARD * (high + abs(piece.slope) * half)
    return middle, spread
