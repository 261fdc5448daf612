"""What the checker computes with: a SymPy expression on intervals, with forward derivatives.

An interval is a pair of balls that contain its two ends (Arb's ``arb``), so that rounding is part of the result. A
ball alone would not do: it forgets on which side of its middle a number lies, and fails on 1 + x^2. What is not
defined becomes no number, with which no comparison is true.
"""

from fractions import Fraction
from typing import Any, TypeAlias

from flint import arb, fmpq

from wspd_design.certificates.kernel.claim import Variable, constant

Ends: TypeAlias = tuple[Any, Any]
"""Balls around the lower and the upper end of an interval."""
Slopes: TypeAlias = dict[int, Ends]
"""Enclosures of the derivatives, by the number of the variable; one that is not there is zero."""

ZERO, ONE, MINUS = ((arb(n), arb(n)) for n in (0, 1, -1))
NAMES = ("Symbol", "Add", "Mul", "Pow", "Abs", "exp", "atan")


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
            operands = [visit(argument) for argument in node.args]
            place = places[node] = len(places)
            name = type(node).__name__
            extra: Any = None
            if node.is_Symbol:
                extra = numbers[node.name]
                if not variables[extra].free:
                    self.known[place] = exactly(variables[extra].low)
            elif node.is_Number:
                self.known[place] = exactly(constant(node))
            elif name not in NAMES:
                raise Refused(f"the expression contains {name}, which has no interval form")
            elif node.is_Pow:
                if not node.args[1].is_Number:
                    raise Refused("a power has an exponent that is no number")
                extra = constant(node.args[1])
            if operands and all(k in self.known for k in operands):
                self.known[place], _ = _apply(name, [(self.known[k], {}) for k in operands], extra)
            elif place not in self.known:
                self.steps.append((place, name, operands, extra))
            return place

        self.result = visit(formula)

    def run(self, ends: list[Ends], *, derivatives: bool = False) -> tuple[Ends, list[Ends]]:
        """Enclose the value and, if asked, the slope along every variable."""
        done: dict[int, tuple[Ends, Slopes]] = {k: (value, {}) for k, value in self.known.items()}
        for place, name, operands, extra in self.steps:
            if name == "Symbol":
                done[place] = ends[extra], {extra: ONE} if derivatives else {}
            else:
                done[place] = _apply(name, [done[k] for k in operands], extra)
        found, slope = done[self.result]
        return found, [slope.get(k, ZERO) for k in range(len(ends))]


def _apply(name: str, operands: list[tuple[Ends, Slopes]], exponent: Any) -> tuple[Ends, Slopes]:
    """Do one operation on intervals and their slopes."""
    x, dx = operands[0]
    if name == "Add":
        for y, dy in operands[1:]:
            x, dx = add(x, y), _plus(dx, dy)
    elif name == "Mul":
        for k, (y, dy) in enumerate(operands[1:]):
            dx = _plus(_times(dx, y), _times(dy, x))
            x = sqr(x) if k == 0 and operands[1] is operands[0] else mul(x, y)
    elif name == "Pow":
        inner = mul(exactly(exponent), power(x, exponent - 1))
        x, dx = power(x, exponent), _times(dx, inner)
    elif name == "Abs":
        # Where the sign is open the slope may be that of either side.
        sign = ONE if x[0] >= 0 else MINUS if x[1] <= 0 else (arb(-1), arb(1))
        x, dx = magnitude(x), _times(dx, sign)
    elif name == "exp":
        x = exp(x)
        dx = _times(dx, x)
    else:
        x, dx = atan(x), _times(dx, inverse(add(ONE, sqr(x))))
    return x, dx


def add(x: Ends, y: Ends) -> Ends:
    """Sum of two intervals."""
    return x[0] + y[0], x[1] + y[1]


def mul(x: Ends, y: Ends) -> Ends:
    """Product of two intervals; mostly their signs tell which ends count."""
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


def magnitude(x: Ends) -> Ends:
    """Magnitude of an interval."""
    return arb(0).max(x[0]).max(-x[1]), x[1].max(-x[0])


def sqr(x: Ends) -> Ends:
    """Square of an interval."""
    low, high = magnitude(x)
    return low * low, high * high


def inverse(x: Ends) -> Ends:
    """Reciprocal of an interval; no number if it may contain zero."""
    return (1 / x[1], 1 / x[0]) if x[0] > 0 or x[1] < 0 else (arb.nan(), arb.nan())


def power(x: Ends, exponent: Fraction) -> Ends:
    """Power of an interval; no number if a broken exponent meets a base that may reach zero."""
    if exponent < 0:
        return inverse(power(x, -exponent))
    if exponent.denominator > 1:
        return exp(mul(exactly(exponent), log(x)))
    if exponent == 0:
        return add(ONE, mul(ZERO, x))
    if exponent % 2 == 0:
        return sqr(power(x, exponent / 2))
    return x[0] ** int(exponent), x[1] ** int(exponent)


def exp(x: Ends) -> Ends:
    """Exponential function of an interval."""
    return x[0].exp(), x[1].exp()


def log(x: Ends) -> Ends:
    """Natural logarithm of an interval; no number if it may reach zero."""
    return (x[0].log(), x[1].log()) if x[0] > 0 else (arb.nan(), arb.nan())


def atan(x: Ends) -> Ends:
    """Inverse tangent of an interval."""
    return x[0].atan(), x[1].atan()


def _plus(x: Slopes, y: Slopes) -> Slopes:
    return {**x, **y, **{k: add(x[k], y[k]) for k in x.keys() & y.keys()}}


def _times(slope: Slopes, factor: Ends) -> Slopes:
    return {k: mul(each, factor) for k, each in slope.items()}


def exactly(number: Fraction) -> Ends:
    """Interval of one rational."""
    around = arb(fmpq(number.numerator, number.denominator))
    return around, around


def finite(x: Ends) -> bool:
    """Whether an interval has two finite ends."""
    return bool(x[0].is_finite() and x[1].is_finite())
