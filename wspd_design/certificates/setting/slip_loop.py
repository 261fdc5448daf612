"""The sampled loop of a law with friction-torque observer, as corners of what may enter a sample.

The state X = (e, p, N, Y) and what one sample makes of it stand in :mod:`derivations.slip_loop`. The map is affine in
each of the numbers that may differ from sample to sample, (phi, psi) counted as one: a quadratic function of the next
state is then convex along each, and corners of their ranges decide about all values in between.

Written for every number type: doubles search, balls prove.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import reduce
from itertools import pairwise, product
from typing import Any, TypeAlias

from wspd_design.model.generated import slip_loop as generated
from wspd_design.model.number import Number, maximum, minimum

Pair: TypeAlias = tuple[Number, Number]
Matrix: TypeAlias = tuple[Any, ...]
"""Its rows."""

STATES = 4
DISTURBANCES = (
    "acceleration error",
    "command error",
    "torque drift",
    "mean torque drift",
    "reference drift",
    "mean reference drift",
    "slip drift",
    "uneven slip drift",
    "speed error",
)
"""Beside the state; each is bounded [rad/s]."""

EDGE = (0.0, 0.5, 1.0)  # shares of a sample after which the secant changes, where tangents touch the edge


@dataclass(frozen=True, slots=True, kw_only=True)
class LoopLaw:
    """Numbers of the law, as it has them."""

    sample_time: Number  # s, h
    gain: Number  # -, of the surface, k h
    ahead: Number  # -
    pole: Number  # -, of the observer, theta


@dataclass(frozen=True, slots=True, kw_only=True)
class LoopRanges:
    """Ranges of the numbers that may differ from sample to sample."""

    secants: Pair  # 1/s, of the friction over the wheel speed, over the inertia; neither end 0
    effects: Pair  # -, g
    parts: Pair  # -, rho
    seen: Pair  # -, share of the wanted way in the mean torque of the law
    pulse: Number  # -, longest pulse over the sample time
    delay: Number  # -, latest beginning of a pulse over the sample time
    added: Number  # -, what a rising supply adds to a way at most, over the way


def polygon(secants: Pair, sample_time: Number) -> tuple[Pair, ...]:
    """Return corners that enclose (phi, psi/h) of a sample, whatever the course of the secant within its range."""
    low, high = secants
    ends = [generated.switched_slide(last, last, 1.0, sample_time)[:2] for last in secants]
    corners = []
    for last, first in ((high, low), (low, high)):
        touching = [generated.switched_slide(last, first, share, sample_time) for share in EDGE]
        corners += [_meeting(one, other) for one, other in pairwise(touching)]
    return (*ends, *corners)


def _meeting(one: tuple[Number, Number, Number], other: tuple[Number, Number, Number]) -> Pair:
    """Where two tangents meet."""
    (x1, y1, slope1), (x2, y2, slope2) = one, other
    x = (y2 - y1 + slope1 * x1 - slope2 * x2) / (slope1 - slope2)
    return x, y1 + slope1 * (x - x1)


def parts_of(speedups: Pair, longest: Number) -> Pair:
    """Return the smallest and the largest part of the wanted way that the valve goes.

    Parameters
    ----------
    speedups : tuple of number
        Assumed over true time of the valve, smallest and largest [-].
    longest : number
        Longest pulse over the assumed time [-].
    """
    shortest_and_longest = [*speedups, *(generated.part_of_way(each, longest) for each in speedups)]
    return reduce(minimum, shortest_and_longest), reduce(maximum, shortest_and_longest)


def numbers_at_corners(law: LoopLaw, ranges: LoopRanges) -> Iterator[tuple[Number, ...]]:
    """Return phi, psi/h, g, rho, and both shares of the sample at all corners."""
    latest = generated.lateness(ranges.secants[1] * law.sample_time, ranges.pulse, ranges.delay)
    latest = (latest + ranges.added) / (1.0 + ranges.added)  # what the supply adds may come last
    for slide, g, rho, late, seen in product(
        polygon(ranges.secants, law.sample_time),
        dict.fromkeys(ranges.effects),
        dict.fromkeys(ranges.parts),
        (0.0, latest),
        dict.fromkeys(ranges.seen),
    ):
        yield (*slide, g, rho, late, seen)


def corners(law: LoopLaw, ranges: LoopRanges, units: Sequence[Any]) -> Iterator[Matrix]:
    """Return [A B] of X+ = A X + B d at all corners, d in the order of :data:`DISTURBANCES`.

    Parameters
    ----------
    law : LoopLaw
        Numbers of the law.
    ranges : LoopRanges
        Of what may differ.
    units : sequence
        Rows of the identity, as anything that adds up and takes a factor.
    """
    for each in numbers_at_corners(law, ranges):
        yield sample(law, each, units)


def wanted(law: LoopLaw) -> tuple[Number, ...]:
    """Return the row that gives Y* from the state, and from the acceleration error last."""
    columns = [[float(i == j) for i in range(STATES + 1)] for j in range(STATES + 1)]
    return tuple(
        generated.wanted_torque(e, n, y, law.gain, law.ahead, error) for e, _, n, y, error in columns
    )


def sample(law: LoopLaw, numbers: Sequence[Any], units: Sequence[Any]) -> tuple[Any, ...]:
    """Return the rows of [A B] for some numbers of a sample, with units as in :func:`corners`."""
    e, p, n, y, error, *disturbed = units
    way = generated.wanted_torque(e, n, y, law.gain, law.ahead, error) - y
    phi, psi, g, rho, late, seen = numbers
    return generated.next_sample(e, p, n, y, way, phi, psi, g, rho, late, seen, law.pole, *disturbed)
