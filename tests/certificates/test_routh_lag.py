"""The loop near its reference with valve lag: decided for all speeds and parameters, against eigenvalues."""

from dataclasses import replace

import numpy as np
import pytest

from tests.attack.case import read_data
from tests.attack.plant import gain, slip_pole
from tests.certificates.round_trip import keep, no_proof_can_be_missed, no_word_can_be_changed, not_for
from wspd_design.certificates.checks.linear import routh_lag
from wspd_design.certificates.records import Status
from wspd_design.certificates.setting import linear_loop
from wspd_design.certificates.setting.linear_loop import DECAY, RATE, Valve, nominal, quartic
from wspd_design.certificates.theorems.linear import conditions
from wspd_design.controllers.adaptive_fuzzy import torque_demand, torque_per_surface
from wspd_design.controllers.offers import Feedback, SlipModel
from wspd_design.model.generated import sliding_surface
from wspd_design.parameters.loading import load_rail

LAG = 0.6  # s, of both ways of the paper's valve
LIGHT = {"mass": (61473.0, 92209.0), "wheelset inertia": (640.0, 860.0)}


@pytest.fixture(scope="module")
def light(make_problem, make_controller, narrow, er24pc):
    """Make a problem in which mass, inertia and mu0 vary and the other numbers are known."""

    def made(name, rail="polach-dry", vehicle=None, **changes):
        vehicle = vehicle or er24pc
        bounds = narrow(vehicle, load_rail(rail), **LIGHT, mu0=load_rail(rail).bounds["mu0"])
        law = changes.pop("law", None) or make_controller(name, rail)
        return make_problem(law, rail=rail, vehicle=vehicle, bounds=bounds, **changes)

    return made


def plant_at(rail, speed, at):
    """Slip pole and gain by the attacker's equations; ``at`` has the numbers that are not nominal."""
    plant = read_data("er24pc", rail).plant.with_numbers({name.replace(" ", "_"): at[name] for name in at})
    return SlipModel(pole=float(slip_pole(plant, 0.14, speed)), gain=float(gain(plant, speed)))


def matrix(plant, gains, decay=1.0 / LAG, rate=1.0 / LAG):
    """Loop in slip error, torque, its integral and that of the integral, written out from the equations."""
    row = [rate * gains.proportional, -decay - rate * gains.torque, rate * gains.integral, rate * gains.twice]
    return np.array([[plant.pole, -plant.gain, 0.0, 0.0], row, [1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]])


def growth(plant, gains, **valve):
    """Largest real part of a pole [1/s]; an integral that the law does not use is no part of its loop."""
    size = 2 + (gains.integral != 0.0) + (gains.twice != 0.0)
    return np.linalg.eigvals(matrix(plant, gains, **valve)[:size, :size]).real.max()


@pytest.mark.parametrize("name", ["afsmc", "smc", "torque-feedback"])
@pytest.mark.parametrize("rail", ["polach-dry", "polach-wet", "table10-wet"])
@pytest.mark.parametrize(("decay", "rate"), [(1.0 / LAG, 1.0 / LAG), (2.0, 5.0)])
def test_polynomial_is_the_characteristic_one_of_the_loop(
    make_problem, make_controller, name, rail, decay, rate
):
    problem = make_problem(make_controller(name, rail), rail=rail)
    for speed in (3.0, 12.0, 33.0):
        gains = problem.controller.linear_form(speed)
        found = quartic(
            nominal(problem.vehicle, problem.rail, 0.14, speed), Valve(decay=decay, rate=rate), gains
        )
        expected = np.poly(matrix(plant_at(rail, speed, {}), gains, decay, rate))[1:]
        assert np.array(found) == pytest.approx(expected, rel=1e-6, abs=1e-6)


def test_polynomial_of_the_sliding_mode_on_its_own_model_is_the_derived_one(make_problem, make_controller):
    law = make_controller("smc")
    problem = make_problem(law)
    plant = nominal(problem.vehicle, problem.rail, 0.14, 9.0)
    rate = law.gains.switching_gain / 9.0 / law.gains.boundary_layer
    derived = sliding_surface.lag_characteristic(plant.pole, LAG, law.gains.surface_rate, rate)
    found = quartic(plant, Valve(decay=1.0 / LAG, rate=1.0 / LAG), law.linear_form(9.0))
    assert (LAG, *(LAG * each for each in found[:3])) == pytest.approx(derived, rel=1e-12)
    assert found.constant == 0.0


def test_slope_of_the_adaptive_law(printed_gains):
    gains = printed_gains()
    step = 1e-4
    up, down = (torque_demand(gains, s, gains.initial_weights, gains.initial_bound) for s in (step, -step))
    assert torque_per_surface(gains, 0.0) == pytest.approx((up - down) / (2.0 * step), rel=1e-6)


@pytest.mark.parametrize("name", ["afsmc", "smc"])
@pytest.mark.parametrize("rail", ["polach-dry", "polach-wet"])
def test_witness_is_unstable(light, name, rail):
    problem = light(name, rail)
    verdict = routh_lag.CHECK.run(problem)
    assert verdict.status is Status.REFUTED
    assert verdict.margin.high < 0.0
    at = {point.name: point.value for point in verdict.witness}
    speed = at["speed"] / 3.6
    plant = plant_at(rail, speed, {each: at[each] for each in ("mass", "wheelset inertia", "mu0")})
    assert plant.pole == pytest.approx(at["slip pole"], rel=1e-6)
    assert growth(plant, problem.controller.linear_form(speed)) > 0.0


