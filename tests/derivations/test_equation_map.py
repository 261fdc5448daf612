"""The equation map is complete, current, computed, and refuses what is wrong."""

import re
import tomllib
from dataclasses import asdict, replace

import pytest
import sympy as sp
import typst

from derivations.claim import Claim, certainty, units, vanishes, verdicts
from tests.lazily import Lazily
from wspd_design.parameters.equations import VERDICTS, load_equations

equation_map = Lazily("equation_map")
generate = Lazily("generate")

EQUATIONS = load_equations()
BY_NUMBER = {e.number: e for e in EQUATIONS}


def claim(number: str) -> Claim:
    return next(c for c in equation_map.CLAIMS if c.number == number)


def test_every_numbered_equation_is_there_in_order():
    numbers = [int(e.number) for e in EQUATIONS if e.number.isdigit()]
    assert numbers == list(range(1, 50))
    others = {"B_W", "T_d", "dc", *(f"Table {n}" for n in (1, 2, 3, 4, 5, 9, 10))}
    assert {e.number for e in EQUATIONS} - set(map(str, numbers)) == others


def test_shipped_map_equals_the_computed_one():
    assert load_equations() == equation_map.equations()
    text = (generate.ROOT / generate.EQUATIONS).read_text()
    assert tomllib.loads(text)["equation"][0]["number"] == "1"


def test_verdicts_agree_with_residuals():
    for e in EQUATIONS:
        assert e.verdicts
        assert set(e.verdicts) <= set(VERDICTS)
        assert ("misprint" in e.verdicts) == (e.residual not in ("", "0")), e.number
        assert ("gap" in e.verdicts) == bool(e.gap) == bool(e.assumption), e.number
        assert e.gap != "0", e.number
        if "misprint" in e.verdicts:
            assert e.corrected, e.number
        if "holds" in e.verdicts:
            assert e.verdicts == ("holds",)
            assert e.residual == "0", e.number
        if e.verdicts in (("definition",), ("lost",)):
            assert e.residual == "", e.number


@pytest.mark.parametrize(
    ("verdict", "numbers"),
    [
        ("holds", "1 2 5 6 8 11 18 19 27 32 34 42 49"),
        ("misprint", "B_W 23 41"),
        ("misprint, gap", "14 25 28 39 44 47"),
        ("gap", "10 13 15 20 26 33 37 38 43 45 46 48"),
        ("definition", "3 4 7 9 12 16 17 21 22 24 29 30 31 35 36 40"),
    ],
)
def test_verdicts_that_were_established_independently(verdict, numbers):
    assert {number: BY_NUMBER[number].verdict for number in numbers.split()} == dict.fromkeys(
        numbers.split(), verdict
    )


def test_tables_and_rules_have_the_verdicts_of_the_audit():
    found = {number: BY_NUMBER[number].verdict for number in BY_NUMBER if not number.isdigit()}
    assert found == {
        "B_W": "misprint",
        "Table 1": "definition",
        "Table 2": "holds",
        "dc": "definition",
        "Table 3": "gap",
        "Table 4": "lost",
        "Table 5": "misprint",
        "Table 9": "misprint",
        "Table 10": "gap",
        "T_d": "definition",
    }


def test_every_correction_says_how_sure_it_is():
    for e in EQUATIONS:
        assert set(e.certainty) <= {"proved", "inferred", "scan"}
        assert len({"proved", "inferred"} & set(e.certainty)) <= 1
        if "misprint" in e.verdicts:
            assert {"proved", "inferred"} & set(e.certainty), e.number
    one_glyph = {e.number for e in EQUATIONS if "scan" in e.certainty}
    assert {"2", "B_W", "14", "23", "25", "28", "39", "44", "Table 3"} <= one_glyph
    assert not {"10", "13", "43"} & one_glyph  # the paper's own mathematics
    readings = {e.number for e in EQUATIONS if "inferred" in e.certainty}
    assert {"B_W", "Table 3", "Table 5", "Table 9", "20"} <= readings


@pytest.mark.parametrize("number", ["25", "26", "28", "38", "39", "44"])
def test_torque_as_control_input_is_said_where_it_enters(number):
    assert "T_brake = u: no lag, no pulses (PWM), 0 <= dc <= 1" in BY_NUMBER[number].assumption


@pytest.mark.parametrize("number", ["14", "15"])
def test_full_supply_is_said_where_it_enters(number):
    assert BY_NUMBER[number].assumption.startswith("P_cin = P_max")


def test_constant_weights_and_bound_are_said():
    for number in ("33", "44"):
        assert "constant b and psi" in BY_NUMBER[number].assumption


def test_every_entry_has_a_domain():
    assert all(e.domain for e in EQUATIONS)
    assert {n: BY_NUMBER[n].domain for n in ("1", "3", "7", "19", "34", "49")} == {
        "1": "v > 0, omega >= 0",
        "3": "v > 0",
        "7": "v >= R omega",
        "19": "v > 0, omega >= 0, slip 0 to 1",
        "34": "slip 0 to 1, 0 < v <= v0",
        "49": "wavelengths 3 to 25 m",
    }


