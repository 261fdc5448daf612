"""Interval arithmetic on arrays, behind the few operations that the prover needs.

The default is :mod:`tight`, whose results are the tightest doubles around the exact ones. Where the wheel that it calls
is missing, :mod:`outward` does the same in NumPy with a few units in the last place to spare.
"""

from collections.abc import Callable
from importlib import import_module
from typing import TYPE_CHECKING, Any, Protocol, TypeAlias

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

Intervals: TypeAlias = Any
"""An array of intervals with the ends ``lo`` and ``hi``; it adds, subtracts, multiplies, divides and negates."""


class Backend(Protocol):
    """A module with intervals and their functions, all of which enclose the exact result."""

    __name__: str
    Interval: Callable[["Array", "Array"], Intervals]
    sqr: Callable[[Intervals], Intervals]
    sqrt: Callable[[Intervals], Intervals]
    exp: Callable[[Intervals], Intervals]
    log: Callable[[Intervals], Intervals]
    atan: Callable[[Intervals], Intervals]


def default_backend() -> Backend:
    """Return the tight arithmetic, or the one in NumPy where its wheel is not installed."""
    try:
        found: Backend = import_module("wspd_design.certificates.search.tight")
    except (ImportError, OSError):
        found = import_module("wspd_design.certificates.search.outward")
    return found
