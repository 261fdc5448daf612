"""The loop about a center of its states: changes of the torque are the one at the center and the rest."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import product
from operator import mul
from typing import NamedTuple

from wspd_design.certificates.kernel.arb import Ball, ball, ends_of, hull_of, least_of, most_of, point
from wspd_design.certificates.kernel.checker import Refused
from wspd_design.certificates.setting.slip_loop import (
    DISTURBANCES,
    Pair,
    parts_about,
    parts_of,
    shares_together,
    wanted,
)
from wspd_design.certificates.theorems.slip_band.loop import Loop
from wspd_design.certificates.theorems.slip_band.pulses import Limit, Pulses, Row, in_time, loop_law
from wspd_design.certificates.theorems.slip_band.statement import BandLaw
from wspd_design.model.generated.slip_loop import share_after

LEVEL = 1e-9  # growth of errors over a sample that counts as none


class Lengths(NamedTuple):
    """Pulses over the sample time."""

    shortest: Fraction  # of the way at the center, at any torque of the states
    longest: Fraction
    back: Fraction  # longest one to the other side


def about(law: BandLaw, loop: Loop, center: Sequence[Ball], lengths: Lengths) -> Loop:
    """Return the loop with changes of the torque counted from the one at a center of the states.

    Parameters
    ----------
    law : BandLaw
        Its numbers.
    loop : Loop
        As :func:`loop_of` returns it.
    center : sequence of ball
        State [rad/s].
    lengths : Lengths
        What pulses are kept to.
    """
    way = way_at(law, loop, center)
    if not (way > 0 or way < 0):
        return loop
    side, other = loop.pulses if way > 0 else loop.pulses[::-1]
    pulse, (shortest, longest, back) = loop.pulse, map(point, lengths)
    # A way to the other side counts for its part of the distance from the center, at most as it does for the longest.
    most_back = other.part(back) * ends_of(loop.pulses[0].height[1] + loop.pulses[1].height[1])[1]
    far = most_back / (most_back + abs(way))
    opposite = tuple(end + far * (each - end) for end, each in zip(side.parts, other.parts, strict=True))
    shares, (late, seen) = _shares(law, loop, (side, other), (shortest, longest))
    disturbances = [low.union(high) for low, high in loop.disturbances]
    known = tuple(point(Fraction(float(each.mid()))) for each in (late, seen))
    disturbances[DISTURBANCES.index("mean reference drift")] += (seen - known[1]) * way
    effect = loop.ranges.effects[1]
    most = most_of([end for each in loop.pulses for end in each.parts]) * effect
    steepest = most_of([loop.ranges.secants[1] * point(law.sample_time), point(LEVEL)])
    # To the other side the valve is another one: a part of what is gone there has not the late share of the way there.
    mixed = most_of([abs(here - there) for here, there in product(side.parts, other.parts)])
    mixed *= most_of([back, longest]) / 2 * ball(Fraction(-1), Fraction(1))
    disturbances[DISTURBANCES.index("uneven slip drift")] += (
        ((late - known[0]) * most + mixed * effect) * way * steepest.expm1() / steepest
    )
    within = (in_time(law, each, pulse if each is side else back, loop.beside) for each in loop.pulses)
    return replace(
        loop,
        ranges=replace(
            loop.ranges,
            parts=parts_about(side.parts, ends_of(hull_of(opposite))),
            shares=shares,
            shares_center=known,
        ),
        disturbances=tuple(map(ends_of, disturbances)),
        limits=(*within, *loop.limits[2:], *_center_in_time(side, abs(way), (shortest, longest))),
    )


def _shares(
    law: BandLaw, loop: Loop, sides: tuple[Pulses, Pulses], at_center: tuple[Ball, Ball]
) -> tuple[tuple[Pair, ...], tuple[Ball, Ball]]:
    """Return the late share and the share in the mean torque of the law, of the rest as corners and of the center.

    What a longer pulse changes counts in a mean over the sample from its end on. So a part l of the rest counts in the
    mean torque that the law works out, times the rate of the way that it goes by its nominal times; and nearly the same
    part in what the wheel sees, which is weighted by how errors grow, comes later with a late pulse, and goes by the
    true times. Lengths are convex over ways: l is at least as large as halfway between the center and the longest one.

    Parameters
    ----------
    law : BandLaw
        Its numbers.
    loop : Loop
        As :func:`loop_of` returns it.
    sides : tuple of Pulses
        To the side of the way at the center, and to the other one.
    at_center : tuple of ball
        Shortest and longest pulse of the way at the center, over the sample time.
    """
    h, share, side = point(law.sample_time), point(law.time_share), sides[0]
    shortest, longest = at_center
    low, high = loop.ranges.secants
    slowest, fastest = least_of([low * h, point(-LEVEL)]), most_of([high * h, point(LEVEL)])
    reach, none = loop.pulse / side.time, point(0)
    # The part gone on the way from the center differs by so much from that on the way from none.
    begun = side.part(longest) / side.part(loop.pulse)

    def uneven(speedup: Ball) -> Ball:
        return 1 + ((abs(1 - speedup) * reach).exp() - 1) * begun

    uneven_true = most_of([uneven(end) for end in side.speedups])
    # Parts l of the true change have other weights than those of the law, which differ by side.
    weights = most_of(
        [
            ((abs(end - share) + abs(1 - share)) * loop.pulse / each.time).exp()
            for each in sides
            for end in each.speedups
        ]
    ).sqrt()
    aside = loop.pulse * (weights - 1) / (weights + 1)
    left, added = 1 - (loop.pulse + longest) / 2, loop.added
    later = most_of([share_after(fastest, left - aside - loop.delay), none])
    earlier = share_after(slowest, left + aside) * uneven_true
    least, most = parts_of((share, share), most_of([loop.pulse / each.time for each in sides]))
    shares = shares_together(
        (left, point(1)),
        (later / uneven_true / (1 + added) / left, (earlier + added) / (1 + added) / left),
        ends_of((least / uneven(share)).union(most * uneven(share))),
    )
    # Of the center itself, over the part that is gone on the whole way.
    least, most = parts_of((share, share), longest / side.time)
    fading = (
        -share * longest / side.time
    ).exp()  # the rate at the end of the pulse over that at its beginning
    seen = (least * (1 - longest / 2)).union(most * (1 - fading * shortest / 2))
    differs = [
        most_of([excess * loop.pulse, abs(1 - end) * longest]) / side.time
        for sign, end in zip((1, -1), side.speedups, strict=True)
        for excess in (sign * (1 - end),)
    ]
    faster = (-side.speedups[1] * longest / side.time).exp()
    last = most_of([share_after(fastest, 1 - longest / 2 - loop.delay), none]) * (-differs[0]).exp()
    first = share_after(slowest, 1 - faster * shortest / 2) * differs[1].exp()
    return shares, (1 - (last / (1 + added)).union((first + added) / (1 + added)), seen)


def way_at(law: BandLaw, loop: Loop, center: Sequence[Ball]) -> Ball:
    """Return the wanted change of the torque at a center, what disturbs being in its middle [rad/s]."""
    known, command = ((low + high) / 2 for low, high in loop.disturbances[:2])
    asked = wanted(loop_law(law))
    return sum(map(mul, asked, center), command + asked[4] * known - center[3])


def _center_in_time(side: Pulses, way: Ball, lengths: tuple[Ball, Ball]) -> Iterator[Limit]:
    """Keep the torque where the way at the center takes no shorter and no longer a pulse."""
    least, most = way.lower(), way.upper()
    shortest, longest = map(side.part, lengths)

    def row(sign: int) -> Row:
        return (point(0), point(0), point(0), point(sign * side.rises), point(0))

    if not longest > 0:
        raise Refused("the pulses of the way at the center must be from 0 to the longest one")
    yield Limit(
        what="the torque at which the way at the center is too long",
        row=row(-1),
        bound=side.height[0] - most / longest,
    )
    if shortest > 0:
        yield Limit(
            what="the torque at which the way at the center is too short",
            row=row(1),
            bound=least / shortest - side.height[1],
        )
