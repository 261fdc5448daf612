"""The checker's arithmetic against 300-bit references, and the same tests against wrong arithmetic.

Random containment alone would not do: an exponential that rounds inwards survives it, since a random point hardly
ever lies at the end of an interval. Thin intervals show it.
"""

import random
from fractions import Fraction

import flint
import pytest
import sympy

from wspd_design.certificates.kernel import checker
from wspd_design.certificates.kernel.claim import steps_of

WIDE, THIN = 300, 100  # numbers of intervals


def _ends(low, high):
    return flint.arb(flint.fmpq(*low.as_integer_ratio())), flint.arb(flint.fmpq(*high.as_integer_ratio()))


def _contains(interval, exact):
    low, high = interval[0].lower(), interval[1].upper()
    return bool(low <= exact.upper()) and bool(exact.lower() <= high)


# Function of intervals, its reference on numbers, its number of operands, whether they must be positive.
OPERATIONS = {
    "add": (checker.add, lambda x, y: x + y, 2, False),
    "magnitude": (checker.magnitude, abs, 1, False),
    "mul": (checker.mul, lambda x, y: x * y, 2, False),
    "sqr": (checker.sqr, lambda x: x * x, 1, False),
    "inverse": (checker.inverse, lambda x: 1 / x, 1, True),
    "cube": (lambda x: checker.power(x, Fraction(3)), lambda x: x**3, 1, False),
    "fourth": (lambda x: checker.power(x, Fraction(4)), lambda x: x**4, 1, False),
    "minus square": (lambda x: checker.power(x, Fraction(-2)), lambda x: 1 / x**2, 1, True),
    "fractional power": (
        lambda x: checker.power(x, Fraction(2, 3)),
        lambda x: x ** (flint.arb(2) / 3),
        1,
        True,
    ),
    "exp": (lambda x: checker.rising("exp", x), lambda x: x.exp(), 1, False),
    "log": (lambda x: checker.rising("log", x), lambda x: x.log(), 1, True),
    "atan": (lambda x: checker.rising("atan", x), lambda x: x.atan(), 1, False),
}


def _numbers(rng, positive):
    low, high = sorted(rng.choice([rng.uniform(-4.0, 4.0), float(rng.randint(-3, 3))]) for _ in range(2))
    high += 0.1  # never without width, which random points would notice
    return (abs(low) + 0.01, abs(low) + 0.02 + abs(high)) if positive else (low, high)


def contains_random_points(operation):
    """Whether wide intervals contain the results of random points inside."""
    function, reference, count, positive = operation
    rng = random.Random(1)
    for _ in range(WIDE):
        boxes = [_numbers(rng, positive) for _ in range(count)]
        with flint.ctx.workprec(80):
            found = function(*(_ends(*box) for box in boxes))
        with flint.ctx.workprec(300):
            points = [flint.arb(rng.uniform(*box)) for box in boxes]
            if not _contains(found, reference(*points)):
                return False
    return True


def contains_thin_results(operation):
    """Whether intervals without width contain the exact result, and little more."""
    function, reference, count, positive = operation
    rng = random.Random(2)
    for _ in range(THIN):
        points = [_numbers(rng, positive)[0] for _ in range(count)]
        with flint.ctx.workprec(80):
            found = function(*(_ends(point, point) for point in points))
        with flint.ctx.workprec(300):
            exact = reference(*(flint.arb(point) for point in points))
            width = found[1].upper() - found[0].lower()
            if not _contains(found, exact) or not width <= 1e-20 * (1 + abs(exact)):
                return False
    return True


@pytest.mark.parametrize("name", OPERATIONS)
def test_operations_enclose(name):
    assert contains_random_points(OPERATIONS[name])
    assert contains_thin_results(OPERATIONS[name])


def _inwards(function):
    """The same function, rounded inwards by as little as its precision knows."""

    def mutated(x):
        low, high = function(x)
        nudge = flint.arb(2) ** -90
        return low.mid() * (1 + nudge) + nudge, high.mid() * (1 - nudge) - nudge

    return mutated


