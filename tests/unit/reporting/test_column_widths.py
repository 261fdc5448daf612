"""Columns of the PDF: no word lies over the next column."""

from wspd_design.reporting.blocks import Column, Table
from wspd_design.reporting.pdf import LINE, _shares


def table(*cells: str) -> Table:
    return Table(
        columns=tuple(Column(title="name") for _ in cells), rows=(cells,), caption="Words.", anchor="words"
    )


def test_a_column_is_as_wide_as_its_longest_word() -> None:
    long = "a text of many words " * 8
    name = "holding_torque, and a few words behind it"
    first, second, third = _shares(table(long, name, long))
    assert first == third == 80
    assert second / (first + second + third) * LINE > len("holding_torque")


def test_a_column_of_short_texts_is_as_wide_as_they_are() -> None:
    assert _shares(table("a text of many words " * 8, "short")) == [80, 0]
