"""The reference problem, whose supremum other tools enclose, and what the prover reports on the way."""

import subprocess
import sys
import time
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from wspd_design.certificates.kernel.checker import Work, decide, value
from wspd_design.certificates.kernel.obligation import Inequality
from wspd_design.certificates.records import Status
from wspd_design.certificates.search import outward
from wspd_design.certificates.search import settle as engine
from wspd_design.certificates.search.budget import Budget, within
from wspd_design.certificates.search.progress import listening
from wspd_design.certificates.search.prover import extreme, prove
from wspd_design.certificates.setting import domain
from wspd_design.certificates.setting.model_error import mismatch
from wspd_design.certificates.theorems.sliding import reserve

TRUE_SUPREMUM = 24.79297  # m/s2, enclosed by 24.79296 and 24.79298


def test_supremum_to_five_digits(make_reference_problem, reference_claim):
    problem = make_reference_problem(30.0)
    found = extreme(reference_claim, tolerance=1e-5)
    eta = reserve(problem)
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


def test_fast_enough(reference_claim, proved):
    """Processor time, so that a busy machine does not count."""
    started = time.process_time()
    extreme(reference_claim, tolerance=1e-3)
    prover = time.process_time() - started
    assert decide(dict(proved.stated.proof), Work()).leaves > 100
    checker = time.process_time() - started - prover
    assert prover < 2.0
    assert checker < 10.0


def test_fallback_arithmetic_finds_the_same(reference_claim, proved):
    found = extreme(reference_claim, tolerance=0.01, backend=outward)
    assert found.low <= proved.high
    assert found.high >= proved.low
    assert found.high - found.low <= 0.01


def _decided(claim, tolerance):
    return Inequality(key="gain", claim=claim).decide(engine.settle(claim, tolerance=tolerance), Work())


@pytest.mark.parametrize("distance", [1e-2, 1e-3, 1e-4, 1e-5])
def test_verdict_near_the_supremum(reference_claim, distance):
    """Just above it is proved, just below refuted, although the enclosure is asked for within 0.01 only."""
    supremum = extreme(reference_claim, tolerance=1e-6)
    above, below = (
        _decided(replace(reference_claim, bound=Fraction(bound)), tolerance=0.01)
        for bound in (supremum.high + distance, supremum.low - distance)
    )
    assert (above.status, below.status) == (Status.PROVED, Status.REFUTED)
    assert 0.0 <= above.margin.low <= above.margin.high
    assert below.margin.low <= below.margin.high < 0.0
    place = {v.name: Fraction(below.place[v.name]) for v in reference_claim.free}
    exact = value(reference_claim.statement(), place, Work())
    assert exact[0] > Fraction(supremum.low - distance)


def test_used_up_budget_is_undecided(reference_claim):
    with within(Budget(effort=100 / 60_000)):
        found = _decided(reference_claim, tolerance=1e-6)
    assert found.status is Status.UNDECIDED
    assert not found.proved
    assert found.effort.cut
    assert 0.0 < found.effort.undecided <= 1.0
    assert found.low <= TRUE_SUPREMUM + 0.31 <= found.high


def test_progress_rises_to_one(reference_claim):
    told = []
    with listening(told.append):
        prove(reference_claim)
    assert told[-1] == pytest.approx(1.0)
    assert all(0.0 <= share <= 1.0 for share in told)
    assert told == sorted(told)


def test_checker_needs_no_prover():
    """It loads neither CasADi nor NumPy nor interval arithmetic."""
    code = (
        "import sys; import wspd_design.certificates.kernel.checker; "
        "print(sorted({'casadi', 'numpy', 'scipy', 'ival'} & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_the_same_claim_gives_the_same_text(reference_claim):
    first, second = (engine.settle(reference_claim, tolerance=1e-3).proof for _ in range(2))
    assert first == second
