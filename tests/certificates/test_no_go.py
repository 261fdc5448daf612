"""No law of the class is stable where the slip pole beats the valve; laws with dynamics of their own are not bound."""

import json
from dataclasses import fields, replace

import numpy as np
import pytest
from scipy.optimize import least_squares
from scipy.signal import cont2discrete

from tests.attack.case import read_data
from tests.attack.plant import gain, slip_pole
from tests.certificates.own_laws import BOUND, NOT_BOUND, EvilSliding
from tests.certificates.round_trip import keep, no_proof_can_be_missed, no_word_can_be_changed, refused
from wspd_design.certificates.checks.frame import accepted
from wspd_design.certificates.checks.valve import no_go
from wspd_design.certificates.kernel.checker import Refused, Work
from wspd_design.certificates.kernel.file import certificate_text
from wspd_design.certificates.kernel.finding import Stated
from wspd_design.certificates.kernel.obligation import Inequality
from wspd_design.certificates.records import Status
from wspd_design.certificates.replay import replay
from wspd_design.certificates.search.settle import finding, settle
from wspd_design.certificates.suite import CHECKS
from wspd_design.certificates.theorems.table import THEOREMS
from wspd_design.certificates.theorems.theorem import told
from wspd_design.certificates.theorems.valve import interval_claim, valve_rate

CLASS = ("no_go", "open_loop_pole", "sampling")
LAG = 0.6  # s
SPEEDS = (5.0, 10.0, 20.0, 26.0)  # m/s, all inside the range that is proved on dry rail


@pytest.fixture(scope="module")
def dry(make_problem, make_controller):
    return make_problem(make_controller("afsmc"))


@pytest.fixture(scope="module")
def proved(dry):
    return keep(no_go.CHECK, dry)


@pytest.fixture(scope="module")
def vacuous(make_problem, make_controller):
    return keep(no_go.CHECK, make_problem(make_controller("smc", "polach-wet"), rail="polach-wet"))


def test_dry_rail_is_a_proved_limitation(dry, proved):
    certificate = proved.certificate
    assert certificate.status is Status.LIMITATION
    low, high = certificate.findings["beyond"].part
    assert (low, high) == pytest.approx((10.0 / 3.6, 27.11), rel=1e-3)
    wider = interval_claim(dry, valve_rate(dry)[1], (low, 1.01 * high), ">=")
    found = finding(Inequality(key="wider", claim=wider), settle(wider, tolerance=1e-3))
    assert found.status is Status.REFUTED
    # The independent equations agree on where the pole is 1/tau.
    plant = read_data("er24pc", "polach-dry").plant
    assert slip_pole(plant, 0.14, high) > 1.0 / LAG > slip_pole(plant, 0.14, 1.01 * high)
    _, shown, limit = no_go.CHECK.run(dry).series
    assert (shown.x[0], shown.x[-1]) == pytest.approx((3.6 * low, 3.6 * high))
    assert min(shown.y) >= limit.y[0]


def test_the_sentence_names_no_speed_that_is_not_proved(proved):
    low, high = proved.certificate.findings["beyond"].part
    words = proved.certificate.claim.split(" from ")[1].split()
    assert low <= float(words[0])
    assert float(words[2]) <= high


def test_the_claim_says_whom_it_binds(proved):
    for said in ("does not read the torque", "integrals alone", "differentiable", "static load", "nominal"):
        assert said in proved.certificate.claim


def test_wet_rail_is_vacuous(vacuous):
    assert vacuous.certificate.status is Status.VACUOUS
    assert "There is no such speed" in vacuous.certificate.claim


def test_the_rate_of_the_valve_is_exceeded_for_certain(dry):
    """With a time constant whose reciprocal is a double the two numbers differ all the same."""
    brake = replace(dry.vehicle.brake, fill_time=0.5, vent_time=0.5)
    low, high = valve_rate(replace(dry, vehicle=replace(dry.vehicle, brake=brake)))
    assert low <= 2.0 < high


def test_the_faster_of_two_valves_counts(dry):
    brake = replace(dry.vehicle.brake, fill_time=0.6, vent_time=0.15)
    assert valve_rate(replace(dry, vehicle=replace(dry.vehicle, brake=brake)))[1] == pytest.approx(1 / 0.15)


