"""Vectors of three symbols or numbers, so that what is zero by structure costs no operation."""

from typing import TypeAlias

from wspd_design.model.number import Number

Vector: TypeAlias = tuple[Number, Number, Number]
Axes: TypeAlias = tuple[Vector, Vector, Vector]
"""Three orthogonal unit vectors: the axes of a body in those of the track."""

ZERO: Vector = (0.0, 0.0, 0.0)


def add(a: Vector, b: Vector) -> Vector:
    """Return a + b."""
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


def subtract(a: Vector, b: Vector) -> Vector:
    """Return a - b."""
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def scaled(factor: Number, a: Vector) -> Vector:
    """Return a multiple of a vector."""
    return factor * a[0], factor * a[1], factor * a[2]


def dot(a: Vector, b: Vector) -> Number:
    """Return the inner product."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Vector, b: Vector) -> Vector:
    """Return a x b."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def outward(axes: Axes, a: Vector) -> Vector:
    """Turn a vector from the axes of a body into those of the track."""
    x, y, z = (a[0] * axes[0][k] + a[1] * axes[1][k] + a[2] * axes[2][k] for k in range(3))
    return x, y, z


def inward(axes: Axes, a: Vector) -> Vector:
    """Turn a vector from the axes of the track into those of a body."""
    return dot(axes[0], a), dot(axes[1], a), dot(axes[2], a)


def turned(axes: Axes, a: Vector) -> Vector:
    """Return how far a point of a body moves when the body turns from rest: (R - 1) a."""
    x, y, z = (
        sum(a[j] * (axes[j][k] - 1.0 if j == k else axes[j][k]) for j in range(3) if _is(a[j]))
        for k in range(3)
    )
    return x, y, z


def _is(a: Number) -> bool:
    return not (isinstance(a, (int, float)) and a == 0.0)
