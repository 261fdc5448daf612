"""Elementary functions that accept every number type the kernels run on.

The physics is written once and evaluated on ``float``, NumPy arrays, CasADi symbols and intervals. Sums and
products dispatch by themselves; the handful of functions below finds the right library from the type of its
argument, so that this package imports none of them.
"""

import math
import sys
from typing import Any, TypeAlias

Number: TypeAlias = Any
"""A float, a NumPy array, a CasADi symbol or an interval: whatever the caller computes with."""


def _library(*operands: Number) -> Any:
    """Return the module whose functions act on the first operand that is not a plain Python number."""
    for operand in operands:
        if not isinstance(operand, (float, int)):
            return sys.modules[type(operand).__module__.partition(".")[0]]
    return math


def _elementary(name: str, x: Number) -> Number:
    """Apply a function of the library of the argument, or the argument's own method of that name."""
    kind = type(x)
    if issubclass(kind, (float, int)):
        return getattr(math, name)(x)
    function = getattr(sys.modules[kind.__module__.partition(".")[0]], name, None)
    return function(x) if function else getattr(x, name)()


def exp(x: Number) -> Number:
    """Exponential function."""
    return math.exp(x) if type(x) is float else _elementary("exp", x)


def atan(x: Number) -> Number:
    """Inverse tangent."""
    return math.atan(x) if type(x) is float else _elementary("atan", x)


def sin(x: Number) -> Number:
    """Sine."""
    return math.sin(x) if type(x) is float else _elementary("sin", x)


def tan(x: Number) -> Number:
    """Tangent."""
    return math.tan(x) if type(x) is float else _elementary("tan", x)


def log(x: Number) -> Number:
    """Natural logarithm."""
    return math.log(x) if type(x) is float else _elementary("log", x)


def sqrt(x: Number) -> Number:
    """Square root."""
    return math.sqrt(x) if type(x) is float else _elementary("sqrt", x)


def maximum(x: Number, y: Number) -> Number:
    """Return the larger of two numbers."""
    return _extremum(x, y, largest=True)


def minimum(x: Number, y: Number) -> Number:
    """Return the smaller of two numbers."""
    return _extremum(x, y, largest=False)


def _extremum(x: Number, y: Number, *, largest: bool) -> Number:
    library = _library(x, y)
    if library is math:
        return max(x, y) if largest else min(x, y)
    match library.__name__:
        case "numpy":
            return library.maximum(x, y) if largest else library.minimum(x, y)
        case "casadi":
            return library.fmax(x, y) if largest else library.fmin(x, y)
        case "flint":
            interval = x if hasattr(x, "max") else y
            other = y if interval is x else x
            return interval.max(other) if largest else interval.min(other)
        case _:
            return library.max(x, y) if largest else library.min(x, y)


def where(condition: Number, x: Number, y: Number) -> Number:
    """Return ``x`` where the condition holds and ``y`` elsewhere; both are always evaluated."""
    if isinstance(condition, (bool, int, float)):
        return x if condition else y
    library = _library(condition)
    return (
        library.if_else(condition, x, y) if library.__name__ == "casadi" else library.where(condition, x, y)
    )


def clip(x: Number, low: Number, high: Number) -> Number:
    """Limit ``x`` to ``[low, high]``."""
    return minimum(maximum(x, low), high)


def saturation(x: Number) -> Number:
    """Saturation function sat(x): ``x`` limited to [-1, 1]."""
    return clip(x, -1.0, 1.0)
