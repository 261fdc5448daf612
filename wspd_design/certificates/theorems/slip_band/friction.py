"""Proved bounds of the friction about the reference in a window of speed, and what they say between two wheel speeds.

A wheel that turns faster than the reference by an error e has a sliding speed that is e R less, at every train speed.
Errors are therefore divided into strips by e R over the lowest speed of the range, and the friction of a window is
bounded in each of them. Between two errors it changes by the mean slope of the strips in between.
"""

from collections.abc import Iterator
from fractions import Fraction
from itertools import pairwise
from typing import NamedTuple, TypeAlias

from wspd_design.certificates.kernel.arb import Ball, ball, point
from wspd_design.certificates.kernel.checker import Refused
from wspd_design.parameters.bounds import Ends

Strip: TypeAlias = tuple[Fraction, Fraction]


def _strips(edges: tuple[str, ...]) -> tuple[Strip, ...]:
    ends = tuple(map(Fraction, edges))
    return tuple(pairwise(ends))


SLOPES = _strips(("-0.02", "-0.012", "-0.002", "0.003", "0.008", "0.013", "0.018", "0.04"))
"""Strips in which the slope is bounded, e R over the lowest speed [-]."""
FADINGS = _strips(("-0.013", "-0.001", "0.004", "0.008", "0.012", "0.027"))
"""The same for the fading, where a loop may settle."""
REACHES = ((0, 7), (1, 6), (2, 6), (2, 7))
"""First strip of the slope and the one after the last, that errors of an ellipsoid are kept in: it takes one."""


class Friction(NamedTuple):
    """Bounds in a window: of -S, of the force over mu0 Q at the reference, of its fading."""

    slopes: tuple[Ends, ...]  # s/m, in the order of the strips
    level: Ends  # -
    fadings: tuple[Ends, ...]  # s/m

    @property
    def named(self) -> dict[str, Ends]:
        """All bounds by name, in the order of a proof."""
        return dict(zip(NAMES, (*self.slopes, self.level, *self.fadings), strict=True))

    @classmethod
    def of(cls, bounds: "tuple[Ends, ...]") -> "Friction":
        """Put bounds in the order of a proof together."""
        count = len(SLOPES)
        return cls(bounds[:count], bounds[count], bounds[count + 1 :])


NAMES = (
    *(f"slope {k + 1}" for k in range(len(SLOPES))),
    "level",
    *(f"fading {k + 1}" for k in range(len(FADINGS))),
)


def strip_of(name: str) -> Strip | None:
    """Return the strip in which a bound holds; none for the level, which is that at the reference."""
    return dict(zip(NAMES, (*SLOPES, None, *FADINGS), strict=True))[name]


def reached(reach: int) -> Strip:
    """Return errors that an ellipsoid is kept between, e R over the lowest speed."""
    first, after = REACHES[reach]
    return SLOPES[first][0], SLOPES[after - 1][1]


def slope_at(friction: Friction, error: Ball) -> Ball:
    """Bound -S at an error, e R over the lowest speed [s/m]."""
    return _at(SLOPES, friction.slopes, error)


def fading_at(friction: Friction, error: Ball) -> Ball:
    """Bound the fading at an error, e R over the lowest speed [s/m]."""
    return _at(FADINGS, friction.fadings, error)


def _at(strips: tuple[Strip, ...], bounds: tuple[Ends, ...], error: Ball) -> Ball:
    found = None
    for (low, high), ends in zip(strips, bounds, strict=True):
        if not (error < point(low) or error > point(high)):
            found = ball(*ends) if found is None else found.union(ball(*ends))
    if found is None or error < point(strips[0][0]) or not _inside(error, (strips[0][0], strips[-1][1])):
        raise Refused("errors are counted from where the friction is not bounded")
    return found


def _inside(error: Ball, strip: Strip) -> bool:
    return bool(error >= point(strip[0])) and bool(error <= point(strip[1]))


def mean_slope(friction: Friction, error: Ball, reach: int) -> Ball:
    """Bound the mean of -S between an error and any other that is reached [s/m].

    The mean from the error to another one goes towards the bounds of the strip that this one lies in, so that it is
    largest and smallest at edges of strips, or next to the error.
    """
    if not _inside(error, reached(reach)):
        raise Refused("errors are counted from outside of those that are reached")
    found = slope_at(friction, error)
    for side in _sides(friction, error, reach):
        length, sums = point(0), (point(0), point(0))
        for strip, ends in side:
            length += strip
            sums = sums[0] + strip * point(ends[0]), sums[1] + strip * point(ends[1])
            if length > 0:
                found = found.union(sums[0] / length).union(sums[1] / length)
    return found


def _sides(friction: Friction, error: Ball, reach: int) -> Iterator[list[tuple[Ball, Ends]]]:
    """Yield lengths and bounds of the strips on either side of an error, from there on."""
    first, after = REACHES[reach]
    strips = list(zip(SLOPES, friction.slopes, strict=True))[first:after]
    yield [
        ((point(high) - error.max(point(low))).max(point(0)), ends)
        for (low, high), ends in strips
        if not error >= point(high)
    ]
    yield [
        ((error.min(point(high)) - point(low)).max(point(0)), ends)
        for (low, high), ends in strips[::-1]
        if not error <= point(low)
    ]
