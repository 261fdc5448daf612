"""What the checker computes with: a SymPy expression on intervals, with forward derivatives.

An interval is a pair of balls that contain its two ends (Arb's ``arb``), so that rounding is part of the result. A
ball alone would not do: it forgets on which side of its middle a number lies, and fails on 1 + x^2. What is not
defined becomes no number, with which no comparison is true.
"""

from fractions import Fraction
from typing import Any, TypeAlias

import flint

from wspd_design.certificates.proof.claim import Variable, constant

Ends: TypeAlias = tuple[Any, Any]
"""Balls around the lower and the upper end of an interval."""
Slopes: TypeAlias = dict[int, Ends]
"""Enclosures of the derivatives, by the number of the variable; one that is not there is zero."""

NONE: Slopes = {}
NAMES = {"Add", "Mul", "exp", "log", "atan", "Abs", "Max", "Min"}
OPERANDS = {"Max": 2, "Min": 2}

MOST_EXPONENT = 16  # of a power that is taken by multiplication


class Refused(ValueError):
    """The certificate does not show the claim."""


class Program:
    """A SymPy expression on intervals, each shared part once; what no free variable enters is done beforehand."""

    def __init__(self, formula: Any, variables: tuple[Variable, ...]) -> None:
        self.free = [k for k, v in enumerate(variables) if v.free]
        self.known: dict[int, Ends] = {}
        self.steps: list[tuple[int, str, list[int], Any]] = []
        numbers = {v.name: k for k, v in enumerate(variables)}
        places: dict[Any, int] = {}

        def visit(node: Any) -> int:
            if node in places:
                return places[node]
            arguments = [visit(argument) for argument in node.args]
            place = places[node] = len(places)
            if node.is_Symbol and variables[numbers[node.name]].free:
                self.steps.append((place, "Symbol", [], numbers[node.name]))
            elif node.is_Symbol:
                self.known[place] = (ball(variables[numbers[node.name]].low),) * 2
            elif not node.args:
                self.known[place] = (ball(constant(node)),) * 2
            else:
                name, operands, extra = _operation(node, arguments)
                if all(k in self.known for k in operands):
                    x = [self.known[k] for k in operands]
                    self.known[place], _ = _apply(name, operands, x, [{}] * len(x), extra)
                else:
                    self.steps.append((place, name, operands, extra))
            return place

        self.result = visit(formula)

    def run(self, ends: list[Ends], *, derivatives: bool = False) -> tuple[Ends, list[Ends]]:
        """Enclose the value and, if asked, the slope along every variable."""
        zero, one = flint.arb(0), flint.arb(1)
        values, slopes = dict(self.known), dict.fromkeys(self.known, NONE)
        for place, name, operands, extra in self.steps:
            if name == "Symbol":
                values[place], slopes[place] = ends[extra], {extra: (one, one)} if derivatives else {}
                continue
            x, dx = [values[k] for k in operands], [slopes[k] for k in operands]
            values[place], slopes[place] = _apply(name, operands, x, dx, extra)
        slope = slopes[self.result]
        return values[self.result], [slope.get(k, (zero, zero)) for k in range(len(ends))]


def _operation(node: Any, arguments: list[int]) -> tuple[str, list[int], Any]:
    """Name of an operation, its operands and, for a power, its exponent."""
    if node.is_Pow:
        if not node.args[1].is_number:
            raise Refused("a power has an exponent that is no number")
        return "Pow", arguments[:1], constant(node.args[1])
    name = type(node).__name__
    if len(arguments) != OPERANDS.get(name, len(arguments)) or name not in NAMES:
        raise Refused(f"the expression contains {name}, which has no interval form")
    return name, arguments, None


def _apply(
    name: str, operands: list[int], x: list[Ends], dx: list[Slopes], extra: Any
) -> tuple[Ends, Slopes]:
    """Do one operation on intervals and their slopes."""
    found, slope = x[0], dx[0]
    if name == "Add":
        for y, dy in zip(x[1:], dx[1:], strict=True):
            found, slope = add(found, y), _plus(slope, dy)
        return found, slope
    if name == "Mul":
        for k in range(1, len(x)):
            slope = _plus(_times(slope, x[k]), _times(dx[k], found))
            same = k == 1 and operands[0] == operands[1]
            found = sqr(found) if same else mul(found, x[k])
        return found, slope
    if name in {"Abs", "Max", "Min"}:
        minus = flint.arb(-1), flint.arb(-1)
        y, dy = (negative(x[0]), _times(dx[0], minus)) if name == "Abs" else (x[1], dx[1])
        return _extremum(x[0], dx[0], y, dy, largest=name != "Min")
    inner: Ends
    if name == "Pow":
        found, inner = power(x[0], extra)
    elif name == "exp":
        found = inner = exp(x[0])
    elif name == "log":
        found, inner = log(x[0]), inverse(x[0])
    else:
        one = flint.arb(1), flint.arb(1)
        found, inner = atan(x[0]), inverse(add(one, sqr(x[0])))
    return found, _times(dx[0], inner)


