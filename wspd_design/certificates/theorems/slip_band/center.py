"""The loop about a center of its states: changes of the torque are the one at the center and the rest."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from operator import mul
from typing import NamedTuple

from wspd_design.certificates.kernel.arb import Ball, ends_of, least_of, most_of, point
from wspd_design.certificates.kernel.checker import Refused
from wspd_design.certificates.setting.slip_loop import (
    DISTURBANCES,
    Pair,
    cut_to,
    parts_of,
    shares_together,
    ways_about,
)
from wspd_design.certificates.theorems.slip_band.limits import Limit, within_pulses
from wspd_design.certificates.theorems.slip_band.loop import Loop
from wspd_design.certificates.theorems.slip_band.pulses import Pulses
from wspd_design.certificates.theorems.slip_band.statement import BandLaw
from wspd_design.certificates.theorems.slip_band.wants import Row
from wspd_design.model.generated.slip_loop import share_after, share_left

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
    way = way_at(loop, center)
    loop = _on_curve(law, loop, center)
    if not (way > 0 or way < 0):
        if loop.beyond > 1:
            raise Refused(
                "more may be wanted than the longest pulse does, and the way at the center may have either sign"
            )
        return loop
    side, other = loop.pulses if way > 0 else loop.pulses[::-1]
    pulse, (shortest, longest, back) = loop.pulse, map(point, lengths)
    if loop.beyond > 1 and not back >= pulse:
        raise Refused(
            "more may be wanted than the longest pulse does, and pulses back are kept to shorter ones"
        )
    # A way to the other side counts for its part of the distance from the center, at most as it does for the longest.
    most_back = other.part(back) * ends_of(loop.pulses[0].height[1] + loop.pulses[1].height[1])[1]
    far = most_back / (most_back + abs(way))
    own = _together(law, loop, _from_center(law, loop, side, shortest, longest))
    opposite = _together(law, loop, _from_none(other, back))
    late = _center_late(law, loop, side, shortest, longest)
    seen = _center_seen(law, side, shortest, longest)
    disturbances = [low.union(high) for low, high in loop.disturbances]
    known = tuple(point(Fraction(float(each.mid()))) for each in (late, seen))
    disturbances[DISTURBANCES.index("mean reference drift")] += (seen - known[1]) * way
    _, growth = _growths(law, loop)
    most = side.parts[1] * loop.ranges.effects[1] * growth.expm1() / growth
    disturbances[DISTURBANCES.index("uneven slip drift")] += (late - known[0]) * way * most
    ways = ways_about(side.parts, other.parts, far, (own, opposite), known)
    if loop.beyond > 1:
        # Of the limit the way at the center takes at most this part: its pulse is kept to the longest one.
        ways = cut_to(ways, share_left(1, loop.beyond, side.part(longest) / side.part(pulse)))
    return replace(
        loop,
        ranges=replace(loop.ranges, ways=ways, shares_center=known),
        disturbances=tuple(map(ends_of, disturbances)),
        within=within_pulses(
            loop.pulses,
            [pulse if each is side else back for each in loop.pulses],
            loop.wants,
            loop.beyond,
        ),
        others=(*loop.others, *_center_in_time(side, abs(way), (shortest, longest))),
    )


def _on_curve(law: BandLaw, loop: Loop, center: Sequence[Ball]) -> Loop:
    """Return the loop with the pull beside the center that the braking curve leaves of k e at least."""
    curve = loop.curve
    if curve is None or curve.times == 1:
        return loop
    there = sum(map(mul, curve.predicted(law), center), curve.beside[0].union(curve.beside[1]))
    if not there < curve.error:
        raise Refused("the center is on the braking curve")
    least = share_left(curve.left, curve.times, there / curve.error)
    return replace(loop, ranges=replace(loop.ranges, pulls=(point(1), ends_of(least)[0])))


def _growths(law: BandLaw, loop: Loop) -> tuple[Ball, Ball]:
    """Return growths of errors over a sample, as exponents other than 0: the smallest and the largest."""
    h = point(law.sample_time)
    low, high = loop.ranges.secants
    return least_of([low * h, point(-LEVEL)]), most_of([high * h, point(LEVEL)])


class _Change(NamedTuple):
    """Change of what the valve does, from a pulse of some length to one that is longer, up to the longest one.

    What a longer pulse changes counts in a mean over the sample from its end on. So a part l of a change counts in the
    mean torque that the law works out, times the rate of the way that it goes by its nominal times; and nearly the same
    part in what the wheel sees, which is weighted by how errors grow, comes later with a late pulse, and goes by the
    true times. Lengths are convex over ways: l is at least as large as halfway between the ends of the change. It is
    largest towards no pulse at all, where it is that of the whole way.
    """

    pulses: Pulses
    longest: Ball  # pulse over the sample time
    left: Pair  # -, smallest and largest l
    uneven: Ball  # -, factor by which the part gone in a change differs from that of all of a way at most
    uneven_law: Ball  # -, the same by the times of the law


def _from_center(law: BandLaw, loop: Loop, side: Pulses, shortest: Ball, longest: Ball) -> _Change:
    """Return changes from the way at the center, whose pulse has one of these lengths, to others on its side."""
    # The part gone on the way from the center differs by so much from that on the way from none.
    begun = side.part(longest) / side.part(loop.pulse)

    def uneven(speedup: Ball) -> Ball:
        return 1 + ((abs(1 - speedup) * loop.pulse / side.time).exp() - 1) * begun

    return _Change(
        pulses=side,
        longest=loop.pulse,
        left=(1 - (loop.pulse + longest) / 2, _most_left(law, side, shortest, longest)),
        uneven=most_of([uneven(end) for end in side.speedups]),
        uneven_law=uneven(point(law.time_share)),
    )


def _from_none(other: Pulses, back: Ball) -> _Change:
    """Return changes from no pulse to those to the other side."""
    return _Change(
        pulses=other, longest=back, left=(1 - back / 2, point(1)), uneven=point(1), uneven_law=point(1)
    )


def _together(law: BandLaw, loop: Loop, change: _Change) -> tuple[Pair, ...]:
    """Return corners of the late share and the share in the mean torque of the law, of a change."""
    share, (slowest, fastest) = point(law.time_share), _growths(law, loop)
    pulses, longest, (left, most_left), uneven, uneven_law = change
    weights = most_of([(abs(end - share) * longest / pulses.time).exp() for end in pulses.speedups]).sqrt()
    aside = longest * (weights - 1) / (weights + 1)  # parts have other weights than those of the law
    later = most_of([share_after(fastest, left - aside - loop.delay), point(0)]) / uneven
    earlier = share_after(slowest, left + aside) * uneven + loop.added
    least, most = parts_of((share, share), longest / pulses.time)
    return shares_together(
        (left, most_left),
        (later / (1 + loop.added) / left, earlier / (1 + loop.added) / left),
        ends_of((least / uneven_law).union(most * uneven_law)),
    )


def _center_seen(law: BandLaw, side: Pulses, shortest: Ball, longest: Ball) -> Ball:
    """Return the share of the way at the center in the mean torque of the law."""
    share = point(law.time_share)
    least, most = parts_of((share, share), longest / side.time)
    return (least * (1 - longest / 2)).union(most * _most_left(law, side, shortest, longest))


def _most_left(law: BandLaw, side: Pulses, shortest: Ball, longest: Ball) -> Ball:
    """Return the largest part of a way, by a pulse of one of these lengths, that counts in the mean of the law."""
    # The rate at the end of the pulse over that at its beginning.
    fading = (-point(law.time_share) * longest / side.time).exp()
    return 1 - fading * shortest / 2


def _center_late(law: BandLaw, loop: Loop, side: Pulses, shortest: Ball, longest: Ball) -> Ball:
    """Return the late share of the way at the center, over the part of it that is gone by any pulse on its side."""
    slowest, fastest = _growths(law, loop)
    # That part differs from the one gone at the center by so much, in the exponent, to either side.
    shorter = [abs(1 - end) * longest for end in side.speedups]
    less, more = (
        most_of([sign * (1 - end) * loop.pulse, *shorter]) / side.time
        for sign, end in zip((1, -1), side.speedups, strict=True)
    )
    fading = (-side.speedups[1] * longest / side.time).exp()
    last = most_of([share_after(fastest, 1 - longest / 2 - loop.delay), point(0)]) * (-less).exp()
    first = share_after(slowest, 1 - fading * shortest / 2) * more.exp() + loop.added
    return 1 - last.union(first) / (1 + loop.added)


def way_at(loop: Loop, center: Sequence[Ball]) -> Ball:
    """Return the wanted change of the torque at a center, what disturbs being in its middle [rad/s]."""
    known, command = ((low + high) / 2 for low, high in loop.disturbances[:2])
    asked = loop.wants[0].row
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
