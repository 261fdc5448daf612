"""What a claim says, and when two expressions are the same function."""

from dataclasses import replace
from fractions import Fraction

import pytest
import sympy

from wspd_design.certificates.kernel.checker import Refused, Work, decide, number
from wspd_design.certificates.kernel.claim import Claim, Variable, steps_of, variable
from wspd_design.certificates.kernel.finding import Stated
from wspd_design.certificates.kernel.obligation import Identity, proof_of
from wspd_design.certificates.kernel.term import text
from wspd_design.certificates.records import Status

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
    written = claim.statement()["model"]
    for literal in ("0.1", "0.2", "0.3"):
        assert ["n", literal] in written
    other = replace(claim, expression=lambda values: values["x"] * 0.7 + 0.3)
    assert other.statement()["model"] != written


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


def identity(one, other):
    return Identity(key="identity", text="one = other", left=one, right=other)


@pytest.mark.parametrize(("one", "other"), SAME)
def test_same_functions(one, other):
    asked = identity(one, other)
    assert decide(proof_of(asked), Work()).statement == "one = other"
    assert asked.decide(Stated(proof=proof_of(asked)), Work()).status is Status.PROVED


@pytest.mark.parametrize(("one", "other"), DIFFERENT)
def test_different_functions(one, other):
    asked = identity(one, other)
    with pytest.raises(Refused, match="not the same function"):
        decide(proof_of(asked), Work())
    with pytest.raises(Refused, match="not the same function"):
        asked.decide(Stated(proof=proof_of(asked)), Work())
    assert asked.decide(Stated(), Work()).status is Status.REFUTED


def test_a_true_identity_does_not_stand_for_another_one():
    true, false = identity(x, x), identity(x, y)
    with pytest.raises(Refused, match="states something else"):
        false.decide(Stated(proof=proof_of(true)), Work())


def test_each_shared_part_is_one_step():
    shared = sympy.exp(x * y)
    steps = steps_of(sympy.atan(shared) + sympy.Abs(shared - 3 * x, evaluate=False))
    assert [step[0] for step in steps].count("exp") == 1
    assert len(set(steps)) == len(steps)
