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


# --- parts of the steepness ----------------------------------------------------------------------------------


def part_of(problem, **numbers):
    """Steepness of a wheel with other numbers."""
    low, high = creep_slope.steepness_of(
        replace(problem, bounds=problem.bounds | {name: (x, x) for name, x in numbers.items()})
    )
    assert high / low - 1.0 < 1e-12
    return low


@pytest.fixture
def wet(make_problem, make_controller):
    problem = make_problem(make_controller("torque-feedback"), speeds=(5.0, 5.0))
    kept = {name: ends for name, ends in problem.bounds.items() if name in ("mass", "mu0")}
    return replace(problem, bounds=type(problem.bounds).of(kept))


@pytest.mark.parametrize("grows", [True, False])
def test_steepness_is_largest_for_the_lightest_wheel_with_the_least_friction(wet, grows):
    problem = replace(wet, contact_grows_with_load=grows)
    (light, heavy), (poor, good) = problem.span("mass"), problem.span("mu0")
    low, high = creep_slope.steepness_of(problem)
    assert low == pytest.approx(part_of(problem, mass=heavy, mu0=good), rel=1e-12)
    assert high == pytest.approx(part_of(problem, mass=light, mu0=poor), rel=1e-12)
    power = 1.0 / 3.0 if grows else 1.0
    assert high / low == pytest.approx(good / poor * (heavy / light) ** power, rel=1e-9)


@pytest.mark.parametrize(
    "claimed", [creep_slope.slope_claim, creep_slope.level_claim, creep_slope.fading_claim]
)
def test_wheels_of_one_steepness_have_one_friction(wet, claimed):
    """What is proved in a part holds for any mass and mu0 with a steepness in it, and for no other one."""
    (light, heavy), (poor, good) = wet.span("mass"), wet.span("mu0")
    power = 1.0 / 3.0
    same = poor * (heavy / light) ** power  # of the light wheel, as steep as the heavy one on the poor rail
    steepness = part_of(wet, mass=heavy, mu0=poor)
    assert part_of(wet, mass=light, mu0=same) == pytest.approx(steepness, rel=1e-9)

    def value(problem, steepness=None):
        claim, slips = claimed(problem, (0.14, 0.14), "<=", Fraction(0)), (0.14, 0.14)
        if steepness:
            claim = creep_slope.for_steepness(claim, slips, steepness)
        return extreme(claim, tolerance=1e-9).high

    def alone(mass, mu0):
        return replace(wet, bounds=wet.bounds | {"mass": (mass, mass), "mu0": (mu0, mu0)})

    found = value(wet, steepness=(steepness, steepness))
    assert value(alone(heavy, poor)) == pytest.approx(found, abs=1e-8)
    assert value(alone(light, same)) == pytest.approx(found, abs=1e-8)
    assert abs(value(alone(light, good)) - found) > 1e-4
    whole = creep_slope.steepness_of(wet)
    assert value(wet, steepness=whole) == pytest.approx(value(wet), abs=1e-7)
