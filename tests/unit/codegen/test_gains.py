"""A float that knows its symbol is the float it stands for, in everything that a law may do with it."""

import copy
import math
import operator
from dataclasses import dataclass
from fractions import Fraction
from typing import NamedTuple

import casadi as ca
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from wspd_design.codegen.gains import Gain, plain, with_gains
from wspd_design.model import number

P, Q, X = ca.SX.sym("p"), ca.SX.sym("q"), ca.SX.sym("x")
FLOATS = st.floats(-1e3, 1e3).map(lambda x: x + 0.25)
ARITHMETIC = (operator.add, operator.sub, operator.mul, operator.truediv)
COMPARISONS = (operator.lt, operator.le, operator.gt, operator.ge, operator.eq, operator.ne)


def value_of(result, p, q=0.0, x=0.0):
    """What a kernel makes of an expression, and the value that the law saw while it was traced."""
    expression = result if isinstance(result, ca.SX) else result.__SX__()
    return float(ca.Function("f", [P, Q, X], [expression])(p, q, x))


@pytest.mark.parametrize("operation", ARITHMETIC)
@settings(max_examples=40, deadline=None)
@given(p=FLOATS, q=FLOATS)
def test_arithmetic_of_numbers_keeps_value_and_expression(operation, p, q):
    expected = operation(p, q)
    for one, other in ((Gain(p, P), Gain(q, Q)), (Gain(p, P), q), (p, Gain(q, Q))):
        result = operation(one, other)
        assert type(result) is Gain
        assert plain(result) == expected == value_of(result, p, q)


@pytest.mark.parametrize("operation", ARITHMETIC)
@settings(max_examples=40, deadline=None)
@given(p=FLOATS, x=FLOATS)
def test_arithmetic_with_symbols_has_the_gain_as_an_input(operation, p, x):
    for result, expected in (
        (operation(Gain(p, P), X), operation(p, x)),
        (operation(X, Gain(p, P)), operation(x, p)),
    ):
        assert type(result) is ca.SX
        assert value_of(result, p, x=x) == expected
        assert ca.depends_on(result, P)


@pytest.mark.parametrize("operation", COMPARISONS)
@settings(max_examples=40, deadline=None)
@given(p=FLOATS, q=FLOATS)
def test_comparisons(operation, p, q):
    expected = operation(p, q)
    assert operation(Gain(p, P), Gain(q, Q)) is expected
    assert operation(Gain(p, P), q) is expected
    assert operation(p, Gain(q, Q)) is expected
    assert bool(value_of(operation(Gain(p, P), X), p, x=q)) is expected
    assert bool(value_of(operation(X, Gain(p, P)), p, x=q)) is operation(q, p)


@pytest.mark.parametrize("name", ["exp", "atan", "sin"])
def test_elementary_functions(name):
    result = getattr(number, name)(Gain(0.7, P))
    assert plain(result) == getattr(math, name)(0.7)
    assert value_of(result, 0.7) == pytest.approx(getattr(math, name)(0.7), rel=1e-15)
    assert ca.depends_on(result.__SX__(), P)


@settings(max_examples=40, deadline=None)
@given(p=FLOATS)
def test_powers_take_the_exponent_as_it_is(p):
    # A symbolic exponent has no value for a negative base.
    assert plain(Gain(p, P) ** 3) == p**3
    assert value_of(Gain(p, P) ** 3, p) == pytest.approx(p**3, rel=1e-15)
    assert value_of(X ** Gain(2.0, P), 2.0, x=-abs(p)) == pytest.approx(p**2, rel=1e-15)
    assert isinstance((-abs(Gain(p, P))) ** 0.5, complex)


SEEN = {
    "int": int,
    "float": float,
    "bool": bool,
    "text": str,
    "repr": repr,
    "format": "{:.2f}".format,
    "round": lambda x: round(x, 1),
    "floor": math.floor,
    "ceil": math.ceil,
    "trunc": math.trunc,
    "floor division": lambda x: (x // 2, 7.0 // x),
    "remainder": lambda x: (x % 2, 7.0 % x, divmod(x, 2), divmod(7.0, x)),
    "base": lambda x: 2.0**x,
    "square root": math.sqrt,
    "membership": lambda x: x in (1.0, 2.5),
    "instance": lambda x: isinstance(x, float) and not isinstance(x, int),
    "its own methods": lambda x: (x.is_integer(), x.as_integer_ratio(), x.real),
    "fraction": Fraction,
    "array": lambda x: (np.array([1.0, 2.0]) * x).tolist(),
    "array of floats": lambda x: np.array([x, x], dtype=float).tolist(),
    "largest": lambda x: float(max(x, 1.0)),
    "order": lambda x: [float(y) for y in sorted([x, 3.0, 1.0])],
    "copy": lambda x: float(copy.deepcopy([x])[0]),
}


@pytest.mark.parametrize("what", SEEN)
def test_everything_else_sees_the_float(what):
    assert SEEN[what](Gain(2.5, P)) == SEEN[what](2.5)


def test_a_gain_is_no_key():
    with pytest.raises(TypeError, match="unhashable"):
        hash(Gain(2.5, P))


def test_casadi_takes_the_expression():
    for function, expected in (
        (lambda g: ca.fmax(X, g), 4.0),
        (lambda g: ca.if_else(X > 3.0, g, 0.0), 4.0),
        (lambda g: ca.vertcat(g, X)[0], 4.0),
        (lambda g: number.maximum(g, X), 4.0),
        (lambda g: number.where(X > 3.0, g, X), 4.0),
        (lambda g: number.clip(X, 0.0, g), 3.5),
    ):
        result = function(Gain(4.0, P))
        assert value_of(result, 4.0, x=3.5) == expected
        assert ca.depends_on(result, P)


class Pair(NamedTuple):
    low: float
    high: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Inner:
    gain: float
    table: tuple[float, ...]
    rules: tuple[tuple[float, ...], ...]
    count: int


@dataclass(frozen=True, slots=True, kw_only=True)
class Outer:
    name: str
    inner: Inner
    pair: Pair

    def __post_init__(self):
        if not self.pair.low < self.pair.high:
            raise ValueError("low must lie below high")


class Plain:
    __slots__ = ("__dict__", "slotted")

    def __init__(self):
        self.slotted, self.gain, self.listed, self.whole, self.flag = 1.5, np.float64(2.5), [3.5], 4, True


def test_every_float_of_a_law_is_found_in_a_fixed_order():
    law = Outer(
        name="law",
        inner=Inner(gain=1.0, table=(2.0, 3.0), rules=((4.0,), (5.0,)), count=5),
        pair=Pair(low=6.0, high=7.0),
    )
    found = []
    with_gains(law, found.append)
    assert found == [1.0, 2.0, 3.0, 6.0, 7.0]
    negative = with_gains(law, operator.neg)
    assert negative.inner == Inner(gain=-1.0, table=(-2.0, -3.0), rules=((4.0,), (5.0,)), count=5)
    assert (negative.name, negative.pair) == ("law", Pair(low=-6.0, high=-7.0))
    assert (law.inner.gain, law.pair) == (1.0, Pair(6.0, 7.0))  # the law itself stays as it is


def test_attributes_of_a_plain_object():
    found, law = [], Plain()
    with_gains(law, found.append)
    assert found == [1.5, 2.5]
    assert (law.slotted, law.gain, law.listed) == (1.5, 2.5, [3.5])
