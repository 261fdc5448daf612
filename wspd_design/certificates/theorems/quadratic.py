"""Quadratic functions that fall along a loop with torque feedback, shown in rational arithmetic.

In x = (y, w), y the deviation of the sliding speed that the law measures [m/s] and w what the deviation of the torque
changes of it per second [m/s2], a static law with torque feedback makes x' = A x with

    A = [[q, -1], [b g, -(a + b K)]],   q = p - a/v,   g = kappa R T_max / (inertia of the wheelset),

kappa, K and R as the law counts them (K times T_max over its own T_max), a and b the rates of the averaged valve. The
deceleration enters because v changes while the slip does; only the difference q of slip pole p and a/v matters.
Sampled, with the numbers of :mod:`wspd_design.certificates.setting.pulsed_valve` and dU = g y - K w,

    M = [[E - g j r, -D + K j r], [g j, AB - K j]].

A is affine in each of q, a, b and M in each of E, D, AB, j, r; both are affine in (g, K) together, which lie in the
quadrilateral of the ends of T_max and inertia. x'(A'P + PA)x is then affine and x'M'PMx convex along each number, so
that the corners of their ranges suffice, for every course of the numbers in between.

Times of the valve, T_max and inertia do not change during a stop. Their box may be halved; every piece has matrices of
its own.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import product
from typing import Any, NamedTuple, TypeAlias

from wspd_design.certificates.kernel.checker import Refused, Work, number
from wspd_design.certificates.kernel.finding import above, below
from wspd_design.certificates.kernel.term import text
from wspd_design.certificates.records import Problem
from wspd_design.certificates.setting.pulsed_valve import Interval, Sample, Times, rates, sample_of
from wspd_design.certificates.setting.traced_law import written_law

FORMAT = "wspd-quadratic/2"
LETTERS = "fvti"
"""Which range a step halves: fill time, vent time, T_max, inertia; a full stop is a piece."""
MOST_PIECES, MOST_LETTERS = 4_000, 60  # of a proof, and of a number in it: long fractions take long
WORK = 4_000  # operations on intervals that a corner of a piece is worth

Symmetric: TypeAlias = tuple[Any, Any, Any]
"""Entries 11, 12, 22 of a symmetric matrix."""
Matrix: TypeAlias = tuple[tuple[Any, Any], tuple[Any, Any]]
Ranges: TypeAlias = tuple[Interval, ...]
"""In the order of :data:`LETTERS`, that of q [1/s] last."""


class Law(NamedTuple):
    """Exact numbers of a law with torque feedback and of its sampling."""

    slide: Fraction  # duty per s, kappa times R: what g is without T_max over inertia
    torque: Fraction  # 1/(N m), K over the law's own T_max
    sample_time: Fraction  # s


@dataclass(frozen=True, slots=True, kw_only=True)
class Piece:
    """Functions of one piece and their guaranteed fall."""

    continuous: Symmetric
    decay: Fraction  # 1/s, the root of the function falls at least as exp(-decay t)
    sampled: Symmetric
    contraction: Fraction  # it falls at least by this factor per sample


@dataclass(frozen=True, slots=True, kw_only=True)
class Quadratic:
    """A range of q, how the box is halved, in preorder, and the functions of the pieces in their order."""

    poles: Interval  # 1/s
    steps: str
    pieces: tuple[Piece, ...]


def law_of(problem: Problem) -> Law:
    """Exact numbers of the law."""
    law: Any = written_law(problem.controller, "torque-feedback")
    return Law(
        slide=Fraction(law.gains.sliding_gain) * Fraction(law.radius),
        torque=Fraction(law.gains.torque_gain) / Fraction(law.max_torque),
        sample_time=Fraction(problem.sample_time),
    )


def ranges_of(problem: Problem, poles: Interval) -> Ranges:
    """Ranges of the numbers that a piece may narrow."""
    names = ("fill time", "vent time", "max torque", "wheelset inertia")
    spans = [problem.span(name) for name in names]
    return (*((Fraction(low), Fraction(high)) for low, high in spans), poles)


def gains(law: Law, ranges: Ranges) -> tuple[tuple[Fraction, Fraction], ...]:
    """Corners of (g, K) [1/s2, -]."""
    _, _, torques, inertias, _ = ranges
    corners = dict.fromkeys(product(torques, inertias))
    return tuple((law.slide * top / inertia, law.torque * top) for top, inertia in corners)


def averaged(law: Law, ranges: Ranges) -> Iterator[Matrix]:
    """Corners of the matrices A of x' = A x."""
    fill, vent, _, _, poles = ranges
    valve = rates(Times(fill, vent))
    for (g, back), *numbers in product(gains(law, ranges), *map(dict.fromkeys, (poles, valve, valve))):
        q, a, b = numbers
        yield (q, Fraction(-1)), (b * g, -(a + b * back))


def sampled(law: Law, ranges: Ranges) -> Iterator[Matrix]:
    """Corners of the matrices M of a sample."""
    fill, vent, _, _, poles = ranges
    found = sample_of(Times(fill, vent), poles, law.sample_time)
    for (g, back), *numbers in product(gains(law, ranges), *map(dict.fromkeys, found)):
        yield one_sample(Sample(*((each, each) for each in numbers)), g, back)


def one_sample(at: Sample, g: Any, back: Any) -> Matrix:
    """Return M at the lower ends of the numbers of a sample."""
    slide, forced, kept, duty, delay = (low for low, _ in at)
    return (
        (slide - g * duty * delay, -forced + back * duty * delay),
        (g * duty, kept - back * duty),
    )


