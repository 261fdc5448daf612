"""Intervals that carry their slopes, so that a law can be enclosed sharply over a cell.

A law receives train speed and wheel speed, and computes the slip from both. Over a window of speed these two move
together, which plain intervals forget. The mean value form remembers: value at the center plus slopes times
deviations. A :class:`Dual` runs through a law's own ``step`` and brings the slopes back.
"""

from collections.abc import Callable
from typing import Any, TypeAlias

Interval: TypeAlias = Any
"""An ``ival.Interval``, usually of an array with one entry per cell."""


class Dual:
    """An interval with the intervals of its partial derivatives."""

    # The functions of model.number look for a library by the module of their operand; those of flint's balls
    # are methods of the number, and so are these.
    __module__ = "flint"

    def __init__(self, value: Interval, slopes: tuple[Interval, ...]) -> None:
        self.value, self.slopes = value, slopes

    def lift(self, other: Any) -> "Dual":
        """Return a constant, or what already has slopes, in the form of this number."""
        if isinstance(other, Dual):
            return other
        import ival

        zero = ival.Interval(0.0, 0.0)
        return Dual(ival.Interval(other, other), (zero,) * len(self.slopes))

    def _chain(self, value: Interval, slope: Interval) -> "Dual":
        return Dual(value, tuple(slope * each for each in self.slopes))

    def _zip(self, value: Interval, other: "Dual", combine: Callable[[Any, Any], Any]) -> "Dual":
        pairs = zip(self.slopes, other.slopes, strict=True)
        return Dual(value, tuple(combine(mine, theirs) for mine, theirs in pairs))

    def __add__(self, other: Any) -> "Dual":
        other = self.lift(other)
        return self._zip(self.value + other.value, other, lambda a, b: a + b)

    def __sub__(self, other: Any) -> "Dual":
        other = self.lift(other)
        return self._zip(self.value - other.value, other, lambda a, b: a - b)

    def __mul__(self, other: Any) -> "Dual":
        other = self.lift(other)
        return self._zip(self.value * other.value, other, lambda a, b: a * other.value + self.value * b)

    def __truediv__(self, other: Any) -> "Dual":
        other = self.lift(other)
        ratio = self.value / other.value
        return self._zip(ratio, other, lambda a, b: (a - ratio * b) / other.value)

    def __rsub__(self, other: Any) -> "Dual":
        return self.lift(other) - self

    def __rtruediv__(self, other: Any) -> "Dual":
        return self.lift(other) / self

    def __neg__(self) -> "Dual":
        return Dual(-self.value, tuple(-each for each in self.slopes))

    def __pow__(self, exponent: int) -> "Dual":
        if not isinstance(exponent, int):
            return NotImplemented
        return self._chain(self.value**exponent, float(exponent) * self.value ** (exponent - 1))

    __radd__, __rmul__ = __add__, __mul__

    def exp(self) -> "Dual":
        """Exponential function."""
        import ival

        value = ival.exp(self.value)
        return self._chain(value, value)

    def atan(self) -> "Dual":
        """Inverse tangent."""
        import ival

        return self._chain(ival.atan(self.value), 1.0 / (1.0 + self.value**2))

    def max(self, other: Any) -> "Dual":
        """Larger of two; where it is open which one, the slopes cover both."""
        import ival

        other = self.lift(other)
        above, below = self.value.inf >= other.value.sup, self.value.sup <= other.value.inf
        return self._zip(ival.max(self.value, other.value), other, lambda a, b: _select(above, below, a, b))

    def min(self, other: Any) -> "Dual":
        """Smaller of two."""
        return -((-self).max(-self.lift(other)))

    def __abs__(self) -> "Dual":
        return self.max(-self)


def _select(first: Any, second: Any, a: Interval, b: Interval) -> Interval:
    """Return ``a`` where ``first`` holds, ``b`` where ``second`` does, and else what covers both."""
    import ival
    import numpy as np

    low = np.where(first, a.inf, np.where(second, b.inf, np.minimum(a.inf, b.inf)))
    high = np.where(first, a.sup, np.where(second, b.sup, np.maximum(a.sup, b.sup)))
    return ival.Interval(low, high)


def mean_value(
    function: Callable[..., tuple[Any, ...]], arguments: tuple[Interval, ...]
) -> tuple[Interval, ...]:
    """Enclose the values of a function over boxes: the intersection of plain and mean value form.

    Parameters
    ----------
    function : callable
        Takes and returns numbers of any type.
    arguments : tuple of Interval
        One interval (or array of intervals) for each argument.
    """
    import flint  # noqa: F401 - see Dual.__module__
    import ival
    import numpy as np

    zero, one = ival.Interval(0.0, 0.0), ival.Interval(1.0, 1.0)
    centers, boxes = [], []
    for k, each in enumerate(arguments):
        middle = np.clip(0.5 * (each.inf + each.sup), each.inf, each.sup)
        slopes = tuple(one if j == k else zero for j in range(len(arguments)))
        centers.append(Dual(ival.Interval(middle, middle), slopes))
        boxes.append(Dual(each, slopes))
    results = []
    for center, plain in zip(
        map(centers[0].lift, function(*centers)), map(boxes[0].lift, function(*boxes)), strict=True
    ):
        deviations = (box.value - at.value for box, at in zip(boxes, centers, strict=True))
        value = center.value
        for slope, deviation in zip(plain.slopes, deviations, strict=True):
            value = value + slope * deviation
        # Both contain the values, so their intersection is not empty.
        results.append(
            ival.Interval(np.maximum(value.inf, plain.value.inf), np.minimum(value.sup, plain.value.sup))
        )
    return tuple(results)
