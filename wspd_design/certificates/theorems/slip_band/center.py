"""The loop about a center of its states: changes of the torque are the one at the center and the rest."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from operator import mul
from typing import NamedTuple

from wspd_design.certificates.kernel.arb import Ball, ends_of, hull_of, most_of, point
from wspd_design.certificates.kernel.checker import Refused
from wspd_design.certificates.setting.slip_loop import (
    DISTURBANCES,
    parts_about,
    parts_of,
    parts_of_longer,
    wanted,
)
from wspd_design.certificates.theorems.slip_band.loop import Loop
from wspd_design.certificates.theorems.slip_band.pulses import Limit, Pulses, Row, in_time, loop_law
from wspd_design.certificates.theorems.slip_band.statement import BandLaw


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
    share, (shortest, longest, back) = point(law.time_share), map(point, lengths)
    pulse = loop.ranges.pulse
    further = parts_of_longer(share, most_of([pulse / each.time for each in loop.pulses]))
    # The mean over a pulse of what it has reached: a longer one counts from its end on, and ends are convex over ways.
    seen = ends_of((further[0] * (1 - (pulse + longest) / 2)).union(further[1]))
    least, most = parts_of((share, share), longest / side.time)
    fading = (
        -share * longest / side.time
    ).exp()  # the rate at the end of the pulse over that at its beginning
    seen_center = (least * (1 - longest / 2)).union(most * (1 - fading * shortest / 2))
    known = point(Fraction(float(seen_center.mid())))
    disturbances = [low.union(high) for low, high in loop.disturbances]
    disturbances[DISTURBANCES.index("mean reference drift")] += (seen_center - known) * way
    # A way to the other side counts for its part of the distance from the center, at most as it does for the longest.
    most_back = other.part(back) * ends_of(loop.pulses[0].height[1] + loop.pulses[1].height[1])[1]
    far = most_back / (most_back + abs(way))
    opposite = tuple(end + far * (each - end) for end, each in zip(side.parts, other.parts, strict=True))
    within = (in_time(law, each, pulse if each is side else back, loop.beside) for each in loop.pulses)
    return replace(
        loop,
        ranges=replace(
            loop.ranges,
            parts=parts_about(side.parts, ends_of(hull_of(opposite))),
            seen=seen,
            seen_center=known,
        ),
        disturbances=tuple(map(ends_of, disturbances)),
        limits=(*within, *loop.limits[2:], *_center_in_time(side, abs(way), (shortest, longest))),
    )


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
