"""Balls and the doubles around them."""

import math
from fractions import Fraction

import pytest
from flint import arb

from wspd_design.certificates.kernel.arb import above, ball, below, in_balls, point

THIRD = Fraction(1, 3)


def test_point_of_a_fraction_contains_it():
    assert bool(point(THIRD) * 3 - 1 < arb(2) ** -40)
    assert point(0.1).contains(arb(0.1))


@pytest.mark.parametrize(("low", "high"), [(0.1, 0.3), (-2.0, 5.0), (1e-9, 1e9), (THIRD, Fraction(2, 3))])
def test_ball_contains_its_ends_and_what_lies_between(low, high):
    found = ball(low, high)
    assert found.contains(point(float(low) + 0.3 * (float(high) - float(low))))
    assert found.contains(point(low))
    assert found.contains(point(high))


@pytest.mark.parametrize("number", [THIRD, -THIRD, Fraction(1, 2), Fraction(10**30 + 1, 7)])
def test_doubles_enclose(number):
    exact = point(number)
    low, high = Fraction(below(exact)), Fraction(above(exact))
    assert low <= number <= high
    assert high - low <= abs(number) * Fraction(1, 2**48)


def test_unbounded_ball():
    assert above(arb.nan()) == math.inf
    assert below(1 / ball(-1.0, 1.0)) == -math.inf


def test_records_in_balls_lose_no_digit(er24pc):
    """A product of doubles is rounded; that of their balls encloses the exact one."""
    exact = in_balls(er24pc)
    contact = er24pc.contact
    true = (
        Fraction(contact.shear_modulus)
        * Fraction(contact.semi_axis_rolling)
        * Fraction(contact.semi_axis_lateral)
    )
    product = exact.contact.shear_modulus * exact.contact.semi_axis_rolling * exact.contact.semi_axis_lateral
    rounded = contact.shear_modulus * contact.semi_axis_rolling * contact.semi_axis_lateral
    assert product.contains(point(true))
    assert Fraction(rounded) != true
    assert exact.wheelsets == er24pc.wheelsets
    assert exact.brake.max_torque == point(er24pc.brake.max_torque)
