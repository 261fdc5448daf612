"""How numbers are written."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from wspd_design.certificates.records import Point, Range
from wspd_design.reporting import numbers


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0, "0"),
        (1.5, "1.5"),
        (-0.25, "−0.25"),
        (123456.0, "123456"),
        (99999.6, "100000"),
        (0.00012346, "0.0001235"),
        (1.9186e-05, "1.919·10⁻⁵"),
        (-3.0e12, "−3·10¹²"),
        (math.nan, "–"),
        (math.inf, "–"),
    ],
)
def test_significant_digits(value, text):
    assert numbers.significant(value) == text


@given(st.floats(min_value=1e-4, max_value=1e6))
def test_significant_digits_round_correctly(value):
    assert float(numbers.significant(value)) == pytest.approx(value, rel=5.1e-4)


def test_decimals_and_units():
    assert numbers.decimals(-1.005, 1) == "−1.0"
    assert numbers.decimals(math.nan, 1) == "–"
    assert numbers.quantity(3.5, "m/s^2") == "3.5 m/s²"
    assert numbers.quantity(3.5, "-") == "3.5"
    assert numbers.unit("N s2/m2") == "N s²/m²"
    assert numbers.unit("of max V2") == "of max V2"
    assert numbers.quantity_in(120.0 / 3.6, "km/h") == "120 km/h"
    assert numbers.point((Point(name="mu0", value=0.3, unit="-"),)) == "mu0 0.3"


@pytest.mark.parametrize(
    ("low", "high", "text"),
    [
        (0.3846153, 0.3846154, "0.3846 1/s"),
        (1.0, 2.0, "1 to 2 1/s"),
        (None, -0.5, "≤ −0.5 1/s"),
        (0.5, None, "≥ 0.5 1/s"),
        (None, None, "–"),
    ],
)
def test_margins_show_which_side_is_known(low, high, text):
    assert numbers.margin(Range(low=low, high=high, unit="1/s")) == text


def test_no_margin_is_a_dash():
    assert numbers.margin(None) == "–"


def test_listing_and_counting():
    assert numbers.listing(["a"]) == "a"
    assert numbers.listing(["a", "b", "c"]) == "a, b and c"
    assert numbers.listing([]) == ""
    assert (numbers.count(1, "check"), numbers.count(2, "check")) == ("1 check", "2 checks")