MUTANTS = {
    "add": lambda x, y: (x[0] + y[1], x[1] + y[0]),
    "magnitude": lambda x: (abs(x[0]), abs(x[1])),
    "minus square": lambda x: checker.inverse((x[1] ** 2, x[0] ** 2)),
    "mul": lambda x, y: (x[0] * y[0], x[1] * y[1]),
    "sqr": lambda x: (x[0] * x[0], x[1] * x[1]),
    "inverse": lambda x: (1 / x[0], 1 / x[1]),
    "cube": lambda x: checker.power(x, Fraction(2)),
    "fourth": lambda x: (x[0] ** 4, x[1] ** 4),
    "exp": lambda x: (x[0].exp(), (x[0].exp() + x[1].exp()) / 2),
    "log": lambda x: (x[0].log() + 0.01, x[1].log()),
    "atan": lambda x: (x[1].atan(), x[0].atan()),
}


@pytest.mark.parametrize("name", MUTANTS)
def test_wrong_arithmetic_is_seen_by_random_points(name):
    _, *rest = OPERATIONS[name]
    assert not contains_random_points((MUTANTS[name], *rest))


@pytest.mark.parametrize("name", ["exp", "atan", "log"])
def test_inward_rounding_is_seen_by_thin_intervals_only(name):
    function, *rest = OPERATIONS[name]
    mutant = (_inwards(function), *rest)
    assert contains_random_points(mutant)
    assert not contains_thin_results(mutant)


def test_what_is_not_defined_is_no_number():
    across = (flint.arb(-1), flint.arb(2))
    for found in (
        checker.inverse(across),
        checker.rising("log", (flint.arb(-2), flint.arb(-1))),
        checker.power(across, Fraction(1, 2)),
    ):
        assert not checker.finite(found)
        assert not found[1] <= 1e300
    for function in (checker.add, checker.mul):
        assert not checker.finite(function(checker.inverse(across), across))
    assert not checker.finite(checker.sqr(checker.inverse(across)))
    assert not checker.finite(checker.magnitude(checker.inverse(across)))
    assert not checker.finite(checker.power(checker.inverse(across), Fraction(0)))


x, y = sympy.symbols("x y", real=True)
FORMULAS = {
    "product": x * y * x,
    "quotient": (x + y) / (x**2 + 1),
    "powers": x**3 - y ** sympy.Rational(2, 3) + 1 / y**2,
    "transcendental": sympy.exp(-x * y) * sympy.atan(x / y) + y,
    "magnitude": sympy.Abs(x - 2 * y),
    "magnitude of a known sign": sympy.Abs(x + y) * sympy.Abs(-y),
}


RANGE = Fraction(1, 2), Fraction(3)


def _program(formula, variables=(("x", *RANGE), ("y", *RANGE))):
    steps = checker._formula([list(step) for step in steps_of(formula)], {name for name, _, _ in variables})
    return checker.Program(steps, variables, checker.Work())


@pytest.mark.parametrize("name", FORMULAS)
def test_slopes_contain_the_derivatives(name):
    """On boxes, at random points inside; the derivatives are SymPy's with many digits."""
    formula = FORMULAS[name]
    program, rng = _program(formula), random.Random(3)
    exact = [sympy.lambdify((x, y), [formula.diff(v) for v in (x, y)], "mpmath")]
    for _ in range(40):
        box = [_numbers(rng, True), _numbers(rng, True)]
        found, slopes = program.run([_ends(*ends) for ends in box], derivatives=True)
        point = [rng.uniform(*ends) for ends in box]
        assert checker.finite(found)
        for slope, derivative in zip(slopes, exact[0](*point), strict=True):
            assert _contains(slope, flint.arb(float(derivative), 1e-13 * (1.0 + abs(float(derivative)))))


def test_wrong_product_rule_is_seen(monkeypatch):
    monkeypatch.setattr(checker, "_plus", lambda one, other: one or other)
    with pytest.raises(AssertionError):
        test_slopes_contain_the_derivatives("product")


def test_program_shares_parts_and_does_known_ones_once():
    k = sympy.Symbol("k")
    formula = sympy.exp(k) * x + sympy.exp(k) * x**2
    program = _program(formula, (("x", Fraction(0), Fraction(1)), ("k", Fraction(2), Fraction(2))))
    assert sum(step[1] == "exp" for step in program.steps) == 0
    assert sum(step[1] == "x" for step in program.steps) == 1


@pytest.mark.parametrize(
    "formula",
    [sympy.sin(x), sympy.log(x), sympy.Max(x, y), x**y, sympy.Piecewise((x, x > 1), (y, True)), sympy.pi * x],
)
def test_what_the_checker_does_not_know_is_not_stated(formula):
    with pytest.raises(ValueError, match="that a claim may contain"):
        steps_of(formula)
