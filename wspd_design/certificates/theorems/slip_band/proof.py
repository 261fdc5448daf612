"""The proof of a band of slip as JSON; everything in it is suspect."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, NamedTuple, TypeAlias

from wspd_design.certificates.kernel.checker import Refused, number
from wspd_design.certificates.kernel.term import text
from wspd_design.certificates.setting.slip_loop import DISTURBANCES, STATES
from wspd_design.certificates.theorems.slip_band.friction import NAMES, PARTS, REACHES, Friction, Part, Parts

FORMAT = "wspd-slip-band/11"
MOST_CELLS, MOST_LETTERS = 4_000, 60  # of a proof, and of a number in it
ENTRIES = [(i, j) for i in range(STATES) for j in range(i + 1)]

ROOM = Fraction(1, 4)
"""Of what the supply lacks, that the cylinder lacks of the supply, if nothing else is told."""

Square: TypeAlias = tuple[tuple[Fraction, ...], ...]


class Choice(NamedTuple):
    """What the states are chosen for."""

    pulse: Fraction  # -, longest one over the sample time
    near: int  # which errors are kept to: the number of a reach
    settled: Fraction = Fraction(0)  # rad/s, error of the wheel speed that errors are counted from, E
    room: Fraction = ROOM  # -, of what the supply lacks, that the cylinder lacks of the supply at least
    lag: Fraction = Fraction(0)  # -, of what the reference drifts by, that goes with the steady drift
    beyond: Fraction = Fraction(1)  # -, times what the longest pulse does, that is wanted at most
    curve: Fraction = Fraction(
        1
    )  # -, times the error at which the braking curve begins, that is predicted at most


@dataclass(frozen=True, slots=True, kw_only=True)
class Ellipsoid:
    """(X - c)'Q^-1(X - c) <= 1, and the numbers that show that no sample leads out of it."""

    pulse: Fraction  # -, longest pulse over the sample time that a state in it asks for
    supply: Fraction  # -, least share of the full pressure
    near: int  # number of the reach that errors are kept to
    settled: Fraction  # E [rad/s], error of the wheel speed that errors of the state are counted from
    shortest: (
        Fraction  # -, pulse of the way at the center over the sample time, at any state of the ellipsoid
    )
    longest: Fraction  # -, the same, at most
    back: Fraction  # -, longest pulse to the other side over the sample time
    room: Fraction  # -, of what the supply lacks, that the cylinder lacks of the supply at least
    beyond: Fraction  # -, times what the longest pulse does, that is wanted at most
    curve: Fraction  # -, times the error at which the braking curve begins, that is predicted at most
    matrix: Square  # Q [rad2/s2]
    center: tuple[Fraction, ...]  # c [rad/s]
    drift: Fraction  # steady drift that the center is for [rad/s]
    moves: tuple[Fraction, ...]  # b [-], by how much the center moves with that
    alpha: Fraction  # of the function that is left after a sample
    offset: Fraction  # what the way of the center adds at most
    shares: tuple[Fraction, ...]  # what each disturbance adds at most, in the order of the disturbances
    lag: Fraction  # -, of what the reference drifts by, that goes with the steady drift
    steady: Fraction  # what the steady drift adds at most
    change: Fraction  # what its change does
    inside: Fraction  # multiplier that shows that the ellipsoid of the next faster window lies in this one

    @property
    def choice(self) -> Choice:
        """What its states are chosen for."""
        return Choice(self.pulse, self.near, self.settled, self.room, self.lag, self.beyond, self.curve)


@dataclass(frozen=True, slots=True, kw_only=True)
class Proof:
    """Share of the box, bounds of the friction for each window, the slowest first, and the cells in preorder.

    A step is the letter of the range that it halves, or a full stop: a cell, of which the ellipsoids are given.
    """

    share: Fraction
    delay: Fraction  # -, of the sample, until a pulse begins at the latest
    noise: Fraction  # m/s, by which measured speeds of rims and train differ from the true ones at most
    reserve: Fraction  # -, share of the full pressure beyond which nothing is claimed where holding takes more; 1: none
    friction: tuple[Parts, ...]
    steps: str
    cells: tuple[
        tuple[Ellipsoid | None, ...], ...
    ]  # for each cell one for each window; none beyond the reserve


def write(found: Proof) -> dict[str, Any]:
    """Write a proof as JSON; what a cell has in common with an earlier one is written once."""
    ellipsoids: dict[Ellipsoid, int] = {}
    cells = [
        [None if each is None else ellipsoids.setdefault(each, len(ellipsoids)) for each in cell]
        for cell in found.cells
    ]
    return {
        "format": FORMAT,
        "share": text(found.share),
        "delay": text(found.delay),
        "noise": text(found.noise),
        "reserve": text(found.reserve),
        "friction": [
            [
                text(Fraction(end))
                for each in parts
                for ends in (each.steepness, *each.friction.named.values())
                for end in ends
            ]
            for parts in found.friction
        ],
        "steps": found.steps,
        "ellipsoids": [_written(each) for each in ellipsoids],
        "cells": cells,
    }


def _written(each: Ellipsoid) -> list[str]:
    numbers = (
        each.pulse,
        each.supply,
        Fraction(each.near),
        each.settled,
        each.shortest,
        each.longest,
        each.back,
        each.room,
        each.beyond,
        each.curve,
        *(each.matrix[i][j] for i, j in ENTRIES),
        *each.center,
        each.drift,
        *each.moves,
        each.alpha,
        each.offset,
        *each.shares,
        each.lag,
        each.steady,
        each.change,
    )
    return [text(value) for value in (*numbers, each.inside)]


