"""The integration step: halving it changes nothing that counts, except where the closed loop itself is chaotic."""

from itertools import product

import numpy as np
import pytest

from wspd_design.parameters.loading import load_rail
from wspd_design.simulation import stop as module
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
def run_with(monkeypatch, er24pc, make_controller):
    """Simulate with a fraction of the steps and a relative change of the initial speed."""

    def simulated(controller, rail, *, fraction=1.0, change=0.0):
        with monkeypatch.context() as patch:
            patch.setattr(module, "LONGEST_STEP", fraction * module.LONGEST_STEP)
            patch.setattr(module, "STEPS_PER_CREEP_TIME", fraction * module.STEPS_PER_CREEP_TIME)
            scenario = Scenario(rail=load_rail(rail), initial_speed=120.0 / 3.6 * (1.0 + change))
            return simulate(er24pc, make_controller(controller, rail), scenario)

    return simulated


def largest_slip_difference(one, other):
    """Largest difference of the slip at common instants above 0.3 m/s."""
    times = [np.round(run.time, 9) for run in (one, other)]
    _, i, j = np.intersect1d(*times, return_indices=True)
    fast = one.speed[i] > 0.3
    assert fast.sum() > 500
    return np.max(np.abs(one.slip[i, 0] - other.slip[j, 0])[fast])


@pytest.mark.parametrize(("controller", "rail"), [case for case in CASES if case not in CHAOTIC])
def test_half_the_step_gives_the_same_stop(stop, run_with, controller, rail):
    whole, half = stop(controller, rail), run_with(controller, rail, fraction=0.5)
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
    half = run_with(controller, rail, fraction=0.5).totals.distance
    assert abs(half - distance) / distance < SPREAD


def test_a_method_of_lower_order_fails_this_test(monkeypatch, run_with):
    def euler(rates, time, vector, h):
        return tuple(y + h * rate for y, rate in zip(vector, rates(time, vector), strict=True))

    monkeypatch.setattr(module, "runge_kutta", euler)
    whole, half = (run_with("trenitalia", "polach-wet", fraction=fraction) for fraction in (0.5, 0.25))
    assert abs(half.totals.distance / whole.totals.distance - 1.0) > 1e-6
    assert largest_slip_difference(whole, half) > 1e-4


def test_a_run_that_is_not_aligned_with_the_valve_edges_fails_this_test(monkeypatch, stop, run_with):
    # The planted fault: every edge is moved to the next multiple of 7 ms.
    true = module.segments

    def unaligned(command, start, end):
        edges = list(true(command, start, end))
        for k, (valve, a, b) in enumerate(edges):
            a, b = (a if k == 0 else 7e-3 * np.ceil(a / 7e-3)), (b if b == end else 7e-3 * np.ceil(b / 7e-3))
            yield valve, float(a), float(min(b, end))

    monkeypatch.setattr(module, "segments", unaligned)
    moved = run_with("trenitalia", "polach-wet")
    assert abs(moved.totals.distance / stop("trenitalia", "polach-wet").totals.distance - 1.0) > 1e-6


def test_the_method_is_of_order_four():
    # y' = y cos t, y = exp(sin t): the error falls by sixteen when the step is halved. The method moves only the
    # first two components, the states; the others are integrals of them.
    def error(steps):
        y, h = (1.0, 0.0, 0.0), 2.0 / steps
        for k in range(steps):
            y = module.runge_kutta(lambda t, y: (y[0] * np.cos(t), 0.0, y[0]), k * h, y, h)
        return abs(y[0] - np.exp(np.sin(2.0)))

    assert np.log2(error(20) / error(40)) == pytest.approx(4.0, abs=0.15)
    assert error(640) < 1e-10


def test_events_are_found_to_rounding():
    assert module.first_time(lambda h: h >= 0.3456789, 1.0) == pytest.approx(0.3456789, abs=3e-12)
