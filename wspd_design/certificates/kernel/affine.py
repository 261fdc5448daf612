"""Affine arithmetic in NumPy: numbers that know how they depend on what is uncertain, for many boxes at a time.

A form stands for all c + g . z + d with every symbol z between -1 and 1 and |d| <= e: a center, one slope for each
symbol, and an error that nothing else depends on. Sums cancel what two forms have in common, which intervals cannot.
What is not affine is replaced by a straight line and its largest distance from it, over the range of the form.

IEEE 754 rounds every operation to the nearest double; each form adds :data:`ROUNDING` of all that its numbers were made
of to its error. That is several hundred units in the last place, so that it covers sums over hundreds of symbols,
constants that were rounded themselves, and the 4 units that NumPy's own tests allow ``exp``, ``log`` and ``arctan``.
"""

from collections.abc import Callable
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

Array: TypeAlias = NDArray[np.float64]
Where: TypeAlias = NDArray[np.bool_]

ROUNDING = 1e-13  # relative
_THIN = 1e-9  # relative width below which a secant is nothing but rounding


class Affine:
    """An array of affine forms over the same symbols, one for each box."""

    __slots__ = ("_radius", "center", "error", "slopes")
    __array_priority__ = 1000  # so that an array times a form is a form

    def __init__(self, center: Array, slopes: Array, error: Array) -> None:
        self.center = center  # (boxes,)
        self.slopes = slopes  # (boxes, symbols)
        self.error = error  # (boxes,)
        self._radius: Array | None = None

    @property
    def radius(self) -> Array:
        """Largest distance from the center; summed up once, so that no number of a form may be changed."""
        if self._radius is None:
            self._radius = (np.abs(self.slopes).sum(axis=1) + self.error) * (1.0 + ROUNDING)
        return self._radius

    @property
    def low(self) -> Array:
        """Lower end of the range."""
        return self.center - self.radius - ROUNDING * np.abs(self.center)

    @property
    def high(self) -> Array:
        """Upper end of the range."""
        return self.center + self.radius + ROUNDING * np.abs(self.center)

    def without(self, symbol: int) -> "Affine":
        """Return the mean over a symbol."""
        slopes = self.slopes.copy()
        slopes[:, symbol] = 0.0
        return Affine(self.center, slopes, self.error)

    def named(self, symbol: int) -> "Affine":
        """Call the error by a symbol that nothing has used, so that what depends on it can cancel it."""
        slopes = self.slopes.copy()
        slopes[:, symbol] = self.error
        return Affine(self.center, slopes, np.zeros_like(self.error))

    def widened(self, below: Array | float, above: Array | float) -> "Affine":
        """Add anything from minus ``below`` to ``above``."""
        return self.line(1.0, 0.5 * (above - below), 0.5 * (np.abs(above) + np.abs(below)))

    def line(self, slope: Array | float, offset: Array | float, distance: Array | float) -> "Affine":
        """Return slope x + offset, and all within a distance of it."""
        factor = np.broadcast_to(slope, self.center.shape)
        center = factor * self.center + offset
        slopes = self.slopes * factor[:, None]
        made = np.abs(factor) * (np.abs(self.center) + self.radius) + np.abs(offset) + distance
        return Affine(center, slopes, self.error * np.abs(factor) + distance + ROUNDING * made)

    def __neg__(self) -> "Affine":
        return Affine(-self.center, -self.slopes, self.error)

    def __add__(self, other: "Affine | float") -> "Affine":
        if not isinstance(other, Affine):
            return self.line(1.0, other, 0.0)
        center, slopes = self.center + other.center, self.slopes + other.slopes
        made = np.abs(self.center) + np.abs(other.center) + self.radius + other.radius
        return Affine(center, slopes, self.error + other.error + ROUNDING * made)

    __radd__ = __add__

    def __sub__(self, other: "Affine | float") -> "Affine":
        return self + (-other)

    def __rsub__(self, other: "Affine | float") -> "Affine":
        return -self + other

    def __mul__(self, other: "Affine | float") -> "Affine":
        if not isinstance(other, Affine):
            return self.line(other, 0.0, 0.0)
        slopes = self.slopes * other.center[:, None] + other.slopes * self.center[:, None]
        one, two = np.abs(self.center), np.abs(other.center)
        error = one * other.error + two * self.error + self.radius * other.radius
        made = (one + self.radius) * (two + other.radius)
        return Affine(self.center * other.center, slopes, error + ROUNDING * made)

    __rmul__ = __mul__

    def __truediv__(self, other: "Affine | float") -> "Affine":
        return self * (other.inverse() if isinstance(other, Affine) else 1.0 / other)

    def __rtruediv__(self, other: float) -> "Affine":
        return self.inverse() * other

    def __pow__(self, exponent: int) -> "Affine":
        if exponent != 2:
            raise ValueError(f"only squares are known, not the power {exponent}")
        half = 0.5 * self.radius**2  # the square of a deviation lies between 0 and the square of the radius
        slopes = 2.0 * self.slopes * self.center[:, None]
        error = 2.0 * np.abs(self.center) * self.error + half
        made = (np.abs(self.center) + self.radius) ** 2
        return Affine(self.center**2 + half, slopes, error + ROUNDING * made)

    def along(
        self,
        function: Callable[[Array], Array],
        touching: Callable[[Array], tuple[Array, ...]],
        *,
        least: float = -np.inf,
    ) -> "Affine":
        """Replace a function by its secant over the range; parameters as of :meth:`secant`."""
        return self.line(*self.secant(function, touching, least=least))

    def secant(
        self,
        function: Callable[[Array], Array],
        touching: Callable[[Array], tuple[Array, ...]],
        *,
        least: float = -np.inf,
    ) -> tuple[Array, Array, Array]:
        """Return slope, offset and largest distance of a straight line from a function over the range.

        Parameters
        ----------
        function : callable
            Of arrays of numbers, continuous with a continuous slope.
        touching : callable
            All places at which the function has a slope; any number where it has none.
        least : float
            Number that the exact value never falls below, though the range of the form may.
        """
        low, high = np.maximum(self.low, least), np.maximum(self.high, least)
        width = high - low
        at_low, at_high = function(low), function(high)
        wide = width > _THIN * (1.0 + np.abs(self.center))
        slope = np.where(wide, (at_high - at_low) / np.where(wide, width, 1.0), 0.0)
        # Between its ends a function is farthest from a line where it has the slope of the line.
        places = [low, high, *(np.clip(np.nan_to_num(p), low, high) for p in touching(slope))]
        apart = [function(p) - slope * p for p in places]
        most, fewest = np.maximum.reduce(apart), np.minimum.reduce(apart)
        made = np.abs(at_low) + np.abs(at_high) + np.abs(slope) * (np.abs(low) + np.abs(high))
        return slope, 0.5 * (most + fewest), 0.5 * (most - fewest) + ROUNDING * made

    def inverse(self, *, least: float = -np.inf) -> "Affine":
        """Reciprocal; infinitely uncertain where the range holds zero."""
        away = (np.maximum(self.low, least) > 0.0) | (self.high < 0.0)

        def touching(slope: Array) -> tuple[Array, ...]:
            root = np.sqrt(-1.0 / np.minimum(slope, -1e-300))
            return root, -root

        found = self.along(lambda x: 1.0 / x, touching, least=least)
        return Affine(found.center, found.slopes, np.where(away, found.error, np.inf))

    def power(self, exponent: float) -> "Affine":
        """Power of a positive number, with an exponent between -1 and 1 that is not 0."""
        away = self.low > 0.0

        def touching(slope: Array) -> tuple[Array, ...]:
            return (np.maximum(slope / exponent, 1e-90) ** (1.0 / (exponent - 1.0)),)

        found = self.along(lambda x: np.maximum(x, 1e-300) ** exponent, touching)
        return Affine(found.center, found.slopes, np.where(away, found.error, np.inf))

    def exp(self) -> "Affine":
        """Exponential function."""
        return self.along(np.exp, lambda slope: (np.log(np.maximum(slope, 1e-300)),))

    def atan(self) -> "Affine":
        """Inverse tangent."""

        def touching(slope: Array) -> tuple[Array, ...]:
            root = np.sqrt(np.maximum(1.0 / np.maximum(slope, 1e-300) - 1.0, 0.0))
            return root, -root

        return self.along(np.arctan, touching)

    def positive_part(self) -> "Affine":
        """Return the number where it is positive, 0 elsewhere."""
        low, high = self.low, self.high
        across = (low < 0.0) & (high > 0.0)
        secant = high / np.where(across, high - low, 1.0)
        slope = np.where(across, secant, np.where(high > 0.0, 1.0, 0.0))
        half = np.where(across, -0.5 * secant * low, 0.0)
        return self.line(slope, half, half)

    def at_most(self, limit: "Affine | float") -> "Affine":
        """Return the smaller of the number and a limit."""
        return limit - (limit - self).positive_part()  # exactly the limit where that is what counts

    def at_least(self, limit: "Affine | float") -> "Affine":
        """Return the larger of the number and a limit."""
        return (self - limit).positive_part() + limit


def constant(value: float, like: Affine) -> Affine:
    """Return a number that depends on nothing, for the boxes and symbols of another form."""
    return Affine(np.full_like(like.center, value), np.zeros_like(like.slopes), np.zeros_like(like.error))


def between(low: Array, high: Array, like: Affine) -> Affine:
    """Return anything between two numbers, for the boxes and symbols of another form."""
    return constant(0.0, like).line(0.0, 0.5 * (low + high), 0.5 * (high - low))


def chosen(where: Where, one: Affine, other: Affine) -> Affine:
    """Return one form for the boxes where it is wanted, and another one for the rest."""
    return Affine(
        np.where(where, one.center, other.center),
        np.where(where[:, None], one.slopes, other.slopes),
        np.where(where, one.error, other.error),
    )
