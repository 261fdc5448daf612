"""The steps of a claim against SymPy's: the same expressions, run on symbols that are not evaluated."""

from fractions import Fraction
from functools import partial

import pytest
import sympy

from wspd_design.certificates.kernel.claim import formula, steps_of
from wspd_design.certificates.kernel.term import Term, Terms, steps
from wspd_design.certificates.records import Certificate
from wspd_design.certificates.theorems.table import THEOREMS
from wspd_design.certificates.theorems.theorem import asked
from wspd_design.model.number import atan, exp


def by_sympy(expression, names):
    with sympy.evaluate(False):
        return steps_of(sympy.sympify(expression({name: sympy.Symbol(name) for name in names})))


def by_terms(expression, names):
    terms = Terms()
    return steps(terms.number(expression({name: terms.variable(name) for name in names})))


def _claims(problem):
    for theorem in THEOREMS.values():
        wanted = asked(theorem, problem)
        for each in () if isinstance(wanted, Certificate) else wanted:
            if hasattr(each, "claim"):
                yield each.claim(each.within) if hasattr(each, "within") else each.claim


@pytest.mark.parametrize("law", ["smc", "torque-feedback"])
def test_every_claim_of_a_design(make_problem, make_controller, law):
    compared = 0
    for claim in _claims(make_problem(make_controller(law, "polach-wet"), rail="polach-wet")):
        for expression in filter(None, (claim.expression, claim.form)):
            names = [v.name for v in claim.variables]
            assert formula(expression, claim.variables) == by_sympy(expression, names), claim.name
            compared += 1
    assert compared > 30


EXPRESSIONS = [
    lambda x: 1 / x["a"] + 1.0 / x["b"] + 2 / x["a"],
    lambda x: x["a"] - 3.0 - x["b"] + Fraction(1, 3) * x["a"],
    lambda x: -(x["a"] * x["b"]) + -(2.5 * x["a"]) - (-x["b"]) - (-(x["a"] * x["b"])),
    lambda x: -(-1 * x["a"]) + (-1.0) * x["b"],
    lambda x: sum([x["a"], x["b"] ** 2, x["a"] ** 0.5, x["b"] ** (2.0 / 3.0)]),
    lambda x: exp(-x["a"]) * atan(x["b"] / 3.0) + abs(1.0 - x["a"]),
    lambda x: (x["a"] + x["b"]) * (x["a"] + x["b"]) + (x["b"] + x["a"]),
    lambda x: x["a"] * 2 + x["a"] * 2.0,
    lambda _: 0.3,
]


@pytest.mark.parametrize("expression", EXPRESSIONS)
def test_small_expressions(expression):
    assert by_terms(expression, "ab") == by_sympy(expression, "ab")


@pytest.mark.parametrize(
    ("name", "wrong"),
    [
        ("__sub__", lambda x, y: x + y),
        ("__rtruediv__", lambda x, y: x / y),
        ("__neg__", lambda x: x.table.of("mul", x, x)),
        ("atan", lambda x: x.exp()),
    ],
)
def test_a_wrong_operation_is_seen(monkeypatch, name, wrong):
    monkeypatch.setattr(Term, name, wrong)
    differ = partial(by_terms, names="ab"), partial(by_sympy, names="ab")
    assert any(differ[0](each) != differ[1](each) for each in EXPRESSIONS)
