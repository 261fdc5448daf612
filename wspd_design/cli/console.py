"""Where output goes: tables on standard output, progress and errors on standard error."""

import json
import shlex
import shutil
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import typer
from rich import box
from rich.console import Console
from rich.padding import Padding
from rich.table import Table
from rich.text import Text

from wspd_design.cli.exit_codes import INTERRUPTED
from wspd_design.exchange.plain import finite

_MINUTE = 60.0  # s, between two lines of progress
WIDE = 96
"""Columns of a terminal from which on tables put everything side by side."""


def console(*, error: bool = False) -> Console:
    """Return a console as wide as the terminal, also where Rich would assume 80 columns (``TERM=dumb``)."""
    width, height = shutil.get_terminal_size((80, 24))
    return Console(stderr=error, width=width, height=height, highlight=False, emoji=False)


def table(*headers: str, numeric: tuple[str, ...] = ()) -> Table:
    """Return an empty table without vertical lines; ``numeric`` columns are flush right and never broken."""
    made = Table(box=box.SIMPLE_HEAD, show_edge=False, padding=(0, 1, 0, 0))
    for header in headers:
        right = header in numeric
        made.add_column(Text(header), justify="right" if right else "left", no_wrap=right, overflow="fold")
    return made


def spaced(shown: Table) -> Padding:
    """Set a table apart from the text around it."""
    return Padding(shown, (1, 0), expand=False)


def print_written(path: Path, *commands: tuple[str, Sequence[object]]) -> None:
    """Say where a file was written and what to do with it; a command is a purpose and its words after ``wspd``."""
    out = console()
    out.print(f"Written: {path}", style="bold", markup=False, soft_wrap=True)
    width = max((len(purpose) for purpose, _ in commands), default=0) + 2
    for purpose, words in commands:
        spelled = shlex.join(["wspd", *map(str, words)])
        out.print(f"{purpose + ':':<{width}}{spelled}", markup=False, soft_wrap=True)


def print_json(value: dict[str, Any]) -> None:
    """Print one JSON object and nothing else; a number that is not finite becomes null."""
    print(json.dumps(finite(value), indent=2, ensure_ascii=False, allow_nan=False))


@contextmanager
def progress() -> Iterator[Callable[[str], None]]:
    """Show the current stage on standard error while the block runs; a line a minute where that is no terminal."""
    stream = console(error=True)
    if not stream.is_terminal or stream.is_dumb_terminal:
        yield StageLines(clock=time.monotonic)
        return
    with stream.status("") as status:
        yield lambda stage: status.update(f"{stage} ...")


@contextmanager
def progress_bar(what: str, total: int) -> Iterator[Callable[[int], None]]:
    """Show how many of ``total`` are done and the remaining time; a line a minute where there is no terminal."""
    stream = console(error=True)
    if not stream.is_terminal or stream.is_dumb_terminal:
        yield ProgressLines(what, total, clock=time.monotonic)
        return
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

    columns = (
        TextColumn("{task.description}", markup=False),
        BarColumn(bar_width=None),
        MofNCompleteColumn(),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=stream, transient=True) as bar:
        task = bar.add_task(what, total=total)
        yield lambda done: bar.update(task, completed=done)


class StageLines:
    """The current stage in lines, for logs: no more than one a minute, none before the first is over."""

    def __init__(self, *, clock: Callable[[], float]) -> None:
        self._clock = clock
        self._told = clock()

    def __call__(self, stage: str) -> None:
        """Tell the stage that is reached."""
        if self._clock() - self._told >= _MINUTE:
            self._told = self._clock()
            print(f"{stage} ...", file=sys.stderr, flush=True)


class ProgressLines:
    """Progress in lines, for logs: one a minute, none before the first is over.

    The remaining time follows from the last minute. The first call says what was done before.
    """

    def __init__(self, what: str, total: int, *, clock: Callable[[], float]) -> None:
        self._what, self._total, self._clock = what, total, clock
        self._told = clock()
        self._before: int | None = None  # what was done when the last line came

    def __call__(self, done: int) -> None:
        """Tell the number of all that are done."""
        now = self._clock()
        if self._before is None:
            self._told, self._before = now, done
        if now - self._told < _MINUTE:
            return
        made, took = done - self._before, now - self._told
        self._told, self._before = now, done
        rest = f", about {_duration(took * (self._total - done) / made)} left" if made else ""
        print(
            f"{self._what}: {done} of {self._total} ({100.0 * done / self._total:.0f} %){rest}",
            file=sys.stderr,
            flush=True,
        )


def _duration(seconds: float) -> str:
    minutes = round(seconds / 60.0)
    return f"{minutes} min" if minutes < 120 else f"{minutes / 60.0:.1f} h"


def interrupted(what: str) -> typer.Exit:
    """Say what an interrupt left, and return the exit that ends the command."""
    print(f"wspd: interrupted after {what}.", file=sys.stderr)
    return typer.Exit(INTERRUPTED)


def is_interactive() -> bool:
    """Tell whether somebody sits in front of the program and can answer questions."""
    return sys.stdin.isatty() and sys.stdout.isatty()
