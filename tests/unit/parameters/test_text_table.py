"""Tables as text: what stands above what, sentences in several lines, widths that fit."""

import math

import pytest

from wspd_design.parameters.table import Column, table_of

COLUMNS = (
    Column(title="name", read=lambda row: row[0]),
    Column(title="long title", unit="m/s", decimals=2, read=lambda row: row[1]),
    Column(title="why", read=lambda row: row[2]),
)


def test_titles_units_and_numbers_stand_above_each_other():
    table = table_of(
        [("a", 1.0, "x"), ("bb", -20.5, None)], COLUMNS, caption="Two rows", notes=["", "A note."]
    )
    assert str(table).splitlines() == [
        "Two rows",
        "        long",
        "       title",
        "name   [m/s]  why",
        "-----------------",
        "a       1.00  x",
        "bb    -20.50  -",
        "A note.",
    ]
    assert repr(table) == str(table)


def test_sentences_take_several_lines_and_the_table_fits():
    table = table_of([("n" * 8, 1.0, "word " * 60), ("m", 2.0, "short")], COLUMNS)
    lines = str(table).splitlines()
    assert max(map(len, lines)) <= 98
    assert str(table).count("word") == 60
    assert lines[-1].split() == ["m", "2.00", "short"]


def test_many_columns_of_words_are_not_cut():
    columns = [Column(title=f"column {k}", read=lambda row, k=k: row * k) for k in range(1, 13)]
    text = str(table_of(["ab"], columns))
    assert all("ab" * k in text.replace("\n", "") or k > 6 for k in range(1, 13))


@pytest.mark.parametrize(
    ("value", "text"),
    [(math.nan, "-"), (math.inf, "-"), (None, "-"), (True, "True"), (3, "3"), (0.1 + 0.2, "0.3")],
)
def test_how_a_value_is_written(value, text):
    assert Column(title="x", read=lambda row: row).text(value) == text


def test_an_empty_table_has_its_titles():
    assert "name" in str(table_of([], COLUMNS))
