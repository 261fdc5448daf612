"""The reference problem, whose supremum other tools enclose, and what the prover reports on the way."""

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from wspd_design.certificates.kernel import checker
from wspd_design.certificates.kernel.checker import Work, value
from wspd_design.certificates.kernel.finding import Stated
from wspd_design.certificates.kernel.obligation import Inequality
from wspd_design.certificates.records import Status
from wspd_design.certificates.search import outward
from wspd_design.certificates.search.budget import DEFAULT_BUDGET, Budget, within
from wspd_design.certificates.search.progress import listening
from wspd_design.certificates.search.prover import extreme, prove
from wspd_design.certificates.search.settle import settle
from wspd_design.certificates.setting import domain
from wspd_design.certificates.setting.model_error import mismatch
from wspd_design.certificates.theorems.sliding import reserve

TRUE_SUPREMUM = 24.79297  # m/s2, enclosed by 24.79296 and 24.79298


def test_supremum_to_five_digits(make_reference_problem, reference_claim):
    eta = reserve(make_reference_problem(30.0))
    found = extreme(reference_claim, tolerance=1e-5)
    assert found.low <= TRUE_SUPREMUM + eta + 1e-5
    assert found.high >= TRUE_SUPREMUM + eta - 1e-5
    assert found.high - found.low < 1e-5
    assert found.undecided == 0.0


def test_sampling_stays_below(make_reference_problem, proved):
    problem = make_reference_problem(30.0)
    points = np.random.default_rng(0).uniform(*domain.box(problem), (100_000, 5))
    sampled = np.abs(mismatch(problem, problem.controller, points).residual).max() + reserve(problem)
    assert sampled < proved.low - 0.5
    assert proved.low <= proved.high < proved.low + 0.02


def test_little_work(reference_claim, proved):
    """Boxes and operations, not seconds, so that a busy machine does not count."""
    assert extreme(reference_claim, tolerance=1e-3).boxes < DEFAULT_BUDGET.boxes / 20
    work = Work()
    checker.decide(proved.stated.proof, work)
    assert checker.MOST_WORK - work.left < checker.MOST_WORK / 50


def test_fallback_arithmetic_finds_the_same(reference_claim, proved):
    found = extreme(reference_claim, tolerance=0.01, backend=outward)
    assert found.low <= proved.high
    assert found.high >= proved.low
    assert found.high - found.low <= 0.01


@pytest.fixture(scope="module")
def supremum(reference_claim):
    return extreme(reference_claim, tolerance=1e-6)


@pytest.mark.parametrize("distance", [1e-2, 1e-3, 1e-4, 1e-5])
def test_verdict_near_the_supremum(reference_claim, supremum, settled, distance):
    """Just above it is proved, just below refuted, although the enclosure is asked for within 0.01 only."""
    above, below = (
        settled(replace(reference_claim, bound=Fraction(bound)), tolerance=0.01)
        for bound in (supremum.high + distance, supremum.low - distance)
    )
    assert (above.status, below.status) == (Status.PROVED, Status.REFUTED)
    assert 0.0 <= above.margin.low <= above.margin.high
    assert below.margin.low <= below.margin.high < 0.0
    place = {name: Fraction(at) for name, at in below.place.items()}
    low, _ = value(reference_claim.statement(), place, Work())
    assert low > Fraction(supremum.low - distance)


def test_used_up_budget_is_undecided(reference_claim):
    with within(Budget(effort=100 / DEFAULT_BUDGET.boxes)):
        stated = settle(reference_claim, tolerance=1e-6)
    found = Inequality(key="claim", claim=reference_claim).decide(stated, Work())
    assert found.status is Status.UNDECIDED
    assert stated.proof is None
    assert stated.effort.cut
    assert 0.0 < stated.effort.undecided <= 1.0
    assert found.low <= TRUE_SUPREMUM + 0.31 <= found.high


def test_progress_rises_to_one(reference_claim):
    told = []
    with listening(told.append):
        prove(reference_claim)
    assert told[-1] == pytest.approx(1.0)
    assert all(0.0 <= share <= 1.0 for share in told)
    assert told == sorted(told)


def test_the_same_claim_gives_the_same_statement(reference_claim):
    first, second = (settle(reference_claim, tolerance=1e-3) for _ in range(2))
    assert isinstance(first, Stated)
    assert first == second
