"""Where output goes: tables on standard output, progress and errors on standard error."""

import json
import shutil
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from rich import box
from rich.console import Console
from rich.padding import Padding
from rich.table import Table
from rich.text import Text

from wspd_design.exchange.plain import finite

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


def print_json(value: dict[str, Any]) -> None:
    """Print one JSON object and nothing else; a number that is not finite becomes null."""
    print(json.dumps(finite(value), indent=2, ensure_ascii=False, allow_nan=False))


@contextmanager
def progress() -> Iterator[Callable[[str], None]]:
    """Show the current stage on standard error while the block runs; nothing where that is no terminal."""
    stream = console(error=True)
    if not stream.is_terminal or stream.is_dumb_terminal:
        yield lambda _stage: None
        return
    with stream.status("") as status:
        yield lambda stage: status.update(f"{stage} ...")


@contextmanager
def progress_bar(what: str, total: int) -> Iterator[Callable[[int], None]]:
    """Show how many of ``total`` are done and the remaining time; nothing where there is no terminal."""
    stream = console(error=True)
    if not stream.is_terminal or stream.is_dumb_terminal:
        yield lambda _done: None
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


def is_interactive() -> bool:
    """Tell whether somebody sits in front of the program and can answer questions."""
    return sys.stdin.isatty() and sys.stdout.isatty()
