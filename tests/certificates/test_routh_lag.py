"""The loop near its reference with valve lag: decided for all speeds and parameters, against eigenvalues."""

import json
from dataclasses import replace

import numpy as np
import pytest

from wspd_design.certificates.checks.linear import routh_lag
from wspd_design.certificates.kernel.checker import check as check_proof
from wspd_design.certificates.kernel.claim import number
from wspd_design.certificates.records import Status
from wspd_design.certificates.setting.linear_loop import (
    cubic,
    lag_of,
    nominal,
)
from wspd_design.controllers.adaptive_fuzzy import torque_demand, torque_per_surface
from wspd_design.controllers.offers import Feedback
from wspd_design.model.generated import sliding_surface
from wspd_design.model.slip import slip_dynamics


def eigenvalues(problem, speed, *, mass=None, inertia=None, mu0=None):
    """Closed loop of slip, torque and integral, by differences of the law's own step where it is linear."""
    vehicle, law = problem.vehicle, problem.controller
    vehicle = replace(
        vehicle, mass=mass or vehicle.mass, wheelset_inertia=inertia or vehicle.wheelset_inertia
    )
    rail = replace(problem.rail, mu0=mu0 or problem.rail.mu0)
    plant = slip_dynamics(vehicle, rail, problem.slip, speed)
    gains, lag = law.linear_form(speed), vehicle.brake.fill_time
    return np.linalg.eigvals(
        [
            [plant.pole, plant.gain, 0.0],
            [-gains.proportional / lag, -(1.0 + gains.torque) / lag, gains.integral / lag],
            [-1.0, 0.0, 0.0],
        ]
    )


@pytest.mark.parametrize("name", ["afsmc", "smc", "torque-feedback"])
@pytest.mark.parametrize("rail", ["polach-dry", "polach-wet", "table10-wet"])
def test_polynomial_has_the_eigenvalues_of_the_loop(make_problem, make_controller, name, rail):
    problem = make_problem(make_controller(name, rail), rail=rail)
    for speed in (3.0, 12.0, 33.0):
        plant = nominal(problem.vehicle, problem.rail, 0.14, speed)
        roots = np.roots(cubic(plant, lag_of(problem), problem.controller.linear_form(speed)))
        assert np.sort_complex(roots) == pytest.approx(
            np.sort_complex(eigenvalues(problem, speed)), rel=1e-6, abs=1e-6
        )


def test_polynomial_of_the_sliding_mode_on_its_own_model_is_the_derived_one(make_problem, make_controller):
    law = make_controller("smc")
    problem = make_problem(law)
    plant = nominal(problem.vehicle, problem.rail, 0.14, 9.0)
    rate = law.gains.switching_gain / 9.0 / law.gains.boundary_layer
    derived = sliding_surface.lag_characteristic(plant.pole, 0.6, law.gains.surface_rate, rate)
    assert tuple(cubic(plant, 0.6, law.linear_form(9.0))) == pytest.approx(derived, rel=1e-12)


def test_slope_of_the_adaptive_law(printed_gains):
    gains = printed_gains()
    step = 1e-4
    up, down = (torque_demand(gains, s, gains.initial_weights, gains.initial_bound) for s in (step, -step))
    assert torque_per_surface(gains, 0.0) == pytest.approx((up - down) / (2.0 * step), rel=1e-6)


@pytest.mark.parametrize("name", ["afsmc", "smc"])
@pytest.mark.parametrize("rail", ["polach-dry", "polach-wet"])
def test_witness_is_unstable(make_problem, make_controller, name, rail):
    problem = make_problem(make_controller(name, rail), rail=rail)
    verdict = routh_lag.check(problem)
    assert verdict.status is Status.REFUTED
    assert verdict.margin.high < 0.0
    at = {point.name: point.value for point in verdict.witness}
    speed = at["speed"] / 3.6
    found = eigenvalues(problem, speed, mass=at["mass"], inertia=at["wheelset inertia"], mu0=at["mu0"])
    assert found.real.max() > 0.0


@pytest.mark.parametrize("name", ["smc", "torque-feedback"])
def test_proved_loop_is_stable_wherever_one_looks(make_problem, make_controller, fast_vehicle, name):
    vehicle = fast_vehicle if name == "smc" else None
    problem = make_problem(make_controller(name), vehicle=vehicle)
    verdict = routh_lag.check(problem)
    assert verdict.status is Status.PROVED
    assert 0.0 < verdict.margin.low <= verdict.margin.high
    assert all(hypothesis.status is Status.PROVED for hypothesis in verdict.hypotheses)
    assert len(verdict.proofs) == len(verdict.hypotheses)
    rng = np.random.default_rng(3)
    for _ in range(300):
        speed, mass, inertia, mu0 = (
            rng.uniform(*bounds)
            for bounds in (
                problem.speeds,
                problem.span("mass"),
                problem.span("wheelset inertia"),
                problem.span("mu0"),
            )
        )
        found = eigenvalues(problem, speed, mass=mass, inertia=inertia, mu0=mu0)
        if name == "torque-feedback":  # no integral action: one eigenvalue is that of the unused integral
            found = np.delete(found, np.argmin(np.abs(found)))
        assert found.real.max() < 0.0


def test_planted_fault_in_the_polynomial_is_seen(make_problem, make_controller, monkeypatch):
    """Without the lag in it the polynomial would pass the paper's loop; the eigenvalues would not agree."""
    problem = make_problem(make_controller("smc"))
    monkeypatch.setattr(routh_lag, "lag_of", lambda _: 1e-3)
    assert routh_lag.check(problem).status is Status.PROVED
    assert lag_of(problem) == 0.6
    assert eigenvalues(problem, 5.0).real.max() > 0.0


def test_integral_of_the_wrong_sign_is_refuted(make_problem, make_controller, fast_vehicle):
    law = make_controller("smc")
    wrong = replace(law, gains=replace(law.gains, surface_rate=-0.4))
    verdict = routh_lag.check(make_problem(wrong, vehicle=fast_vehicle))
    assert verdict.status is Status.REFUTED
    assert {h.text: h.status for h in verdict.hypotheses}["I > 0"] is Status.REFUTED


def test_proof_of_one_law_does_not_serve_another(make_problem, make_controller):
    law = make_controller("torque-feedback")
    weaker = replace(law, gains=replace(law.gains, torque_gain=25.0))
    proofs = [routh_lag.check(make_problem(each)).proofs[0] for each in (law, weaker)]

    def stated(law, proof):
        bound = number(json.loads(proof.certificate)["bound"])
        return replace(routh_lag.claims(make_problem(law), law)[0], bound=bound)

    assert proofs[0].claim == proofs[1].claim
    assert proofs[0].claim_hash != proofs[1].claim_hash
    assert check_proof(stated(weaker, proofs[1]), proofs[1].certificate).accepted
    assert not check_proof(stated(weaker, proofs[0]), proofs[0].certificate).accepted


def test_laws_without_reference_claim_nothing(make_problem, make_controller):
    assert routh_lag.check(make_problem(make_controller("none"))).status is Status.NOT_APPLICABLE


def test_no_gain_at_all_is_not_stable(make_problem, make_controller, monkeypatch):
    monkeypatch.setattr(
        "wspd_design.certificates.setting.linear_loop.on_brake",
        lambda *_, **__: Feedback(proportional=0.0, integral=0.0, torque=0.0),
    )
    assert routh_lag.check(make_problem(make_controller("afsmc"))).status is Status.REFUTED
