"""The sampled loop of a law with friction-torque observer, as corners of what may enter a sample.

The state X = (e, p, N, Y, D) and what one sample makes of it stand in :mod:`derivations.slip_loop`. The map is affine
in each of the numbers that may differ from sample to sample, (phi, psi) counted as one: a quadratic function of the
next state is then convex along each, and corners of their ranges decide about all values in between.

Written for every number type: doubles search, balls prove.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import reduce
from itertools import pairwise, product
from typing import Any, NamedTuple, TypeAlias

from wspd_design.model.generated import slip_loop as generated
from wspd_design.model.number import Number, maximum, minimum

Pair: TypeAlias = tuple[Number, Number]
Matrix: TypeAlias = tuple[Any, ...]
"""Its rows."""

STATES = 5
REFERENCE_DRIFT = "reference drift"
DISTURBANCES = (
    "acceleration error",
    "command error",
    "torque drift",
    "mean torque drift",
    REFERENCE_DRIFT,
    "mean reference drift",
    "slip drift",
    "uneven slip drift",
    "speed error",
    "lag drift",
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
    kept: Number  # -, of the error of the filtered acceleration over a sample


class Way(NamedTuple):
    """Numbers of a wanted change of the torque."""

    part: Number  # -, rho of the rest beside the change at the center
    part_center: Number  # -, rho of that one
    late: Number  # -, share of the sample that sees the torque before the rest
    seen: Number  # -, share of the rest in the mean torque of the law


@dataclass(frozen=True, slots=True, kw_only=True)
class LoopRanges:
    """Ranges of the numbers that may differ from sample to sample."""

    secants: Pair  # 1/s, of the friction over the wheel speed, over the inertia; neither end 0
    effects: Pair  # -, g
    ways: tuple[Way, ...]  # corners
    shares_center: Pair  # -, late share and share in the mean torque of the law, of the way at the center
    pulls: tuple[Number, ...] = (1.0,)  # -, corners of the pull over k e, of what is beside the center
    brought: tuple[Number, ...] = (0.0,) * len(
        DISTURBANCES
    )  # -, what a reference drift of 1 brings along of each disturbance


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
    found = [*speedups, *(generated.part_of_way(each, longest) for each in speedups)]
    return reduce(minimum, found), reduce(maximum, found)


def ways_about(
    side: Pair, other: Pair, far: Number, shares: tuple[Sequence[Pair], Sequence[Pair]], center: Pair
) -> tuple[Way, ...]:
    """Return corners of ways about one at a center: of longer or shorter ones on its side, and of those to the other.

    A way to the other side is one from 0 and that at the center, each for its part of the distance from there.

    Parameters
    ----------
    side, other : tuple of number
        Smallest and largest part of ways to the side of that at the center, and to the other side.
    far : number
        Largest part of the distance that lies on the other side.
    shares : tuple of two sequences of pairs
        Corners of late share and share in the mean torque of the law: of what is between ways on the side of that at
        the center, and of ways from 0 to the other side.
    center : tuple of number
        The same of the way at the center.
    """
    own, opposite = shares
    found = []
    for rho in side:
        found += [Way(rho, rho, *each) for each in (*own, center)]
        for there, (late, seen) in product(other, opposite):
            part = rho + far * (there - rho)
            weighed = far * there * (1 - late) + (1 - far) * rho * (1 - center[0])
            found.append(Way(part, rho, 1 - weighed / part, far * seen + (1 - far) * center[1]))
    return tuple(found)


def cut_to(ways: Sequence[Way], share: Number) -> tuple[Way, ...]:
    """Return corners of ways of which the rest beside the center may be cut to a share by the longest pulse."""
    cut = (each._replace(part=share * each.part, seen=share * each.seen) for each in ways)
    return (*ways, *cut)


def latest_share(growth: Number, pulse: Number, delay: Number, added: Number) -> Number:
    """Return the largest share of a sample that sees the torque before a pulse.

    Parameters
    ----------
    growth : number
        Largest secant times the sample time [-].
    pulse, delay : number
        Longest pulse and its latest beginning, over the sample time [-].
    added : number
        What a rising supply adds to a way at most, over the way; it may come last [-].
    """
    return (generated.lateness(growth, pulse, delay) + added) / (1.0 + added)


def shares_together(left: Pair, true: Pair, law: Pair) -> tuple[Pair, ...]:
    """Return the late share and the share in the mean torque of the law that go together, as corners.

    The later a pulse ends, the less of it counts in either mean: l a of what the wheel sees and l b of what the law
    works out, with one l and numbers a and b that hardly differ from pulse to pulse. With a = A (1 + x), b = B (1 + y),
    A and B in the middle of their ranges, l x and l y are (l x + l y)/2 along with l, and (l x - l y)/2 aside.

    Parameters
    ----------
    left : tuple of number
        Smallest and largest l [-].
    true : tuple of number
        Smallest and largest a, of the true change [-].
    law : tuple of number
        Smallest and largest b, of the one that the law works out [-].
    """
    low, high = left
    (a, spread_a), (b, spread_b) = (((x + y) / 2, (y - x) / (x + y)) for x, y in (true, law))
    aside = (spread_a + spread_b) / 2 * high
    return tuple(
        (1 - a * (along + sign * aside), b * (along - sign * aside))
        for along in (low - aside, high + aside)
        for sign in (1.0, -1.0)
    )


def numbers_at_corners(
    law: LoopLaw, ranges: LoopRanges
) -> Iterator[tuple[tuple[Number, ...], tuple[Number, ...]]]:
    """Return phi, psi/h, g, rho, both shares of the sample, and the pull at all corners, for the rest and the center.

    At the center the pull is k e.
    """
    for slide, g, way, pull in product(
        polygon(ranges.secants, law.sample_time), dict.fromkeys(ranges.effects), ranges.ways, ranges.pulls
    ):
        yield (
            (*slide, g, way.part, way.late, way.seen, pull),
            (*slide, g, way.part_center, *ranges.shares_center, 1.0),
        )


def corners(law: LoopLaw, ranges: LoopRanges, units: Sequence[Any]) -> Iterator[tuple[Matrix, Matrix]]:
    """Return [A B] of X+ = A X + B d at all corners, for the rest beside a center and for the center.

    With Z = (X, d) and Z_c its values at the center, X+ = [A B] (Z - Z_c) + [A B]_c Z_c.

    Parameters
    ----------
    law : LoopLaw
        Numbers of the law.
    ranges : LoopRanges
        Of what may differ.
    units : sequence
        Rows of the identity, as anything that adds up and takes a factor; d in the order of :data:`DISTURBANCES`.
    """
    units = with_reference(units, ranges.brought)
    for rest, center in numbers_at_corners(law, ranges):
        yield sample(law, rest, units), sample(law, center, units)


def with_reference(units: Sequence[Any], brought: Sequence[Number]) -> list[Any]:
    """Add to each disturbance what the drift of the reference brings along of it; units as in :func:`corners`."""
    drift = units[STATES + DISTURBANCES.index(REFERENCE_DRIFT)]
    disturbed = [each + share * drift for each, share in zip(units[STATES:], brought, strict=True)]
    return [*units[:STATES], *disturbed]


def wanted(law: LoopLaw, pull: Number = 1.0) -> tuple[Number, ...]:
    """Return the row that gives Y* from the state, for a pull over k e; what adds to D, it counts as D."""
    columns = [[float(i == j) for i in range(STATES)] for j in range(STATES)]
    gain = pull * law.gain
    return tuple(generated.wanted_torque(e, n, y, gain, law.ahead, lag) for e, _, n, y, lag in columns)


def sample(law: LoopLaw, numbers: Sequence[Any], units: Sequence[Any]) -> tuple[Any, ...]:
    """Return the rows of [A B] for some numbers of a sample, with units as in :func:`corners`."""
    e, p, n, y, lag, error, *disturbed = units
    phi, psi, g, rho, late, seen, pull = numbers
    way = generated.wanted_torque(e, n, y, pull * law.gain, law.ahead, lag + error) - y
    return generated.next_sample(
        e, p, n, y, lag, way, phi, psi, g, rho, late, seen, law.pole, law.kept, *disturbed
    )
