"""The attacker of invariant sets: none of the runs leaves sets that hold, and it leaves sets that were moved."""

import math

import pytest

from tests.attack.case import Case, Stated, read_data
from tests.attack.claims import attacks
from tests.attack.search import assail
from tests.certificates.invariance.loops import feedback_problem
from wspd_design.certificates.search.invariant_sets import document
from wspd_design.certificates.search.invariant_sets.search import search

SPREAD, SPEEDS = 0.01, (23.0, 26.0)


@pytest.fixture(scope="module")
def case():
    """The loop of the tests of the invariant sets, in the attacker's own numbers."""
    data = read_data("er24pc", "polach-wet")
    bounds = {
        name: (getattr(data.plant, name) * (1.0 - SPREAD), getattr(data.plant, name) * (1.0 + SPREAD))
        for name in ("mass", "wheelset_inertia", "mu0")
    }
    return Case(
        law="torque-feedback",
        gains={"sliding_gain": 1.0, "torque_gain": 10.0},
        slip=0.14,
        speeds=SPEEDS,
        slips=(0.02, 0.6),
        tolerance=0.05,
        sample_time=0.02,
        model=data.plant,
        data=type(data)(plant=data.plant, body=data.body, bounds=bounds),
    )


@pytest.fixture(scope="module")
def windows():
    problem = feedback_problem(spread=SPREAD, speeds=SPEEDS)
    return document.write(problem, search(problem, most_work=math.inf))["windows"]


def assailed(case, windows):
    stated = Stated(check="sampled_invariance", status="PROVED", claim="", sets=(windows,))
    (attack,) = attacks(case, stated, case.varied)
    return assail(attack, evaluations=60_000, seed=2)


def test_no_run_leaves_the_sets(case, windows):
    found = assailed(case, windows)
    assert not found.broken
    assert math.isfinite(found.margin)


def test_runs_leave_sets_that_were_moved(case, windows):
    moved = [
        {**each, "columns": {str(int(slip) + 25): flat for slip, flat in each["columns"].items()}}
        for each in windows
    ]
    assert assailed(case, moved).broken


def test_runs_leave_sets_that_lack_a_window(case, windows):
    assert assailed(case, windows[:1] + windows[2:]).broken
