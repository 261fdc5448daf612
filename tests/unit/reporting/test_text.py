"""Light markup: what it makes, and that text from outside is never taken for markup."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from wspd_design.reporting.text import (
    CodeSpan,
    Emphasis,
    Link,
    Math,
    escape,
    plain,
    printable,
    rich,
    spoken,
    unbroken,
)


def test_every_kind_of_markup() -> None:
    assert rich(r"a *b c* `d` $x_1$ [e](#f-1) [](#g) \*h\* \$") == (
        "a ",
        Emphasis(text="b c"),
        " ",
        CodeSpan(text="d"),
        " ",
        Math(source="x_1", spoken="x 1"),
        " ",
        Link(anchor="f-1", text="e"),
        " ",
        Link(anchor="g"),
        " *h* $",
    )


def test_a_lone_special_character_is_literal() -> None:
    assert rich("3 * 4 costs 5 $ [see]") == ("3 * 4 costs 5 $ [see]",)


@given(st.text())
def test_escaped_text_comes_back_as_it_was(text: str) -> None:
    assert "".join(rich(escape(text))) == text  # type: ignore[arg-type]


def test_plain_reads_formulas_aloud() -> None:
    assert plain(rich("*the* pole $p <= 1/tau$ of `x`")) == "the pole p at most 1 over tau of x"


@pytest.mark.parametrize(
    ("source", "expected"),
    [
        ('T_"brake"', "T brake"),
        ("dot(lambda)_d", "lambda dot d"),
        ("s^2", "s squared"),
        ("W_0/v", "W 0 over v"),
        ("v >= 2", "v at least 2"),
    ],
)
def test_spoken(source: str, expected: str) -> None:
    assert spoken(source) == expected


@given(st.text())
def test_printable_text_has_no_control_characters(text: str) -> None:
    assert not any((ord(c) < 32 and c not in "\n\t") or 0x7F <= ord(c) < 0xA0 for c in printable(text))


def test_no_line_ends_between_a_limit_and_its_sign_or_unit() -> None:
    assert unbroken("at most ≤ 0.5 s, < 1 and ≥ 95.5 %") == "at most ≤\xa00.5\xa0s, <\xa01 and ≥\xa095.5\xa0%"
    assert unbroken("a < b or 3 of 4") == "a < b or 3 of 4"
