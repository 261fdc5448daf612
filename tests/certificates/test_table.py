"""The table of theorems: complete, told without a search, and every claim names its domain."""

import re
from dataclasses import replace

import pytest

from wspd_design.certificates import suite
from wspd_design.certificates.kernel.checker import Work
from wspd_design.certificates.kernel.finding import Stated
from wspd_design.certificates.quantities import AXLE, QUANTITIES
from wspd_design.certificates.records import Certificate, Status
from wspd_design.certificates.setting import domain
from wspd_design.certificates.theorems.table import THEOREMS
from wspd_design.certificates.theorems.theorem import asked, told
from wspd_design.cli.verification import _SHOWN
from wspd_design.reporting.blocks import Status as Shown
from wspd_design.reporting.sections.checks import MEANINGS

LAWS = ("smc", "afsmc", "afsmc-repaired", "torque-feedback", "trenitalia")
WITHOUT_SPEED = {
    "derivation": "identities between formulas, at whatever speed",
    "feedback": "a statement about the graph of the step, at whatever speed",
    "surface_hurwitz": "a statement about the gains, on the surface at whatever speed",
}
"""Theorems whose claim names no range of speed, and why."""
NOMINAL = re.compile("with the nominal parameters|other numbers of vehicle and rail nominal")
VALVE = re.compile("fill and vent times|fills and vents with one time constant")
AXLES = re.compile("every axle|axle at static load")
GREEN = {Status.PROVED}
BAD = {Status.REFUTED, Status.LIMITATION}


def nothing_stated(theorem, problem):
    """Tell a theorem of which nothing is stated, as a file without findings does."""
    wanted = asked(theorem, problem)
    if isinstance(wanted, Certificate):
        return wanted
    return told(theorem, problem, {each.key: each.decide(Stated(), Work()) for each in wanted})


@pytest.fixture(scope="module", params=LAWS)
def problem(request, make_problem, make_controller):
    return make_problem(make_controller(request.param, "polach-wet"), rail="polach-wet")


@pytest.fixture(scope="module")
def told_of(problem):
    return {name: nothing_stated(theorem, problem) for name, theorem in THEOREMS.items()}


def test_each_theorem_has_its_check_and_each_check_its_theorem():
    assert list(suite.CHECKS) == list(THEOREMS) == list(suite.NAMES)
    for name, check in suite.CHECKS.items():
        assert check.theorem is THEOREMS[name]
        assert THEOREMS[name].name == name


def test_a_general_claim_is_a_sentence():
    for theorem in THEOREMS.values():
        assert theorem.title
        assert theorem.claim.endswith(".")
        assert theorem.claim.count("  ") == 0
    assert len({each.title for each in THEOREMS.values()}) == len(THEOREMS)


def test_where_nothing_is_stated_nothing_is_proved(problem, told_of):
    """What the design alone decides is left: conditions, and signs that are wrong."""
    for name, found in told_of.items():
        assert found.status is not Status.PROVED, name
        assert found.status is not Status.LIMITATION, name
        assert found.status is not Status.EVIDENCE, name
        assert found.name == name
        assert found.claim.endswith(".")
        assert len(found.model_hash) == 64
        conditions = [each for each in found.findings.values() if each.status is Status.REFUTED]
        assert found.status is not Status.REFUTED or conditions, name
    assert problem.controller.name


def test_every_claim_names_its_speeds_or_speaks_about_none(told_of):
    for name, found in told_of.items():
        if found.status is not Status.NOT_APPLICABLE:
            named = re.search(r"\d ?(km/h|m/s)\b(?!2)", found.claim) is not None
            assert named is (name not in WITHOUT_SPEED), (name, found.claim)


def test_what_is_varied_or_held_is_a_number_with_bounds(problem, told_of):
    uncertain = set(domain.uncertain(problem))
    for name, found in told_of.items():
        assert set(found.varied) | set(found.held) <= uncertain & set(QUANTITIES), name
        assert not set(found.varied) & set(found.held), name
        assert len(set(found.varied)) == len(found.varied), name


def test_what_is_varied_or_held_stands_in_the_claim(told_of):
    """The axle's load and the train's deceleration have words of their own; so have numbers that are all nominal."""
    for name, found in told_of.items():
        claim = found.claim.lower()
        held = () if NOMINAL.search(claim) else found.held
        words = set(found.varied) | set(held)
        if AXLES.search(claim):
            words -= set(AXLE)
        if VALVE.search(claim):
            words -= {"fill time", "vent time"}
        missing = [each for each in words if each.lower() not in claim]
        assert not missing, (name, missing, found.claim)


def test_a_wider_domain_is_another_claim(problem, told_of):
    """Plant the fault: a claim that does not say over which speeds it holds."""
    low, high = problem.speeds
    wider = replace(problem, speeds=(low, high + 1.0))
    for name, found in told_of.items():
        if found.status is not Status.NOT_APPLICABLE and name not in WITHOUT_SPEED:
            assert nothing_stated(THEOREMS[name], wider).claim != found.claim, name


def test_only_good_news_is_green():
    for status, shown in _SHOWN.items():
        assert ("green" in shown.style) is (status in GREEN), status
        assert ("red" in shown.style) is (status in BAD), status
        assert ("✓" in shown.sign) is (status in GREEN), status
    assert set(_SHOWN) == set(Status)


def test_the_report_shows_only_good_news_as_good():
    tones = {status: Shown[status.name].tone for status in Status}
    assert {status for status, tone in tones.items() if tone == "good"} == GREEN
    assert {status for status, tone in tones.items() if tone == "bad"} == BAD
    assert {Shown[status.name]: status.value for status in Status} == MEANINGS


def test_the_meaning_of_a_green_status_is_not_bad_news():
    for status in GREEN:
        assert "holds" in status.value
        assert not re.search(r"\b(false|cannot|fails|nothing|not)\b", status.value)
    for status in BAD:
        assert re.search(r"\b(false|cannot|fails)\b", status.value)
