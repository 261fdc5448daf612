"""The builder of all tables: each column says what stands above it and how it reads its value from an item."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Generic, Literal, TypeAlias, TypeVar

from wspd_design.reporting import numbers
from wspd_design.reporting.blocks import Cell, Column, Table
from wspd_design.reporting.text import Text, unbroken

if TYPE_CHECKING:
    from collections.abc import Callable

Item = TypeVar("Item")


@dataclass(frozen=True, slots=True, kw_only=True)
class Uncertain:
    """A number and the spread that limits its digits."""

    value: float
    spread: float


Value: TypeAlias = Text | Cell | float | Uncertain


@dataclass(frozen=True, slots=True, kw_only=True)
class ColumnOf(Generic[Item]):
    """A column of words, or of numbers with fixed decimals or with significant digits, which stand flush right."""

    title: Text
    read: "Callable[[Item], Value]"
    unit: str = ""
    decimals: int | None = None
    significant: int | None = None
    flush_right: bool = False  # words that end in a number, such as a margin

    @property
    def align(self) -> Literal["left", "right"]:
        """Side on which the column is flush."""
        numeric = self.decimals is not None or self.significant is not None
        return "right" if numeric or self.flush_right else "left"

    def cell(self, item: Item) -> Text | Cell:
        """Return what stands in the row of an item; a number that does not exist is a dash."""
        value = self.read(item)
        if isinstance(value, Uncertain):
            return numbers.uncertain(value.value, value.spread, self.decimals or 0)
        if not isinstance(value, int | float):
            return value
        if self.significant is not None:
            return numbers.significant(value, self.significant)
        return numbers.decimals(value, self.decimals or 0)


def build(
    items: Iterable[Item], columns: Sequence[ColumnOf[Item]], *, caption: Text, anchor: str = ""
) -> Table:
    """Return the table with a row for each item.

    Parameters
    ----------
    items : iterable
        One for each row.
    columns : sequence of ColumnOf
        From left to right.
    caption : Text
        What the table shows.
    anchor : str
        For links to it.
    """
    return Table(
        columns=tuple(
            Column(title=each.title, unit=unbroken(each.unit), align=each.align) for each in columns
        ),
        rows=tuple(tuple(column.cell(item) for column in columns) for item in items),
        caption=caption,
        anchor=anchor,
    )
