"""The test that is running: the folder that its files are named from, and where its figures go."""

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from pathlib import Path

SEARCHED = "searched"
"""Last part of the name of the figure that says why a check was searched."""
SAMPLED = "it rests on samples, which are drawn again"
"""Why a check is searched that no file of a certificate can decide."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Running:
    """What the assertions need to know about the test that calls them."""

    folder: Path  # of the test file
    record: Callable[[str, object], None]  # takes name and value of a figure


_RUNNING: ContextVar[Running | None] = ContextVar("running", default=None)


@contextmanager
def running(test: Running) -> Iterator[None]:
    """Let the assertions in the block belong to a test."""
    token = _RUNNING.set(test)
    try:
        yield
    finally:
        _RUNNING.reset(token)


def record(name: str, value: object) -> None:
    """Keep a figure of the running test; outside of pytest nobody asks for it."""
    test = _RUNNING.get()
    if test is not None:
        test.record(name, value)


def located(written: object) -> object:
    """Return a name as it is seen from here: a relative path of a file is looked up beside the test file first.

    Parameters
    ----------
    written : object
        What a test gives for a design, a vehicle or a rail. Names of what ships with the program, records, and paths
        that are found from the working directory alone stay as they are.
    """
    test = _RUNNING.get()
    if test is None or not isinstance(written, (str, Path)):
        return written
    file, tail = _parted(str(written))
    if not file.endswith((".toml", ".py")) or Path(file).is_absolute():
        return written
    beside = test.folder / file
    if not beside.exists() and Path(file).exists():
        return written
    return os.path.relpath(beside) + tail


def _parted(text: str) -> tuple[str, str]:
    """Part ``FILE.toml:laden`` and ``FILE.py:NAME`` into the path and the rest."""
    for ending in (".toml:", ".py:"):
        head, found, tail = text.rpartition(ending)
        if found:
            return head + ending[:-1], ":" + tail
    return text, ""
