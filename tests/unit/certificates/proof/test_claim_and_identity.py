"""What a claim says, and when two expressions are the same function."""

from dataclasses import replace
from fractions import Fraction

import pytest
import sympy

from wspd_design.certificates.kernel.claim import Claim, Variable, model_text, number, text, variable
from wspd_design.certificates.kernel.identity import same

x, y = sympy.symbols("x y", positive=True)


@pytest.mark.parametrize(
    "rational", [Fraction(1, 3), Fraction(0.55), Fraction(55, 100), Fraction(-7), Fraction(10**30)]
)
def test_numbers_are_written_without_loss(rational):
    assert number(text(rational)) == rational


def test_a_decimal_means_its_double():
    assert variable("mu0", 0.55, "-").low == Fraction(0.55) != Fraction(55, 100)
    assert text(Fraction(0.55)) == "0.55"


def test_range_that_is_none_and_names_that_repeat_are_refused():
    with pytest.raises(ValueError, match="lies above"):
        Variable(name="x", low=Fraction(2), high=Fraction(1), unit="-")
    with pytest.raises(ValueError, match="same name"):
        Claim(
            name="twice",
            variables=(variable("x", 1.0, "-"), variable("x", 2.0, "-")),
            expression=lambda values: values["x"],
            relation="<=",
            bound=Fraction(1),
            unit="-",
        )


def test_formula_is_the_model_as_it_is_written():
    """Nothing is rounded or simplified on the way: 0.1 + 0.2 of symbols stays a sum of two doubles."""
    claim = Claim(
        name="sum",
        variables=(variable("x", (0.0, 1.0), "-"),),
        expression=lambda values: (values["x"] + 0.1) + 0.2 - values["x"] * 0.3,
        relation="<=",
        bound=Fraction(1),
        unit="-",
    )
    written = model_text(claim.formula())
    for literal in ("0.1", "0.2", "0.3"):
        assert literal in written.splitlines()
    assert claim.digest() != replace(claim, expression=lambda values: values["x"] * 0.7 + 0.3).digest()


SAME = [
    ((x + y) ** 2, x**2 + 2 * x * y + y**2),
    (x / y / x, 1 / y),
    (x ** sympy.Rational(2, 3) / x, x ** sympy.Rational(-1, 3)),
    (sympy.exp(-x * y) * y, y * sympy.exp(-y * x)),
    (sympy.Abs(x - y), sympy.Abs(y - x)),
    (sympy.atan(x / y + 0), sympy.atan(x**2 / (x * y))),
]
DIFFERENT = [
    ((x + y) ** 2, x**2 + y**2),
    (sympy.exp(x), sympy.exp(y)),
    (sympy.exp(x), sympy.atan(x)),
    (x ** sympy.Rational(2, 3), x ** sympy.Rational(1, 3)),
    (sympy.Abs(x - y), x - y),
    (sympy.Float(0.1) * x, x / 10),
    (x, x + sympy.Rational(1, 10**40)),
]


@pytest.mark.parametrize(("one", "other"), SAME)
def test_same_functions(one, other):
    assert same(one, other)


@pytest.mark.parametrize(("one", "other"), DIFFERENT)
def test_different_functions(one, other):
    assert not same(one, other)
