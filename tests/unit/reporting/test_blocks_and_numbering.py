"""The block model refuses what cannot be rendered, and numbers the rest."""

from dataclasses import replace

import pytest

from tests.unit.reporting.sample_report import sample
from wspd_design.reporting.blocks import (
    Block,
    Cell,
    Column,
    Document,
    Equation,
    Figure,
    Heading,
    KeyNumber,
    KeyNumbers,
    Paragraph,
    Status,
    Table,
)
from wspd_design.reporting.numbering import number
from wspd_design.reporting.text import rich


@pytest.fixture(scope="module")
def document() -> Document:
    return sample()


def test_statuses_differ_without_color() -> None:
    assert len({(status.sign, status.word) for status in Status}) == len(Status) == 18
    assert {status.tone for status in Status} == {"good", "bad", "open", "neutral"}


def test_a_row_of_the_wrong_length_is_refused() -> None:
    with pytest.raises(ValueError, match="a row has 2 cells, not 1"):
        Table(columns=(Column(title="a"),), rows=(("1", Cell(status=Status.GOOD)),), caption="c")


def test_pictures_and_formulas_need_words() -> None:
    with pytest.raises(ValueError, match="alt must say"):
        Figure(svg="<svg/>", caption="c", alt=" ")
    with pytest.raises(ValueError, match="description must say"):
        Equation(source="x", description="")


def test_at_most_four_key_numbers() -> None:
    with pytest.raises(ValueError, match="5 given"):
        KeyNumbers(numbers=(KeyNumber(label="a", value="1"),) * 5)


def test_labels(document: Document) -> None:
    labels = [each.label for each in number(document).blocks if each.label]
    assert labels == ["1", "Eq. (19)", "the equation", "1.1", "1.1.1", "2", "Figure 1", "Figure 2", "Table 2"]


def test_references_show_the_label(document: Document) -> None:
    labels = number(document).labels
    assert labels["reaching"] == "Section 1.1"
    assert labels["eq19"] == "Eq. (19)"
    assert labels["slip-figure"] == "Figure 1"
    assert labels["stops"] == "Table 2"


@pytest.mark.parametrize(
    ("blocks", "message"),
    [
        ((Heading(text="a", anchor="x"), Heading(text="b", anchor="x")), "used twice"),
        ((Heading(text="a", anchor="contents"),), "used twice"),
        ((Heading(text="a", anchor="No Good"),), "lower-case"),
        ((Heading(text="a", anchor="x", level=2),), "skips a level"),
        ((Heading(text="a", anchor="x"), Heading(text="b", anchor="y", level=3)), "skips a level"),
        ((Paragraph(text=rich("[](#nowhere)")),), "no such anchor"),
        ((Figure(svg="<svg/>", caption="c", alt="a", data="none.csv"),), "none.csv, which is not attached"),
    ],
)
def test_broken_structure_is_refused(document: Document, blocks: tuple[Block, ...], message: str) -> None:
    bare = replace(document, summary=(), verdict=replace(document.verdict, sentence=""), blocks=blocks)
    with pytest.raises(ValueError, match=message):
        number(bare)


def test_a_heading_in_the_summary_is_refused(document: Document) -> None:
    with pytest.raises(ValueError, match="no headings"):
        number(replace(document, summary=(Heading(text="a", anchor="x"),)))
