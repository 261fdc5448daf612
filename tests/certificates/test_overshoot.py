"""How far the slip goes beyond its reference in a stop, for laws of every kind."""

from dataclasses import dataclass, replace

import pytest

from tests.certificates.round_trip import keep, no_word_can_be_changed, not_for, refused
from tests.unit.controllers.vehicle_cases import protection
from wspd_design.certificates.checks.sliding import holding_torque
from wspd_design.certificates.checks.stop import overshoot
from wspd_design.certificates.records import Status
from wspd_design.certificates.theorems.overshoot import plant_of
from wspd_design.controllers.protocol import Command
from wspd_design.model.number import maximum, where
from wspd_design.parameters.bounds import EXACT, Bounds

pytestmark = pytest.mark.usefixtures("remembered")

WET = "polach-wet"


@dataclass(frozen=True)
class Band:
    """Vent above the reference, fill below it; ``sign`` and ``fills`` plant faults."""

    radius: float
    sign: float = 1.0
    fills: float = 1.0
    slip: float = 0.14
    sample_time: float = 0.02
    name: str = "band"

    def start(self, _):
        return ()

    def step(self, state, m):
        now = 1.0 - self.radius * m.wheel_speed / maximum(m.speed, 0.5)
        slides = self.sign * (now - 0.5 * self.slip) > 0.0
        return state, Command(fill=where(slides, 0.0, self.fills), vent=where(slides, 1.0, 0.0))


def problem_of(make_problem, law, vehicle):
    return make_problem(law, rail=WET, vehicle=vehicle, sample_time=law.sample_time)


@pytest.fixture
def slippery(er24pc):
    """Return a vehicle whose resistance stops it soon, whatever the brake does."""
    return replace(er24pc, resistance_constant=60e3, bounds=EXACT)


def test_a_law_with_the_wrong_sign_locks_its_wheel(make_problem, fast_vehicle):
    right, wrong = (Band(radius=fast_vehicle.wheel_radius, sign=sign) for sign in (1.0, -1.0))
    kept = keep(overshoot.CHECK, problem_of(make_problem, wrong, fast_vehicle))
    assert kept.certificate.status is Status.REFUTED
    no_word_can_be_changed(kept)
    assert overshoot.CHECK.run(problem_of(make_problem, right, fast_vehicle)).status is not Status.VACUOUS
    assert not_for(kept, problem_of(make_problem, right, fast_vehicle))


def test_a_law_that_never_fills_never_gets_there(make_problem, slippery):
    law = Band(radius=slippery.wheel_radius, fills=0.0)
    kept = keep(overshoot.CHECK, problem_of(make_problem, law, slippery))
    assert kept.certificate.status is Status.REFUTED
    assert "though the brake could bring it there: the law brakes too little" in kept.certificate.explanation
    no_word_can_be_changed(kept)


def test_a_protection_keeps_to_its_own_reference_on_all_wheelsets(make_problem, er24pc):
    law = protection(er24pc, "observer-smc")
    problem = problem_of(make_problem, law, er24pc)
    assert plant_of(problem) == "planar"
    kept = keep(overshoot.CHECK, problem)
    assert kept.certificate.status is Status.EVIDENCE
    assert "(planar)" in kept.certificate.claim
    no_word_can_be_changed(kept)


@pytest.mark.parametrize("name", ["trenitalia", "knorr-bremse", "mitsubishi", "none"])
def test_rules_of_the_industry_are_judged_too(make_problem, make_controller, name):
    found = overshoot.CHECK.run(make_problem(make_controller(name), rail=WET))
    assert found.status is Status.REFUTED
    assert "The law names no slip that it holds." in found.explanation


@pytest.fixture
def coach(er24pc):
    """Return a vehicle whose brake uses half of the adhesion."""
    return replace(er24pc, brake=replace(er24pc.brake, max_torque=6.6e3, bounds=EXACT))


def test_a_brake_that_never_reaches_the_reference_refutes_nothing(make_problem, make_controller, coach):
    problem = make_problem(make_controller("trenitalia"), rail=WET, vehicle=coach)
    for check in (overshoot.CHECK, holding_torque.CHECK):
        kept = keep(check, problem)
        assert kept.certificate.status is Status.VACUOUS
        assert kept.certificate.explanation.startswith("The brake never reaches the reference")
        findings = {key: each for key, each in kept.content["findings"].items() if "reach" not in key}
        assert refused(kept, findings=findings)


@pytest.mark.parametrize("name", ["torque-feedback", "trenitalia"])
def test_what_holds_the_reference_is_enclosed_for_every_law(make_problem, make_controller, name):
    kept = keep(holding_torque.CHECK, make_problem(make_controller(name, WET), rail=WET))
    assert kept.certificate.status is Status.PROVED
    assert "of the least T_max" in kept.certificate.explanation
    no_word_can_be_changed(kept)


def test_a_wheel_that_a_vented_brake_does_not_let_go_is_refuted(make_problem, make_controller, er24pc):
    """Plant the fault: bearings that brake the wheel more than a slippery rail can turn it."""
    stiff = replace(er24pc, wheel_damping=60.0, bounds=Bounds.of({}))
    kept = keep(
        holding_torque.CHECK, make_problem(make_controller("trenitalia"), rail="low-adhesion", vehicle=stiff)
    )
    assert kept.certificate.status is Status.REFUTED
    no_word_can_be_changed(kept)
