"""Statements about designs in the tests of users: ``assert_certified("mine.toml", "reaching")``.

The names below are loaded when they are first used: pytest imports this package in every run where it is installed.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from wspd_design.testing.stability import assert_certified, assert_refuted
    from wspd_design.testing.stops import assert_stops

_HOME = {"assert_certified": "stability", "assert_refuted": "stability", "assert_stops": "stops"}

__all__ = ["assert_certified", "assert_refuted", "assert_stops"]


def __getattr__(name: str) -> Any:
    """Load a public name from its module."""
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOME[name]}"), name)


def __dir__() -> list[str]:
    return __all__
