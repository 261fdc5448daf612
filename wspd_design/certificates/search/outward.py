"""Interval arithmetic in NumPy, rounded outwards.

IEEE 754 rounds sums, products, quotients and square roots to the nearest double, so that the next double outside
encloses the exact result. For ``exp``, ``log`` and ``arctan`` NumPy's own tests allow 4 units in the last place;
twice as many are added here.
"""

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

Array: TypeAlias = NDArray[np.float64]

ULPS = 8  # added to either end of a transcendental function


def _below(x: Array) -> Array:
    return np.nextafter(x, -np.inf)


def _above(x: Array) -> Array:
    return np.nextafter(x, np.inf)


def _hull(ends: list[Array]) -> "Interval":
    """Enclose exact numbers whose nearest doubles are given; an operand that is not a number may be anything."""
    low, high = np.minimum.reduce(ends), np.maximum.reduce(ends)
    return Interval(
        np.where(np.isnan(low), -np.inf, _below(low)), np.where(np.isnan(high), np.inf, _above(high))
    )


def _widened(low: Array, high: Array) -> "Interval":
    return Interval(low - ULPS * np.spacing(np.abs(low)), high + ULPS * np.spacing(np.abs(high)))


@dataclass(frozen=True, slots=True)
class Interval:
    """An array of intervals."""

    lo: Array
    hi: Array

    def __add__(self, other: "Interval") -> "Interval":
        return Interval(_below(self.lo + other.lo), _above(self.hi + other.hi))

    def __sub__(self, other: "Interval") -> "Interval":
        return self + -other

    def __neg__(self) -> "Interval":
        return Interval(-self.hi, -self.lo)

    def __mul__(self, other: "Interval") -> "Interval":
        with np.errstate(all="ignore"):
            return _hull([a * b for a in (self.lo, self.hi) for b in (other.lo, other.hi)])

    def __truediv__(self, other: "Interval") -> "Interval":
        with np.errstate(all="ignore"):
            found = _hull([a / b for a in (self.lo, self.hi) for b in (other.lo, other.hi)])
        singular = (other.lo <= 0.0) & (other.hi >= 0.0)
        return Interval(np.where(singular, -np.inf, found.lo), np.where(singular, np.inf, found.hi))


def sqr(x: Interval) -> Interval:
    """Square."""
    low, high = x.lo * x.lo, x.hi * x.hi
    across = (x.lo < 0.0) & (x.hi > 0.0)
    smallest = np.where(across, 0.0, np.minimum(low, high))
    return Interval(np.maximum(_below(smallest), 0.0), _above(np.maximum(low, high)))


def sqrt(x: Interval) -> Interval:
    """Square root of the part that has one; anything where there is none."""
    with np.errstate(invalid="ignore"):
        low, high = np.sqrt(np.maximum(x.lo, 0.0)), np.sqrt(x.hi)
    return Interval(np.maximum(_below(low), 0.0), np.where(np.isnan(high), np.inf, _above(high)))


def exp(x: Interval) -> Interval:
    """Exponential function."""
    with np.errstate(over="ignore", under="ignore", invalid="ignore"):
        found = _widened(np.exp(x.lo), np.exp(x.hi))
    return Interval(np.where(found.lo > 0.0, found.lo, 0.0), np.where(np.isnan(found.hi), np.inf, found.hi))


def log(x: Interval) -> Interval:
    """Natural logarithm of the part that has one; anything where there is none."""
    with np.errstate(divide="ignore", invalid="ignore"):
        found = _widened(np.log(np.maximum(x.lo, 0.0)), np.log(x.hi))
    return Interval(
        np.where(np.isnan(found.lo), -np.inf, found.lo), np.where(np.isnan(found.hi), np.inf, found.hi)
    )


def atan(x: Interval) -> Interval:
    """Inverse tangent."""
    return _widened(np.arctan(x.lo), np.arctan(x.hi))
