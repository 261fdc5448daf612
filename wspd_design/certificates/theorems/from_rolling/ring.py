"""A larger ellipsoid, of which every sample leads further inwards, until the wheels are in that of a band.

Its next state has at most alpha V + D, with D the sum of the shares: after n samples at most D/(1 - alpha) + alpha^n of
what the ellipsoid allows. So much of it must lie in the ellipsoid of the band.
"""

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from math import ceil, log
from typing import NamedTuple

from wspd_design.certificates.kernel.arb import above, below, point
from wspd_design.certificates.kernel.checker import Refused
from wspd_design.certificates.records import Problem
from wspd_design.certificates.theorems.slip_band.arrival import Asked
from wspd_design.certificates.theorems.slip_band.checker import (
    DIGITS,
    errors,
    inverse,
    lies_in,
    steady_of,
)
from wspd_design.certificates.theorems.slip_band.loop import Conditions, loop_of
from wspd_design.certificates.theorems.slip_band.proof import Ellipsoid, Proof
from wspd_design.certificates.theorems.slip_band.statement import Cell, fastest_loss, law_of, windows_of


class Ring(NamedTuple):
    """An ellipsoid around that of a band, both of the same cell and window."""

    ellipsoid: Ellipsoid
    inside: Fraction  # multiplier that shows that what is left of it lies in what it leads to
    spared: Fraction  # of D/(1 - alpha), that alpha^n may be


class Led(NamedTuple):
    """What the outermost ring asks of the wheels, and what all of them tell."""

    asked: Asked
    samples: int  # until they are in the ellipsoid of the band
    errors: tuple[float, float]  # rad/s, of the wheel speed until then


def led(problem: Problem, found: Proof, at: tuple[Cell, int], band: Ellipsoid, rings: Sequence[Ring]) -> Led:
    """Return what rings, the outermost first, ask for, or refuse them; the proof of the band is an accepted one.

    The speeds that it asks for leave room for what the train loses until the wheels are in the band.
    """
    from flint import ctx

    law, (cell, k) = law_of(problem.controller), at
    window = windows_of(problem)[k]
    if not rings:
        raise Refused("there is no ring")
    next_one, samples, ends = band, 0, (0.0, 0.0)
    with ctx.workprec(DIGITS):
        there = steady_of(problem, found, at, band)
        for ring in reversed(rings):
            outer = ring.ellipsoid
            conditions = Conditions(outer.supply, found.delay, found.noise, found.reserve)
            loop = loop_of(problem, law, cell, window, found.friction[k], outer.choice, conditions)
            low, high = errors(law, loop, outer)
            left = added_by(outer) / (1 - outer.alpha)
            if ring.spared <= 0 or not 0 < left * (1 + ring.spared) < 1:
                raise Refused("a ring does not lead inwards")
            if outer.supply < next_one.supply:
                raise Refused("what a ring leads to asks for more supply")
            inner = scaled(outer, left * (1 + ring.spared))
            if not lies_in((inner, loop.steady), (replace(next_one, inside=ring.inside), there)):
                raise Refused("what is left of a ring does not lie in what it leads to")
            samples += ceil(log(float(left * ring.spared)) / log(float(outer.alpha))) + 1
            ends = min(ends[0], below(low)), max(ends[1], above(high))
            next_one, there = outer, loop.steady
        away = above(there.away(point(next_one.drift)))
    return Led(
        asked=Asked(
            speeds=(window[0] + float(fastest_loss(problem) * law.sample_time * samples), window[1]),
            settled=float(next_one.settled),
            matrix=inverse(next_one.matrix),
            center=[float(each) for each in next_one.center],
            moved=[float(each) * away for each in next_one.moves],
            supply=float(next_one.supply),
        ),
        samples=samples,
        errors=ends,
    )


def added_by(ellipsoid: Ellipsoid) -> Fraction:
    """Return what all shares add up to."""
    return sum((ellipsoid.offset, *ellipsoid.shares, ellipsoid.steady, ellipsoid.change), Fraction(0))


def scaled(ellipsoid: Ellipsoid, times: Fraction) -> Ellipsoid:
    """Return it with a multiple of Q."""
    return replace(ellipsoid, matrix=tuple(tuple(times * each for each in row) for row in ellipsoid.matrix))
