"""Elementary functions on every number type: float, NumPy, CasADi, and two interval libraries."""

import math

import casadi
import flint
import ival
import numpy as np
import pytest

from wspd_design.model import number

UNARY = [(number.exp, math.exp), (number.atan, math.atan), (number.sin, math.sin)]
BINARY = [(number.maximum, max), (number.minimum, min)]


def casadi_value(expression):
    return float(casadi.evalf(casadi.SX(expression)))


@pytest.mark.parametrize(("function", "reference"), UNARY)
@pytest.mark.parametrize("x", [-2.5, -1, 0.0, 0.3, 4])
def test_one_argument(function, reference, x):
    expected = reference(x)
    assert function(x) == expected
    np.testing.assert_allclose(function(np.array([x, 2.0 * x])), [expected, reference(2.0 * x)], rtol=1e-15)
    assert casadi_value(function(casadi.SX(x))) == pytest.approx(expected, rel=1e-15)
    interval = function(ival.Interval(x, x))
    assert interval.inf <= expected <= interval.sup
    assert flint.arb(expected).overlaps(function(flint.arb(x)) + flint.arb(0, 1e-15 * (1.0 + abs(expected))))


@pytest.mark.parametrize(("function", "reference"), BINARY)
@pytest.mark.parametrize(("x", "y"), [(1.0, 2.0), (2.0, -1.0), (0, 0.5)])
def test_two_arguments_in_both_orders(function, reference, x, y):
    expected = reference(x, y)
    assert function(x, y) == expected
    for first, second in ((x, y), (y, x)):
        np.testing.assert_array_equal(function(np.array([first]), second), [expected])
        np.testing.assert_array_equal(function(first, np.array([second])), [expected])
        assert casadi_value(function(casadi.SX(first), second)) == expected
        assert casadi_value(function(first, casadi.SX(second))) == expected
        for mixed in (function(flint.arb(first), second), function(first, flint.arb(second))):
            assert mixed.contains(flint.arb(expected))
        for mixed in (
            function(ival.Interval(float(first), float(first)), second),
            function(first, ival.Interval(float(second), float(second))),
        ):
            assert (mixed.inf, mixed.sup) == (expected, expected)


def test_extremum_of_intervals_is_that_of_their_members():
    smaller = number.minimum(ival.Interval(0.0, 3.0), ival.Interval(1.0, 2.0))
    assert (smaller.inf, smaller.sup) == (0.0, 2.0)
    wide = number.maximum(flint.arb(1.5, 1.5), flint.arb(1.5, 0.5))
    assert wide.contains(flint.arb(1.001))
    assert wide.contains(flint.arb(2.999))
    assert not wide.contains(flint.arb(0.5))


def test_choice():
    assert number.where(True, 1.0, 2.0) == 1.0
    assert number.where(0.0, 1.0, 2.0) == 2.0
    np.testing.assert_array_equal(number.where(np.array([1.0, 3.0]) > 2.0, -1.0, 5.0), [5.0, -1.0])
    x = casadi.SX.sym("x")
    choose = casadi.Function("choose", [x], [number.where(x > 2.0, -1.0, 5.0)])
    assert (float(choose(1.0)), float(choose(3.0))) == (5.0, -1.0)


@pytest.mark.parametrize(
    ("x", "expected"), [(-7.0, -1.0), (-0.25, -0.25), (0.5, 0.5), (1.0, 1.0), (9.0, 1.0)]
)
def test_saturation(x, expected):
    assert number.saturation(x) == expected
    np.testing.assert_array_equal(number.saturation(np.array([x])), [expected])
    assert casadi_value(number.saturation(casadi.SX(x))) == expected
    assert number.clip(x, 0.0, 0.4) == min(max(x, 0.0), 0.4)
