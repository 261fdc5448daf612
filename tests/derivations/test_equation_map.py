"""The equation map is complete, current, computed, and refuses what is wrong."""

import re
import tomllib
from dataclasses import asdict, replace

import pytest
import sympy as sp
import typst

from derivations import equation_map, generate
from derivations.claims import brake, sliding
from wspd_design.parameters.equations import load_equations

EQUATIONS = load_equations()


def claim(number: str, part=sliding) -> equation_map.Claim:
    return next(c for c in part.CLAIMS if c.number == number)


def test_every_numbered_equation_is_there_in_order():
    numbers = [int(e.number) for e in EQUATIONS if e.number.isdigit()]
    assert numbers == list(range(1, 50))
    assert {e.number for e in EQUATIONS} - set(map(str, numbers)) == {
        "B_W",
        "Table 3",
        "Table 5",
        "Table 9",
        "Table 10",
    }


def test_shipped_map_equals_the_computed_one():
    assert load_equations() == equation_map.equations()
    text = (generate.ROOT / generate.EQUATIONS).read_text()
    assert tomllib.loads(text)["equation"][0]["number"] == "1"
    assert generate.README not in generate.outdated(generate.ROOT)


def test_verdicts_agree_with_residuals():
    for e in EQUATIONS:
        match e.verdict:
            case "holds":
                assert e.residual == "0", e.number
            case "misprint":
                assert e.residual not in ("", "0"), e.number
                assert e.corrected, e.number
            case "gap":
                assert e.residual not in ("", "0"), e.number
                assert e.assumption, e.number
            case "definition":
                assert e.residual == "", e.number
            case other:
                pytest.fail(f"({e.number}): unknown verdict {other}")


@pytest.mark.parametrize(
    ("verdict", "numbers"),
    [
        ("holds", "1 2 5 6 8 11 18 19 27 38 49"),
        ("misprint", "B_W 14 23 25 28 39 41"),
        ("gap", "10 13 15 20 33 37 43 44 45 47 48"),
    ],
)
def test_verdicts_that_were_established_independently(verdict, numbers):
    found = {e.number: e.verdict for e in EQUATIONS}
    assert {found[number] for number in numbers.split()} == {verdict}


def test_files_functions_and_tests_exist():
    for e in EQUATIONS:
        assert (generate.ROOT / e.file).is_file()
        path, _, name = e.test.partition("::")
        assert f"def {name}(" in (generate.ROOT / path).read_text(), e.test


def test_every_generated_function_is_in_the_map():
    generated = {f"{name}.{f.name}" for name, module in generate.MODULES.items() for f in module.FUNCTIONS}
    assert {name for e in EQUATIONS for name in e.functions} == generated


def test_wrong_correction_is_refused():
    wrong = replace(claim("14", brake), corrected_residual=sp.Symbol("x"))
    with pytest.raises(ValueError, match="corrected form leaves x"):
        equation_map.verdict(wrong)


def test_wrong_equation_without_correction_is_refused():
    wrong = replace(claim("11", brake), residual=sp.Symbol("x"))
    with pytest.raises(ValueError, match="no corrected form"):
        equation_map.verdict(wrong)


def test_residual_decides_the_verdict():
    misprint = claim("28")
    assert equation_map.verdict(misprint) == "misprint"
    assert equation_map.verdict(replace(misprint, residual=sp.Integer(0))) == "holds"


def test_typst_math_compiles_and_eq_19_has_drift_and_gain():
    shown = [text for e in EQUATIONS for text in (e.typst_printed, e.typst_corrected) if text]
    assert len(shown) > 70
    page = "\n\n".join(f"$ {text} $" for text in shown)
    assert typst.compile(page.encode(), format="pdf").startswith(b"%PDF")
    nineteen = next(e for e in EQUATIONS if e.number == "19").typst_corrected
    assert re.search(r"underbrace\(.*F\(lambda, v, t\)\).*underbrace\(.*G\(v\)\)", nineteen)


def test_map_names_no_place_of_this_machine():
    text = " ".join(str(value) for e in EQUATIONS for value in asdict(e).values())
    assert not re.search(r"/(work|tmp|root|home)/", text)
