"""The band of slip on a quarter of the box: proved, accepted, and refused where it would be false."""

import json
from dataclasses import replace

import pytest

import wspd_design as wd
from tests.certificates.band.conftest import certificate_of, problem_of
from wspd_design.certificates.kernel.checker import Refused, Work
from wspd_design.certificates.records import Status
from wspd_design.certificates.replay import replay
from wspd_design.certificates.setting.written_protection import not_written
from wspd_design.certificates.theorems.band import CELLS, SLIP_BAND
from wspd_design.certificates.theorems.slip_band.checker import checker
from wspd_design.certificates.theorems.slip_band.statement import windows_of
from wspd_design.controllers.valve_inversion import ValveInversion

pytestmark = pytest.mark.slow
PLENTY = 10**9


def test_band_of_a_quarter_of_the_box_is_proved_and_accepted(quarter, proved, document):
    assert proved.status is Status.PROVED
    bands = [proved.findings[CELLS].numbers[f"band {k}"] for k in range(len(windows_of(quarter)))]
    assert bands == sorted(bands, reverse=True)
    assert bands[0] < 0.025
    assert bands[-1] < 0.002
    assert replay(quarter, json.dumps(document)).accepted


def refused(problem, proof):
    with pytest.raises(Refused) as reason:
        checker(problem, problem.controller)(proof, Work(PLENTY))
    return str(reason.value)


@pytest.fixture
def proof(document):
    return document["findings"][CELLS]["proof"]


def test_checker_alone_accepts_it(quarter, proof):
    assert checker(quarter, quarter.controller)(proof, Work(PLENTY))["cells"] >= 1


def test_ellipsoid_that_is_too_small_is_refused(quarter, proof):
    for window in range(len(windows_of(quarter))):
        forged = json.loads(json.dumps(proof))
        each = forged["cells"][0][window]
        each[:10] = [repr(4.0 * float(number)) for number in each[:10]]
        assert "may lead out of an ellipsoid" in refused(quarter, forged)


def test_ellipsoid_that_is_too_large_is_refused(quarter, proof):
    each = proof["cells"][0][0]
    each[:10] = [repr(0.01 * float(number)) for number in each[:10]]
    assert "may" in refused(quarter, proof)


def test_shares_above_one_are_refused(quarter, proof):
    proof["cells"][0][0][10] = "0.9999"
    assert "add up to more than 1" in refused(quarter, proof)


def test_disturbance_without_share_is_refused(quarter, proof):
    proof["cells"][0][0][11] = "0.0"
    assert "no share" in refused(quarter, proof)


def test_hole_between_windows_is_refused(quarter, proof):
    """An ellipsoid may be invariant in its own window and still not lie in that of the next slower one."""
    cells = proof["cells"][0]
    cells[0], cells[-1] = cells[-1], cells[0]
    assert "may" in refused(quarter, proof)
    cells[0], cells[-1] = cells[-1], cells[0]
    cells[1] = [repr(0.97 * float(number)) for number in cells[0][:10]] + cells[0][10:]
    assert "next slower" in refused(quarter, proof)


def test_dropped_window_and_dropped_cell_are_refused(quarter, proof):
    missing = json.loads(json.dumps(proof))
    missing["cells"][0].pop()
    assert "one entry for each" in refused(quarter, missing)
    halved = json.loads(json.dumps(proof))
    halved["steps"] = "m.."
    assert "do not match" in refused(quarter, halved)


def test_narrower_friction_proves_less_than_the_theorem_asks(quarter, proof, document):
    """Bounds that are narrower than the proved ones are a true statement about another friction."""
    low, high = (float(each) for each in proof["friction"][0][:2])
    proof["friction"][0][:2] = [repr(0.5 * low), repr(0.5 * high)]
    assert not replay(quarter, json.dumps(document)).accepted


def test_proof_of_a_quarter_does_not_hold_for_the_half(document):
    assert not replay(problem_of(0.5), json.dumps(document)).accepted


def test_nominal_inversion_with_a_fast_valve_is_not_proved():
    """Full steps through a valve that is twice as fast: the loop oscillates, and no ellipsoid is found."""
    problem = problem_of(0.0)
    law = problem.controller
    valve = replace(law.valve, time_share=1.0)
    assert isinstance(valve, ValveInversion)
    law = replace(law, valve=valve, core=replace(law.core, tracking=replace(law.core.tracking, valve=valve)))
    fast = problem.bounds | {"fill time": (0.25, 0.25), "vent time": (0.25, 0.25)}
    found = certificate_of(replace(problem, controller=law, bounds=fast))
    assert found.status is Status.UNDECIDED


def test_other_laws_are_not_spoken_about(quarter):
    def reason(**changed):
        return SLIP_BAND.speaks_about(replace(quarter, **changed))

    assert reason() == ""
    sliding = wd.design_controller(quarter.vehicle, quarter.rail, wd.Specification(), law="smc")
    assert "observer" in reason(controller=sliding.build(quarter.vehicle, quarter.rail))
    assert "holds slip 0.14" in reason(slip=0.15)
    law = quarter.controller
    assert "constant slip" in reason(controller=replace(law, pressure_sensors=False))
    assert "holds its valves" in reason(controller=replace(law, cut_out_speed=5.0))


class Gentle(type(problem_of(0.0).controller)):
    """Claims to be the protection and commands other pulses."""

    def step(self, state, measurement):
        state, commands = super().step(state, measurement)
        return state, tuple(each._replace(fill=0.9 * each.fill) for each in commands)


def test_step_that_runs_is_what_counts(quarter):
    law = quarter.controller
    assert not_written(law) == ""
    gentle = Gentle(**{name: getattr(law, name) for name in law.__dataclass_fields__})
    assert "is not shown" in not_written(gentle)
    assert "is not shown" in SLIP_BAND.speaks_about(replace(quarter, controller=gentle))
