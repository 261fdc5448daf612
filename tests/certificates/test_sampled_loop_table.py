"""The table of the checks about the sampled loop in docs/certificates.md, against the checks that are registered."""

import re
from pathlib import Path

import pytest

import wspd_design as wd
from wspd_design.certificates.kernel.checker import Work
from wspd_design.certificates.kernel.finding import Stated
from wspd_design.certificates.theorems.holds_for import HOLDS_FOR, HoldsFor
from wspd_design.certificates.theorems.table import THEOREMS
from wspd_design.certificates.theorems.theorem import asked, told
from wspd_design.design.problem import stability_problem

PAGE = Path(__file__).parents[2] / "docs" / "certificates.md"
SAMPLED = [name for name, kind in HOLDS_FOR.items() if kind is HoldsFor.SAMPLED]
LAWS = ("smc", "afsmc", "torque-feedback", "observer-smc", "super-twisting", "integral-smc", "afsmc-mended")
BOX = "the box"


def rows():
    """Cells of the table by check."""
    section = PAGE.read_text(encoding="utf-8").partition("## Which check speaks about the sampled loop")[2]
    table = [line for line in section.partition("\n## ")[0].splitlines() if line.startswith("| `")]
    return {
        cells[0].strip("`"): cells[1:]
        for cells in ([c.strip() for c in line.strip("| ").split(" | ")] for line in table)
    }


@pytest.fixture(scope="module")
def problems():
    vehicle, rail = wd.load_vehicle("er24pc"), wd.load_rail("polach-wet")
    specification = wd.Specification(sample_time=0.02, reference="constant")
    return {
        law: stability_problem(
            vehicle,
            rail,
            wd.design_controller(vehicle, rail, specification, law=law).build(vehicle, rail),
            specification,
        )
        for law in LAWS
    }


def named(cell):
    """Laws that a cell names."""
    return set(LAWS) if cell == "every law" else set(re.findall("`([^`]+)`", cell))


@pytest.fixture(scope="module")
def spoken_about(problems):
    """Laws that each check speaks about."""
    return {
        name: {law for law, problem in problems.items() if not THEOREMS[name].speaks_about(problem)}
        for name in SAMPLED
    }


def differences(table, spoken_about):
    """Checks whose row names other laws than those that the check speaks about, or that have no row."""
    return [name for name in SAMPLED if name not in table or named(table[name][0]) != spoken_about[name]]


def test_each_check_of_the_sampled_loop_has_a_row_and_each_row_its_laws(spoken_about):
    table = rows()
    assert list(table) == SAMPLED
    assert differences(table, spoken_about) == []


def test_wrong_row_and_missing_row_are_seen(spoken_about):
    """Plant the fault: a law too many, and a check that the page forgets."""
    table = rows()
    wrong = table | {"margins": ["`smc`, `observer-smc`", *table["margins"][1:]]}
    assert differences(wrong, spoken_about) == ["margins"]
    assert differences({k: v for k, v in table.items() if k != "slip_band"}, spoken_about) == ["slip_band"]


def test_what_varies_is_what_the_claims_vary(problems):
    for name, cells in rows().items():
        problem = problems[next(law for law in LAWS if law in named(cells[0]))]
        wanted = asked(THEOREMS[name], problem)
        assert isinstance(wanted, tuple)
        varied = told(
            THEOREMS[name], problem, {each.key: each.decide(Stated(), Work()) for each in wanted}
        ).varied
        if cells[2] == "nothing":
            assert varied == (), name
        elif cells[2] == BOX:
            assert {"mass", "mu0", "wheelset inertia"} < set(varied), (name, varied)
        else:
            assert set(varied) == set(cells[2].split(", ")), (name, varied)


def test_no_two_checks_have_one_meaning():
    told_alone = [cells[4] for cells in rows().values()]
    assert all(len(each) > 10 for each in told_alone)
    assert len(set(told_alone)) == len(told_alone)


def test_a_check_that_says_again_what_another_says_tells_so(problems):
    for law in ("smc", "afsmc", "torque-feedback"):
        theorem = THEOREMS["traced_loop"]
        wanted = asked(theorem, problems[law])
        claim = told(
            theorem, problems[law], {each.key: each.decide(Stated(), Work()) for each in wanted}
        ).claim
        assert "That is what margins says of the sampled linear form of this law" in claim