@pytest.mark.parametrize("check", CLASS)
@pytest.mark.parametrize("name", NOT_BOUND)
def test_laws_outside_the_class_are_not_bound(make_problem, name, check):
    law = NOT_BOUND[name]
    assert CHECKS[check].run(make_problem(law)).status is Status.NOT_APPLICABLE


@pytest.mark.parametrize("check", CLASS)
@pytest.mark.parametrize("name", ["torque-feedback", "trenitalia", "knorr-bremse", "mitsubishi"])
def test_shipped_laws_outside_the_class_are_not_bound(make_problem, make_controller, name, check):
    assert THEOREMS[check].speaks_about(make_problem(make_controller(name)))


@pytest.mark.parametrize("name", ["smc", "afsmc", "afsmc-repaired"])
def test_shipped_laws_of_the_class(make_problem, make_controller, name):
    assert all(THEOREMS[check].speaks_about(make_problem(make_controller(name))) == "" for check in CLASS)


@pytest.mark.parametrize("name", BOUND)
def test_own_laws_of_the_class(make_problem, name):
    assert all(THEOREMS[check].speaks_about(make_problem(BOUND[name])) == "" for check in CLASS)


@pytest.mark.parametrize("check", CLASS)
def test_a_subclass_is_what_its_step_does(make_problem, make_controller, check):
    law = make_controller("smc")
    evil = EvilSliding(**{field.name: getattr(law, field.name) for field in fields(law)})
    assert "reads the braking torque" in THEOREMS[check].speaks_about(make_problem(evil))


@pytest.mark.parametrize("name", NOT_BOUND)
def test_no_file_binds_a_law_outside_the_class(make_problem, proved, name):
    assert not replay(make_problem(NOT_BOUND[name]), json.dumps(proved.content)).accepted


@pytest.mark.parametrize("speed", SPEEDS)
def test_a_lead_filter_is_stable_where_no_law_of_the_class_is(proved, speed):
    """Independent equations: poles -6, -6 and -1/tau with z' = -b z + e and u = T* + k (e + (1/tau - b) z)."""
    low, high = proved.certificate.findings["beyond"].part
    assert low < speed < high
    plant = read_data("er24pc", "polach-dry").plant
    p, g = slip_pole(plant, 0.14, speed), gain(plant, speed)
    b = p + 12.0
    k = LAG * (p * b + 36.0) / g
    loop = np.array([[p, -g, 0.0], [k / LAG, -1.0 / LAG, k * (1.0 / LAG - b) / LAG], [1.0, 0.0, -b]])
    assert np.sort(np.linalg.eigvals(loop).real) == pytest.approx([-6.0, -6.0, -1.0 / LAG], abs=1e-3)


def sampled(pole):
    plant = (
        np.array([[pole, 1.0], [0.0, -1.0 / LAG]]),
        np.array([[0.0], [1.0 / LAG]]),
        np.eye(2),
        np.zeros((2, 1)),
    )
    transition, entry, *_ = cont2discrete(plant, 0.02)
    return transition, entry


def with_memory(pole, slip, torque, gains):
    """Loop of a sampled law with one integral: x+ = x + slip s + torque T, u = -(c s + k x)."""
    transition, entry = sampled(pole)
    upper = np.hstack([transition - entry @ np.array([[gains[0], 0.0]]), -gains[1] * entry])
    return np.vstack([upper, [[slip, torque, 1.0]]])


def test_an_integral_of_the_torque_stabilizes_a_sampled_loop():
    """The reason why a law whose memory reads the torque is not in the class: p = 9.92 1/s, 20 ms, eigenvalues 0.8."""
    wanted = np.poly([0.8, 0.8, 0.8])[1:]

    def missed(x):
        return np.poly(with_memory(9.92, x[1], 1.0, (x[0], x[2])))[1:].real - wanted

    found = least_squares(missed, [2000.0, 10.0, -40.0], x_scale=[100.0, 10.0, 10.0], xtol=1e-15, ftol=1e-15)
    assert np.abs(np.linalg.eigvals(with_memory(9.92, found.x[1], 1.0, found.x[[0, 2]]))).max() < 0.81


