"""The checker as a whole with wrong arithmetic: whoever breaks an operation of it is seen by containment.

The references are the same functions on 300-bit enclosures, without SymPy, without the checker's program and without
its intervals. Wide boxes show wrong operations, thin ones those that round inwards.
"""

import random
from fractions import Fraction
from functools import cache

import flint
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from wspd_design.certificates.kernel import checker
from wspd_design.certificates.kernel.checker import PRECISION, Work, value
from wspd_design.certificates.kernel.claim import Claim, variable
from wspd_design.model.number import atan, exp

FUNCTIONS = {
    "difference": lambda x, y: x - y,
    "product": lambda x, y: (x - 1.0) * (y - 1.5),
    "square": lambda x, y: (x - y) * (x - y) + (x - 1.0) ** 2,
    "fourth power": lambda x, y: (x - y) ** 4 - x,
    "cube": lambda x, y: (x - 1.3) ** 3 * y,
    "quotient": lambda x, y: (x - y) / (x * y + 0.1),
    "fractional power": lambda x, y: x ** (2.0 / 3.0) - y ** (-1.0 / 3.0),
    "exponential": lambda x, y: exp(-0.6 * x * y),
    "inverse tangent": lambda x, y: atan(3.0 * (x - y)) * y,
    "magnitude": lambda x, y: abs(x - y) - y,
    "creep force": lambda x, y: atan(0.4 * x / y) + x / y / (1.0 + (x / y) ** 2) * exp(-x),
}
LOW, HIGH = Fraction(1, 4), Fraction(5, 2)


def claim_of(name):
    return Claim(
        name=name,
        variables=tuple(variable(each, (float(LOW), float(HIGH)), "-") for each in "xy"),
        expression=lambda at: FUNCTIONS[name](at["x"], at["y"]),
        relation="<=",
        bound=Fraction(0),
        unit="-",
    )


@cache
def statement_of(name):
    return claim_of(name).statement()


def exact(name, point):
    with flint.ctx.workprec(300):
        return FUNCTIONS[name](*(flint.arb(flint.fmpq(x.numerator, x.denominator)) for x in point))


def rational(rng):
    return LOW + (HIGH - LOW) * Fraction(rng.randint(0, 10**6), 10**6)


def run(name, ends):
    given = checker._Inequality(statement_of(name))
    with flint.ctx.workprec(PRECISION):
        program = checker.Program(given.form, given.variables, Work())
        box = [tuple(flint.arb(flint.fmpq(x.numerator, x.denominator)) for x in pair) for pair in ends]
        return program.run(box, derivatives=True)


def inside(found, reference):
    return bool(found[0].lower() <= reference.upper()) and bool(reference.lower() <= found[1].upper())


def holds_on_boxes():
    """Whether boxes contain the values of points inside, and the slopes their differences."""
    rng = random.Random(4)
    for name in FUNCTIONS:
        for _ in range(12):
            ends = [sorted(rational(rng) for _ in range(2)) for _ in range(2)]
            found, slopes = run(name, ends)
            shares = [Fraction(rng.randint(0, 8), 8) for _ in range(4)]
            first = [low + share * (high - low) for (low, high), share in zip(ends, shares[:2], strict=True)]
            second = [low + share * (high - low) for (low, high), share in zip(ends, shares[2:], strict=True)]
            if not inside(found, exact(name, first)):
                return False
            with flint.ctx.workprec(300):
                moved = exact(name, second) - exact(name, first)
                steps = [
                    flint.arb(flint.fmpq(*(q - p).as_integer_ratio()))
                    for p, q in zip(first, second, strict=True)
                ]
                hull = sum(
                    (a.union(b) * step for (a, b), step in zip(slopes, steps, strict=True)), flint.arb(0)
                )
            if not (hull + flint.arb(0, 1e-18)).overlaps(moved):
                return False
    return True


def holds_at_points():
    """Whether points are enclosed, and by no more than rounding."""
    rng = random.Random(5)
    for name in FUNCTIONS:
        for _ in range(12):
            point = [rational(rng), rational(rng)]
            low, high = value(statement_of(name), dict(zip("xy", point, strict=True)), Work())
            reference = exact(name, point)
            with flint.ctx.workprec(300):
                ends = [flint.arb(flint.fmpq(x.numerator, x.denominator)) for x in (low, high)]
                if not inside(ends, reference) or high - low > Fraction(1, 10**18):
                    return False
    return True


def test_the_checker_encloses():
    assert holds_on_boxes()
    assert holds_at_points()


