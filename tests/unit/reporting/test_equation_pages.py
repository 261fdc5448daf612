"""Formulas as SVG: where the line is, what is shared, and that they follow the color of the text."""

import pytest

from wspd_design.reporting.blocks import Equation
from wspd_design.reporting.equations import typeset
from wspd_design.reporting.text import Math


@pytest.mark.parametrize(
    ("source", "low", "high"),
    [("x", 0.0, 0.02), ("T_d", 0.1, 0.3), ("(x)", 0.2, 0.3), ("frac(1, 2)", 0.3, 0.6)],
)
def test_depth_below_the_line(source: str, low: float, high: float) -> None:
    """Letters without a descender stand on the line; subscripts, parentheses and fractions reach below it."""
    formula = Math(source=source, spoken="a case")
    assert low <= typeset([formula]).image(formula).depth <= high


def test_the_marker_of_the_line_is_gone() -> None:
    formula = Math(source="x", spoken="x")
    assert "#010203" not in typeset([formula]).image(formula).svg


def test_inline_and_displayed_differ_and_share_their_glyphs() -> None:
    inline = Math(source="sum_(i=1)^n x", spoken="the sum of x")
    displayed = Equation(source="sum_(i=1)^n x", description="The sum of x.")
    formulas = typeset([inline, displayed, inline])
    assert len(formulas.images) == 2
    assert formulas.image(inline) != formulas.image(displayed)
    assert formulas.glyphs.count("<symbol ") == len(set(formulas.glyphs.split("<symbol ")[1:]))


def test_formulas_have_the_color_of_the_text() -> None:
    formula = Equation(source="frac(a, b)", description="a over b")
    svg = typeset([formula]).image(formula).svg
    assert 'stroke="currentColor"' in svg
    assert 'fill="currentColor"' in svg
    assert "#000000" not in svg


def test_a_document_without_formulas_needs_no_glyphs() -> None:
    assert typeset([]).glyphs == ""