def add(x: Ends, y: Ends) -> Ends:
    """Sum of two intervals."""
    return x[0] + y[0], x[1] + y[1]


def negative(x: Ends) -> Ends:
    """Opposite of an interval."""
    return -x[1], -x[0]


def mul(x: Ends, y: Ends) -> Ends:
    """Product of two intervals."""
    (a, b), (c, d) = x, y
    if a >= 0 and c >= 0:
        return a * c, b * d
    if b <= 0 and d <= 0:
        return b * d, a * c
    if a >= 0 and d <= 0:
        return b * c, a * d
    if b <= 0 and c >= 0:
        return a * d, b * c
    p, q, r, s = a * c, a * d, b * c, b * d
    return p.min(q).min(r).min(s), p.max(q).max(r).max(s)


def sqr(x: Ends) -> Ends:
    """Square of an interval."""
    a, b = x
    p, q = a * a, b * b
    if a >= 0:
        return p, q
    if b <= 0:
        return q, p
    return flint.arb(0), p.max(q)


def inverse(x: Ends) -> Ends:
    """Reciprocal of an interval; no number if it may contain zero."""
    if x[0] > 0 or x[1] < 0:
        return 1 / x[1], 1 / x[0]
    return flint.arb.nan(), flint.arb.nan()


def natural_power(x: Ends, n: int) -> Ends:
    """Power with an exponent of at least 1; an odd one keeps the order of the ends."""
    if n % 2 == 0:
        return sqr(natural_power(x, n // 2))
    return x[0] ** n, x[1] ** n


def power(x: Ends, exponent: Fraction) -> tuple[Ends, Ends]:
    """Power of an interval and its derivative with respect to the base."""
    if exponent == -1:
        found = inverse(x)
        return found, negative(sqr(found))
    if exponent.denominator == 1 and 2 <= exponent <= MOST_EXPONENT:
        n = int(exponent)
        return natural_power(x, n), mul((flint.arb(n),) * 2, natural_power(x, n - 1))
    factor = (ball(exponent),) * 2
    found = exp(mul(factor, log(x)))
    return found, mul(factor, mul(found, inverse(x)))


def exp(x: Ends) -> Ends:
    """Exponential function of an interval."""
    return x[0].exp(), x[1].exp()


def log(x: Ends) -> Ends:
    """Natural logarithm of an interval; no number if it may reach zero."""
    if x[0] > 0:
        return x[0].log(), x[1].log()
    return flint.arb.nan(), flint.arb.nan()


def atan(x: Ends) -> Ends:
    """Inverse tangent of an interval."""
    return x[0].atan(), x[1].atan()


def _extremum(x: Ends, dx: Slopes, y: Ends, dy: Slopes, *, largest: bool) -> tuple[Ends, Slopes]:
    """Larger or smaller of two; where it is open which, the slope may be that of either."""
    if largest:
        found = x[0].max(y[0]), x[1].max(y[1])
        first, second = x[0] >= y[1], y[0] >= x[1]
    else:
        found = x[0].min(y[0]), x[1].min(y[1])
        first, second = x[1] <= y[0], y[1] <= x[0]
    if first or second:
        return found, dx if first else dy
    zero = flint.arb(0), flint.arb(0)
    slope = {}
    for k in dx.keys() | dy.keys():
        (a, b), (c, d) = dx.get(k, zero), dy.get(k, zero)
        slope[k] = a.min(c), b.max(d)
    return found, slope


def _plus(x: Slopes, y: Slopes) -> Slopes:
    if not x or not y:
        return x or y
    return {**x, **y, **{k: add(x[k], y[k]) for k in x.keys() & y.keys()}}


def _times(slope: Slopes, factor: Ends) -> Slopes:
    return {k: mul(each, factor) for k, each in slope.items()}


def _sign(x: Ends) -> int:
    """1 or -1 if an interval certainly has no number of the other sign, else 0."""
    if x[0] >= 0:
        return 1
    return -1 if x[1] <= 0 else 0


def ball(number: Fraction) -> Any:
    """Ball around a rational."""
    return flint.arb(flint.fmpq(number.numerator, number.denominator))


def finite(x: Ends) -> bool:
    """Whether an interval has two finite ends."""
    return bool(x[0].is_finite() and x[1].is_finite())
