"""Quadratic functions around the equilibrium: accepted if they fall, refused if anything is wrong with them."""

import json
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from tests.certificates.round_trip import keep, no_proof_can_be_missed, no_word_can_be_changed, refused
from wspd_design.certificates.checks.region.lpv_lyapunov import CHECK
from wspd_design.certificates.kernel.checker import Refused, Work
from wspd_design.certificates.kernel.file import certificate_text
from wspd_design.certificates.kernel.finding import Finding, Stated
from wspd_design.certificates.records import Status
from wspd_design.certificates.replay import replay
from wspd_design.certificates.setting.plant import dynamics_at
from wspd_design.certificates.theorems import equilibrium, quadratic
from wspd_design.certificates.theorems.region import FASTEST, FUNCTION
from wspd_design.controllers.protocol import Command
from wspd_design.controllers.torque_feedback import TorqueFeedback
from wspd_design.parameters.bounds import EXACT, Bounds

pytestmark = pytest.mark.usefixtures("remembered")


@pytest.fixture(scope="module")
def problem(make_problem, make_controller):
    """A loop whose numbers are known: its equilibrium is at the reference."""
    made = make_problem(make_controller("torque-feedback", "polach-wet"), rail="polach-wet")
    return replace(made, bounds=EXACT)


@pytest.fixture(scope="module")
def kept(problem):
    return keep(CHECK, problem)


@pytest.fixture(scope="module")
def proved(kept):
    return kept.certificate


def test_proved_with_known_numbers(proved):
    assert proved.status is Status.PROVED
    assert all(each.status is Status.PROVED for each in proved.hypotheses)
    assert 0.0 < proved.margin.low < 1.0


def test_words_and_proofs(kept):
    no_word_can_be_changed(kept)
    no_proof_can_be_missed(kept)


@pytest.mark.parametrize("key", [FUNCTION, FASTEST, equilibrium.ABOVE])
def test_a_dropped_proof_does_not_leave_it_proved(kept, key):
    findings = {name: each for name, each in kept.content["findings"].items() if name != key}
    assert refused(kept, findings=findings)


def test_functions_fall_along_random_courses(problem, proved):
    """The nonlinear valve with true pulses, linear slip: V falls from sample to sample."""
    document = proved.findings[FUNCTION].stated.proof
    a, b, c = (float(Fraction(each)) for each in document["pieces"][0][4:7])
    contraction = float(Fraction(document["pieces"][0][7]))
    matrix = np.array([[a, b], [b, c]])
    law, rng = quadratic.law_of(problem), np.random.default_rng(5)
    ranges = quadratic.ranges_of(problem, tuple(map(Fraction, document["poles"])))
    for m in quadratic.sampled(law, ranges):
        x = rng.normal(size=(2, 50))
        after = np.array([[float(each) for each in row] for row in m]) @ x
        assert ((after * (matrix @ after)).sum(0) <= contraction**2 * (x * (matrix @ x)).sum(0)).all()


def test_false_functions_are_refused(problem, proved):
    document = dict(proved.findings[FUNCTION].stated.proof)
    check = quadratic.checker(problem)
    assert check(document, Work())["pieces"] == 1.0
    for k, value in ((0, "-1"), (4, "-1"), (3, "40"), (7, "1/2"), (7, "3/2"), (3, "-1"), (1, "5"), (5, "5")):
        changed = [*document["pieces"][0]]
        changed[k] = value
        with pytest.raises(Refused):
            check(document | {"pieces": [changed]}, Work())
    for changes in (
        {"steps": ""},
        {"steps": ".."},
        {"steps": "q.."},
        {"pieces": []},
        {"poles": ["1", "0"]},
        {"format": "x"},
    ):
        with pytest.raises(Refused):
            check(document | changes, Work())
    with pytest.raises(Refused):
        check(document, Work(100))


def test_functions_for_a_smaller_range_of_poles_prove_nothing(problem, proved):
    document = dict(proved.findings[FUNCTION].stated.proof)
    low, high = map(Fraction, document["poles"])
    content = json.loads(certificate_text(proved))
    content["findings"][FUNCTION]["proof"] = document | {
        "poles": [document["poles"][0], str(float((low + high) / 2))]
    }
    assert not replay(problem, json.dumps(content)).accepted


