"""Tables of the report's builder, rendered for the terminal: plain signs, units in brackets below the titles."""

from collections.abc import Sequence

from rich.table import Table as TerminalTable
from rich.text import Text as TerminalText

from wspd_design.cli.console import table
from wspd_design.reporting.blocks import Cell, Table
from wspd_design.reporting.numbers import MINUS, NONE
from wspd_design.reporting.text import Text, plain

_SIGNS = str.maketrans({MINUS: "-", NONE: "-"})


def terminal_table(shown: Table, *, styles: Sequence[str] = ()) -> TerminalTable:
    """Return a table for the terminal; ``styles`` are those of its rows."""
    headers = [plain(each.title) + (f"\n[{each.unit}]" if each.unit else "") for each in shown.columns]
    right = tuple(
        header for header, each in zip(headers, shown.columns, strict=True) if each.align == "right"
    )
    made = table(*headers, numeric=right)
    for index, row in enumerate(shown.rows):
        made.add_row(*map(_cell, row), style=styles[index] if styles else None)
    return made


def _cell(cell: Text | Cell) -> TerminalText:
    if isinstance(cell, Cell):
        return TerminalText(f"{cell.status.sign} {plain(cell.text) or cell.status.word}")
    return TerminalText(plain(cell).translate(_SIGNS))
