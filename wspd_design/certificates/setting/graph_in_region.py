"""Values of CasADi graphs where some quantities are known to stay in ranges: which branch is taken there, decided.

As in :mod:`wspd_design.certificates.setting.graph_field` numbers are elements of a prime field, at three points at
once, each with a double beside it that belongs to a state inside the region. A comparison is about the sign of a
difference d. If d = alpha g + beta with a known quantity g at all three points, it is so at all points, except with a
probability of 1 in 2^255; the range of g then decides the sign, with alpha and beta from the doubles. What is not
decided stays an element that depends on what is compared, so that two graphs agree only if they compare the same.

Logarithms of inverses and exponentials of opposites are related, as they are in real numbers. Where two branches of a
graph meet, either of them counts.
"""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from wspd_design.certificates.kernel.checker import PRIME, element
from wspd_design.certificates.setting.graph_field import UndecidedError, applied, residue
from wspd_design.codegen.graph import evaluate

POINTS = 3
SURE = 1e-9  # relative, by which a sign must be beyond rounding


@dataclass(frozen=True, slots=True)
class Value:
    """A number at the points."""

    field: tuple[int, ...]
    real: tuple[float, ...]  # at states inside the region
    boolean: bool = False

    @staticmethod
    def of(number: float, *, boolean: bool = False) -> "Value":
        """Return a number that is the same everywhere."""
        return Value((residue(number),) * POINTS, (float(number),) * POINTS, boolean)

    @staticmethod
    def free(real: Sequence[float], *name: int | str) -> "Value":
        """Return a number that is free: random elements of the field."""
        return Value(tuple(element(*name, point) for point in range(POINTS)), tuple(real))

    def minus(self, other: "Value") -> "Value":
        """Difference."""
        field = tuple((a - b) % PRIME for a, b in zip(self.field, other.field, strict=True))
        return Value(field, tuple(a - b for a, b in zip(self.real, other.real, strict=True)))


@dataclass(frozen=True, slots=True)
class Known:
    """A quantity and the range that it stays in."""

    value: Value
    low: float
    high: float


def values(function: Any, inputs: Sequence[Sequence[Value]], known: Sequence[Known]) -> list[list[Value]]:
    """Evaluate a graph in the region.

    Parameters
    ----------
    function : casadi.Function
        Of SX, with dense inputs and outputs.
    inputs : sequence of sequence of Value
        For each input of the function.
    known : sequence of Known
        What decides comparisons.

    Raises
    ------
    UndecidedError
        If the graph has no value there.
    """

    def constant(number: float) -> Value:
        return Value.of(number)

    return evaluate(function, inputs, constant, lambda name, x: _apply(name, x, known))


def _apply(name: str, x: list[Value], known: Sequence[Known]) -> Value:
    match name:
        case "OP_LT" | "OP_LE":
            above = positive(x[1].minus(x[0]), known, zero=name == "OP_LE")
            if above is not None:
                return Value.of(float(above), boolean=True)
        case "OP_FMIN" | "OP_FMAX":
            above = positive(x[1].minus(x[0]), known, zero=True)
            if above is not None:
                return x[0] if above == (name == "OP_FMIN") else x[1]
        case "OP_FABS":
            above = positive(x[0], known, zero=True)
            if above is not None:
                return x[0] if above else Value.of(0.0).minus(x[0])
        case "OP_EXPM1":
            return _apply("OP_EXP", x, known).minus(Value.of(1.0))
        case "OP_LOG1P":
            return _apply("OP_LOG", [x[0].minus(Value.of(-1.0))], known)
    found = [_in_field(name, [(each.field[k], each.boolean) for each in x]) for k in range(POINTS)]
    real = tuple(_in_doubles(name, [each.real[k] for each in x]) for k in range(POINTS))
    return Value(tuple(value for value, _ in found), real, found[0][1])


def _in_field(name: str, x: list[tuple[int, bool]]) -> tuple[int, bool]:
    elements, truths = [value for value, _ in x], [flag for _, flag in x]
    a = elements[0]
    if name == "OP_EXP":
        smaller = min(a, PRIME - a)
        grown = 1 if a == 0 else element(name, smaller)
        return (grown if a == smaller or a == 0 else pow(grown, -1, PRIME)), False
    if name == "OP_LOG":
        if a == 0:
            raise UndecidedError("a logarithm of 0")
        smaller = min(a, pow(a, -1, PRIME))
        found = 0 if a == 1 else element(name, smaller)
        return (found if a == smaller else -found % PRIME), False
    if name == "OP_SQRT" and a in (0, 1):
        return a, False
    return applied(name, elements, truths)


