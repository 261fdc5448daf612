"""The integration step: halving it changes nothing that counts, except where the closed loop itself is chaotic."""

from itertools import product

import pytest

from wspd_design.codegen import closed_loop
from wspd_design.parameters.loading import load_rail
from wspd_design.simulation.records import Scenario
from wspd_design.simulation.stop import simulate

CONTROLLERS = ("afsmc", "smc", "trenitalia", "knorr-bremse", "mitsubishi", "none")
RAILS = ("table10-dry", "table10-wet", "polach-dry", "polach-wet")

# Closed loops in which a change of the initial speed by 1e-9 grows to more than 1e-5 of the distance: the rules of
# Mitsubishi's table, with repeated locks, on the two wet rails. Nobody can compute these distances to 1e-6.
CHAOTIC = {("mitsubishi", "table10-wet"), ("mitsubishi", "polach-wet")}
PERTURBATIONS = (1e-9, -1e-9, 2e-9, -2e-9, 3e-9)
SPREAD = 1e-2  # of the distance, over slightly perturbed runs

CASES = list(product(CONTROLLERS, RAILS))


@pytest.fixture
def run_with(er24pc, make_controller):
    """Simulate with finer steps and a relative change of the initial speed."""

    def simulated(controller, rail, *, refinement=1, change=0.0, sample_time=0.1):
        scenario = Scenario(rail=load_rail(rail), initial_speed=120.0 / 3.6 * (1.0 + change))
        law = make_controller(controller, rail, sample_time=sample_time)
        return simulate(er24pc, law, scenario, plant="quarter", refinement=refinement)

    return simulated


def largest_slip_difference(one, other):
    """Largest difference of the slip at the sampling instants above 0.3 m/s."""
    fast = [(a.seen, b.seen) for a, b in zip(one.samples, other.samples, strict=False) if a.seen.speed > 0.3]
    assert len(fast) > 90
    return max(0.55 * abs(a.wheel_speed / a.speed - b.wheel_speed / b.speed) for a, b in fast)


@pytest.mark.parametrize(("controller", "rail"), [case for case in CASES if case not in CHAOTIC])
def test_half_the_step_gives_the_same_stop(stop, run_with, controller, rail):
    whole, half = stop(controller, rail), run_with(controller, rail, refinement=2)
    assert half.totals.distance == pytest.approx(whole.totals.distance, rel=1e-6)
    assert largest_slip_difference(whole, half) < 1e-4


@pytest.mark.parametrize(
    ("controller", "rail"), [("trenitalia", "polach-wet"), ("mitsubishi", "table10-dry")]
)
def test_a_small_perturbation_stays_small_elsewhere(stop, run_with, controller, rail):
    whole, other = stop(controller, rail), run_with(controller, rail, change=1e-9)
    assert other.totals.distance == pytest.approx(whole.totals.distance, rel=1e-6)


@pytest.mark.parametrize(("controller", "rail"), sorted(CHAOTIC))
def test_chaotic_loops_have_a_spread_and_not_a_digit(stop, run_with, controller, rail):
    distance = stop(controller, rail).totals.distance
    perturbed = [run_with(controller, rail, change=change).totals.distance for change in PERTURBATIONS]
    spread = (max(perturbed) - min(perturbed)) / distance
    assert 1e-5 < spread < SPREAD  # it is chaotic, and this much is known of it
    half = run_with(controller, rail, refinement=2).totals.distance
    assert abs(half - distance) / distance < SPREAD


# Faults planted in the compiled loop: what is replaced, and by what.
FAULTS = {
    "steps that run across the valve edges": (
        "edge = edge < before ? edge : 1e300;",
        "edge = 1e300;",
    ),
    "the method of Euler": (
        "step[s] * (1.0 / 6.0) * SUM(ACCELERATION)",
        "step[s] * ACCELERATION(0)",
    ),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_of_the_integration_fails_this_test(monkeypatch, run_with, fault):
    true = closed_loop.closed_loop_source
    old, new = FAULTS[fault]

    def faulty(*arguments, **options):
        source = true(*arguments, **options)
        assert old in source
        return source.replace(old, new)

    monkeypatch.setattr(closed_loop, "closed_loop_source", faulty)
    period = 0.0973  # s; at 0.1 s the steps end at the valve edges anyhow
    whole, half = (run_with("trenitalia", "polach-wet", refinement=n, sample_time=period) for n in (1, 2))
    apart = abs(half.totals.distance / whole.totals.distance - 1.0)
    assert apart > 1e-6 or largest_slip_difference(whole, half) > 1e-4
