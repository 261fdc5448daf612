"""Units: conversion against well-known numbers, and one sentence for every way to write it wrong."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from wspd_design.parameters.errors import UserError
from wspd_design.parameters.units import dimension_of, format_quantity, parse_quantity, to_si, units_of


@pytest.mark.parametrize(
    ("value", "unit", "expected"),
    [
        (120.0, "km/h", 33.333333333333336),
        (60.0, "kN m", 60e3),
        (60.0, "kNm", 60e3),
        (2.0, "kN*m", 2e3),
        (7.73, "mm", 0.00773),
        (84.0, "GPa", 84e9),
        (6.0, "bar", 6e5),
        (95.0, "%", 0.95),
        (1.5, "min", 90.0),
        (3.0, "m/s2", 3.0),
        (3.0, "N s²/m²", 3.0),
    ],
)
def test_conversion_is_exact_to_the_last_bit(value, unit, expected):
    assert to_si(value, unit) == expected


@pytest.mark.parametrize(
    ("text", "dimension", "expected"),
    [
        ("120 km/h", "speed", 120 / 3.6),
        ("120km/h", "speed", 120 / 3.6),
        ("33,3 m/s", "speed", 33.3),
        ("  100 ms ", "time", 0.1),
        ("0.14", "ratio", 0.14),
        ("14 %", "ratio", 0.14),
        ("0,125", "ratio", 0.125),
        ("-3.5 m/s^2", "acceleration", -3.5),
        ("6e1 kN m", "torque", 60e3),
        (".5 s", "time", 0.5),
    ],
)
def test_quantities_are_read_as_people_write_them(text, dimension, expected):
    assert parse_quantity(text, dimension, what="x") == pytest.approx(expected, rel=1e-15)


@pytest.mark.parametrize(
    ("text", "dimension", "fragments"),
    [
        ("100 kmh", "speed", ("unknown unit", '"100 km/h"')),
        ("100 KM/H", "speed", ("unknown unit", '"100 km/h"')),
        ("100 sm", "time", ("unknown unit", '"100 s"')),
        ("100", "speed", ("no unit", '"120 km/h"')),
        ("100", "torque", ("no unit", '"1 N m"')),
        ("100 ms", "speed", ("unit of time, not of speed", '"120 km/h"')),
        ("14 m", "ratio", ("unit of length", '"0.14"')),
        ("nan", "speed", ("not a finite number", "m/s or km/h")),
        ("nan km/h", "speed", ("not a finite number",)),
        ("inf s", "time", ("not a finite number",)),
        ("1e999 s", "time", ("not a finite number",)),
        ("1e308 min", "time", ("not a finite number",)),
        ("fast", "speed", ("not a finite number",)),
        ("", "speed", ("not a finite number",)),
        ("1,200 km/h", "speed", ("ambiguous", '"1.200 km/h" or "1200 km/h"')),
        ("5 furlongs", "length", ("unknown unit", "m or mm")),
    ],
)
def test_wrong_quantities_get_one_sentence_with_the_remedy(text, dimension, fragments):
    with pytest.raises(UserError) as caught:
        parse_quantity(text, dimension, what="initial speed")
    message = str(caught.value)
    assert message.startswith("initial speed")
    assert "\n" not in message
    assert message.endswith((".", "km/h", "min"))
    for fragment in fragments:
        assert fragment in message


def test_unknown_unit_in_code_names_the_nearest():
    with pytest.raises(UserError, match='"kmh" is not a known unit; did you mean "km/h"'):
        to_si(1.0, "kmh")
    with pytest.raises(UserError, match="known units: -, %, permille, m/s"):
        dimension_of("parsec!")


@pytest.mark.parametrize(
    ("value", "unit", "text"),
    [(120 / 3.6, "km/h", "120 km/h"), (0.14, "-", "0.14"), (0.14, "%", "14 %"), (60e3, "kNm", "60 kN m")],
)
def test_quantities_are_written_for_people(value, unit, text):
    assert format_quantity(value, unit) == text


@given(st.floats(-1e6, 1e6), st.sampled_from(["m/s", "km/h"]))
def test_what_is_written_can_be_read(speed, unit):
    assert parse_quantity(format_quantity(speed, unit), "speed", what="v") == pytest.approx(speed, rel=1e-5)


def test_words_of_the_trade():
    assert parse_quantity("75 mph", "speed", what="v") == 75 * 0.44704
    assert parse_quantity("1.2 km", "length", what="x") == 1200.0
    assert parse_quantity("\u22125 ‰", "ratio", what="grade") == -0.005


def test_si_unit_comes_first():
    assert units_of("speed") == ("m/s", "km/h", "mph")
    assert math.isinf(to_si(-1e308, "kN"))