def decays(p: Symmetric, a: Matrix, decay: Any) -> Symmetric:
    """Return -(A'P + PA) - 2 decay P, which must be positive definite."""
    p11, p12, p22 = p
    (a11, a12), (a21, a22) = a
    return (
        -2 * (p11 * a11 + p12 * a21) - 2 * decay * p11,
        -(p11 * a12 + p12 * a22 + p12 * a11 + p22 * a21) - 2 * decay * p12,
        -2 * (p12 * a12 + p22 * a22) - 2 * decay * p22,
    )


def contracts(p: Symmetric, a: Matrix, contraction: Any) -> Symmetric:
    """Return contraction^2 P - A'PA, which must be positive definite."""
    p11, p12, p22 = p
    (a11, a12), (a21, a22) = a
    left = (p11 * a11 + p12 * a21, p12 * a11 + p22 * a21)
    right = (p11 * a12 + p12 * a22, p12 * a12 + p22 * a22)
    kept = contraction * contraction
    return (
        kept * p11 - (a11 * left[0] + a21 * left[1]),
        kept * p12 - (a12 * left[0] + a22 * left[1]),
        kept * p22 - (a12 * right[0] + a22 * right[1]),
    )


def is_positive(p: Symmetric) -> bool:
    """Whether a symmetric matrix is positive definite: the pivots of LDL' are positive."""
    p11, p12, p22 = p
    return bool(p11 > 0) and bool(p11 * p22 - p12 * p12 > 0)


def halved(ranges: Ranges, letter: str) -> tuple[Ranges, Ranges]:
    """Both halves of a box, the lower one first."""
    k = LETTERS.index(letter)
    low, high = ranges[k]
    middle = (low + high) / 2
    return (*ranges[:k], (low, middle), *ranges[k + 1 :]), (*ranges[:k], (middle, high), *ranges[k + 1 :])


def checker(problem: Problem) -> Callable[[Mapping[str, Any], Work], dict[str, float]]:
    """Return what decides about a proof and tells its numbers."""

    def check(proof: Mapping[str, Any], work: Work) -> dict[str, float]:
        found, law = read(proof), law_of(problem)
        boxes = [ranges_of(problem, found.poles)]
        pieces = iter(found.pieces)
        for step in found.steps:
            if not boxes:
                raise Refused("the steps go on after the last piece")
            box = boxes.pop()
            if step == ".":
                _decide(law, box, next(pieces, None), work)
            elif step in LETTERS:
                boxes += halved(box, step)[::-1]
            else:
                raise Refused("a step is unknown")
        if boxes or next(pieces, None) is not None:
            raise Refused("steps and pieces do not match")
        return {
            "lowest pole": float(found.poles[0]),
            "highest pole": float(found.poles[1]),
            "decay": below(min(each.decay for each in found.pieces)),
            "contraction": above(max(each.contraction for each in found.pieces)),
            "pieces": float(len(found.pieces)),
        }

    return check


def _decide(law: Law, box: Ranges, piece: Piece | None, work: Work) -> None:
    """Refuse a piece whose functions do not fall."""
    if piece is None:
        raise Refused("a piece has no function")
    if not (is_positive(piece.continuous) and is_positive(piece.sampled)):
        raise Refused("a matrix P is not positive definite")
    if piece.decay < 0 or not 0 <= piece.contraction <= 1:
        raise Refused("a stated fall is none")
    for matrix in averaged(law, box):
        work.spend(WORK // 10)
        if not is_positive(decays(piece.continuous, matrix, piece.decay)):
            raise Refused("a function does not fall along the continuous loop at a corner")
    for matrix in sampled(law, box):
        work.spend(WORK // 10)
        if not is_positive(contracts(piece.sampled, matrix, piece.contraction)):
            raise Refused("a function does not fall along the sampled loop at a corner")


def proof_of(found: Quadratic) -> dict[str, Any]:
    """Write a proof as JSON."""
    return {
        "format": FORMAT,
        "poles": [text(each) for each in found.poles],
        "steps": found.steps,
        "pieces": [
            [text(each) for each in (*piece.continuous, piece.decay, *piece.sampled, piece.contraction)]
            for piece in found.pieces
        ],
    }


def read(proof: Mapping[str, Any]) -> Quadratic:
    """Read a proof, or refuse it."""
    if proof.keys() != {"format", "poles", "steps", "pieces"} or proof["format"] != FORMAT:
        raise Refused(f"the proof does not have the format {FORMAT}")
    low, high = _numbers(proof["poles"], 2)
    if low > high or Fraction(float(low)) != low or Fraction(float(high)) != high:
        raise Refused("the range of q is not one between two doubles")
    steps, pieces = proof["steps"], proof["pieces"]
    if not isinstance(steps, str) or not isinstance(pieces, list) or not 0 < len(pieces) <= MOST_PIECES:
        raise Refused("the proof has no steps or no pieces, or too many")
    if len(steps) != 2 * len(pieces) - 1:
        raise Refused("steps and pieces do not match")
    return Quadratic(
        poles=(low, high), steps=steps, pieces=tuple(_piece(_numbers(each, 8)) for each in pieces)
    )


def _piece(numbers: Sequence[Fraction]) -> Piece:
    a, b, c, decay, d, e, f, contraction = numbers
    return Piece(continuous=(a, b, c), decay=decay, sampled=(d, e, f), contraction=contraction)


def _numbers(written: object, count: int) -> list[Fraction]:
    if not isinstance(written, list) or len(written) != count:
        raise Refused(f"the proof lacks {count} numbers")
    if any(len(str(each)) > MOST_LETTERS for each in written):
        raise Refused(f"a number of the proof has more than {MOST_LETTERS} letters")
    return [number(each) for each in written]
