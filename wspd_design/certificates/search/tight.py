"""The tightest intervals of doubles, from the C library of ``ival`` (PyPI crival).

A batch of the prover is small, so that the way into C counts more than the arithmetic: both ends of an array lie in one
block of memory, whose address is known, and the functions are called with addresses alone. Own code and the class
``ival.Interval`` give the same bits; the tests compare them.
"""

import ctypes
from collections.abc import Callable
from typing import Any, TypeAlias

import ival
import numpy as np
from numpy.typing import NDArray

Array: TypeAlias = NDArray[np.float64]

_LIBRARY = ctypes.CDLL(ival.library_path)


def _function(name: str, operands: int) -> Callable[..., None]:
    """Return a function of the library: both ends of each operand, both of the result, and how many there are."""
    found: Any = getattr(_LIBRARY, f"ival_{name}")
    found.argtypes = [ctypes.c_void_p] * (2 * operands + 2) + [ctypes.c_size_t]
    found.restype = None
    return found  # type: ignore[no-any-return]


_ADD, _SUB, _MUL, _DIV = (_function(name, 2) for name in ("add", "sub", "mul", "div"))
_NEG, _SQR, _SQRT, _EXP, _LOG, _ATAN = (
    _function(name, 1) for name in ("neg", "sqr", "sqrt", "exp", "log", "atan")
)


class Interval:
    """An array of intervals; the lower ends come before the upper ones in memory."""

    __slots__ = ("address", "ends")

    def __init__(self, lo: Array, hi: Array) -> None:
        ends = np.empty((2, *np.broadcast_shapes(lo.shape, hi.shape)))
        ends[0], ends[1] = lo, hi
        self.ends, self.address = ends, ends.__array_interface__["data"][0]

    @property
    def lo(self) -> Array:
        """Lower ends."""
        found: Array = self.ends[0]
        return found

    @property
    def hi(self) -> Array:
        """Upper ends."""
        found: Array = self.ends[1]
        return found

    def __add__(self, other: "Interval") -> "Interval":
        return _of_two(_ADD, self, other)

    def __sub__(self, other: "Interval") -> "Interval":
        return _of_two(_SUB, self, other)

    def __mul__(self, other: "Interval") -> "Interval":
        return _of_two(_MUL, self, other)

    def __truediv__(self, other: "Interval") -> "Interval":
        return _of_two(_DIV, self, other)

    def __neg__(self) -> "Interval":
        return _of_one(_NEG, self)


def sqr(x: Interval) -> Interval:
    """Square."""
    return _of_one(_SQR, x)


def sqrt(x: Interval) -> Interval:
    """Square root of the part that has one."""
    return _of_one(_SQRT, x)


def exp(x: Interval) -> Interval:
    """Exponential function."""
    return _of_one(_EXP, x)


def log(x: Interval) -> Interval:
    """Natural logarithm of the part that has one."""
    return _of_one(_LOG, x)


def atan(x: Interval) -> Interval:
    """Inverse tangent."""
    return _of_one(_ATAN, x)


def _made(ends: Array) -> Interval:
    """Return an interval of an array that holds both ends, without copying."""
    found = Interval.__new__(Interval)
    found.ends, found.address = ends, ends.__array_interface__["data"][0]
    return found


def _of_one(function: Callable[..., None], x: Interval) -> Interval:
    found, size = _made(np.empty(x.ends.shape)), x.ends.nbytes // 2
    function(x.address, x.address + size, found.address, found.address + size, size // 8)
    return found


def _of_two(function: Callable[..., None], x: Interval, y: Interval) -> Interval:
    shape = x.ends.shape
    if shape != y.ends.shape:
        shape = (2, *np.broadcast_shapes(shape[1:], y.ends.shape[1:]))
        x, y = _spread(x, shape), _spread(y, shape)
    found = _made(np.empty(shape))
    size = found.ends.nbytes // 2
    a, b, c = x.address, y.address, found.address
    function(a, a + size, b, b + size, c, c + size, size // 8)
    return found


def _spread(x: Interval, shape: tuple[int, ...]) -> Interval:
    """Repeat intervals so that they have a shape, as NumPy broadcasts."""
    if x.ends.shape == shape:
        return x
    ends, missing = np.empty(shape), len(shape) - x.ends.ndim
    ends[...] = x.ends.reshape(2, *(1,) * missing, *x.ends.shape[1:])
    return _made(ends)
