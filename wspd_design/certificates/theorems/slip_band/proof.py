"""The proof of a band of slip as JSON; everything in it is suspect."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, TypeAlias

from wspd_design.certificates.kernel.checker import Refused, number
from wspd_design.certificates.kernel.term import text
from wspd_design.certificates.setting.slip_loop import DISTURBANCES, STATES
from wspd_design.certificates.theorems.slip_band.loop import Friction

FORMAT = "wspd-slip-band/1"
MOST_CELLS, MOST_LETTERS = 4_000, 60  # of a proof, and of a number in it
ENTRIES = [(i, j) for i in range(STATES) for j in range(i + 1)]

Square: TypeAlias = tuple[tuple[Fraction, ...], ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class Ellipsoid:
    """X'PX <= 1, what of it is left after a sample, and what each disturbance adds at most."""

    matrix: Square  # P [s2/rad2]
    alpha: Fraction
    shares: tuple[Fraction, ...]  # in the order of the disturbances


@dataclass(frozen=True, slots=True, kw_only=True)
class Proof:
    """Bounds of the friction for each window, the slowest first, how the box is halved, and the cells in preorder."""

    friction: tuple[Friction, ...]
    steps: str
    cells: tuple[tuple[Ellipsoid, ...], ...]  # for each cell one for each window


def write(found: Proof) -> dict[str, Any]:
    """Write a proof as JSON."""
    return {
        "format": FORMAT,
        "friction": [[text(Fraction(end)) for ends in each for end in ends] for each in found.friction],
        "steps": found.steps,
        "cells": [[_written(each) for each in cell] for cell in found.cells],
    }


def _written(each: Ellipsoid) -> list[str]:
    return [text(value) for value in (*(each.matrix[i][j] for i, j in ENTRIES), each.alpha, *each.shares)]


def read(proof: Mapping[str, Any], windows: int) -> Proof:
    """Read a proof about a number of windows, or refuse it."""
    if proof.keys() != {"format", "friction", "steps", "cells"} or proof["format"] != FORMAT:
        raise Refused(f"the proof does not have the format {FORMAT}")
    steps, cells = proof["steps"], proof["cells"]
    if not isinstance(steps, str) or not isinstance(cells, list) or not 0 < len(cells) <= MOST_CELLS:
        raise Refused("the proof has no steps or no cells, or too many")
    if len(steps) != 2 * len(cells) - 1:
        raise Refused("steps and cells do not match")
    return Proof(
        friction=tuple(_friction(_numbers(each, 6)) for each in _list(proof["friction"], windows)),
        steps=steps,
        cells=tuple(
            tuple(
                _ellipsoid(_numbers(each, len(ENTRIES) + 1 + len(DISTURBANCES)))
                for each in _list(cell, windows)
            )
            for cell in cells
        ),
    )


def _friction(numbers: Sequence[Fraction]) -> Friction:
    ends = [float(each) for each in numbers]
    if any(Fraction(end) != each for end, each in zip(ends, numbers, strict=True)):
        raise Refused("a bound of the friction is not a double")
    slope, level, fading = (ends[0], ends[1]), (ends[2], ends[3]), (ends[4], ends[5])
    if not (slope[0] < slope[1] and level[0] <= level[1] and fading[0] <= fading[1]):
        raise Refused("a range of the friction is none")
    return Friction(slope=slope, level=level, fading=fading)


def _ellipsoid(numbers: Sequence[Fraction]) -> Ellipsoid:
    entries = dict(zip(ENTRIES, numbers, strict=False))
    rows = tuple(tuple(entries[max(i, j), min(i, j)] for j in range(STATES)) for i in range(STATES))
    count = len(ENTRIES)
    return Ellipsoid(matrix=rows, alpha=numbers[count], shares=tuple(numbers[count + 1 :]))


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
