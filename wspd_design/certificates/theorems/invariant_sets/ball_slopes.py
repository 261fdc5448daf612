"""Slopes of a law over a box, on the balls of python-flint: the checker's own counterpart of ``duals.py``."""

from collections.abc import Callable
from typing import Any, TypeAlias

Ball: TypeAlias = Any
"""A ``flint.arb``."""


def hull(low: Ball, high: Ball) -> Ball:
    """Return a ball that holds two balls and all between them."""
    return low.union(high)


class Sloped:
    """A ball with the balls of its partial derivatives; what it can do is what laws need."""

    __module__ = "flint"  # its elementary functions are methods, like those of flint's numbers

    def __init__(self, value: Ball, slopes: list[Ball]) -> None:
        self.value, self.slopes = value, slopes

    def lift(self, other: Any) -> "Sloped":
        """Return a constant, or what already has slopes, in the form of this number."""
        return Sloped(*self._parts(other))

    def _parts(self, other: Any) -> tuple[Ball, list[Ball]]:
        from flint import arb

        if isinstance(other, Sloped):
            return other.value, other.slopes
        return arb(other), [arb(0)] * len(self.slopes)

    def _linear(self, value: Ball, mine: Any, theirs: Any, slopes: list[Ball]) -> "Sloped":
        return Sloped(value, [mine * a + theirs * b for a, b in zip(self.slopes, slopes, strict=True)])

    def __add__(self, other: Any) -> "Sloped":
        value, slopes = self._parts(other)
        return self._linear(self.value + value, 1, 1, slopes)

    def __mul__(self, other: Any) -> "Sloped":
        value, slopes = self._parts(other)
        return self._linear(self.value * value, value, self.value, slopes)

    def __truediv__(self, other: Any) -> "Sloped":
        value, slopes = self._parts(other)
        ratio = self.value / value
        return Sloped(ratio, [(a - ratio * b) / value for a, b in zip(self.slopes, slopes, strict=True)])

    def __sub__(self, other: Any) -> "Sloped":
        value, slopes = self._parts(other)
        return self._linear(self.value - value, 1, -1, slopes)

    def __neg__(self) -> "Sloped":
        return self.lift(0) - self

    def __rsub__(self, other: Any) -> "Sloped":
        return self.lift(other) - self

    def __rtruediv__(self, other: Any) -> "Sloped":
        return self.lift(other) / self

    def __pow__(self, exponent: int) -> "Sloped":
        return self._linear(self.value**exponent, exponent * self.value ** (exponent - 1), 0, self.slopes)

    __radd__, __rmul__ = __add__, __mul__

    def exp(self) -> "Sloped":
        """Exponential function."""
        return self._linear(self.value.exp(), self.value.exp(), 0, self.slopes)

    def atan(self) -> "Sloped":
        """Inverse tangent."""
        return self._linear(self.value.atan(), 1 / (1 + self.value**2), 0, self.slopes)

    def max(self, other: Any) -> "Sloped":
        """Larger of two; where it is open which one, the slopes cover both."""
        value, slopes = self._parts(other)
        if self.value >= value:
            return self
        if self.value <= value:
            return Sloped(value, slopes)
        return Sloped(self.value.max(value), [hull(a, b) for a, b in zip(self.slopes, slopes, strict=True)])

    def min(self, other: Any) -> "Sloped":
        """Smaller of two."""
        return -((-self).max(-other))

    def __abs__(self) -> "Sloped":
        return self.max(-self)

    def __bool__(self) -> bool:
        raise TypeError("the law asks whether a range is a single number, which slopes cannot answer")

    def __eq__(self, other: object) -> bool:
        return bool(self)


def law_slopes(
    function: Callable[..., tuple[Any, ...]], boxes: tuple[Ball, ...]
) -> list[tuple[Ball, list[Ball]]]:
    """Values and partial derivatives of a function over a box, for each of its results."""
    from flint import arb

    unit = [[arb(int(j == k)) for j in range(len(boxes))] for k in range(len(boxes))]
    arguments = [Sloped(box, slopes) for box, slopes in zip(boxes, unit, strict=True)]
    results = [arguments[0].lift(each) for each in function(*arguments)]
    return [(each.value, each.slopes) for each in results]