def test_equilibrium_leaves_the_tolerance_off_the_nominal_numbers(make_problem, make_controller):
    """Audit A2: with the bounds of the files there is no equilibrium near the reference at some corner."""
    problem = make_problem(make_controller("torque-feedback", "polach-wet"), rail="polach-wet")
    kept = keep(CHECK, problem)
    found = kept.certificate
    assert found.status is Status.REFUTED
    assert found.witness
    assert found.hypotheses[-1].status is Status.REFUTED
    no_word_can_be_changed(kept)
    place = found.findings[equilibrium.NOWHERE].place
    usual = {name: str(float(problem.nominal(name))) if name != "speed" else "10.0" for name in place}
    forged = kept.content["findings"] | {equilibrium.NOWHERE: {"place": usual}}
    assert refused(kept, findings=forged)


def test_known_equilibrium_of_the_audit(problem):
    """10 km/h, 61473 kg, 640 kg m2, mu0 0.24: the frozen equilibrium lay at slip 0.8175 for kappa, K of the audit."""
    bounds = Bounds.of({"mass": (61473.0, 92209.0), "wheelset inertia": (640.0, 860.0), "mu0": (0.24, 0.36)})
    uncertain = replace(problem, bounds=bounds)
    at = {"speed": 10.0 / 3.6, "mass": 61473.0, "wheelset inertia": 640.0, "mu0": 0.24}
    assert equilibrium.nowhere(uncertain, at, Work())["rate"] > 0.0
    usual = {"speed": 10.0 / 3.6, "mass": 76841.0, "wheelset inertia": 752.0, "mu0": 0.3}
    with pytest.raises(Refused):
        equilibrium.nowhere(uncertain, usual, Work())


def test_a_place_without_equilibrium_is_told_by_its_own_numbers(problem):
    """The witness may be of the other half of the claim: the sentence names the place that it speaks about."""
    place = {"speed": 10.0 / 3.6, "mass": 61473.0, "mu0": 0.24}
    found = Finding(status=Status.REFUTED, asked="", numbers={"rate": 2.5}, stated=Stated(place=place))
    open_ = Finding(status=Status.UNDECIDED, asked="")
    told = equilibrium.explained(
        problem, {equilibrium.ABOVE: open_, equilibrium.BELOW: open_, equilibrium.NOWHERE: found}
    )
    assert told.startswith("At speed 10 km/h, mass 6.147e+04 kg, mu0 0.24 no equilibrium lies within 0.05")
    assert "at the witness" not in told


def with_valve(problem, fill, vent, top=60e3):
    brake = replace(problem.vehicle.brake, fill_time=fill, vent_time=vent, max_torque=top)
    return replace(problem, vehicle=replace(problem.vehicle, brake=brake))


def with_gains(problem, sliding, torque):
    law = problem.controller
    return replace(
        problem, controller=replace(law, gains=replace(law.gains, sliding_gain=sliding, torque_gain=torque))
    )


def test_a_fast_vent_refutes_the_old_rule(problem):
    """Audit A7b: K = tau/h - 1 of the slower time makes the torque swing where the brake vents with 0.15 s."""
    old = with_gains(problem, 3.907810377265587, 29.0)
    assert CHECK.run(old).status is Status.PROVED
    assert CHECK.run(with_valve(old, 0.6, 0.15)).status is Status.REFUTED
    # Audit A7: T_F = T_V = 0.3 s and 68.7 kN m.
    assert CHECK.run(with_valve(old, 0.3, 0.3, 68.7e3)).status is Status.REFUTED


def test_a_law_inherits_nothing(problem):
    class Evil(TorqueFeedback):
        def step(self, state, _measurement):
            return state, Command(fill=1.0, vent=0.0)

    law = problem.controller
    evil = Evil(**{name: getattr(law, name) for name in law.__dataclass_fields__})
    assert CHECK.run(replace(problem, controller=evil)).status is Status.NOT_APPLICABLE


def test_plant_is_the_one_of_the_claim(problem):
    at = dynamics_at(problem, np.array([[0.14, 10.0]]), ("slip", "speed"))
    held = float(-at.drift[0] / at.gain[0])
    assert 0.0 < held < problem.vehicle.brake.max_torque
