"""Tables that show themselves: as text in a terminal, as HTML in a notebook, as a data frame."""

import math
import textwrap
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

from wspd_design.parameters.later import later

Item = TypeVar("Item")

_WIDTH = 98  # characters of a table of words: what a notebook and most terminals show in one line
_LEAST = 12  # of a column of words
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
        """Set the table in characters of equal width; sentences take several lines."""
        right = [self.flush_right(place) for place in range(len(self.columns))]
        heads = [
            [
                *(column.title.split() if flush else [column.title]),
                *([f"[{column.unit}]"] if column.unit else []),
            ]
            for column, flush in zip(self.columns, right, strict=True)
        ]
        widths = _fitting(heads, self.texts, right)
        height = max(map(len, heads))
        lines = [[[""] * (height - len(head)) + head for head in heads]] if height else []
        for row in self.texts:
            lines.append(
                [textwrap.wrap(text, width) or [""] for text, width in zip(row, widths, strict=True)]
            )
        shown = [part for line in lines for part in _set(line, widths, right)]
        rule = "-" * (sum(widths) + len(_BETWEEN) * (len(widths) - 1))
        notes = [part for note in self.notes for part in textwrap.wrap(note, _WIDTH)]
        caption = textwrap.wrap(self.caption, _WIDTH)
        return "\n".join([*caption, *shown[:height], rule, *shown[height:], *notes])

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


def _fitting(
    heads: Sequence[Sequence[str]], rows: Sequence[Sequence[str]], right: Sequence[bool]
) -> list[int]:
    """Width of each column: that of its longest text, the widest columns of words less until the table fits."""
    widths = [
        max(map(len, [*head, *(row[place] for row in rows)]), default=1) or 1
        for place, head in enumerate(heads)
    ]
    words = [place for place, flush in enumerate(right) if not flush]
    while sum(widths) + len(_BETWEEN) * (len(widths) - 1) > _WIDTH and words:
        widest = max(words, key=lambda place: widths[place])
        if widths[widest] <= _LEAST:
            break
        widths[widest] -= 1
    return widths


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