def read(proof: Mapping[str, Any], windows: int) -> Proof:
    """Read a proof about a number of windows, or refuse it."""
    names = {
        "format",
        "share",
        "delay",
        "noise",
        "reserve",
        "friction",
        "steps",
        "ellipsoids",
        "cells",
    }
    if proof.keys() != names or proof["format"] != FORMAT:
        raise Refused(f"the proof does not have the format {FORMAT}")
    steps, cells, ellipsoids = proof["steps"], proof["cells"], proof["ellipsoids"]
    if not isinstance(steps, str) or not isinstance(cells, list) or not 0 < len(cells) <= MOST_CELLS:
        raise Refused("the proof has no steps or no cells, or too many")
    if len(steps) != 2 * len(cells) - 1:
        raise Refused("steps and cells do not match")
    if not isinstance(ellipsoids, list) or len(ellipsoids) > windows * len(cells):
        raise Refused("the proof has no ellipsoids, or too many")
    share, delay, noise, reserve = _numbers(
        [proof[name] for name in ("share", "delay", "noise", "reserve")], 4
    )
    if not 0 < share <= 1:
        raise Refused("the share of the box must be above 0, and 1 at most")
    if delay < 0 or noise < 0:
        raise Refused("a delay or a noise is below 0")
    if not 0 < reserve <= 1:
        raise Refused("the share of the full pressure that is claimed about must be above 0, and 1 at most")
    known = [
        _ellipsoid(_numbers(each, 10 + len(ENTRIES) + 2 * STATES + 7 + len(DISTURBANCES)))
        for each in ellipsoids
    ]
    return Proof(
        share=share,
        delay=delay,
        noise=noise,
        reserve=reserve,
        friction=tuple(
            _parts(_numbers(each, PARTS * 2 * (1 + len(NAMES)))) for each in _list(proof["friction"], windows)
        ),
        steps=steps,
        cells=tuple(tuple(_one_of(known, each) for each in _list(cell, windows)) for cell in cells),
    )


def _one_of(known: Sequence[Ellipsoid], place: object) -> Ellipsoid | None:
    if place is None:
        return None
    if not isinstance(place, int) or isinstance(place, bool) or not 0 <= place < len(known):
        raise Refused("a cell names an ellipsoid that is not there")
    return known[place]


def _parts(numbers: Sequence[Fraction]) -> Parts:
    ends = [float(each) for each in numbers]
    if any(Fraction(end) != each for end, each in zip(ends, numbers, strict=True)):
        raise Refused("a bound of the friction or a range of the steepness is not a double")
    pairs = tuple(zip(ends[::2], ends[1::2], strict=True))
    if any(low > high for low, high in pairs):
        raise Refused("a range of the friction or of the steepness is none")
    count = 1 + len(NAMES)
    return tuple(Part(pairs[k], Friction.of(pairs[k + 1 : k + count])) for k in range(0, len(pairs), count))


def _ellipsoid(written: Sequence[Fraction]) -> Ellipsoid:
    pulse, supply, near, settled, shortest, longest, back, room, beyond, curve, *numbers = written
    if not 0 < pulse <= 1:
        raise Refused("the longest pulse must be above 0, and the sample at most")
    if not 0 <= supply <= 1:
        raise Refused("the share of the full pressure must be from 0 to 1")
    if near not in range(len(REACHES)):
        raise Refused("a reach is not there")
    if not 0 <= shortest <= longest <= pulse or not 0 < back <= pulse:
        raise Refused(
            "the pulses of the way at the center, and those back, must be from 0 to the longest one"
        )
    if not room > 0:
        raise Refused("the room above the cylinder must be above 0")
    if not (beyond >= 1 and curve >= 1):
        raise Refused("what is wanted at most, and predicted, must be stated as 1 or more times its limit")
    entries = dict(zip(ENTRIES, numbers, strict=False))
    rows = tuple(tuple(entries[max(i, j), min(i, j)] for j in range(STATES)) for i in range(STATES))
    center, (drift, *rest) = numbers[len(ENTRIES) :][:STATES], numbers[len(ENTRIES) + STATES :]
    moves, (alpha, offset, *shares, lag, steady, change, inside) = rest[:STATES], rest[STATES:]
    return Ellipsoid(
        pulse=pulse,
        supply=supply,
        near=int(near),
        settled=settled,
        shortest=shortest,
        longest=longest,
        back=back,
        room=room,
        beyond=beyond,
        curve=curve,
        matrix=rows,
        center=tuple(center),
        drift=drift,
        moves=tuple(moves),
        alpha=alpha,
        offset=offset,
        shares=tuple(shares),
        lag=lag,
        steady=steady,
        change=change,
        inside=inside,
    )


def _list(written: object, count: int) -> list[Any]:
    if not isinstance(written, list) or len(written) != count:
        raise Refused(f"the proof does not have one entry for each of {count} windows")
    return written


def _numbers(written: object, count: int) -> list[Fraction]:
    if not isinstance(written, list) or len(written) != count:
        raise Refused(f"the proof lacks {count} numbers")
    if any(len(str(each)) > MOST_LETTERS for each in written):
        raise Refused(f"a number of the proof has more than {MOST_LETTERS} letters")
    return [number(each) for each in written]
