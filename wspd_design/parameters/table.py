"""Tables that show themselves: as text in a terminal, as HTML in a notebook, as a data frame."""

import math
import textwrap
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

from wspd_design.parameters.later import later

Item = TypeVar("Item")

_WIDTH = 64  # characters of a column of sentences
_BETWEEN = "  "


@dataclass(frozen=True, slots=True, kw_only=True)
class Column(Generic[Item]):
    """What stands above a column, and how it reads its value from an item.

    Attributes
    ----------
    title : str
    read : Callable[[Item], Any]
    unit : str
    decimals : int or None
        Of numbers.
    digits : int
        Significant ones, where no decimals are stated.
    flush_right : bool
        Words that are numbers.
    """

    title: str
    read: Callable[[Item], Any]
    unit: str = ""
    decimals: int | None = None
    digits: int = 6
    flush_right: bool = False

    @property
    def header(self) -> str:
        """Title and unit, as a data frame names the column."""
        return f"{self.title} [{self.unit}]" if self.unit else self.title

    def text(self, value: Any) -> str:
        """Write a value; a number that does not exist is a dash."""
        if isinstance(value, bool) or not isinstance(value, int | float):
            return "-" if value is None else str(value)
        if not math.isfinite(value):
            return "-"
        return f"{value:.{self.digits}g}" if self.decimals is None else f"{value:.{self.decimals}f}"


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Table:
    """Rows of values below titles with units.

    ``str`` and ``print`` show it as text, a notebook as HTML; :meth:`to_pandas` returns its numbers.

    Attributes
    ----------
    caption : str
    columns : tuple[Column[Any], ...]
    rows : tuple[tuple[Any, ...], ...]
        Values: numbers, words, None for nothing.
    tones : tuple[str, ...]
        Of the rows: good, bad, open or neutral; empty for none.
    notes : tuple[str, ...]
        Sentences below it.
    """

    caption: str
    columns: tuple[Column[Any], ...]
    rows: tuple[tuple[Any, ...], ...]
    tones: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()

    def __str__(self) -> str:
        """Set the table in characters of equal width."""
        cells = [[column.title, f"[{column.unit}]" if column.unit else ""] for column in self.columns]
        lines: list[list[list[str]]] = []
        for row in self.texts:
            lines.append([textwrap.wrap(text, _WIDTH) or [""] for text in row])
        widths = [
            max(map(len, [*head, *(part for line in lines for part in line[place])]))
            for place, head in enumerate(cells)
        ]
        right = [self.flush_right(place) for place in range(len(self.columns))]
        heads = [[[head[part]] for head in cells] for part in range(2 if any(h[1] for h in cells) else 1)]
        shown = [part for line in heads for part in _set(line, widths, right)]
        rule = ["-" * len(_BETWEEN.join("-" * width for width in widths))]
        body = [part for line in lines for part in _set(line, widths, right)]
        notes = [part for note in self.notes for part in textwrap.wrap(note, 100)]
        return "\n".join([*([self.caption] if self.caption else []), *shown, *rule, *body, *notes])

    __repr__ = __str__

    def _repr_html_(self) -> str:
        return str(later("notebook.html", "table_card")(self))

    @property
    def texts(self) -> tuple[tuple[str, ...], ...]:
        """The cells as they are written."""
        return tuple(
            tuple(column.text(value) for column, value in zip(self.columns, row, strict=True))
            for row in self.rows
        )

    def flush_right(self, place: int) -> bool:
        """Tell whether a column holds numbers."""
        if self.columns[place].flush_right:
            return True
        values = [row[place] for row in self.rows if row[place] is not None]
        return bool(values) and all(isinstance(value, int | float) for value in values)

    def to_pandas(self) -> Any:
        """Return the values as a ``pandas.DataFrame``, columns named with their unit; needs the extra ``frames``."""
        return later("notebook.frames", "frame_of_table")(self)


def table_of(
    items: Iterable[Item],
    columns: Sequence[Column[Item]],
    *,
    caption: str = "",
    tone: Callable[[Item], str] | None = None,
    notes: Sequence[str] = (),
) -> Table:
    """Return the table with a row for each item.

    Parameters
    ----------
    items : iterable
        One for each row.
    columns : sequence of Column
        From left to right.
    caption : str
        What the table shows.
    tone : callable, optional
        Returns the tone of the row of an item.
    notes : sequence of str
        Sentences below it; empty ones are left out.
    """
    kept = tuple(items)
    return Table(
        caption=caption,
        columns=tuple(columns),
        rows=tuple(tuple(column.read(item) for column in columns) for item in kept),
        tones=tuple(map(tone, kept)) if tone else (),
        notes=tuple(filter(None, notes)),
    )


def _set(line: list[list[str]], widths: list[int], right: list[bool]) -> list[str]:
    """Set one row, whose cells may have several lines."""
    made = []
    for number in range(max(map(len, line))):
        parts = [cell[number] if number < len(cell) else "" for cell in line]
        padded = [
            part.rjust(width) if flush else part.ljust(width)
            for part, width, flush in zip(parts, widths, right, strict=True)
        ]
        made.append(_BETWEEN.join(padded).rstrip())
    return made