def positive(d: Value, known: Sequence[Known], *, zero: bool) -> bool | None:
    """Tell whether a number is above 0 in the whole region, or None; ``zero`` is said where it is 0 everywhere."""
    if not any(d.field):
        return zero
    for low, high in _ranges(d, known):
        if low >= 0.0:
            return True
        if high <= 0.0:
            return False
    return None


def _ranges(d: Value, known: Sequence[Known]) -> Iterator[tuple[float, float]]:
    """Yield ranges of a number that is affine in a known quantity, widened by what rounding may do."""
    if len(set(d.field)) == 1:
        yield d.real[0], d.real[0]
        return
    for each in known:
        g = each.value
        steps = [((d.field[k] - d.field[0]), (g.field[k] - g.field[0])) for k in (1, 2)]
        (d1, g1), (d2, g2) = steps
        if (d1 * g2 - d2 * g1) % PRIME or not g1 % PRIME:
            continue
        k = max((1, 2), key=lambda place: abs(g.real[place] - g.real[0]))
        apart = g.real[k] - g.real[0]
        if apart == 0.0 or not math.isfinite(apart):
            continue
        factor = (d.real[k] - d.real[0]) / apart
        if factor == 0.0 or not math.isfinite(factor):
            continue
        at_ends = [_at(d, g, end, factor) for end in (each.low, each.high)]
        if not any(map(math.isnan, at_ends)):
            yield min(at_ends), max(at_ends)


def _at(d: Value, g: Value, end: float, factor: float) -> float:
    """Value of d where g is at the end of its range; towards 0 by what rounding may do, but where it is 0 exactly."""
    if math.isinf(end):
        return factor * end
    apart = g.field[0] - residue(end)
    if not (d.field[0] * (g.field[1] - g.field[0]) - (d.field[1] - d.field[0]) * apart) % PRIME:
        return 0.0
    found = d.real[0] + factor * (end - g.real[0])
    unsure = SURE * max(abs(d.real[0]), abs(factor * end), abs(factor * g.real[0]))
    return math.copysign(max(abs(found) - unsure, 0.0), found) if abs(found) > unsure else math.nan


_REAL: dict[str, Callable[..., float]] = {
    "OP_ASSIGN": lambda a: a,
    "OP_ADD": lambda a, b: a + b,
    "OP_SUB": lambda a, b: a - b,
    "OP_MUL": lambda a, b: a * b,
    "OP_DIV": lambda a, b: a / b,
    "OP_INV": lambda a: 1.0 / a,
    "OP_NEG": lambda a: -a,
    "OP_SQ": lambda a: a * a,
    "OP_TWICE": lambda a: 2.0 * a,
    "OP_POW": lambda a, b: a**b,
    "OP_CONSTPOW": lambda a, b: a**b,
    "OP_EXP": math.exp,
    "OP_LOG": math.log,
    "OP_SQRT": math.sqrt,
    "OP_ATAN": math.atan,
    "OP_TANH": math.tanh,
    "OP_FMIN": min,
    "OP_FMAX": max,
    "OP_FABS": abs,
    "OP_LT": lambda a, b: float(a < b),
    "OP_LE": lambda a, b: float(a <= b),
    "OP_EQ": lambda a, b: float(a == b),
    "OP_NE": lambda a, b: float(a != b),
    "OP_NOT": lambda a: float(not a),
    "OP_AND": lambda a, b: float(bool(a and b)),
    "OP_OR": lambda a, b: float(bool(a or b)),
    "OP_IF_ELSE_ZERO": lambda a, b: b if a else 0.0,
}


def _in_doubles(name: str, x: list[float]) -> float:
    """Value in doubles; not a number where there is none, or the operation is not known."""
    try:
        found = _REAL[name](*x)
    except (KeyError, ValueError, ZeroDivisionError, OverflowError):
        return math.nan
    return math.nan if isinstance(found, complex) else float(found)