def test_units_of_every_equation_are_checked_and_three_are_wrong():
    unchecked = {e.number for e in EQUATIONS if not e.unit and not e.unit_fault}
    assert unchecked == {"Table 4"}
    assert {e.number: e.unit_fault for e in EQUATIONS if e.unit_fault} == {
        "B_W": "B_0 has to be a pure number",
        "14": "ū'*T is in N m/s, τ*T' + T in N m",
        "44": "-|ξ| is in N m, -ψ*G*|s| in 1/s",
    }


def test_units_of_the_unknowns():
    assert BY_NUMBER["41"].unit == "N m/s; α1 in N m/s"
    assert BY_NUMBER["42"].unit == "N m/s; α2 in N m/s"
    assert "u in N m" in BY_NUMBER["26"].unit
    for told in ("m3/rad", "β0 in rad3/m", "γ0 in rad4/m4", "γ2 in rad2/m2", "γ4 in -"):
        assert told in BY_NUMBER["49"].unit
    assert "β2 in rad3/m3" in BY_NUMBER["Table 9"].unit


@pytest.mark.parametrize(
    ("number", "words"),
    [
        ("1", "at v = omega = 0 neither follows"),
        ("7", "takes the magnitude"),
        ("12", "beside R_W of the wheel"),
        ("13", "K_b is not defined in the text"),
        ("15", "Exact for the average over a period h of any length"),
        ("19", "scalar only along a given v(t)"),
        ("20", "its bound is circular"),
        ("23", "p = dF/dλ at fixed speed, k = W K_P/Phi"),
        ("25", "after the transient"),
        ("27", "at a fixed slip"),
        ("37", "leaves sgn(G) out"),
        ("42", "for G < 0 (43) would not be positive definite"),
        ("43", "V2/(G K_P)"),
        ("48", "s -> 0 to e -> 0"),
        ("Table 3", "a consistent code"),
        ("Table 5", "the deceleration of the wheelset"),
        ("Table 10", "A locked wheel breaks the identity"),
        ("dc", "inferred, not printed"),
    ],
)
def test_remarks_that_the_audit_asked_for(number, words):
    assert words in BY_NUMBER[number].remark


def test_transpose_and_derivative_are_told_apart():
    text = " ".join(e.printed + e.corrected for e in EQUATIONS)
    assert "b^ᵀw" in text
    assert not re.search(r"b[~*^]?'w", text)


def test_files_functions_and_tests_exist():
    for e in EQUATIONS:
        assert (generate.ROOT / e.file).is_file()
        path, _, name = e.test.partition("::")
        assert f"def {name}(" in (generate.ROOT / path).read_text(), e.test


BESIDE_THE_PAPER = {
    "friction_observer",
    "fuzzy_loop",
    "fuzzy_surface",
    "rolling_bounds",
    "rolling_sample",
    "slip_loop",
    "slip_tracking",
    "valve_flow",
    "valve_inversion",
    "wheel_filter",
}  # ISO 6358, electro-pneumatic build-up and laws of vehicles, of which the paper prints nothing


def test_every_generated_function_is_in_the_map():
    of_the_paper = {name: module for name, module in generate.MODULES.items() if name not in BESIDE_THE_PAPER}
    assert len(of_the_paper) == len(generate.MODULES) - len(BESIDE_THE_PAPER)
    generated = {f"{name}.{f.name}" for name, module in of_the_paper.items() for f in module.FUNCTIONS}
    assert {name for e in EQUATIONS for name in e.functions} == generated


def test_wrong_correction_is_refused():
    wrong = replace(claim("14"), corrected_residual=sp.Symbol("x"))
    with pytest.raises(ValueError, match="corrected form leaves x"):
        verdicts(wrong)


def test_wrong_equation_without_correction_is_refused():
    wrong = replace(claim("11"), residual=sp.Symbol("x"))
    with pytest.raises(ValueError, match="no corrected form"):
        verdicts(wrong)


def test_assumption_that_is_not_needed_is_refused():
    with pytest.raises(ValueError, match="holds without the assumption"):
        verdicts(replace(claim("38"), gap=sp.Integer(0)))
    with pytest.raises(ValueError, match="needs what is left over"):
        verdicts(replace(claim("38"), gap=None))


def test_correction_of_unknown_certainty_is_refused():
    misprint = claim("28")
    with pytest.raises(ValueError, match="proved or inferred"):
        certainty(replace(misprint, certainty=("scan",)), verdicts(misprint))
    with pytest.raises(ValueError, match="nothing proves"):
        certainty(replace(claim("33"), certainty=("proved",)), ("gap",))


def test_residual_decides_the_verdict():
    misprint = claim("23")
    assert verdicts(misprint) == ("misprint",)
    assert verdicts(replace(misprint, residual=sp.Integer(0))) == ("holds",)
    both = claim("28")
    assert verdicts(replace(both, residual=sp.Integer(0))) == ("gap",)


def test_every_side_of_an_equation_is_checked():
    for each in equation_map.CLAIMS:
        sides = each.sides or each.printed.sides
        if len([side for side in sides if side != 0]) < 2 or units(each).fault:
            continue
        planted = (*sides[:-1], sides[-1] * sp.Symbol("time_constant", positive=True))
        if sides[-1] == 0 or each.unknown:
            continue
        assert units(replace(each, sides=planted)).fault, each.number
    assert vanishes(sp.Integer(0))


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
