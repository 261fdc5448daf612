"""Helpers for the tests of users: they pass, fail and refuse as they should."""

import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest

from wspd_design.certificates.checks.frame import Check
from wspd_design.certificates.records import Status
from wspd_design.design.certification import certify, folder_beside
from wspd_design.design.file import write_design
from wspd_design.design.problem import stability_problem
from wspd_design.design.records import Specification
from wspd_design.design.selection import design_controller
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import load_rail, load_vehicle
from wspd_design.testing import assert_certified, assert_refuted


@pytest.fixture(scope="module")
def design():
    return design_controller(load_vehicle("er24pc"), load_rail("polach-wet"), Specification(), law="smc")


@pytest.fixture(scope="module")
def weak(design):
    """Take most of the switching gain away."""
    gains = (replace(each, value=1.0) if each.name == "switching_gain" else each for each in design.gains)
    return replace(design, gains=tuple(gains))


def test_a_proved_check_passes_from_record_and_file(design, tmp_path):
    path = tmp_path / "smc.toml"
    write_design(design, path)
    for source in (design, path, str(path)):
        (found,) = assert_certified(source, "surface_hurwitz")
        assert found.status is Status.PROVED


def test_a_weak_gain_fails_with_explanation_and_worst_point(weak):
    with pytest.raises(AssertionError) as failure:
        assert_certified(weak, "surface_hurwitz", "reaching")
    message = str(failure.value)
    assert message.startswith(
        "reaching is REFUTED, asked for PROVED: While the slip stays between 0.02 and 0.6"
    )
    assert "W0 = 1 m/s2" in message
    assert "larger W0" in message
    assert "worst point: slip" in message
    assert "surface_hurwitz" not in message
    (found,) = assert_refuted(weak, "reaching")
    assert found.witness


def test_what_is_proved_is_not_refuted(design):
    with pytest.raises(AssertionError, match="surface_hurwitz is PROVED, asked for REFUTED"):
        assert_refuted(design, "surface_hurwitz")


def test_a_proof_is_more_than_evidence_but_nothing_else_is(design):
    assert_certified(design, "surface_hurwitz", at_least=Status.EVIDENCE)
    with pytest.raises(
        AssertionError, match="lyapunov_printed is NOT_APPLICABLE, asked for EVIDENCE or PROVED"
    ):
        assert_certified(design, "lyapunov_printed", at_least=Status.EVIDENCE)
    with pytest.raises(UserError, match="at_least = REFUTED must be PROVED or EVIDENCE"):
        assert_certified(design, "surface_hurwitz", at_least=Status.REFUTED)


def test_another_rail_is_another_claim(design):
    with pytest.raises(AssertionError, match="slip_limit is VACUOUS, asked for PROVED"):
        assert_certified(design, "slip_limit")
    assert_certified(design, "slip_limit", rail="polach-dry", vehicle="er24pc")


def test_a_proved_limitation_fails_unless_it_is_asked_for(design):
    dry = {"vehicle": "er24pc", "rail": "polach-dry"}
    (found,) = assert_certified(design, "no_go", limitation=True, **dry)
    assert found.status is Status.LIMITATION
    for level in (Status.PROVED, Status.EVIDENCE):
        with pytest.raises(AssertionError, match="no_go is LIMITATION, asked for"):
            assert_certified(design, "no_go", at_least=level, **dry)
    with pytest.raises(AssertionError, match="no_go is LIMITATION, asked for REFUTED"):
        assert_refuted(design, "no_go", **dry)
    with pytest.raises(AssertionError, match="surface_hurwitz is PROVED, asked for LIMITATION"):
        assert_certified(design, "surface_hurwitz", limitation=True)


def test_a_problem_of_ones_own(design):
    vehicle, rail = load_vehicle("er24pc"), load_rail("polach-wet")
    problem = stability_problem(vehicle, rail, design.build(vehicle, rail), design.specification)
    assert_certified(problem, "surface_hurwitz")
    with pytest.raises(UserError, match="leave vehicle and rail out"):
        assert_certified(problem, "surface_hurwitz", rail=rail)


def test_wrong_names_are_refused(design):
    with pytest.raises(UserError, match=r'unknown check "raeching" \(did you mean "reaching"\?\)'):
        assert_certified(design, "raeching")
    with pytest.raises(UserError, match="no check is named"):
        assert_certified(design)


def test_a_proved_limitation_is_no_good_news_unless_asked_for(design):
    """The audit: that no law of the class is stable passed as if it were a success."""
    with pytest.raises(AssertionError, match="no_go is LIMITATION, asked for PROVED"):
        assert_certified(design, "no_go", rail="polach-dry")
    (found,) = assert_certified(design, "no_go", rail="polach-dry", limitation=True)
    assert found.status is Status.LIMITATION


def test_what_is_kept_beside_a_design_is_not_searched_again(design, tmp_path, monkeypatch):
    path = tmp_path / "smc.toml"
    write_design(design, path)
    certify(path, only=("gain_positive",), folder=folder_beside(path))
    monkeypatch.setattr(Check, "run", lambda *_, **__: pytest.fail("searched"))
    assert_certified(path, "gain_positive")
    with pytest.raises(pytest.fail.Exception, match="searched"):
        assert_certified(design, "gain_positive")


def test_pytest_shows_the_sentence_and_the_line_of_the_user(tmp_path):
    """A misspelled check came with 40 lines of internals (users.md A16)."""
    (tmp_path / "test_mine.py").write_text(
        "from wspd_design.testing import assert_certified\n\n\n"
        'def test_mine():\n    assert_certified("smc", "reachign")\n'
    )
    shown = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "-c", os.devnull, "test_mine.py"],
        cwd=tmp_path,
        env=os.environ | {"PYTHONPATH": str(Path(__file__).parents[3])},
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    ).stdout
    told = [line for line in shown.splitlines() if line.startswith("E ")]
    assert 'assert_certified("smc", "reachign")' in shown
    assert len(told) == 1
    assert "reaching" in told[0]
    assert "certification.py" not in shown
    assert len(shown.splitlines()) < 20


def test_what_is_kept_beside_an_own_controller_is_not_searched_again(tmp_path, monkeypatch):
    page = (Path(__file__).parents[3] / "docs" / "own-controller.md").read_text()
    (tmp_path / "law.py").write_text(page.partition("`slip_band.py`:\n\n```python\n")[2].partition("```")[0])
    law = f"{tmp_path / 'law.py'}:SlipBand"
    certify(law, only=("feedback",), folder=folder_beside(law))
    monkeypatch.setattr(Check, "run", lambda *_, **__: pytest.fail("searched"))
    assert_certified(law, "feedback")
    with pytest.raises(pytest.fail.Exception, match="searched"):
        assert_certified(law, "gain_positive")