def inwards(function, *, size=-75):
    """The same function with both ends moved inwards by little more than rounding."""

    def mutated(x):
        low, high = function(x)
        nudge = flint.arb(2) ** size
        return low.mid() + nudge, high.mid() - nudge

    return mutated


def swapped(x, y):
    """A sum in which what is subtracted keeps its ends."""
    return (x[0] + y[1], x[1] + y[0]) if y[1] < 0 else (x[0] + y[0], x[1] + y[1])


WRONG = {
    "sub": ("add", swapped),
    "add that forgets": ("add", lambda x, y: (x[0] + y[0], x[0] + y[1])),
    "mul of ends": ("mul", lambda x, y: (x[0] * y[0], x[1] * y[1])),
    "mul of magnitudes": ("mul", lambda x, y: (abs(x[0]) * abs(y[0]), abs(x[1]) * abs(y[1]))),
    "sqr of ends": ("sqr", lambda x: (x[0] * x[0], x[1] * x[1])),
    "sqr that is symmetric": ("sqr", lambda x: (-x[1] * x[1], x[1] * x[1])),
    "inverse without swap": ("inverse", lambda x: (1 / x[0], 1 / x[1])),
    "magnitude of ends": ("magnitude", lambda x: (abs(x[0]), abs(x[1]))),
    "power by one less": ("power", lambda x, n, right=checker.power: right(x, n - 1 if n > 2 else n)),
    "slopes of one factor": ("_plus", lambda x, y: x or y),
    "slopes that are lost": ("_times", lambda _slope, _factor: {}),
}


@pytest.mark.parametrize("name", WRONG)
def test_wrong_operation_is_seen(monkeypatch, name):
    function, mutant = WRONG[name]
    monkeypatch.setattr(checker, function, mutant)
    assert not (holds_on_boxes() and holds_at_points())


WRONG_RISING = {
    "exp of the middle": lambda _, x: ((x[0] + x[1]) / 2,) * 2,
    "ends are swapped": lambda name, x: (checker.RISING[name](x[1]), checker.RISING[name](x[0])),
    "lower end twice": lambda name, x: (checker.RISING[name](x[0]), checker.RISING[name](x[0])),
}


@pytest.mark.parametrize("fault", WRONG_RISING)
def test_wrong_rising_function_is_seen(monkeypatch, fault):
    monkeypatch.setattr(checker, "rising", WRONG_RISING[fault])
    assert not (holds_on_boxes() and holds_at_points())


@pytest.mark.parametrize("name", checker.RISING)
def test_another_rising_function_is_seen(monkeypatch, name):
    other = {"exp": flint.arb.atan, "log": flint.arb.atan, "atan": flint.arb.exp}[name]
    monkeypatch.setitem(checker.RISING, name, other)
    assert not holds_at_points()


@pytest.mark.parametrize("name", checker.RISING)
def test_inward_rounding_is_seen_at_points_only(monkeypatch, name):
    right = checker.rising

    def mutated(asked, x):
        found = right(asked, x)
        return inwards(lambda _: found)(x) if asked == name else found

    monkeypatch.setattr(checker, "rising", mutated)
    assert holds_on_boxes()
    assert not holds_at_points()


share = st.integers(0, 64).map(lambda k: Fraction(k, 64))
spans = st.tuples(share, share).map(lambda pair: tuple(LOW + (HIGH - LOW) * each for each in sorted(pair)))


@given(name=st.sampled_from(list(FUNCTIONS)), ends=st.tuples(spans, spans), shares=st.tuples(share, share))
@settings(max_examples=150, deadline=None)
def test_a_sampled_value_is_inside(name, ends, shares):
    found, _ = run(name, ends)
    point = [low + part * (high - low) for (low, high), part in zip(ends, shares, strict=True)]
    assert checker.finite(found)
    assert inside(found, exact(name, point))


@given(name=st.sampled_from(list(FUNCTIONS)), ends=st.tuples(spans, spans), axis=st.integers(0, 1))
@settings(max_examples=100, deadline=None)
def test_halves_are_never_worse(name, ends, axis):
    found, slopes = run(name, ends)
    low, high = ends[axis]
    for half in ((low, (low + high) / 2), ((low + high) / 2, high)):
        part, steeper = run(name, [half if k == axis else each for k, each in enumerate(ends)])
        for (a, b), (c, d) in zip((found, *slopes), (part, *steeper), strict=True):
            slack = flint.arb(2) ** -45 * (1 + abs(a) + abs(b))
            assert c >= a - slack
            assert d <= b + slack
