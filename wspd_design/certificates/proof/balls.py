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

MOST_EXPONENT = 16  # of a power that is taken by multiplication


class Refused(ValueError):
    """The certificate does not show the claim."""


class Program:
    """The SymPy expression of a claim, each shared part once, on intervals with forward derivatives."""

    def __init__(self, formula: Any, variables: tuple[Variable, ...]) -> None:
        self.numbers = {v.name: k for k, v in enumerate(variables)}
        self.free = [k for k, v in enumerate(variables) if v.free]
        self.steps: list[tuple[str, list[int], Any]] = []
        places: dict[Any, int] = {}

        def visit(node: Any) -> int:
            if node not in places:
                arguments = [visit(argument) for argument in node.args]
                self.steps.append(self._step(node, arguments))
                places[node] = len(self.steps) - 1
            return places[node]

        visit(formula)

    def _step(self, node: Any, arguments: list[int]) -> tuple[str, list[int], Any]:
        if node.is_Symbol:
            return "Symbol", [], self.numbers[node.name]
        if not node.args:
            number = ball(constant(node))
            return "Number", [], (number, number)
        if node.is_Pow:
            if not node.args[1].is_number:
                raise Refused("a power has an exponent that is no number")
            exponent = constant(node.args[1])
            return "Pow", arguments[:1], exponent
        name = type(node).__name__
        if name not in {"Add", "Mul", "exp", "log", "atan", "Abs", "Max", "Min"}:
            raise Refused(f"the expression contains {name}, which has no interval form")
        return name, arguments, None

    def run(self, ends: list[Ends], *, derivatives: bool = False) -> tuple[Ends, list[Ends]]:
        """Enclose the value and, if asked, the slope along every variable."""
        zero, one = flint.arb(0), flint.arb(1)
        values: list[Ends] = []
        slopes: list[dict[int, Ends]] = []
        for name, arguments, extra in self.steps:
            x = [values[k] for k in arguments]
            dx = [slopes[k] for k in arguments]
            if name == "Symbol":
                values.append(ends[extra])
                slopes.append({extra: (one, one)} if derivatives and extra in self.free else {})
                continue
            if name == "Number":
                values.append(extra)
                slopes.append({})
                continue
            if name == "Add":
                found, slope = x[0], dx[0]
                for y, dy in zip(x[1:], dx[1:], strict=True):
                    found, slope = add(found, y), _plus(slope, dy)
            elif name == "Mul":
                found, slope = x[0], dx[0]
                for k in range(1, len(x)):
                    slope = _plus(_times(slope, x[k]), _times(dx[k], found))
                    same = k == 1 and arguments[0] == arguments[1]
                    found = sqr(found) if same else mul(found, x[k])
            elif name == "Pow":
                found, inner = power(x[0], extra)
                slope = _times(dx[0], inner) if dx[0] else {}
            elif name == "exp":
                found = x[0][0].exp(), x[0][1].exp()
                slope = _times(dx[0], found)
            elif name == "log":
                found = _log(x[0])
                slope = _times(dx[0], inverse(x[0]))
            elif name == "atan":
                found = x[0][0].atan(), x[0][1].atan()
                slope = _times(dx[0], inverse(add((one, one), sqr(x[0])))) if dx[0] else {}
            else:
                y, dy = (negative(x[0]), _times(dx[0], (-one, -one))) if name == "Abs" else (x[1], dx[1])
                found, slope = _extremum(x[0], dx[0], y, dy, largest=name != "Min")
            values.append(found)
            slopes.append(slope)
        return values[-1], [slopes[-1].get(k, (zero, zero)) for k in range(len(ends))]


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
    p = ball(exponent)
    low, high = _log(x)
    found = mul((p, p), (low, high))
    found = found[0].exp(), found[1].exp()
    return found, mul((p, p), mul(found, inverse(x)))


def _log(x: Ends) -> Ends:
    if x[0] > 0:
        return x[0].log(), x[1].log()
    return flint.arb.nan(), flint.arb.nan()


def _extremum(
    x: Ends, dx: dict[int, Ends], y: Ends, dy: dict[int, Ends], *, largest: bool
) -> tuple[Ends, dict[int, Ends]]:
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


def _plus(x: dict[int, Ends], y: dict[int, Ends]) -> dict[int, Ends]:
    if not x or not y:
        return x or y
    return {**x, **y, **{k: add(x[k], y[k]) for k in x.keys() & y.keys()}}


def _times(slope: dict[int, Ends], factor: Ends) -> dict[int, Ends]:
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