@pytest.mark.parametrize("pole", [1.0 / LAG, 2.0, 9.92])
def test_no_sampled_law_with_an_integral_of_the_slip_is_stable(pole):
    """At the zero -c of the plant every polynomial of the loop is too large to have all its roots in the circle."""
    transition, entry = sampled(pole)
    numerator = np.poly(transition - entry @ np.array([[1.0, 0.0]])) - np.poly(transition)
    c = -np.roots(numerator[1:])[0].real
    assert c > 0.0
    assert np.abs(np.polyval(np.poly(transition), -c)) >= (1.0 + c) ** 2 * (1.0 - 1e-12)
    rng = np.random.default_rng(3)
    for _ in range(2000):
        gains = rng.normal(size=2) * 10.0 ** rng.uniform(-1.0, 4.0, 2)
        assert np.abs(np.linalg.eigvals(with_memory(pole, 1.0, 0.0, gains))).max() >= 1.0 - 1e-7


def test_files_are_accepted_word_for_word(proved, vacuous):
    for kept in (proved, vacuous):
        no_word_can_be_changed(kept)
        no_proof_can_be_missed(kept)


def _with_range(kept, speeds):
    """Write the file with another range of speeds in the statement of its proof."""
    content = json.loads(json.dumps(kept.content))
    variables = content["findings"]["beyond"]["proof"]["statement"]["variables"]
    (row,) = (each for each in variables if each[0] == "speed")
    row[1:3] = speeds
    return content


@pytest.mark.parametrize(
    "speeds",
    [
        ["2.7777777777777772", "9.0"], ["0.1", "9.0"], ["4.0", "34.0"], ["4.0", "33.333333333333343"],
        ["9.0", "4.0"], ["4.0", "4.0"], ["nan", "9.0"], ["4.0", "inf"], ["-4.0", "9.0"], [4.0, 9.0],
        [None, None], ["1e999", "9.0"], ["4" * 100_000, "9.0"], ["four", "nine"], ["4.0", "9.0"],
    ],
)  # fmt: skip
def test_speeds_that_leave_the_domain_or_were_not_proved_are_refused(proved, speeds):
    found = replay(proved.problem, json.dumps(_with_range(proved, speeds)))
    assert not found.accepted
    assert found.certificate is None


def test_a_genuine_proof_beyond_the_domain_is_refused(dry, proved):
    """Proved of more speeds than the design speaks about: true, but not a statement of this design."""
    proof = proved.certificate.findings["beyond"].stated.proof
    low, high = proved.certificate.findings["beyond"].part
    for speeds in ((low + 1e-9, dry.speeds[1]), (dry.speeds[0], high - 1e-9)):
        narrower = replace(dry, speeds=speeds)
        asked = {each.key: each for each in THEOREMS["no_go"].obligations(narrower)}["beyond"]
        with pytest.raises(Refused, match="not part of the domain"):
            asked.decide(Stated(proof=proof), Work())
    asked = {each.key: each for each in THEOREMS["no_go"].obligations(dry)}["beyond"]
    assert asked.decide(Stated(proof=proof), Work()).status is Status.PROVED


def test_fewer_speeds_show_less_and_the_file_has_to_say_so(dry, proved):
    smaller = settle(interval_claim(dry, valve_rate(dry)[1], (4.0, 9.0), ">="), tolerance=1e-3)
    findings = {"beyond": {"proof": smaller.proof, "place": {"speed": repr(smaller.place["speed"])}}}
    assert refused(proved, findings=findings)  # its sentences speak about more
    # Told honestly, the same proof is accepted.
    theorem = THEOREMS["no_go"]
    made = told(theorem, dry, accepted(theorem.obligations(dry), {"beyond": smaller}))
    assert "from 4 to 9 m/s" in made.claim
    assert replay(dry, certificate_text(made)).accepted


def test_a_place_outside_the_box_by_an_ulp_is_refused(proved):
    highest = proved.problem.speeds[1]
    for speed in (np.nextafter(highest, 100.0), highest * 1.005, 0.0):
        content = json.loads(json.dumps(proved.content))
        content["findings"]["beyond"]["place"] = {"speed": repr(float(speed))}
        assert not replay(proved.problem, json.dumps(content)).accepted
