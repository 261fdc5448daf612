"""Bounds of the repaired adaptive law against its runs, and the refutation of (44) against differences."""

from dataclasses import replace

import numpy as np
import pytest

from wspd_design.certificates.checks.adaptive import afsmc_energy
from wspd_design.certificates.checks.ideal_run import adaptive_run
from wspd_design.certificates.records import Status
from wspd_design.certificates.setting.domain import varied
from wspd_design.controllers.adaptive_fuzzy import firing_strengths
from wspd_design.model.generated import adaptive_fuzzy as generated
from wspd_design.model.number import saturation
from wspd_design.model.slip import slip_dynamics

RAILS = ("polach-dry", "polach-wet")


def designed(make_controller, **changes):
    """Repaired law with gains of the size that the design rules choose."""
    law = make_controller("afsmc-repaired")
    gains = replace(
        law.gains,
        proportional_gain=1.0,
        integral_gain=0.4,
        boundary_layer=0.025,
        weight_rate=92.0,
        bound_rate=92.0,
        initial_weights=(25.0,) * 5,
        initial_bound=20.0,
        centres=(-0.14, -0.07, 0.0, 0.07, 0.14),
        widths=(0.042,) * 5,
    )
    return replace(law, gains=replace(gains, **changes))


@pytest.mark.parametrize("rail", RAILS)
def test_printed_claim_is_refuted_at_a_state(make_problem, make_controller, rail):
    """V2' by differences along the flow, for many admissible ideal weights and bounds, is above the stated value."""
    law = make_controller("afsmc")
    problem = make_problem(law, rail=rail)
    verdict = afsmc_energy.check(problem)
    assert verdict.status is Status.REFUTED
    assert verdict.margin.high < 0.0
    at = {point.name: point.value for point in verdict.witness}
    speed, gains, unit = at["speed"] / 3.6, law.gains, law.gains.torque_unit
    plant = slip_dynamics(problem.vehicle, problem.rail, 0.14, speed)
    ideal = -plant.drift / plant.gain / unit
    w = np.array(firing_strengths(gains, 0.0))
    rng, found = np.random.default_rng(0), []
    for _ in range(500):
        weights = np.array(gains.initial_weights) + rng.normal(size=5) * rng.choice([0.1, 3.0, 30.0])
        bound = abs(ideal - weights @ w) + rng.exponential(0.5)  # any that (34) admits
        squares = unit**2 * np.sum((weights - gains.initial_weights) ** 2)

        def candidate(v, squares=squares, error=unit * (bound - gains.initial_bound)):
            gain = problem.vehicle.wheel_radius / (problem.vehicle.wheelset_inertia * v)
            rates = unit * gains.weight_rate, unit * gains.bound_rate
            return generated.lyapunov_printed(0.0, gain, squares, error, gains.proportional_gain, *rates)

        # At s = 0 only the speed moves V2.
        step = 1e-5 * speed
        slope = (candidate(speed - step) - candidate(speed + step)) / (2.0 * step)
        found.append(slope * plant.deceleration)
    assert min(found) >= at["least dV2/dt"] * (1.0 - 1e-6)
    assert min(found) < 5.0 * at["least dV2/dt"]


def test_law_that_knows_its_torque_is_not_refuted_there(make_problem, make_controller):
    law = make_controller("afsmc")
    generous = replace(law, gains=replace(law.gains, initial_bound=100.0))
    verdict = afsmc_energy.check(make_problem(generous))
    assert verdict.status is Status.UNDECIDED
    assert not verdict.witness


@pytest.fixture(scope="module", params=RAILS)
def repaired(request, make_problem, make_controller):
    problem = make_problem(designed(make_controller), rail=request.param, slips=(0.02, 0.4))
    return problem, afsmc_energy.check(problem)


def test_hypotheses_have_their_own_verdicts(repaired):
    _, verdict = repaired
    found = [hypothesis.status for hypothesis in verdict.hypotheses]
    assert found[: afsmc_energy.LIMITS] == [Status.PROVED] * afsmc_energy.LIMITS
    assert verdict.status is (Status.PROVED if set(found) == {Status.PROVED} else Status.UNDECIDED)
    assert len(verdict.proofs) == 3


def test_runs_keep_the_bounds(repaired):
    problem, verdict = repaired
    at = {point.name: point.value for point in verdict.worst_point}
    gains = problem.controller.gains
    for mass, inertia, mu0 in ((76841.0, 752.0, 1.0), (61473.0, 860.0, 0.8), (92209.0, 640.0, 1.2)):
        vehicle, rail = varied(problem, mass, inertia, mu0 * problem.rail.mu0)
        run = adaptive_run(vehicle, rail, gains, speeds=problem.speeds)
        surface = 0.14 - run.slip + gains.integral_gain * run.integral
        dead = surface - gains.boundary_layer * saturation(surface / gains.boundary_layer)
        assert np.trapezoid(np.abs(dead), run.time) <= at["bound of the integral of abs(s_D)"]
        assert gains.torque_unit * run.states[-1].max() <= at["bound of psi_hat"]


def test_brake_that_suffices_makes_it_a_proof(make_problem, make_controller):
    """A slippery, exactly known rail and a narrow range of slip leave room to apply and to release."""
    law = designed(make_controller)
    problem = make_problem(law, rail="polach-wet", slips=(0.05, 0.3), mu0_bounds=(0.28, 0.3))
    verdict = afsmc_energy.check(problem)
    assert verdict.status is Status.PROVED
    assert verdict.margin.low > 0.0


@pytest.mark.parametrize(
    "changes",
    [
        {"hold_when_saturated": False},
        {"weight_rate": -92.0},
        {"integral_gain": 0.0},
        {"bound_rate": float("nan")},
        {"boundary_layer": float("nan")},
    ],
)
def test_planted_law_loses_a_hypothesis(make_problem, make_controller, changes):
    law = designed(make_controller, **changes)
    problem = make_problem(law, rail="polach-wet", slips=(0.05, 0.3), mu0_bounds=(0.28, 0.3))
    verdict = afsmc_energy.check(problem)
    assert verdict.status is Status.UNDECIDED
    assert Status.REFUTED in {hypothesis.status for hypothesis in verdict.hypotheses}


def test_train_that_accelerates_is_seen(make_problem, make_controller, er24pc):
    pushed = replace(er24pc, resistance_constant=-150e3)
    verdict = afsmc_energy.check(make_problem(designed(make_controller), vehicle=pushed))
    assert verdict.status is not Status.PROVED
    assert {h.text: h.status for h in verdict.hypotheses}[
        "the train decelerates, a >= 0, on the domain"
    ] is Status.REFUTED


@pytest.mark.parametrize("name", ["smc", "none"])
def test_other_laws(make_problem, make_controller, name):
    assert afsmc_energy.check(make_problem(make_controller(name))).status is Status.NOT_APPLICABLE
