"""The constraint of the gain search takes a stop as the band does, with dead time and supply of the vehicle."""

from dataclasses import replace
from fractions import Fraction

import pytest

from tests.certificates.band.conftest import SLOW, problem_of
from wspd_design.certificates.checks.region.slip_band import bounded_friction
from wspd_design.certificates.search.slip_band.search import Sought, Spent, cover, exactly
from wspd_design.certificates.theorems.band import SLIP_BAND, contact_held
from wspd_design.certificates.theorems.slip_band.proof import Proof
from wspd_design.certificates.theorems.slip_band.statement import law_of
from wspd_design.design.stability import closes

pytestmark = pytest.mark.slow
ENOUGH = 60  # ellipsoids


@pytest.fixture(scope="module")
def friction():
    problem = problem_of(0.0, speeds=SLOW)
    return bounded_friction(problem, SLIP_BAND.obligations(problem))[1]


@pytest.mark.parametrize(
    ("gain", "brake", "closed"),
    [
        (60.0, {}, True),
        (60.0, {"dead_time": 0.01}, True),
        (60.0, {"dead_time": 0.019}, False),
        (100.0, {}, True),
        (100.0, {"dead_time": 0.01}, False),
        (100.0, {"build_up": "direct"}, True),
        (100.0, {"supply_rate": 10.0}, False),
        (120.0, {}, False),
    ],
)
def test_both_say_the_same_about_the_nominal_cell(friction, gain, brake, closed):
    problem = problem_of(0.0, speeds=SLOW, approach_rate=gain)
    vehicle = replace(problem.vehicle, brake=replace(problem.vehicle.brake, **brake))
    bounds = problem.bounds | {"supply rate": (vehicle.brake.supply_rate,) * 2}
    problem = contact_held(replace(problem, vehicle=vehicle, bounds=bounds))
    law = law_of(problem.controller)
    sought = Sought(problem=problem, law=law, friction=friction, conditions=exactly(problem, law))
    found = cover(sought, Fraction(1), Spent(ENOUGH))
    said = closes(problem.controller, vehicle, problem.rail, speeds=SLOW, share=0.0)
    assert (said is not None, isinstance(found, Proof)) == (closed, closed)
