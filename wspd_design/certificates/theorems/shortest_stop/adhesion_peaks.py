"""Upper bounds of the adhesion peak over the speed: a certificate of them and its checker, which searches nothing.

f = (2/pi) Q m S(eps), m the friction at the sliding speed and eps = stiffness slip/(m Q), grows with m: its
derivative is (2/pi) Q (S - eps S') with S - eps S' = 2 x^3/(1 + x^2)^2 + atan y - y/(1 + y^2) >= 0 for x = kA eps,
y = kS eps. Friction falls with the sliding speed, so that f falls with v at a fixed slip: a bound of the peak at one
speed holds at all higher ones. A certificate names speeds, a bound for each, and cuts of the slip from 0 to 1. On a
part of the slip the bound is shown in one of two ways:

* the friction is largest at the lower end, x/(1 + x^2) has its maximum 1/2 at x = 1, and atan rises;
* the mean value form, with the slope of f enclosed on the part.

The last speed is the initial one, which comes from the problem. From the bounds ``adhesion_limit.py`` computes the
shortest stop.
"""

import math
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from typing import Any

from wspd_design.certificates.kernel.arb import Ball, ball, in_balls, point
from wspd_design.certificates.kernel.checker import Refused, Work
from wspd_design.certificates.theorems.shortest_stop.adhesion_limit import Limit, loaded, stop_limit
from wspd_design.certificates.theorems.shortest_stop.extremes import Extremes
from wspd_design.model import adhesion
from wspd_design.model.generated import adhesion as generated
from wspd_design.parameters.loading import constants

FORMAT = "wspd-peaks/2"
MOST_SPEEDS, MOST_CUTS = 1000, 1000
MOST_CHARACTERS = 20  # of a number and the space before it
NUMBER = re.compile(
    r"[0-9]{1,4}(\.[0-9]{1,12})?"
)  # no exponent, which could stand for a number that fills the memory
PART_WORK = 100  # operations on balls that a part of the slip is worth

PartTest = Callable[[Fraction, Fraction, Fraction], bool]
"""Whether f/Q is at most the third number on the part of the slip between the first two."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Peaks:
    """What a certificate says, in exact numbers."""

    speeds: tuple[Fraction, ...]  # m/s, rising from 0
    tops: tuple[Fraction, ...]  # -, bound of f/Q from each speed on
    cuts: tuple[tuple[Fraction, ...], ...]  # -, of the slip between 0 and 1, for each speed


def decide(plants: Extremes, start: float, proof: Mapping[str, Any], work: Work) -> tuple[Limit, int]:
    """Return what a certificate of adhesion peaks shows about every stop, and the number of parts of the slip.

    Parameters
    ----------
    plants : Extremes
        Plants that the bound shall cover.
    start : float
        Speed at which every stop starts [m/s].
    proof : mapping
        The certificate from JSON; it may be anything.
    work : Work
        What may still be spent.

    Raises
    ------
    Refused
        If the certificate is malformed or shows nothing.
    NoBound
        If the derivation does not cover the plants.
    """
    found = read(proof, start)
    parts = 0
    for speed, top, cuts in zip(found.speeds, found.tops, found.cuts, strict=True):
        work.spend(PART_WORK * (len(cuts) + 1))
        holds = part_test(plants, speed)
        for low, high in pairwise((Fraction(0), *cuts, Fraction(1))):
            if not holds(low, high, top):
                raise Refused(
                    f"the peak {float(top):g} at {float(speed):g} m/s is not shown for slips from "
                    f"{float(low):g} to {float(high):g}"
                )
            parts += 1
    return stop_limit(plants, (*found.speeds, Fraction(start)), found.tops), parts


def part_test(plants: Extremes, speed: Fraction) -> PartTest:
    """Return the test of a bound of f/Q on a part of the slip at one train speed, under the least load.

    Parameters
    ----------
    plants : Extremes
        With the signs that :func:`overspeed` asks for.
    speed : Fraction
        Of the train [m/s].
    """
    rail = in_balls(plants.strong_rail)
    load, stiffness = loaded(in_balls(plants.strong), plants.share)
    # Below the regularization speed the slip is referred to that speed, and sliding is no faster than there.
    referred = point(max(speed, Fraction(constants().slip_regularization_speed)))

    def ends(low: Ball, high: Ball) -> Ball:
        """Bound f/Q on a part by what is monotone."""
        friction = generated.friction_coefficient(
            low * referred, rail.mu0, rail.friction_ratio, rail.friction_decay
        )
        gradients = [stiffness * slip / (friction * load) for slip in (low, high)]
        first, second = (rail.adhesion_reduction * gradient for gradient in gradients)
        if second < 1:
            hump = second / (1 + second * second)
        elif first > 1:
            hump = first / (1 + first * first)
        else:
            hump = point(0.5)
        return 2 * friction / point(math.pi) * (hump + (rail.slip_reduction * gradients[1]).atan())

    def mean_value(part: Ball, middle: Ball) -> Ball:
        """Enclose f/Q on a part by its value in the middle and its slope."""
        reached = adhesion.creep_force(middle, middle * referred, load, rail, stiffness)
        slope = adhesion.creep_force_slip_derivative(part, referred, load, rail, stiffness)
        return (reached + slope * (part - middle)) / load

    def holds(low: Fraction, high: Fraction, top: Fraction) -> bool:
        bound = point(top)
        if ends(point(low), point(high)) <= bound:
            return True
        return bool(mean_value(ball(low, high), point((low + high) / 2)) <= bound)

    return holds


def read(proof: Mapping[str, Any], start: float) -> Peaks:
    """Read a certificate of the peaks from standstill to the initial speed [m/s].

    Raises
    ------
    Refused
        If it is not one, or its numbers do not rise as they have to.
    """
    if proof.keys() != {"format", "speeds", "peaks", "cuts"} or proof["format"] != FORMAT:
        raise Refused(f"the proof does not have the format {FORMAT}")
    speeds, tops = (_numbers(proof[key], key, MOST_SPEEDS) for key in ("speeds", "peaks"))
    written = proof["cuts"]
    if not isinstance(written, list) or not len(written) == len(speeds) == len(tops):
        raise Refused("the proof does not have one peak and one list of cuts for each speed")
    cuts = tuple(_numbers(each, "cuts", MOST_CUTS) for each in written)
    if speeds[:1] != (Fraction(0),) or not _rise((*speeds, Fraction(start))):
        raise Refused("the speeds do not rise from 0 to the initial speed")
    if not all(_rise((Fraction(0), *each, Fraction(1))) for each in cuts):
        raise Refused("the cuts do not rise between 0 and 1")
    return Peaks(speeds=speeds, tops=tops, cuts=cuts)


def _numbers(written: object, name: str, most: int) -> tuple[Fraction, ...]:
    """Read decimals that stand in one text."""
    short = isinstance(written, str) and len(written) <= most * MOST_CHARACTERS
    words = written.split() if short and isinstance(written, str) else None
    if words is None or len(words) > most or not all(NUMBER.fullmatch(each) for each in words):
        raise Refused(f"the proof states no {name}")
    return tuple(Fraction(each) for each in words)


def _rise(numbers: tuple[Fraction, ...]) -> bool:
    return all(a < b for a, b in pairwise(numbers))
