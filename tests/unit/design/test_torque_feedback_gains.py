"""The rules of the static law with torque feedback, against the loop written out at random points of the domain."""

import re
from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import expm

from wspd_design.certificates.checks.linear import routh_lag
from wspd_design.certificates.checks.region import lpv_lyapunov
from wspd_design.certificates.records import Status
from wspd_design.design.problem import stability_problem
from wspd_design.design.records import Specification
from wspd_design.design.selection import design_controller
from wspd_design.model.slip import slip_dynamics
from wspd_design.parameters.loading import load_rail

LAG = 0.6  # s, of the paper's valve
RAILS = ("polach-dry", "polach-wet", "table10-dry", "eurosprinter127")


def designed(vehicle, rail, **specification):
    return design_controller(vehicle, load_rail(rail), Specification(**specification), law="torque-feedback")


def reason(made, name):
    return next(gain.why for gain in made.gains if gain.name == name)


def loops(vehicle, rail, count=2000, speeds=(10.0 / 3.6, 120.0 / 3.6)):
    """Pairs of q = p - a/v [1/s] and gamma = R T_max/inertia [m/s2] at random points of the domain and its corners."""
    friction, rng = load_rail(rail), np.random.default_rng(3)
    ends = (speeds, vehicle.mass_bounds, vehicle.wheelset_inertia_bounds, friction.mu0_bounds)
    draws = [np.concatenate([rng.uniform(*end, count), rng.choice(end, count)]) for end in ends]
    draws[0] = rng.uniform(*speeds, 2 * count)
    speed, mass, inertia, mu0 = draws
    step = 1e-5

    def rate(slip, speed):
        """Rate of the sliding speed v slip without torque, whose slope at fixed sliding speed error is q."""
        at = slip_dynamics(
            replace(vehicle, mass=mass, wheelset_inertia=inertia), replace(friction, mu0=mu0), slip, speed
        )
        return at.drift, at.deceleration

    (above, _), (below, _), (_, braking) = (rate(0.14 + d, speed) for d in (step, -step, 0.0))
    return (above - below) / (2.0 * step) - braking / speed, vehicle.wheel_radius * 6e4 / inertia


def kept(q, gamma, kappa, back, period):
    """Largest eigenvalue of the loop from one sample to the next, with the duty held."""
    plant = np.array([[q, -gamma, 0.0], [0.0, -1.0 / LAG, 1.0 / LAG], [0.0, 0.0, 0.0]])
    step = expm(plant * period)
    return np.abs(np.linalg.eigvals(step[:2, :2] + np.outer(step[:2, 2], [kappa, -back]))).max()


