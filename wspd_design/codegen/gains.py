"""The numbers of a law as inputs of its kernel: floats that know the symbol they stand for.

A law is traced with its own values, and every float in it carries a CasADi expression beside its value. Arithmetic
keeps both; comparisons and everything else that Python does with a float see the value alone. The trace is therefore
the law at its present numbers, whatever it does with them: where it branches on a number or takes it out of
arithmetic, the trace has a constant, and another value gives another trace.
"""

import copy
import math
import operator
from collections.abc import Callable
from dataclasses import is_dataclass
from typing import Any

_Binary = Callable[[Any, Any], Any]


class Gain:
    """A float with the expression that stands for it in a kernel.

    ``isinstance`` takes it for a float, so that a law treats it as its number; CasADi asks for the expression. It is
    no key of a dictionary: a cache would keep the expression beyond its kernel.
    """

    __slots__ = ("_expression", "_value")
    __hash__ = None  # type: ignore[assignment]
    __array_priority__ = 2000.0  # CasADi and NumPy leave the arithmetic to this class

    def __init__(self, value: float, expression: Any) -> None:
        self._value, self._expression = value, expression

    @property  # type: ignore[misc]
    def __class__(self) -> type:
        """What ``isinstance`` sees."""
        return float

    def __SX__(self) -> Any:
        return self._expression

    def __getattr__(self, name: str) -> Any:
        return getattr(self._value, name)

    def __copy__(self) -> "Gain":
        return self

    def __deepcopy__(self, memo: object) -> "Gain":
        return self

    def __float__(self) -> float:
        return self._value

    def exp(self) -> "Gain":
        """Exponential function."""
        return self._applied(math.exp, "OP_EXP")

    def atan(self) -> "Gain":
        """Inverse tangent."""
        return self._applied(math.atan, "OP_ATAN")

    def sin(self) -> "Gain":
        """Sine."""
        return self._applied(math.sin, "OP_SIN")

    def tan(self) -> "Gain":
        """Tangent."""
        return self._applied(math.tan, "OP_TAN")

    def log(self) -> "Gain":
        """Natural logarithm."""
        return self._applied(math.log, "OP_LOG")

    def sqrt(self) -> "Gain":
        """Square root."""
        return self._applied(math.sqrt, "OP_SQRT")

    def __neg__(self) -> "Gain":
        return self._applied(operator.neg, "OP_NEG")

    def __abs__(self) -> "Gain":
        return self._applied(abs, "OP_FABS")

    def __pow__(self, exponent: Any) -> Any:
        if not isinstance(exponent, (int, float)):
            return self._value**exponent
        value = self._value ** float(exponent)
        return Gain(value, self._expression ** float(exponent)) if isinstance(value, float) else value

    def _applied(self, function: Callable[[float], float], code: str) -> "Gain":
        import casadi as ca

        return Gain(function(self._value), ca.SX.unary(getattr(ca, code), self._expression))


def _arithmetic(python: _Binary, code: str) -> tuple[_Binary, _Binary]:
    """Methods of an operation and of its reflection: with numbers, with symbols, with anything else."""

    def combined(one: Any, other: Any) -> Any:
        import casadi as ca

        operands = one, other
        if all(isinstance(x, (int, float)) for x in operands):
            value = python(*(x._value if type(x) is Gain else x for x in operands))
            return Gain(value, ca.SX.binary(getattr(ca, code), *map(_symbolic, operands)))
        return python(*map(_symbolic if any(isinstance(x, ca.SX) for x in operands) else plain, operands))

    return combined, lambda one, other: combined(other, one)


def _on_value(python: Callable[..., Any]) -> Callable[..., Any]:
    """Method that sees the value alone."""
    return lambda *operands: python(*map(plain, operands))


def _compared(python: _Binary) -> _Binary:
    def compared(one: Gain, other: Any) -> Any:
        import casadi as ca

        return python(one._expression if isinstance(other, ca.SX) else one._value, plain(other))

    return compared


def _symbolic(x: Any) -> Any:
    return x._expression if type(x) is Gain else x


def plain(x: Any) -> Any:
    """Return the value of a gain, and anything else as it is."""
    return x._value if type(x) is Gain else x


_SEEN_AS_A_FLOAT: dict[str, Callable[..., Any]] = {
    "bool": bool,
    "int": int,
    "trunc": math.trunc,
    "floor": math.floor,
    "ceil": math.ceil,
    "round": round,
    "repr": repr,
    "str": str,
    "format": format,
    "floordiv": operator.floordiv,
    "mod": operator.mod,
    "divmod": divmod,
    "rfloordiv": lambda one, other: other // one,
    "rmod": lambda one, other: other % one,
    "rdivmod": lambda one, other: divmod(other, one),
    "rpow": lambda exponent, base: base**exponent,
}
for _name, _code in (("add", "OP_ADD"), ("sub", "OP_SUB"), ("mul", "OP_MUL"), ("truediv", "OP_DIV")):
    _direct, _reflected = _arithmetic(getattr(operator, _name), _code)
    setattr(Gain, f"__{_name}__", _direct)
    setattr(Gain, f"__r{_name}__", _reflected)
for _name in ("eq", "ne", "lt", "le", "gt", "ge"):
    setattr(Gain, f"__{_name}__", _compared(getattr(operator, _name)))
for _name, _function in _SEEN_AS_A_FLOAT.items():
    setattr(Gain, f"__{_name}__", _on_value(_function))


def with_gains(law: Any, gain: Callable[[float], Any]) -> Any:
    """Return a copy of a law in which every float is replaced.

    Parameters
    ----------
    law : object
        Its floats are those among its attributes, in tuples of numbers, and in dataclasses within it.
    gain : callable
        Called with every float, in a fixed order.
    """
    changed = copy.copy(law)
    for name in _attributes(law):
        object.__setattr__(changed, name, _replaced(getattr(law, name), gain))
    return changed


def _replaced(value: Any, gain: Callable[[float], Any]) -> Any:
    if isinstance(value, float):
        return gain(value)
    if isinstance(value, tuple) and all(isinstance(element, (int, float)) for element in value):
        elements = [_replaced(element, gain) for element in value]
        return type(value)._make(elements) if hasattr(value, "_make") else type(value)(elements)
    if is_dataclass(value) and not isinstance(value, type):
        return with_gains(value, gain)
    return value


def _attributes(record: Any) -> list[str]:
    """Names of the attributes that an object itself holds."""
    slots = [name for kind in type(record).__mro__ for name in _slots(kind)]
    names = [name for name in slots if hasattr(record, name)]
    return [*names, *getattr(record, "__dict__", {})]


def _slots(kind: type) -> tuple[str, ...]:
    slots = vars(kind).get("__slots__", ())
    return tuple(
        name for name in ((slots,) if isinstance(slots, str) else slots) if not name.startswith("__")
    )
