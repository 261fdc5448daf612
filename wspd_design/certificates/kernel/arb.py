"""Rigorous numbers: Arb balls (python-flint), and the doubles and fractions around them.

A ball contains the exact result of the arithmetic on the stored numbers, so that a comparison that comes out true
holds.
"""

import math
from collections.abc import Sequence
from dataclasses import fields, is_dataclass, replace
from fractions import Fraction
from typing import Any, TypeAlias

from flint import arb, fmpq

Ball: TypeAlias = Any
"""A ``flint.arb``."""


def ball(low: float | Fraction, high: float | Fraction) -> Ball:
    """Return a ball that contains all numbers from ``low`` to ``high``."""
    return point(low) if low == high else point(low).union(point(high))


def point(value: float | Fraction) -> Ball:
    """Return a ball around one number."""
    if type(value) is float:  # asked first, since isinstance takes long where the answer is no
        return arb(value)
    return arb(fmpq(value.numerator, value.denominator)) if isinstance(value, Fraction) else arb(value)


def in_balls(record: Any) -> Any:
    """Return a record of parameters with every number as a ball, so that nothing is rounded on the way."""
    values = {field.name: getattr(record, field.name) for field in fields(record)}
    return replace(
        record,
        **{name: point(value) for name, value in values.items() if isinstance(value, float)},
        **{name: in_balls(value) for name, value in values.items() if is_dataclass(value)},
    )


def above(value: Ball) -> float:
    """Return a double that nothing in the ball exceeds; infinite if the ball is not bounded."""
    if not value.is_finite():
        return math.inf
    upper = float(value.upper())
    return upper if point(upper) >= value else math.nextafter(upper, math.inf)


def below(value: Ball) -> float:
    """Return a double that nothing in the ball falls short of."""
    return -above(-value)


def ends_of(value: Ball) -> tuple[Ball, Ball]:
    """Return exact numbers that the ball lies between."""
    return point(Fraction(below(value))), point(Fraction(above(value)))


def hull_of(balls: Sequence[Ball]) -> Ball:
    """Return a ball that contains some balls and what lies between them."""
    found = balls[0]
    for each in balls[1:]:
        found = found.union(each)
    return found


def least_of(balls: Sequence[Ball]) -> Ball:
    """Enclose the smallest of some numbers."""
    found = balls[0]
    for each in balls[1:]:
        found = found.min(each)
    return found


def most_of(balls: Sequence[Ball]) -> Ball:
    """Enclose the largest of some numbers."""
    return -least_of([-each for each in balls])