def worst(vehicle, rail, kappa, back, period, count=60):
    """The same over the domain: where q is largest and smallest, and at some points between."""
    q, gamma = loops(vehicle, rail)
    order = np.argsort(q)
    chosen = np.unique(np.concatenate([order[:20], order[-20:], order[:: len(order) // count]]))
    return max(kept(q[k], gamma[k], kappa, back, period) for k in chosen)


@pytest.mark.parametrize("period", [0.01, 0.02, 0.1])
def test_torque_settles_within_a_sample(er24pc, period):
    made = designed(er24pc, "polach-wet", sample_time=period)
    assert (1.0 + made.gain("torque_gain")) / LAG == pytest.approx(1.0 / period)


@pytest.mark.parametrize("rail", RAILS)
def test_slow_pole_is_fast_enough_everywhere(er24pc, rail):
    made = designed(er24pc, rail, sample_time=0.02)
    q, gamma = loops(er24pc, rail)
    line = made.gain("sliding_gain") / (1.0 + made.gain("torque_gain"))
    slow = gamma * line - q
    assert slow.min() >= 2.0 / LAG - 1e-6
    # Nor is it chosen out of all proportion: where q is largest, the heaviest wheelset would leave omega alone.
    assert line * er24pc.wheel_radius * 6e4 / 860.0 - max(q.max(), 0.0) < 1.1 * 2.0 / LAG


@pytest.mark.parametrize("rail", RAILS)
@pytest.mark.parametrize("period", [0.01, 0.02])
def test_sampled_loop_is_stable_on_the_domain(er24pc, rail, period):
    made = designed(er24pc, rail, sample_time=period)
    gains = made.gain("sliding_gain"), made.gain("torque_gain")
    stated = float(re.search(r"keeps at most ([\d.]+) of", reason(made, "torque_gain"))[1])
    assert worst(er24pc, rail, *gains, period) <= stated + 0.005 < 1.0
    # The same look sees a loop without torque feedback, and on the dry rail half the sliding gain.
    assert worst(er24pc, rail, gains[0], 0.0, period) > 1.0
    if rail == "polach-dry":
        assert worst(er24pc, rail, 0.5 * gains[0], gains[1], period) > 1.0


def test_a_sample_time_that_is_too_long_is_said(er24pc):
    dry = reason(designed(er24pc, "polach-dry"), "torque_gain")
    assert "not stable near the reference" in dry
    longest = float(re.search(r"less than (\d+) ms", dry)[1]) * 1e-3
    assert 0.02 < longest < 0.1
    for period, stable in ((0.9 * longest, True), (1.1 * longest, False)):
        made = designed(er24pc, "polach-dry", sample_time=period)
        gains = made.gain("sliding_gain"), made.gain("torque_gain")
        assert (worst(er24pc, "polach-dry", *gains, period) < 1.0) == stable
        assert ("not stable" not in reason(made, "torque_gain")) == stable
    # On the wet rail the default sample time will do.
    assert "not stable" not in reason(designed(er24pc, "polach-wet"), "torque_gain")


def test_reasons_repeat_the_numbers(er24pc):
    made = designed(er24pc, "polach-dry", sample_time=0.02)
    why = reason(made, "sliding_gain")
    q, _ = loops(er24pc, "polach-dry")
    stated = float(re.search(r"q = p - a/v = ([\d.]+) 1/s", why)[1])
    assert 0.98 * stated < q.max() < stated + 0.05
    assert "heaviest wheelset of 860 kg m^2" in why
    assert "mu0 0.66" in why
    assert "tau = 0.6 s and h = 0.02 s" in reason(made, "torque_gain")


def test_gains_follow_the_bounds(er24pc):
    def sliding(vehicle, rail):
        made = design_controller(vehicle, rail, Specification(sample_time=0.02), law="torque-feedback")
        return made.gain("sliding_gain")

    rail = load_rail("polach-dry")
    usual = sliding(er24pc, rail)
    assert sliding(er24pc, replace(rail, mu0_bounds=(0.44, 0.8))) > 1.05 * usual
    assert sliding(replace(er24pc, wheelset_inertia_bounds=(640.0, 1100.0)), rail) > 1.05 * usual
    slow = replace(er24pc, brake=replace(er24pc.brake, fill_time=0.9))
    assert sliding(slow, rail) > 1.1 * usual  # K grows with the slower of both time constants


def test_a_sample_as_long_as_the_valve_leaves_no_torque_feedback(er24pc):
    made = designed(er24pc, "table10-wet", sample_time=0.8)
    assert made.gain("torque_gain") == 0.0
    assert made.gain("sliding_gain") > 0.0


@pytest.mark.parametrize("rail", ["polach-dry", "polach-wet"])
def test_the_design_passes_its_own_certificates(er24pc, rail):
    specification = Specification(sample_time=0.02)
    made, friction = designed(er24pc, rail, sample_time=0.02), load_rail(rail)
    controller = made.build(er24pc, friction)
    problem = stability_problem(er24pc, friction, controller, specification)
    assert routh_lag.check(problem).status is Status.PROVED
    assert lpv_lyapunov.check(problem).status is Status.PROVED
    weak = replace(
        controller, gains=replace(controller.gains, sliding_gain=0.2 * controller.gains.sliding_gain)
    )
    assert lpv_lyapunov.check(replace(problem, controller=weak)).status is Status.REFUTED