def test_witness_off_all_nominal_numbers_is_unstable(make_problem, make_controller):
    """All bounds of the files, with the rates of the valve and the T_max of the witness."""
    problem = make_problem(make_controller("smc"))
    verdict = routh_lag.CHECK.run(problem)
    assert verdict.status is Status.REFUTED
    at = {point.name: point.value for point in verdict.witness}
    speed = at["speed"] / 3.6
    numbers = ("mass", "wheelset inertia", "mu0")
    plant = plant_at("polach-dry", speed, {each: at[each] for each in numbers})
    worth = at["max torque"] / 60e3
    gains = Feedback(*(worth * each for each in problem.controller.linear_form(speed)))
    assert growth(plant, gains, decay=at[DECAY], rate=at[RATE]) > 0.0
    for name in numbers:
        low, high = problem.span(name)
        assert low <= at[name] <= high
    assert at[DECAY] * (1.0 + 1e-12) >= 1.0 / 0.9
    assert at[DECAY] <= 1.0 / 0.3 * (1.0 + 1e-12)


@pytest.fixture(scope="module")
def proved(light):
    return keep(routh_lag.CHECK, light("torque-feedback"))


def _stable_wherever_one_looks(problem, verdict, lag):
    assert verdict.status is Status.PROVED
    assert 0.0 < verdict.margin.low <= verdict.margin.high
    assert "in continuous time" in verdict.explanation
    assert all(hypothesis.status is Status.PROVED for hypothesis in verdict.hypotheses)
    assert set(verdict.proved) == set(conditions(problem))
    rng = np.random.default_rng(3)
    for _ in range(300):
        speed, *numbers = (
            rng.uniform(*each)
            for each in (problem.speeds, *map(problem.span, ("mass", "wheelset inertia", "mu0")))
        )
        plant = plant_at(
            "polach-dry", speed, dict(zip(("mass", "wheelset inertia", "mu0"), numbers, strict=True))
        )
        gains = problem.controller.linear_form(speed)
        assert growth(plant, gains, decay=1.0 / lag, rate=1.0 / lag) < 0.0


def test_proved_loop_is_stable_wherever_one_looks(proved):
    _stable_wherever_one_looks(proved.problem, proved.certificate, LAG)


def test_words_and_proofs(proved, light, make_controller):
    no_word_can_be_changed(proved)
    no_proof_can_be_missed(proved)
    law = make_controller("torque-feedback")
    weaker = replace(law, gains=replace(law.gains, torque_gain=law.gains.torque_gain - 4.0))
    assert not_for(proved, light("torque-feedback", law=weaker))
    slower = replace(law.vehicle, brake=replace(law.vehicle.brake, fill_time=0.7, vent_time=0.7))
    assert not_for(proved, light("torque-feedback", vehicle=slower, law=law))


def test_the_domain_stands_in_the_claim(proved):
    claim = proved.certificate.claim
    for words in ("mass 61473 to 92209", "mu0 0.44 to 0.66", "10 to 120 km/h"):
        assert words in claim
    assert "any slip from 0.09 to 0.19, taken as the equilibrium" in claim


def test_a_fast_valve_lets_the_sliding_mode_pass_and_a_slow_one_does_not(light, fast_vehicle, monkeypatch):
    """Without the lag in it the polynomial would pass the paper's loop; the eigenvalues would not agree."""
    problem = light("smc", vehicle=fast_vehicle)
    _stable_wherever_one_looks(problem, routh_lag.CHECK.run(problem), 0.02)
    slow = light("smc")
    assert routh_lag.CHECK.run(slow).status is Status.REFUTED
    monkeypatch.setattr(linear_loop, "_rates", lambda *_: Valve(decay=50.0, rate=50.0))
    assert routh_lag.CHECK.run(slow).status is Status.PROVED
    gains = slow.controller.linear_form(5.0)
    assert growth(plant_at("polach-dry", 5.0, {}), gains) > 0.0


def test_integral_of_the_wrong_sign_is_refuted(light, make_controller, fast_vehicle):
    law = make_controller("smc")
    wrong = replace(law, gains=replace(law.gains, surface_rate=-0.4))
    verdict = routh_lag.CHECK.run(light("smc", vehicle=fast_vehicle, law=wrong))
    assert verdict.status is Status.REFUTED
    assert {h.text: h.status for h in verdict.hypotheses}["I > 0"] is Status.REFUTED


def test_laws_without_reference_claim_nothing(make_problem, make_controller):
    made = routh_lag.CHECK.run(make_problem(make_controller("none")))
    assert made.status is Status.NOT_APPLICABLE


def test_no_gain_at_all_is_not_stable(light, monkeypatch):
    monkeypatch.setattr(
        linear_loop, "on_brake", lambda *_, **__: Feedback(proportional=0.0, integral=0.0, torque=0.0)
    )
    assert routh_lag.CHECK.run(light("smc")).status is Status.REFUTED
