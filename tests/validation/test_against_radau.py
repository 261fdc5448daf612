"""Ten stops of four axles with locks, changes of rail and grades against SciPy's Radau method at rtol 1e-12.

The other simulation is :mod:`independent_axles`. It takes a minute for each stop, so that its distances and times
stand here; ``pytest -m reference`` works them out again, and one of them is done with a wider tolerance in every run.
"""

from dataclasses import dataclass, replace

import pytest
from independent_axles import IndependentAxles

from wspd_design.controllers.protocol import Command
from wspd_design.model.number import where
from wspd_design.parameters.loading import load_rail
from wspd_design.simulation.records import Patch, Scenario
from wspd_design.simulation.self_check import simulate_checked
from wspd_design.simulation.stop import simulate


@dataclass(frozen=True)
class LockAndRelease:
    """Fill until the wheels are locked, vent until they roll, and again."""

    period: float = 2.0
    name: str = "lock and release"
    sample_time: float = 0.1

    def start(self, measurement):  # noqa: ARG002
        return (1e-9,)

    def step(self, state, measurement):  # noqa: ARG002
        (time,) = state
        again = where(time >= self.period, 0.0, time)
        fill = where(again < 0.6 * self.period, 0.93, 0.0)
        return (again + self.sample_time,), Command(fill=fill, vent=where(fill > 0.0, 0.0, 0.87))


@dataclass(frozen=True)
class Case:
    """A stop, and what Radau finds."""

    law: str
    rail: str
    kmh: float
    distance: float  # m
    time: float  # s
    patches: tuple = ()
    grade: float = 0.0
    locks: bool = False


SLIPPERY = ((3.0, "low-adhesion"), (8.0, "polach-dry"))
WET_BETWEEN = ((3.0, "polach-wet"), (9.0, "table10-dry"))
CASES = {
    "locks": Case("none", "polach-wet", 15.0, 6.822377020823683, 2.471881606843909, locks=True),
    "changes of rail": Case(
        "trenitalia", "table10-dry", 20.0, 10.434656158223443, 2.835969673649119, WET_BETWEEN
    ),
    "locks, downhill": Case(
        "none", "table10-wet", 20.0, 11.135422236672449, 3.004918565433442, grade=-0.02, locks=True
    ),
    "locks and releases": Case("lock", "polach-wet", 25.0, 18.922163511964538, 4.426657881842255, locks=True),
    "locks by a change of rail, uphill": Case(
        "none", "polach-dry", 20.0, 10.469882473696373, 2.869467811437562, SLIPPERY, grade=0.02, locks=True
    ),
    "the demo": Case("afsmc", "polach-wet", 25.0, 15.581224389897978, 3.671392522366674),
    "the demo, changes of rail": Case(
        "afsmc", "polach-dry", 20.0, 11.61225815956361, 3.1506393193853257, SLIPPERY
    ),
    "a table of rules, uphill": Case(
        "trenitalia", "polach-dry", 20.0, 9.36392305725575, 2.557755017892945, grade=0.03
    ),
    "a table of rules, downhill": Case(
        "knorr-bremse", "table10-dry", 20.0, 14.655426663394632, 3.707397389373243, grade=-0.02
    ),
    "a relay": Case("smc", "table10-wet", 20.0, 13.72020750461929, 3.558919556342795),
}


def scenario_of(case):
    return Scenario(
        rail=load_rail(case.rail),
        initial_speed=case.kmh / 3.6,
        grade=case.grade,
        patches=tuple(Patch(start=start, rail=load_rail(rail)) for start, rail in case.patches),
    )


@pytest.fixture
def law_of(make_controller):
    return lambda case: LockAndRelease() if case.law == "lock" else make_controller(case.law, case.rail)


@pytest.mark.parametrize("name", CASES)
def test_the_stop_agrees_to_1e_8(er24pc, law_of, name):
    case = CASES[name]
    law, scenario = law_of(case), scenario_of(case)
    run, check = simulate_checked(er24pc, law, scenario)
    assert not check.unresolved
    assert (run.totals.lock_time > 0.2) == case.locks
    assert run.totals.distance == pytest.approx(case.distance, rel=2e-6)  # with the steps of the step check
    fine = simulate(er24pc, law, scenario, refinement=4)
    assert fine.totals.distance == pytest.approx(case.distance, rel=1e-8)
    assert fine.time[-1] == pytest.approx(case.time, rel=1e-7)


def radau(vehicle, case, law, rtol):
    """Time and distance of the other simulation."""
    scenario = scenario_of(case)
    patches = tuple((patch.start, patch.rail) for patch in scenario.patches)
    independent = IndependentAxles(vehicle, scenario.rail, patches=patches, grade=case.grade, rtol=rtol)
    time, y = independent.run(law, scenario.initial_speed)
    return time, y[5]


@pytest.mark.slow
def test_radau_with_a_wider_tolerance_finds_what_stands_here(er24pc, law_of):
    case = CASES["locks by a change of rail, uphill"]
    time, distance = radau(er24pc, case, law_of(case), 1e-8)
    assert distance == pytest.approx(case.distance, rel=1e-7)
    assert time == pytest.approx(case.time, rel=1e-7)


@pytest.mark.reference
@pytest.mark.parametrize("name", CASES)
def test_radau_finds_what_stands_here(er24pc, law_of, name):
    case = CASES[name]
    time, distance = radau(er24pc, case, law_of(case), 1e-12)
    assert distance == pytest.approx(case.distance, rel=1e-11)
    assert time == pytest.approx(case.time, rel=1e-10)


def test_a_millionth_of_the_friction_is_seen(er24pc, law_of):
    case = CASES["locks, downhill"]
    scenario = scenario_of(case)
    rail = replace(scenario.rail, mu0=scenario.rail.mu0 * (1.0 + 1e-6))
    run = simulate(er24pc, law_of(case), replace(scenario, rail=rail), refinement=4)
    assert abs(run.totals.distance / case.distance - 1.0) > 1e-7
