"""Formulas that are found in plain sentences: which, how they are set, and that nothing else changes."""

import random
import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from wspd_design.parameters.equations import load_equations
from wspd_design.reporting.equations import typeset
from wspd_design.reporting.formula_text import with_formulas
from wspd_design.reporting.text import Math

ASCII = re.compile(r"<=|>=|!=|[a-z]\^|_hat|\babs\(|\d[eE][-+]\d|(?<![\w])-\d|\bm/?s2|\bkg m2")
"""What a reader must never see."""

WORDS = (
    "eta/g",
    "<=",
    "u*",
    "-",
    "(tau",
    "+",
    "h/2)",
    "abs(s_D)",
    "psi_hat",
    "T_max",
    "^2",
    "=",
    "2",
    "b*'w",
    "sup",
    "(",
)


def parted(sentence: str) -> str:
    """Return the sentence with its formulas in brackets, as Typst reads them."""
    return "".join(
        f"[{part.source}]" if isinstance(part, Math) else str(part) for part in with_formulas(sentence)
    )


@pytest.mark.parametrize(
    ("sentence", "shown"),
    [
        (
            "u* stays inside, eta/g <= u* <= T_max - eta/g, eta = 0.2 m/s2, g = R/(2 I), wet",
            '[u^*] stays inside, [eta\\/g <= u^* <= T_"max" - eta\\/g], [eta = 0.2] m/s², [g = R\\/(2 I)], wet',
        ),
        ("u* <= 51 kN m - eta/g", "[u^* <= 51] kN m − [eta\\/g]"),
        ("the integral of abs(s_D) is at most 1.27 s", "the integral of [abs(s_D)] is at most 1.27 s"),
        ("psi_hat below 40 kN m; V' = 0 for s = 0", "[hat(psi)] below 40 kN m; [dot(V) = 0] for [s = 0]"),
        ("psi >= abs(u* - b*'w) all the time", "[psi >= abs(u^* - b^(* top)  w)] all the time"),
        ("a2 a1 > G b I", "[a_2 a_1 > G b I]"),
        ("slip' = F + G T from (1) to (3)", "[dot(lambda) = F + G T] from (1) to (3)"),
        ("(14) tau T' + T = T_max u", '(14) [tau dot(T) + T = T_"max" u]'),
        ("p = dF/d\u03bb at fixed speed", "[p = dif F\\/dif lambda] at fixed speed"),
        ("a rise below 1e-06, or -4.125 +-0.05 m/s^2", "a rise below 10⁻⁶, or −4.125 ±0.05 m/s²"),
        ("1/tau = 1.667 1/s", "[1\\/tau = 1.667] 1/s"),
        ("sup abs(r)/rho", "[sup abs(r)\\/rho]"),
        ("f_d (residual: the part)", "[f_d] (residual: the part)"),
    ],
)
def test_formulas_are_found(sentence: str, shown: str) -> None:
    assert parted(sentence) == shown


@pytest.mark.parametrize(
    "words",
    [
        "A stop begins with slip 0. I know a law, and it is a well-posed one",
        "in N m the largest one, 17.79 1/s per MN m, after 5 m and 1.2 s",
        "the train slows down, eq. (19), Table 5 (b), on er24pc-polach-wet",
        "lyapunov_repaired says nothing",
        "train deceleration 0.01127 m/s², wheelset inertia 860 kg m²",
    ],
)
def test_words_stay_words(words: str) -> None:
    assert with_formulas(words) == (words,)


def test_a_long_formula_breaks_before_its_relation() -> None:
    parts = [
        part
        for part in with_formulas("V = v s_D^2/(2 g) + abs(b)^2/(2 alpha_1) holds")
        if isinstance(part, Math)
    ]
    assert [part.source[:2] for part in parts] == ["V", "= "]


def test_a_formula_is_read_aloud_as_it_stood() -> None:
    (formula, _) = with_formulas("eta/g <= u* holds")
    assert isinstance(formula, Math)
    assert formula.spoken == "eta over g at most u*"


def test_no_remark_of_an_equation_is_left_in_ascii_and_all_of_them_can_be_set() -> None:
    sentences = [text for each in load_equations() for text in (each.remark, each.assumption) if text]
    found = [part for each in sentences for part in with_formulas(each)]
    assert [part for part in found if isinstance(part, str) and ASCII.search(part)] == []
    formulas = [part for part in found if isinstance(part, Math)]
    assert len(formulas) > 100
    assert typeset(formulas).images


@given(st.text(alphabet="ab TRvs_*'^~|()/+-=<>0123.,eλ", max_size=40))
def test_any_text_goes_through(sentence: str) -> None:
    """A search that ends, and never a formula without a symbol."""
    for part in with_formulas(sentence):
        assert not isinstance(part, Math) or re.search("[A-Za-zλ]", part.source)


def test_whatever_is_found_can_be_set() -> None:
    """One formula that Typst refuses would cost the whole report."""
    draw = random.Random(1)
    sentences = ["".join(draw.choices("ab TRvs_*'^~|()/+-=<>0123.,eλ", k=30)) for _ in range(800)]
    sentences += [" ".join(draw.choices(WORDS, k=8)) for _ in range(400)]
    found = [part for each in sentences for part in with_formulas(each) if isinstance(part, Math)]
    assert len(found) > 200
    assert typeset(found).images
