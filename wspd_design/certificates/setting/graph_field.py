"""Values of CasADi graphs in a prime field: whether two graphs are the same function, decided exactly.

The idea is that of ``same`` in the stand-alone checker: inputs and everything that is not rational become
pseudo-random elements of the field of 2^255 - 19 elements, which depend on the values of their arguments. Numbers are
the exact doubles of the graph. Two graphs with the same value at such a point are the same function of real numbers
wherever both are defined, except with a probability of about their degree in 2^255.

A comparison becomes an element b that stands for 0 or 1: ``not b`` is 1 - b, ``a and b`` is a b, and
``if b then x else 0`` is b x. What holds for such an element holds for both branches. The converse fails here and
there, so that "different" means "not shown to be the same".
"""

from collections.abc import Callable, Sequence
from fractions import Fraction
from math import isfinite
from typing import Any

from wspd_design.certificates.kernel.checker import PRIME, element
from wspd_design.codegen.graph import evaluate
from wspd_design.parameters.errors import WspdError


class UndecidedError(WspdError, ValueError):
    """The graph has no value in the field: a division by zero, or a constant that is not a finite number."""


def values(function: Any, inputs: Sequence[Sequence[int]]) -> list[list[int]]:
    """Evaluate a graph in the field.

    Parameters
    ----------
    function : casadi.Function
        Of SX, with dense inputs and outputs.
    inputs : sequence of sequence of int
        Elements of the field, for each input of the function.

    Returns
    -------
    list of list of int
        Elements for each output.

    Raises
    ------
    UndecidedError
        If the graph has no value there.
    """
    elements = [[(each, False) for each in row] for row in inputs]
    found = evaluate(function, elements, lambda number: (residue(number), False), _applied)
    return [[each for each, _ in row] for row in found]


def _applied(name: str, x: list[tuple[int, bool]]) -> tuple[int, bool]:
    return applied(name, [each for each, _ in x], [is_truth for _, is_truth in x])


def applied(name: str, x: list[int], boolean: list[bool]) -> tuple[int, bool]:
    """Return the value of an operation, and whether it stands for 0 or 1."""
    if name in _RATIONAL:
        return _RATIONAL[name](*x) % PRIME, False
    if name in ("OP_DIV", "OP_INV"):
        top, bottom = x if name == "OP_DIV" else (1, x[0])
        return top * _inverse(bottom) % PRIME, False
    if name in ("OP_FMIN", "OP_FMAX"):
        least = element("min", *sorted(x))
        return (least if name == "OP_FMIN" else sum(x) - least) % PRIME, False
    if name == "OP_FABS":  # the magnitude does not know the sign of its argument
        return element("abs", x[0] * x[0] % PRIME), False
    if name in ("OP_LT", "OP_LE"):
        return (_less(*x) if name == "OP_LT" else (1 - _less(x[1], x[0])) % PRIME), True
    if name in ("OP_EQ", "OP_NE"):
        equal = 1 if x[0] == x[1] else element("equal", *sorted(x))
        return (equal if name == "OP_EQ" else (1 - equal) % PRIME), True
    if name in _LOGICAL:
        truths = [value if flag else _truth(value) for value, flag in zip(x, boolean, strict=True)]
        return _LOGICAL[name](*truths) % PRIME, True
    if name == "OP_IF_ELSE_ZERO":
        condition = x[0] if boolean[0] else _truth(x[0])
        return condition * x[1] % PRIME, False
    return element(name, *x), False


_RATIONAL: dict[str, Callable[..., int]] = {
    "OP_ASSIGN": lambda a: a,
    "OP_ADD": lambda a, b: a + b,
    "OP_SUB": lambda a, b: a - b,
    "OP_MUL": lambda a, b: a * b,
    "OP_NEG": lambda a: -a,
    "OP_SQ": lambda a: a * a,
    "OP_TWICE": lambda a: 2 * a,
}
_LOGICAL: dict[str, Callable[..., int]] = {
    "OP_NOT": lambda a: 1 - a,
    "OP_AND": lambda a, b: a * b,
    "OP_OR": lambda a, b: a + b - a * b,
}


def _less(a: int, b: int) -> int:
    return 0 if a == b else element("less", a, b)


def _truth(value: int) -> int:
    """0 for zero, 1 for one; an element for what is not known to be either."""
    return value if value in (0, 1) else element("truth", value)


def _inverse(value: int) -> int:
    if value == 0:
        raise UndecidedError("a divisor vanishes")
    return pow(value, -1, PRIME)


def residue(number: float) -> int:
    """Return a double as an element of the field."""
    if not isfinite(number):
        raise UndecidedError(f"{number} is not a finite number")
    exact = Fraction(number)
    return exact.numerator * pow(exact.denominator, -1, PRIME) % PRIME


def field_point(function: Any, number: int) -> list[list[int]]:
    """Return elements of the field for all inputs of a function, others for each number."""
    return [
        [element("input", place, index, number) for index in range(function.nnz_in(place))]
        for place in range(function.n_in())
    ]


def same_in_field(pairs: Sequence[tuple[Any, Any]], points: int) -> bool:
    """Tell whether the functions of each pair have the same values at points; False where that is not decided."""
    try:
        return all(
            values(one, field_point(one, number)) == values(other, field_point(other, number))
            for one, other in pairs
            for number in range(points)
        )
    except UndecidedError:
        return False
