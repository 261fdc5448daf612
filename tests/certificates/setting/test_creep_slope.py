"""The range of p - a/v from the slope of a normal wheel: no wheel of the domain leaves it."""

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from wspd_design.certificates.search.prover import extreme
from wspd_design.certificates.setting import creep_slope, domain
from wspd_design.certificates.setting.plant import dynamics_at


@pytest.mark.parametrize("rail", ["polach-wet", "polach-dry"])
@pytest.mark.parametrize("grows", [True, False])
def test_no_wheel_leaves_the_range(make_problem, make_controller, rail, grows):
    problem = make_problem(make_controller("torque-feedback", rail), rail=rail, contact_grows_with_load=grows)
    ends = []
    for relation in (">=", "<="):
        claim = creep_slope.slope_claim(problem, problem.near, relation, Fraction(0))
        found = extreme(claim, tolerance=0.02)
        ends.append(found.low if relation == ">=" else found.high)
    low, high = creep_slope.poles(problem, problem.near, *ends)
    names = ("slip", *creep_slope.USED)
    least, most = domain.box(problem, names)
    least[0], most[0] = problem.near
    rng = np.random.default_rng(3)
    inside = rng.uniform(least, most, (4000, len(names)))
    corners = np.where(rng.random((4000, len(names))) < 0.5, least, most)
    points = np.concatenate([inside, corners])
    at = dynamics_at(problem, points, names)
    q = at.pole - at.deceleration / points[:, names.index("speed")]
    assert low <= q.min()
    assert q.max() <= high
    # The range is not wide out of all proportion: some wheel comes near its upper end, which counts.
    assert q.max() > high - 0.4 * abs(high) - 1.0


def test_known_plant_has_the_slope_of_the_kernel(make_problem, make_controller):
    problem = make_problem(make_controller("torque-feedback"), speeds=(10.0, 10.0))
    exact = replace(problem, bounds=type(problem.bounds)())
    claim = creep_slope.slope_claim(exact, (0.14, 0.14), "<=", Fraction(0))
    found = extreme(claim, tolerance=1e-6)
    low, high = creep_slope.poles(exact, (0.14, 0.14), found.low, found.high)
    at = dynamics_at(exact, np.array([[0.14, 10.0]]), ("slip", "speed"))
    expected = float(at.pole[0] - at.deceleration[0] / 10.0)
    assert low <= expected <= high
    assert high - low < 1e-4
