"""Piecewise linear functions whose corners are rounded, so that integrators of order four keep their order.

Within a width about each corner stands a polynomial whose value and first three derivatives go over into those of the
straight lines; elsewhere the function is piecewise linear exactly.
"""

from itertools import pairwise

from wspd_design.model.number import Number, clip, maximum


def corner(x: Number, width: Number) -> Number:
    """Return ``x`` above zero and 0 below, rounded within ``width`` of it.

    The second derivative is 15/16 (1 - s^2)^2 over the width, s = x / width.
    """
    s = clip(x / width, -1.0, 1.0)
    square = s * s
    rise = 0.9375 * (0.5 - square * (1.0 / 6.0 - square / 30.0))
    return maximum(x - width, 0.0) + width * (0.15625 + s * (0.5 + s * rise))


def table(x: Number, points: tuple[Number, ...], values: tuple[Number, ...], width: float) -> Number:
    """Interpolate linearly between points, with rounded corners; beyond the ends the last value stays.

    Parameters
    ----------
    x : number
        Where.
    points, values : tuple of number
        Two or more points, rising, and the values there.
    width : float
        Of the rounding, on both sides of each point.
    """
    slopes = [(b - a) / (q - p) for (p, q), (a, b) in zip(pairwise(points), pairwise(values), strict=True)]
    result = values[0]
    for point, before, after in zip(points, [0.0, *slopes], [*slopes, 0.0], strict=True):
        result = result + (after - before) * corner(x - point, width)
    return result


def lower(x: Number, y: Number, width: Number) -> Number:
    """Return the smaller of two numbers, less where they differ by less than ``width``."""
    return x - corner(x - y, width)


def step(x: Number, width: Number) -> Number:
    """Return 0 below zero and 1 above, going over within twice the width."""
    return (corner(x + width, width) - corner(x - width, width)) / (2.0 * width)
