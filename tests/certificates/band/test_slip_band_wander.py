"""A slip that moves beside what the law knows: proved for bounds of it, refused and left beyond them."""

from dataclasses import replace

import numpy as np
import pytest

from tests.certificates.band.conftest import certificate_of
from tests.certificates.band.test_declared_law import problem_with
from wspd_design.certificates.kernel.checker import Refused, Work
from wspd_design.certificates.records import Status
from wspd_design.certificates.theorems.band import CELLS, claims, key
from wspd_design.certificates.theorems.slip_band.checker import checker
from wspd_design.certificates.theorems.slip_band.proof import read
from wspd_design.certificates.theorems.slip_band.statement import NAMES, windows_of
from wspd_design.parameters.bounds import Bounds
from wspd_design.parameters.units import KMH

pytestmark = pytest.mark.slow
ERROR, DRIFT = 0.03, 0.02  # -, m/s2
PLENTY = 10**9


def wandering(tmp_path, error=ERROR, drift=DRIFT):
    """Law of the page with a slip that wanders, on half of the box of low adhesion from 60 km/h on."""
    told = f"time_share=self.share, slip_error={error}, slip_drift={drift},"
    problem = problem_with(tmp_path, ("time_share=self.share,", told))
    ends = {}
    for name in NAMES:
        (low, high), middle = problem.span(name), problem.nominal(name)
        ends[name] = (middle + 0.5 * (low - middle), middle + 0.5 * (high - middle))
    return replace(problem, bounds=Bounds.of(ends), speeds=(60.0 / KMH, 80.0 / KMH))


@pytest.fixture(scope="module")
def wander(tmp_path_factory):
    problem = wandering(tmp_path_factory.mktemp("law"))
    return problem, certificate_of(problem)


def test_band_around_any_slip_that_wanders_within_its_bounds_is_proved(wander):
    _, found = wander
    assert found.status is Status.PROVED
    assert f"within {ERROR:g} of 0.14 and moves beside it no faster than by {DRIFT:g} m/s2" in found.claim
    assert any("may be wrong" in each for each in found.assumptions)
    numbers = found.findings[CELLS].numbers
    assert 0.0001 < max(numbers["band 0 above"], numbers["band 0 below"]) < 0.0011


def test_the_same_ellipsoids_do_not_hold_for_faster_drift(wander, tmp_path):
    _, found = wander
    faster = wandering(tmp_path, drift=2.0 * DRIFT)
    with pytest.raises(Refused, match="may lead out of an ellipsoid"):
        checker(faster, faster.controller)(found.findings[CELLS].stated.proof, Work(PLENTY))


def test_what_is_asked_of_the_friction_grows_with_the_error_of_the_slip(wander, tmp_path):
    """So that bounds for a smaller error are no answer to the question for a larger one."""
    problem, _ = wander
    asked = {}
    for each in (problem, wandering(tmp_path, error=2.0 * ERROR)):
        (slipping,) = (
            x for x in claims(each)[key("level", 0, 0, "<=")].variables if x.name == "sliding speed"
        )
        asked[id(each)] = float(slipping.low), float(slipping.high)
    (low, high), (wider_low, wider_high) = asked.values()
    assert wider_low < low < high < wider_high


def test_drift_within_its_bound_stays_and_a_jump_leaves(wander):
    """The reference drifts to and fro as badly as it may, then jumps once by what it may differ at all."""
    problem, found = wander
    windows = windows_of(problem)
    ellipsoid = read(found.findings[CELLS].stated.proof, len(windows)).cells[0][0]
    p = np.linalg.inv(np.array(ellipsoid.matrix, dtype=float))
    center = np.array(ellipsoid.center, dtype=float)
    law, h = problem.controller, problem.sample_time
    theta, k = np.exp(-law.observer * h), law.pull * h
    moved = DRIFT * h / law.vehicle.wheel_radius
    jump = ERROR * windows[0][0] / law.vehicle.wheel_radius

    def size(state):
        return float((state - center) @ p @ (state - center))

    def sample(state, drift, q=0.0):
        """The loop once more, for a true valve and a friction that does not change."""
        e, observer, n, y, lag = state
        phi, psi = np.exp(q * h), 1.0
        wanted = n + k * (e + float(ellipsoid.settled) + law.ahead * (n - y + lag)) + lag
        part = law.share * (wanted - y)
        error = phi * e - psi * (y + 0.6 * part) + drift
        r = error - drift - e - observer - n + y + 0.6 * part
        lag *= np.exp(-h / law.smoothing)
        return np.array([error, -(theta**2) * r, n + (1.0 - theta) ** 2 * r, y + part, lag])

    random = np.random.default_rng(3)
    worst, state = 0.0, center.copy()
    for number in range(2000):
        state = sample(state, moved * (random.choice((-1.0, 1.0)) if number % 400 < 200 else 1.0))
        worst = max(worst, size(state))
    assert 0.005 < worst <= 1.0
    assert size(sample(state, jump)) > 1.0
