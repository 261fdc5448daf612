"""The band of slip: proved for boxes and cells, for a share of them alone, and of which laws nothing is said."""

import json
from dataclasses import replace
from fractions import Fraction

import pytest

import wspd_design as wd
from tests.certificates.band.conftest import SLOW, certificate_of, problem_of, refused, told_of
from tests.certificates.band.forging import told_with
from wspd_design.certificates.checks.region.slip_band import bounded_friction
from wspd_design.certificates.records import Status
from wspd_design.certificates.replay import replay
from wspd_design.certificates.search.slip_band.search import Sought, Spent, cover, exactly
from wspd_design.certificates.setting.written_protection import not_written
from wspd_design.certificates.theorems.band import CELLS, SLIP_BAND, contact_held
from wspd_design.certificates.theorems.slip_band.proof import Proof, write
from wspd_design.certificates.theorems.slip_band.statement import law_of, windows_of
from wspd_design.controllers.observers.sensors import Sensors
from wspd_design.controllers.valve_inversion import ValveInversion

pytestmark = pytest.mark.slow


def test_band_of_half_of_the_box_is_proved_and_accepted(half, proved, document):
    assert proved.status is Status.PROVED
    assert len(proved.varied) == 11
    numbers = proved.findings[CELLS].numbers
    for side, slowest, fastest in (("above", 0.016, 0.001), ("below", 0.024, 0.002)):
        bands = [numbers[f"band {k} {side}"] for k in range(len(windows_of(half)))]
        assert bands == sorted(bands, reverse=True)
        assert bands[0] < slowest
        assert bands[-1] < fastest
    assert replay(half, json.dumps(document)).accepted


def test_checker_alone_accepts_it(half, proof):
    assert told_of(half, proof)["cells"] >= 1


def test_whole_box_of_low_adhesion_is_proved():
    certificate = certificate_of(problem_of(1.0, rail=wd.load_rail("low-adhesion"), speeds=SLOW))
    assert certificate.status is Status.PROVED
    numbers = certificate.findings[CELLS].numbers
    assert numbers["share"] == 1.0
    assert max(numbers["band 0 above"], numbers["band 0 below"]) < 0.0015


def test_cells_that_go_on_with_the_ellipsoids_of_a_larger_one_are_accepted():
    """Tangents of a smaller range touch elsewhere: an ellipsoid of a cell may not be one of its half."""
    problem = problem_of(0.9, speeds=(14.0 / 3.6, 20.0 / 3.6))
    _, friction = bounded_friction(problem, SLIP_BAND.obligations(problem))
    assert friction is not None
    law = law_of(problem.controller)
    sought = Sought(
        problem=contact_held(problem), law=law, friction=friction, conditions=exactly(problem, law)
    )
    proof = cover(sought, Fraction(1), Spent(200))
    assert isinstance(proof, Proof)
    assert len(proof.cells) > 1
    numbers = told_of(problem, write(proof))
    assert numbers["cells"] == len(proof.cells)


def test_share_of_the_box_is_part_of_the_statement(half, proof):
    """A share below 1 is a proof about less than the box, one above it about numbers that are not in it."""
    proof["share"] = "1.5"
    assert "1 at most" in refused(half, proof)
    proof["share"] = "0.5"
    assert told_of(half, proof)["share"] == 0.5


def test_share_of_the_box_is_told_and_leaves_the_claim_open(half, proved, proof):
    told = told_with(half, proved, {CELLS: proof | {"share": "0.5"}})
    assert told.status is Status.UNDECIDED
    assert told.explanation.startswith(
        "Shown on 50 % of each range about its nominal value, not on all of it."
    )
    assert told.margin is None


def test_proof_of_half_of_the_box_does_not_hold_for_all_of_it(document):
    assert not replay(problem_of(1.0), json.dumps(document)).accepted


def test_narrower_friction_proves_less_than_the_theorem_asks(half, proof, document):
    """Bounds that are narrower than the proved ones are a true statement about another friction."""
    low, high = (float(each) for each in proof["friction"][0][2:4])
    proof["friction"][0][2:4] = [repr(0.5 * low), repr(0.5 * high)]
    assert not replay(half, json.dumps(document)).accepted


def test_nominal_inversion_with_a_fast_valve_is_not_proved():
    """Full steps through a valve that is twice as fast: the loop oscillates, and no ellipsoid is found."""
    problem = problem_of(0.0, speeds=(10.0 / 3.6, 12.0 / 3.6))
    assert certificate_of(problem).status is Status.PROVED
    law = problem.controller
    valve = replace(law.valve, time_share=1.0)
    assert isinstance(valve, ValveInversion)
    law = replace(law, valve=valve, core=replace(law.core, tracking=replace(law.core.tracking, valve=valve)))
    fast = problem.bounds | {"fill time": (0.25, 0.25), "vent time": (0.25, 0.25)}
    found = certificate_of(replace(problem, controller=law, bounds=fast))
    assert found.status is Status.UNDECIDED


def test_worn_wheels_of_which_the_law_takes_no_scale_are_refused(half, proof):
    """A law that does not take the scale from them holds another slip: with 5 %, .2 in place of .14 at 510 mm."""
    law = half.controller
    careless = replace(half, controller=replace(law, source=replace(law.source, largest_scale_error=0.03)))
    assert "does not take its scale" in refused(careless, proof)


def test_other_laws_are_not_spoken_about(half):
    def reason(**changed):
        return SLIP_BAND.speaks_about(replace(half, **changed))

    assert reason() == ""
    sliding = wd.design_controller(half.vehicle, half.rail, wd.Specification(), law="smc")
    assert "observer" in reason(controller=sliding.build(half.vehicle, half.rail))
    assert "holds slip 0.14" in reason(slip=0.15)
    law = half.controller
    assert "pressure sensors" in reason(controller=replace(law, pressure_sensors=False))
    seeking = replace(wd.Specification(), sample_time=0.02, reference="seeking", speeds=half.speeds)
    searching = wd.design_controller(half.vehicle, half.rail, seeking, law="observer-smc")
    assert "searches for the peak" in reason(controller=searching.build(half.vehicle, half.rail))
    wheels = wd.Specification(sample_time=0.02, sensors=Sensors(speed="wheels"), speeds=half.speeds)
    estimating = wd.design_controller(half.vehicle, half.rail, wheels, law="observer-smc")
    assert "estimates the train speed" in reason(controller=estimating.build(half.vehicle, half.rail))
    assert "holds its valves" in reason(controller=replace(law, cut_out_speed=5.0))


class Gentle(type(problem_of(0.0).controller)):
    """Claims to be the protection and commands other pulses."""

    def step(self, state, measurement):
        state, commands = super().step(state, measurement)
        return state, tuple(each._replace(fill=0.9 * each.fill) for each in commands)


def test_step_that_runs_is_what_counts(half):
    law = half.controller
    assert not_written(law) == ""
    gentle = Gentle(**{name: getattr(law, name) for name in law.__dataclass_fields__})
    assert "is not shown" in not_written(gentle)
    assert "is not shown" in SLIP_BAND.speaks_about(replace(half, controller=gentle))
