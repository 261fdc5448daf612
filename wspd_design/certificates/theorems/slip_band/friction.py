"""Proved bounds of the friction about the reference in a window of speed, and what they say between two wheel speeds.

A wheel that turns faster than the reference by an error e has a sliding speed that is e R less, at every train speed.
Errors are therefore divided into strips by e R over the lowest speed of the range, and the friction of a window is
bounded in each of them. Between two errors it changes by the mean slope of the strips in between.

Beside speed and slip the force over mu0 Q depends on the steepness alone, on which mass and mu0 act. Its range is
divided into parts, and the friction is bounded in each of them.
"""

from collections.abc import Sequence
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


SLOPES = _strips(("-0.02", "-0.01", "-0.002", "0.004", "0.01", "0.018", "0.024", "0.03", "0.04"))
"""Strips in which the slope is bounded, e R over the lowest speed [-]."""
FADINGS = _strips(("-0.013", "0.004", "0.012", "0.027"))
"""The same for the fading, where a loop may settle."""
REACHES = ((0, 8), (1, 5), (2, 5), (2, 8), (2, 6), (2, 7), (3, 6), (3, 7), (4, 6), (4, 7), (4, 8), (3, 5))
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


FRICTION = "mu0"
PARTS = 4  # of the range of the steepness, in each of which the friction is bounded


class Part(NamedTuple):
    """A range of the steepness over the slip, and bounds of the friction of all wheels whose steepness lies in it."""

    steepness: Ends  # as the modulus that stands for it [Pa]
    friction: Friction


Parts: TypeAlias = tuple[Part, ...]


def parts_of(steepness: Ends) -> tuple[Ends, ...]:
    """Divide the range of the steepness."""
    low, high = steepness
    edges = (low, *(low + (high - low) * k / PARTS for k in range(1, PARTS)), high)
    return tuple(pairwise(edges))


def bounds_for(parts: Parts, steepness: Ends) -> Friction:
    """Return bounds for any steepness of a range, or refuse parts that leave some of it out."""
    low, high = steepness
    used = [each for each in parts if low <= each.steepness[1] and each.steepness[0] <= high]
    if (
        not used
        or used[0].steepness[0] > low
        or used[-1].steepness[1] < high
        or any(one.steepness[1] < other.steepness[0] for one, other in pairwise(used))
    ):
        raise Refused("the parts of the steepness leave out some of a cell")
    every = zip(*(each.friction.named.values() for each in used), strict=True)
    return Friction.of(tuple((min(low for low, _ in ends), max(high for _, high in ends)) for ends in every))


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
    found = slope_at(friction, error)
    first, after = REACHES[reach]
    between = [k for k, (low, high) in enumerate(SLOPES) if not (error < point(low) or error > point(high))]
    strips = list(zip(SLOPES, friction.slopes, strict=True))[
        min(first, *between) : max(after, between[-1] + 1)
    ]
    for k, ((low, high), own) in enumerate(strips):
        if error < point(low) or error > point(high):
            continue
        for end, further in ((high, strips[k + 1 :]), (low, strips[:k][::-1])):
            # The mean to the end of a further strip is monotonic over what lies in the own one.
            for begin in (error.lower().max(point(low)), error.upper().min(point(high))):
                found = _joined(found, abs(point(end) - begin), own, further)
    return found


def _joined(found: Ball, length: Ball, own: Ends, further: Sequence[tuple[Strip, Ends]]) -> Ball:
    """Join means to the ends of further strips, from a length in the own one."""
    sums = [length * point(end) for end in own]
    for (low, high), ends in further:
        length += point(high - low)
        sums = [each + point(high - low) * point(end) for each, end in zip(sums, ends, strict=True)]
        found = found.union(sums[0] / length).union(sums[1] / length)
    return found
