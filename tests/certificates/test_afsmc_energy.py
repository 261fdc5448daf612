"""Bounds of the repaired adaptive law against its runs, and the refutation of (44) against differences."""

from dataclasses import replace

import numpy as np
import pytest

from tests.certificates.round_trip import keep, no_proof_can_be_missed, no_word_can_be_changed, refused
from wspd_design.certificates.checks.adaptive import afsmc_energy
from wspd_design.certificates.checks.ideal_run import adaptive_run
from wspd_design.certificates.records import Status
from wspd_design.certificates.setting.plant import plant_with
from wspd_design.controllers.adaptive_fuzzy import firing_strengths
from wspd_design.model.generated import adaptive_fuzzy as generated
from wspd_design.model.number import saturation
from wspd_design.model.slip import slip_dynamics
from wspd_design.parameters.loading import load_rail

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
    kept = keep(afsmc_energy.CHECK, problem)
    verdict = kept.certificate
    assert verdict.status is Status.REFUTED
    assert verdict.margin.high < 0.0
    no_word_can_be_changed(kept)
    assert refused(kept, findings={"at s = 0": {"place": {"speed": "100.0"}}})
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
    verdict = afsmc_energy.CHECK.run(make_problem(generous))
    assert verdict.status is Status.UNDECIDED
    assert not verdict.witness


@pytest.fixture(scope="module")
def make_small(make_problem, make_controller, narrow, er24pc):
    """Make a problem on a slippery rail and a narrow range of slip: there the brake has room to apply and release."""

    def make(bounds=None, rail="polach-wet", slips=(0.05, 0.3), **changes):
        law = designed(make_controller, **changes)
        known = narrow(er24pc, load_rail(rail), mass=(70e3, 80e3), mu0=(0.28, 0.3))
        stated = (
            known | {"wheelset inertia": (700.0, 760.0), "train deceleration": (1.0, 3.2)} | (bounds or {})
        )
        return make_problem(law, rail=rail, slips=slips, bounds=stated)

    return make


@pytest.fixture(scope="module")
def proved(make_small):
    return keep(afsmc_energy.CHECK, make_small())


def test_brake_that_suffices_makes_it_a_proof(proved):
    assert proved.certificate.status is Status.PROVED
    assert proved.certificate.margin.low > 0.0
    assert {each.status for each in proved.certificate.hypotheses} == {Status.PROVED}
    no_word_can_be_changed(proved)
    no_proof_can_be_missed(proved)


def test_conditions_come_first(proved):
    """Audit A9 and M3: the slip in its range, T = u, and u* inside the limits stand before any bound."""
    claim = proved.certificate.claim
    places = [
        claim.index(part)
        for part in ("slip stays between", "T = u", "eta/g <= u* <= T_max - eta/g", "integral of")
    ]
    assert places == sorted(places)
    assert "A stop begins with slip 0" in proved.certificate.explanation


def test_runs_keep_the_bounds(proved):
    problem = proved.problem
    at = {point.name: point.value for point in proved.certificate.worst_point}
    gains = problem.controller.gains
    for mass, inertia, mu0 in ((76841.0, 752.0, 0.3), (70e3, 760.0, 0.28), (80e3, 700.0, 0.3)):
        vehicle, rail = plant_with(problem, {"mass": mass, "wheelset inertia": inertia, "mu0": mu0})
        run = adaptive_run(vehicle, rail, gains, speeds=problem.speeds)
        surface = 0.14 - run.slip + gains.integral_gain * run.integral
        dead = surface - gains.boundary_layer * saturation(surface / gains.boundary_layer)
        assert np.trapezoid(np.abs(dead), run.time) <= at["bound on the integral of abs(s_D)"]
        assert gains.torque_unit * run.states[-1].max() <= at["bound on psi_hat"]


def test_torque_beyond_the_brake_refutes_the_claim(make_small):
    """performance.md section 5: where the least margin is negative, the claim is false, not open."""
    kept = keep(afsmc_energy.CHECK, make_small({"mu0": (0.28, 0.9)}))
    assert kept.certificate.status is Status.REFUTED
    assert kept.certificate.margin.high < 0.0
    at = {point.name: point.value for point in kept.certificate.witness}
    assert at["u* + eta/g"] > kept.problem.span("max torque")[0]
    assert refused(kept, status="PROVED")
    assert refused(kept, status="UNDECIDED")


def test_energy_rises_where_the_torque_is_limited(make_small):
    """Audit M3: u* 65 kN m under T_max 60 kN m and s_D .05 make V' = +245 N m, with the adaptation held."""
    problem = make_small()
    per_inertia = problem.vehicle.wheel_radius / problem.vehicle.wheelset_inertia
    rate = generated.lyapunov_repaired_rate(0.05, 3.0, per_inertia, 65e3 - 60e3, 0.0)
    assert rate == pytest.approx(245.0, abs=1.0)


@pytest.mark.parametrize(
    "changes", [{"hold_when_saturated": False}, {"weight_rate": -92.0}, {"integral_gain": 0.0}]
)
def test_planted_law_loses_a_hypothesis(make_small, changes):
    verdict = afsmc_energy.CHECK.run(make_small(**changes))
    assert verdict.status is Status.UNDECIDED
    assert Status.REFUTED in {hypothesis.status for hypothesis in verdict.hypotheses}


@pytest.mark.parametrize("changes", [{"bound_rate": float("nan")}, {"boundary_layer": float("nan")}])
def test_a_law_that_is_not_a_number_is_not_judged(make_small, changes):
    assert afsmc_energy.CHECK.run(make_small(**changes)).status is Status.NOT_APPLICABLE


def test_train_that_accelerates_is_seen(make_small):
    problem = make_small({"resistance constant": (-150e3, -150e3)})
    verdict = afsmc_energy.CHECK.run(problem)
    assert verdict.status is not Status.PROVED


@pytest.mark.parametrize("name", ["smc", "none"])
def test_other_laws(make_problem, make_controller, name):
    assert afsmc_energy.CHECK.run(make_problem(make_controller(name))).status is Status.NOT_APPLICABLE
