"""Results that are remembered while the code that made them is the same."""

import sys
from collections import OrderedDict
from collections.abc import Callable, Hashable
from functools import cache
from itertools import chain
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

    def get(self, key: Hashable, kinds: tuple[type, ...], make: Callable[[], _Result]) -> _Result:
        """Return what is remembered, or make it.

        Parameters
        ----------
        key : hashable
            All that the result depends on beside code.
        kinds : tuple of type
            Classes that take part with their methods and modules.
        make : callable
            Makes the result.
        """
        code, known = _code(kinds), self._known.get(key)
        if known is None or len(known[0]) != len(code) or not all(map(is_, known[0], code)):
            known = code, make()
        self._known[key] = known
        self._known.move_to_end(key)
        if len(self._known) > self._size:
            self._known.popitem(last=False)
        return known[1]


def _code(kinds: tuple[type, ...]) -> list[Any]:
    """What these rooms, and some classes with their modules, hold at present."""
    spaces = [*_rooms(), *map(vars, dict.fromkeys(base for kind in kinds for base in kind.__mro__[:-1]))]
    spaces += [vars(sys.modules[name]) for name in dict.fromkeys(kind.__module__ for kind in kinds)]
    return list(chain.from_iterable(space.values() for space in spaces))


@cache
def _rooms() -> tuple[dict[str, Any], ...]:
    return tuple(vars(sys.modules[name]) for name in sorted(sys.modules) if name.startswith(_ROOMS))
