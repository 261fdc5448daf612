"""Stops of four axles with locks, changes of rail and grades against SciPy's Radau method at its finest tolerance."""

from dataclasses import dataclass

import pytest
from independent_four_axles import IndependentFourAxles

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
    law: str
    rail: str
    kmh: float
    patches: tuple = ()
    grade: float = 0.0
    locks: bool = False


SLIPPERY = ((3.0, "low-adhesion"), (8.0, "polach-dry"))
CASES = {
    "locks": Case("none", "polach-wet", 15.0, locks=True),
    "changes of rail": Case("trenitalia", "table10-dry", 20.0, ((3.0, "polach-wet"), (9.0, "table10-dry"))),
    "locks, downhill": Case("none", "table10-wet", 20.0, grade=-0.02, locks=True),
    "locks and releases": Case("lock", "polach-wet", 25.0, locks=True),
    "locks by a change of rail, uphill": Case("none", "polach-dry", 20.0, SLIPPERY, grade=0.02, locks=True),
    "the demo": Case("afsmc", "polach-wet", 25.0),
    "the demo, changes of rail": Case("afsmc", "polach-dry", 20.0, SLIPPERY),
    "a table of rules, uphill": Case("trenitalia", "polach-dry", 20.0, grade=0.03),
    "a table of rules, downhill": Case("knorr-bremse", "table10-dry", 20.0, grade=-0.02),
    "a relay": Case("smc", "table10-wet", 20.0),
}
QUICK = ("locks", "changes of rail")


@pytest.mark.parametrize(
    "name", [pytest.param(n, marks=() if n in QUICK else pytest.mark.slow) for n in CASES]
)
def test_the_distance_agrees_to_1e_8(er24pc, make_controller, name):
    case = CASES[name]
    law = LockAndRelease() if case.law == "lock" else make_controller(case.law, case.rail)
    patches = tuple((start, load_rail(rail)) for start, rail in case.patches)
    scenario = Scenario(
        rail=load_rail(case.rail),
        initial_speed=case.kmh / 3.6,
        grade=case.grade,
        patches=tuple(Patch(start=start, rail=rail) for start, rail in patches),
    )
    independent = IndependentFourAxles(er24pc, scenario.rail, patches=patches, grade=case.grade, rtol=1e-12)
    time, y = independent.run(law, scenario.initial_speed)
    run, check = simulate_checked(er24pc, law, scenario)
    errors = []
    for r in (1, 2, 4, 8):
        x = simulate(er24pc, law, scenario, refinement=r)
        errors.append((x.totals.distance / y[5] - 1, x.time[-1] / time - 1))
    print(name, check, errors, time, run.totals.lock_time)
    assert (run.totals.lock_time > 0.2) == case.locks
    assert run.totals.distance == pytest.approx(y[5], rel=1e-8)
    assert run.time[-1] == pytest.approx(time, rel=1e-8)
