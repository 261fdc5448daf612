"""The reaching condition against the reference problem, whose supremum is known from an interval proof."""

from dataclasses import replace

import numpy as np
import pytest

from wspd_design.certificates.checks.sliding import reaching
from wspd_design.certificates.kernel.checker import check
from wspd_design.certificates.records import Status
from wspd_design.certificates.setting import domain
from wspd_design.certificates.setting.domain import MASS, SLIP, SPEED
from wspd_design.certificates.setting.model_error import mismatch
from wspd_design.certificates.setting.plant import plant_with
from wspd_design.controllers.sliding_mode import sliding_torque
from wspd_design.model.slip import slip_dynamics
from wspd_design.parameters.errors import UserError

KNOWN_SUPREMUM = 24.7935  # m/s2, enclosed by 24.793 and 24.794
PLACE = {"slip": 0.121, "speed": 2.0 * 3.6, "mass": 1.2 * 76841.0, "mu0": 0.6}


def _random_points(problem, count, seed=0):
    low, high = domain.box(problem)
    return np.random.default_rng(seed).uniform(low, high, (count, 5))


def test_supremum_of_the_reference_problem(make_reference_problem):
    found = reaching.supremum(make_reference_problem())
    assert 24.792 < found.value <= found.upper < 24.7945
    assert found.upper - found.value < 1e-3
    at = {point.name: point.value for point in found.point}
    for name, value in PLACE.items():
        assert at[name] == pytest.approx(value, rel=3e-3)


def test_gain_that_satisfies_100_000_random_points_is_refuted(make_reference_problem):
    """Sampling alone would certify a false bound; climbing from the samples finds the counterexample."""
    problem = make_reference_problem()
    sampled = np.abs(mismatch(problem, problem.controller, _random_points(problem, 100_000)).residual)
    assert sampled.max() < KNOWN_SUPREMUM - 0.5
    reserve = reaching.reserve(problem)
    for gain in (sampled.max() + reserve + 0.01, KNOWN_SUPREMUM + reserve - 0.01):
        verdict = reaching.check(make_reference_problem(gain))
        assert verdict.status is Status.REFUTED
        at = {point.name: point.value for point in verdict.witness}
        assert at["(abs(r) + eta)/rho"] > gain  # the inertia is known, so rho = 1
        assert verdict.margin.low < verdict.margin.high < 0.0
        assert verdict.margin.high == pytest.approx(gain - KNOWN_SUPREMUM - reserve, abs=2e-3)


def test_gain_above_the_supremum_is_proved(make_reference_problem):
    gain = KNOWN_SUPREMUM + reaching.reserve(make_reference_problem()) + 0.01
    problem = make_reference_problem(gain)
    verdict = reaching.check(problem)
    assert verdict.status is Status.PROVED
    assert 0.0 < verdict.margin.low < verdict.margin.high < 0.02
    assert {hypothesis.status for hypothesis in verdict.hypotheses} == {Status.PROVED}


def test_proof_is_replayed_against_the_claim_of_the_problem_alone(make_reference_problem):
    problem = make_reference_problem(30.0)
    proof = reaching.check(problem).proofs[0]
    claim, _ = reaching.claims(problem, problem.controller)
    assert check(claim, proof.certificate).accepted
    # The certificate of this problem says nothing about a heavier locomotive.
    weaker = make_reference_problem(20.0)
    demanding, _ = reaching.claims(weaker, weaker.controller)
    assert "less than is claimed" in check(demanding, proof.certificate).reason
    heavier = replace(
        problem, bounds=problem.bounds | {"mass": (problem.span("mass")[0], 1.01 * problem.span("mass")[1])}
    )
    other, _ = reaching.claims(heavier, problem.controller)
    assert "another claim" in check(other, proof.certificate).reason


def test_plot_shows_the_needed_gain_below_its_supremum(make_reference_problem):
    verdict = reaching.check(make_reference_problem(30.0))
    needed, chosen = verdict.series
    assert max(needed.y) <= 30.0 - verdict.margin.low
    assert max(needed.y) == pytest.approx(30.0 - verdict.margin.high, rel=0.01)
    assert chosen.y == (30.0, 30.0)


def test_mismatch_is_what_the_plant_does_under_the_law(make_problem, make_controller):
    """v sbar' = r - rho W0 sat(sbar / layer), with sbar' from the plant under the torque of the law."""
    law = make_controller("smc")
    problem = make_problem(law)
    points = _random_points(problem, 50, seed=4)
    known = mismatch(problem, law, points)
    for row, residual, ratio in zip(points, known.residual, known.inertia_ratio, strict=True):
        vehicle, rail = plant_with(problem, dict(zip(domain.PARAMETERS, row[MASS:], strict=True)))
        plant = slip_dynamics(vehicle, rail, row[SLIP], row[SPEED])
        error = 0.14 - row[SLIP]
        for surface in (0.5, 0.01, -0.3):
            integral = (surface - error) / law.gains.surface_rate
            torque = sliding_torque(law, row[SLIP], row[SPEED], integral)
            surface_rate = -(plant.drift + plant.gain * torque) + law.gains.surface_rate * error
            switching = (
                ratio * law.gains.switching_gain * np.clip(surface / law.gains.boundary_layer, -1.0, 1.0)
            )
            assert row[SPEED] * surface_rate == pytest.approx(residual - switching, rel=1e-9, abs=1e-9)


@pytest.mark.parametrize(("rail", "speeds"), [("polach-wet", (2.8, 33.3)), ("polach-dry", (5.0, 20.0))])
def test_the_reserve_brings_a_rolling_wheel_to_its_surface_in_time(
    make_problem, make_controller, rail, speeds
):
    """In steps of sigma = int dt/v, with the hardest deceleration that a train can have, by numbers of its own."""
    problem = make_problem(make_controller("smc", rail), rail=rail, speeds=speeds)
    vehicle = problem.vehicle
    drag = vehicle.resistance_constant + vehicle.resistance_linear * speeds[1]
    drag += vehicle.resistance_quadratic * speeds[1] ** 2
    hardest = 9.81 * problem.mu0_bounds[1] + drag / problem.mass_bounds[0]
    eta, distance, speed, step = reaching.reserve(problem), problem.slip, speeds[1], 1e-5
    while distance > 0.0:
        speed -= hardest * speed * step
        distance -= eta * step
    assert speed >= speeds[0] * (1.0 - 1e-3)
    assert speed <= speeds[0] * (1.0 + 1e-3)  # a larger reserve asks for more gain than the surface needs


def test_unknown_inertia_asks_for_more_gain(make_problem, make_controller):
    law = make_controller("smc")
    known = make_problem(law, bounds={"wheelset inertia": (law.vehicle.wheelset_inertia,) * 2})
    assert reaching.required_gain(make_problem(law)).value > reaching.required_gain(known).value
    expected = reaching.supremum(known).value + reaching.reserve(known)
    assert reaching.required_gain(known).value == pytest.approx(expected, abs=1e-4)


def test_laws_without_friction_model_have_no_reaching_condition(make_problem, make_controller):
    problem = make_problem(make_controller("afsmc"))
    assert reaching.check(problem).status is Status.NOT_APPLICABLE
    with pytest.raises(UserError, match="friction model"):
        reaching.supremum(problem)
