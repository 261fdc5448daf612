"""What a verification has already worked out, by what was asked: no statement is searched or decided twice."""

import json
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Any, TypeVar

Result = TypeVar("Result")

_known: ContextVar[dict[str, Any] | None] = ContextVar("known", default=None)


@contextmanager
def remembering() -> Iterator[None]:
    """Keep what is worked out inside the block, and forget it at the end of the outermost one."""
    if _known.get() is not None:
        yield
        return
    token = _known.set({})
    try:
        yield
    finally:
        _known.reset(token)


def is_remembering() -> bool:
    """Whether anything is kept, so that it is worth while to write down what is asked."""
    return _known.get() is not None


def recall(asked: object, work_out: Callable[[], Result]) -> Result:
    """Return what was worked out before, or work it out now.

    Parameters
    ----------
    asked : object
        All that the result depends on, as JSON; never the identity of an object.
    work_out : callable
        Gives the result.
    """
    known = _known.get()
    if known is None:
        return work_out()
    key = json.dumps(asked, sort_keys=True)
    if key not in known:
        known[key] = work_out()
    found: Result = known[key]
    return found
