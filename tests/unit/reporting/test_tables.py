"""The builder of tables: a column reads, formats and aligns its values; the terminal shows the same table plainly."""

import math
from io import StringIO

import pytest
from rich.console import Console

from wspd_design.cli.terminal_tables import terminal_table
from wspd_design.reporting.blocks import Cell, Status
from wspd_design.reporting.tables import ColumnOf, Uncertain, build


@pytest.mark.parametrize(
    ("column", "value", "expected"),
    [
        (ColumnOf(title="a", read=lambda x: x), "words", "words"),
        (ColumnOf(title="a", decimals=2, read=lambda x: x), -1.005, "−1.00"),
        (ColumnOf(title="a", decimals=0, read=lambda x: x), 7, "7"),
        (ColumnOf(title="a", decimals=1, read=lambda x: x), math.nan, "–"),
        (ColumnOf(title="a", significant=2, read=lambda x: x), 2.34e-9, "2.3·10⁻⁹"),
        (
            ColumnOf(title="a", decimals=1, read=lambda x: x),
            Uncertain(value=315.94, spread=0.1),
            "315.94 ± 0.05",
        ),
        (ColumnOf(title="a", decimals=1, read=lambda x: x), Uncertain(value=315.94, spread=0.0), "315.9"),
    ],
)
def test_a_column_formats_what_it_reads(column, value, expected):
    assert column.cell(value) == expected


def test_numbers_stand_right_and_words_left_unless_told():
    columns = (
        ColumnOf(title="words", read=str),
        ColumnOf(title="decimals", decimals=0, read=float),
        ColumnOf(title="significant", significant=3, read=float),
        ColumnOf(title="margin", flush_right=True, read=str),
    )
    made = build([1.0], columns, caption="all")
    assert [each.align for each in made.columns] == ["left", "right", "right", "right"]
    assert made.rows == (("1.0", "1", "1", "1.0"),)


def test_the_terminal_shows_the_same_values_with_plain_signs():
    made = build(
        [(-1.5, Status.GOOD), (math.nan, Status.BAD)],
        (
            ColumnOf(title="gap", unit="m", decimals=1, read=lambda row: row[0]),
            ColumnOf(title="found", read=lambda row: Cell(status=row[1])),
        ),
        caption="",
    )
    console = Console(width=40, record=True, file=StringIO())
    console.print(terminal_table(made))
    lines = [line.split() for line in console.export_text().splitlines() if line.strip()]
    assert lines[0] == ["gap"]
    assert lines[1] == ["[m]", "found"]
    assert lines[3:] == [["-1.5", "✓", "good"], ["-", "✗", "bad"]]
