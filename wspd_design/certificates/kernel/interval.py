"""Interval arithmetic in NumPy: two ends for each of many numbers at a time, rounded outwards.

IEEE 754 rounds each operation to the nearest double, within half a unit in the last place; ends are moved outwards by
more than that, and by more than 8 units where NumPy evaluates a function.
"""

from collections.abc import Callable
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

Array: TypeAlias = NDArray[np.float64]
Where: TypeAlias = NDArray[np.bool_]
Index: TypeAlias = NDArray[np.int_]
Number: TypeAlias = "Interval | Array | float"

ROUNDING = 2.5e-16  # relative, more than half a unit in the last place
TINY = 1e-300  # where the relative one underflows
FUNCTION = 2e-15  # relative, more than 8 units


class Interval:
    """An array of intervals; where the lower end is above the upper one, nothing is meant."""

    __slots__ = ("high", "low")
    __array_priority__ = 1000  # so that an array times an interval is one

    def __init__(self, low: Array | float, high: Array | float) -> None:
        self.low: Array = np.asarray(low, dtype=float)
        self.high: Array = np.asarray(high, dtype=float)

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape of the array."""
        return np.broadcast_shapes(self.low.shape, self.high.shape)

    def __neg__(self) -> "Interval":
        return Interval(-self.high, -self.low)

    def __add__(self, other: Number) -> "Interval":
        one = interval(other)
        return _rounded(self.low + one.low, self.high + one.high)

    __radd__ = __add__

    def __sub__(self, other: Number) -> "Interval":
        one = interval(other)
        return _rounded(self.low - one.high, self.high - one.low)

    def __rsub__(self, other: Number) -> "Interval":
        return interval(other) - self

    def __mul__(self, other: Number) -> "Interval":
        one = interval(other)
        if one.low is one.high:  # a number has fewer products
            a, b = self.low * one.low, self.high * one.low
            return _rounded(np.minimum(a, b), np.maximum(a, b))
        products = self.low * one.low, self.low * one.high, self.high * one.low, self.high * one.high
        return _rounded(
            np.minimum(np.minimum(products[0], products[1]), np.minimum(products[2], products[3])),
            np.maximum(np.maximum(products[0], products[1]), np.maximum(products[2], products[3])),
        )

    __rmul__ = __mul__

    def __truediv__(self, other: Number) -> "Interval":
        return self * interval(other).inverse()

    def __rtruediv__(self, other: Number) -> "Interval":
        return interval(other) * self.inverse()

    def inverse(self) -> "Interval":
        """Return one over it, anything where it holds 0."""
        with np.errstate(divide="ignore", invalid="ignore"):
            found = _rounded(1.0 / self.high, 1.0 / self.low)
        zero = (self.low <= 0.0) & (self.high >= 0.0)
        return Interval(np.where(zero, -np.inf, found.low), np.where(zero, np.inf, found.high))

    def hull(self, other: Number) -> "Interval":
        """Return what holds both."""
        one = interval(other)
        return Interval(np.minimum(self.low, one.low), np.maximum(self.high, one.high))

    def cut(self, other: Number) -> "Interval":
        """Return what both hold."""
        one = interval(other)
        return Interval(np.maximum(self.low, one.low), np.minimum(self.high, one.high))

    def at_least(self, other: Number) -> "Interval":
        """Return the larger of two numbers."""
        one = interval(other)
        return Interval(np.maximum(self.low, one.low), np.maximum(self.high, one.high))

    def at_most(self, other: Number) -> "Interval":
        """Return the smaller of two numbers."""
        one = interval(other)
        return Interval(np.minimum(self.low, one.low), np.minimum(self.high, one.high))

    def rising(self, function: Callable[[Array], Array]) -> "Interval":
        """Return the values of a function that rises."""
        return _rounded(function(self.low), function(self.high), FUNCTION)

    def falling(self, function: Callable[[Array], Array]) -> "Interval":
        """Return the values of a function that falls."""
        return _rounded(function(self.high), function(self.low), FUNCTION)

    def exp(self) -> "Interval":
        """Return e to the power of it."""
        return self.rising(np.exp)

    def sqrt(self) -> "Interval":
        """Return the root of what it has from 0 on."""
        return self.at_least(0.0).rising(np.sqrt)

    def column(self) -> "Interval":
        """Return it as a column, to be combined with rows."""
        return Interval(self.low[..., None], self.high[..., None])

    def __getitem__(self, key: Any) -> "Interval":
        return Interval(self.low[key], self.high[key])

    def holds(self) -> Where:
        """Tell where anything is meant."""
        found: Where = self.low <= self.high
        return found


def interval(value: Number) -> Interval:
    """Return an interval around numbers, which are exact."""
    if isinstance(value, Interval):
        return value
    array = np.asarray(value, dtype=float)
    found = Interval(array, array)
    found.high = found.low
    return found


def about(value: float) -> Interval:
    """Return an interval around the number that a function was to give."""
    return _rounded(np.asarray(value), np.asarray(value), FUNCTION)


def chosen(where: Where, one: Number, other: Number) -> Interval:
    """Return one where a condition holds, and another elsewhere."""
    a, b = interval(one), interval(other)
    return Interval(np.where(where, a.low, b.low), np.where(where, a.high, b.high))


def _rounded(low: Array, high: Array, relative: float = ROUNDING) -> Interval:
    return Interval(low - (np.abs(low) * relative + TINY), high + (np.abs(high) * relative + TINY))
