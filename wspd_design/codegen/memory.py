"""Results that are remembered while the code that made them is the same."""

import sys
from collections import OrderedDict
from collections.abc import Callable, Hashable
from functools import cache
from operator import is_
from typing import Any, Generic, TypeVar

_Result = TypeVar("_Result")
_ROOMS = tuple(
    f"wspd_design.{room}" for room in ("controllers", "model", "plants", "codegen", "parameters.loading")
)


class Memory(Generic[_Result]):
    """The last results by their key; one is made anew after anything in these rooms was replaced."""

    def __init__(self, size: int) -> None:
        self._size = size
        self._known: OrderedDict[Hashable, tuple[list[Any], _Result]] = OrderedDict()

    def get(self, key: Hashable, kind: type, make: Callable[[], _Result]) -> _Result:
        """Return what is remembered, or make it.

        Parameters
        ----------
        key : hashable
            All that the result depends on beside code.
        kind : type
            Class whose methods and module take part.
        make : callable
            Makes the result.
        """
        code, known = _code(kind), self._known.get(key)
        if known is None or len(known[0]) != len(code) or not all(map(is_, known[0], code)):
            known = code, make()
        self._known[key] = known
        self._known.move_to_end(key)
        if len(self._known) > self._size:
            self._known.popitem(last=False)
        return known[1]


def _code(kind: type) -> list[Any]:
    """What these rooms, and a class with its own module, hold at present."""
    spaces = [vars(module) for module in (*_modules(), sys.modules[kind.__module__])]
    spaces += [dict(vars(base)) for base in kind.__mro__]
    return [thing for space in spaces for thing in space.values()]


@cache
def _modules() -> tuple[Any, ...]:
    return tuple(sys.modules[name] for name in sorted(sys.modules) if name.startswith(_ROOMS))
