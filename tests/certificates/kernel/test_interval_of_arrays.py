"""Intervals of arrays against exact fractions, with ends that are rounded outwards."""

import math
from fractions import Fraction

import numpy as np
import pytest

from wspd_design.certificates.kernel.interval import Interval, about, chosen, interval

COUNT = 300


def drawn(seed):
    """Intervals of all sizes and signs, some of them numbers and some with an end at 0."""
    random = np.random.default_rng(seed)
    low = random.normal(size=COUNT) * 10.0 ** random.integers(-12, 12, COUNT)
    high = low + random.exponential(size=COUNT) * 10.0 ** random.integers(-12, 12, COUNT)
    low[:20], high[10:30] = high[:20], np.maximum(low[10:30], 0.0)
    low[40:50] = np.minimum(0.0, high[40:50])
    return Interval(np.minimum(low, high), np.maximum(low, high))


def points(value, k):
    """Numbers of one of the intervals, as fractions."""
    low, high = Fraction(float(value.low[k])), Fraction(float(value.high[k]))
    return low, (low + high) / 2, low + (high - low) / 7, high


def holds(found, k, exact):
    return Fraction(float(found.low[k])) <= exact <= Fraction(float(found.high[k]))


ACTIONS = {
    "plus": lambda a, b: a + b,
    "minus": lambda a, b: a - b,
    "times": lambda a, b: a * b,
}


@pytest.mark.parametrize("action", ACTIONS)
@pytest.mark.parametrize("kind", ["intervals", "numbers", "turned"])
def test_results_hold_exact_ones_and_are_close(action, kind):
    a, b, act = drawn(1), drawn(2), ACTIONS[action]
    other = b if kind == "intervals" else b.low
    found = act(a, other) if kind != "turned" else act(b.low, a)
    for k in range(COUNT):
        seconds = points(b, k) if kind == "intervals" else [Fraction(float(b.low[k]))]
        firsts, seconds = (points(a, k), seconds) if kind != "turned" else (seconds, points(a, k))
        values = [act(one, two) for one in firsts for two in seconds]
        assert all(holds(found, k, each) for each in values)
        size = max(abs(each) for each in values) + max(
            (abs(each) for each in (*firsts, *seconds)), default=0
        ) * (action != "times")
        assert Fraction(float(found.low[k])) >= min(values) - size * Fraction(1, 10**15) - Fraction(
            1, 10**290
        )
        assert Fraction(float(found.high[k])) <= max(values) + size * Fraction(1, 10**15) + Fraction(
            1, 10**290
        )


def test_quotients_hold_exact_ones():
    a, b = drawn(3), drawn(4)
    with np.errstate(invalid="ignore"):  # where 0 is held
        quotient, inverse, turned = a / b, 1.0 / b, b.inverse()
    apart = (b.low > 0.0) | (b.high < 0.0)
    assert np.count_nonzero(apart) > 50
    for k in np.flatnonzero(apart):
        for two in points(b, k):
            assert holds(inverse, k, 1 / two)
            assert holds(turned, k, 1 / two)
            assert all(holds(quotient, k, one / two) for one in points(a, k))
        tight = 1.0 / b.high[k], 1.0 / b.low[k]
        assert turned.low[k] == pytest.approx(tight[0], rel=1e-15)
        assert turned.high[k] == pytest.approx(tight[1], rel=1e-15)


@pytest.mark.parametrize("ends", [(-1.0, 2.0), (0.0, 2.0), (-2.0, 0.0), (0.0, 0.0), (-0.0, 1.0)])
def test_one_over_what_holds_0_is_anything(ends):
    with np.errstate(invalid="ignore"):
        found = Interval(*(np.array([each]) for each in ends)).inverse()
    assert found.low[0] == -np.inf
    assert found.high[0] == np.inf


@pytest.mark.parametrize(
    "act", [lambda x: x + 0.1, lambda x: x - 0.1, lambda x: x * 0.1, lambda x: 0.1 * x, lambda x: x / 3.0]
)
def test_ends_are_rounded_outwards(act):
    value = np.array([0.7, -0.7, 1e-5, 1e200, 5e-324, 0.0])
    found, plain = act(Interval(value, value)), act(value)
    assert (found.low < plain).all()
    assert (found.high > plain).all()
    half = np.spacing(np.abs(plain[:4])) / 2.0
    assert (plain[:4] - found.low[:4] >= half).all()
    assert (found.high[:4] - plain[:4] >= half).all()


def test_functions_that_rise_and_fall_are_rounded_by_more_than_8_units():
    value = np.linspace(-3.0, 3.0, 61)
    wide = Interval(value, value + 0.5)
    for found, low, high in (
        (wide.exp(), np.exp(wide.low), np.exp(wide.high)),
        (wide.rising(np.arctan), np.arctan(wide.low), np.arctan(wide.high)),
        (wide.falling(lambda x: np.exp(-x)), np.exp(-wide.high), np.exp(-wide.low)),
        (about(math.pi), np.array([math.pi]), np.array([math.pi])),
    ):
        assert (low - found.low >= 8 * np.spacing(np.abs(low)) * (low != 0.0)).all()
        assert (found.high - high >= 8 * np.spacing(np.abs(high)) * (high != 0.0)).all()
        np.testing.assert_allclose(found.low, low, rtol=5e-15, atol=1e-299)
        np.testing.assert_allclose(found.high, high, rtol=5e-15, atol=1e-299)


def test_roots_begin_at_0():
    found = Interval(np.array([-4.0, 1.0]), np.array([9.0, 4.0])).sqrt()
    np.testing.assert_allclose(found.low, [0.0, 1.0], atol=1e-14)
    np.testing.assert_allclose(found.high, [3.0, 2.0], rtol=1e-14)
    assert found.low[0] <= 0.0


def test_both_and_either():
    a = Interval(np.array([0.0, 0.0, 5.0]), np.array([2.0, 2.0, 6.0]))
    b = Interval(np.array([1.0, 3.0, 4.0]), np.array([3.0, 4.0, 7.0]))
    hull, cut = a.hull(b), a.cut(b)
    assert (hull.low.tolist(), hull.high.tolist()) == ([0.0, 0.0, 4.0], [3.0, 4.0, 7.0])
    assert (cut.low.tolist(), cut.high.tolist()) == ([1.0, 3.0, 5.0], [2.0, 2.0, 6.0])
    assert cut.holds().tolist() == [True, False, True]
    larger, smaller = a.at_least(b), a.at_most(b)
    assert (larger.low.tolist(), larger.high.tolist()) == ([1.0, 3.0, 5.0], [3.0, 4.0, 7.0])
    assert (smaller.low.tolist(), smaller.high.tolist()) == ([0.0, 0.0, 4.0], [2.0, 2.0, 6.0])
    assert a.hull(1.0).high.tolist() == [2.0, 2.0, 6.0]
    one = chosen(np.array([True, False, True]), a, 9.0)
    assert (one.low.tolist(), one.high.tolist()) == ([0.0, 9.0, 5.0], [2.0, 9.0, 6.0])


def test_turned_columns_and_parts():
    a = Interval(np.array([1.0, 2.0]), np.array([3.0, 5.0]))
    assert ((-a).low.tolist(), (-a).high.tolist()) == ([-3.0, -5.0], [-1.0, -2.0])
    assert a.column().shape == (2, 1)
    assert (a.column() * np.ones(3)).shape == (2, 3)
    assert (a[1].low, a[1].high) == (2.0, 5.0)
    assert interval(a) is a
    assert isinstance(np.array([1.0, 2.0]) * a, Interval)
    assert isinstance(np.array([1.0, 2.0]) - a, Interval)
