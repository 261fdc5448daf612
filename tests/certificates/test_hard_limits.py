"""What full venting brings back: against SciPy at single points, and with faults that must be seen."""

import json
import math
from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from wspd_design.certificates.checks.valve import hard_limits
from wspd_design.certificates.kernel.file import certificate_text
from wspd_design.certificates.records import Status
from wspd_design.certificates.replay import replay
from wspd_design.certificates.search import recovery, recovery_samples
from wspd_design.certificates.setting import domain
from wspd_design.certificates.setting.domain import INERTIA, MASS, MU0, SLIP, SPEED
from wspd_design.model.slip import slip_dynamics


@pytest.fixture(scope="module")
def dry(make_problem, make_controller):
    return make_problem(make_controller("afsmc"))


@pytest.fixture(scope="module")
def wet(make_problem, make_controller):
    return make_problem(make_controller("smc", "polach-wet"), rail="polach-wet")


@pytest.fixture(scope="module")
def refuted(dry):
    return hard_limits.check(dry)


@pytest.fixture(scope="module")
def proved(wet):
    return hard_limits.check(wet)


def nominal(problem, speeds):
    points = np.empty((len(speeds), 5))
    points[:, SLIP], points[:, SPEED], points[:, MU0] = problem.slip, speeds, problem.rail.mu0
    points[:, MASS], points[:, INERTIA] = problem.vehicle.mass, problem.vehicle.wheelset_inertia
    return points


def pinned(problem):
    """Return the problem without uncertainty."""
    vehicle, mu0 = problem.vehicle, problem.rail.mu0
    inertia = (vehicle.wheelset_inertia,) * 2
    return replace(problem, mass_bounds=(vehicle.mass,) * 2, inertia_bounds=inertia, mu0_bounds=(mu0, mu0))


def leaves(problem, point, deviation):
    """Integrate slip and torque forwards: held for a sample, then vented; does the slip pass the highest?"""
    vehicle, rail = domain.varied(problem, point[MASS], point[INERTIA], point[MU0])
    brake, speed, reference = vehicle.brake, point[SPEED], problem.slip
    at = slip_dynamics(vehicle, rail, reference, speed)
    torque = min(-at.drift / at.gain, brake.max_torque)

    def rates(time, state):
        plant = slip_dynamics(vehicle, rail, state[0], speed)
        return [
            plant.drift + plant.gain * state[1],
            -state[1] / brake.vent_time * (time > problem.sample_time),
        ]

    def above(_, state):
        return state[0] - problem.slips[1]

    def back(_, state):
        return state[0] - reference

    above.terminal = back.terminal = True
    run = solve_ivp(
        rates, (0.0, 60.0), [reference + deviation, torque], events=(above, back), max_step=0.01, rtol=1e-7
    )
    assert run.status == 1
    return bool(run.t_events[0].size)


def slip_when_seen(problem, point, deviation):
    """Integrate the slip under the torque that held it, for one sample."""
    vehicle, rail = domain.varied(problem, point[MASS], point[INERTIA], point[MU0])
    holding = -slip_dynamics(vehicle, rail, problem.slip, point[SPEED]).drift

    def rate(_, state):
        return [slip_dynamics(vehicle, rail, state[0], point[SPEED]).drift + holding]

    run = solve_ivp(rate, (0.0, problem.sample_time), [problem.slip + deviation], rtol=1e-9)
    return run.y[0, -1]


@pytest.mark.parametrize("speed", [3.0, 7.0, 20.0])
def test_recoverable_deviation_parts_runs_that_return_from_runs_that_do_not(dry, speed):
    (point,) = nominal(dry, [speed])
    (found,) = recovery.recoverable(dry, point[None])
    assert not leaves(dry, point, 0.995 * found)
    assert leaves(dry, point, 1.005 * found)


def test_balls_are_certain_just_beyond_the_recoverable_deviation(dry):
    points = nominal(dry, [3.0, 7.0, 20.0])
    for point, found in zip(points, recovery.recoverable(dry, points), strict=True):
        assert recovery.passes(dry, point, 0.98 * found) is None
        at = slip_dynamics(dry.vehicle, dry.rail, dry.slip, point[SPEED])
        seen = recovery.passes(dry, point, 1.05 * found)
        assert seen.torque == pytest.approx(-at.drift / at.gain, rel=1e-6)
        assert seen.slip <= slip_when_seen(dry, point, 1.05 * found) <= 1.02 * seen.slip


def drawn_within(problem, speed, *, count=1000):
    """Points of the domain at a speed, at random."""
    low, high = domain.slip_held(problem)
    low[SPEED] = high[SPEED] = speed
    return np.random.default_rng(9).uniform(low, high, (count, 5))


def overlooked(problem, samples):
    """Speeds at which a point at random is worse than the worst of the samples."""
    return [
        speed
        for speed, worst in zip(samples.speeds[::8], samples.worst[::8], strict=True)
        if recovery.recoverable(problem, drawn_within(problem, speed)).min() < 0.999 * worst
    ]


def test_the_worst_lies_where_the_brake_just_holds_the_reference(dry):
    """A wheel that is too heavily loaded for T_max, one sample late, comes back the easier."""
    samples = recovery_samples.sample(dry)
    assert not overlooked(dry, samples)
    assert np.all(np.diff(np.diff(samples.worst[samples.speeds < 10.0])) > -1e-3)  # no bump
    slow = int(np.searchsorted(samples.speeds, 24.0 / domain.KMH))
    point, worst = samples.tightest[slow], samples.worst[slow]
    assert dry.mass_bounds[0] < point[MASS] < dry.mass_bounds[1]
    plant = domain.dynamics(dry, point[None])
    assert -plant.drift / plant.gain == pytest.approx(dry.vehicle.brake.max_torque, rel=1e-9)
    assert not leaves(dry, point, 0.99 * worst)
    assert leaves(dry, point, 1.01 * worst)


def test_corners_alone_are_too_hopeful(dry, monkeypatch):
    monkeypatch.setattr(recovery_samples, "just_held", lambda _problem, points, _column: points)
    assert len(overlooked(dry, recovery_samples.sample(dry))) > 3


@pytest.mark.parametrize("rail", ["polach-dry", "polach-wet", "table10-dry"])
def test_no_guarantee_exceeds_what_integration_finds(make_problem, make_controller, rail):
    problem = make_problem(make_controller("afsmc"), rail=rail)
    points = np.random.default_rng(8).uniform(*domain.slip_held(problem), (300, 5))
    fall = -domain.dynamics(problem, points).drift
    shares = []
    for slip in np.linspace(problem.slip, problem.slips[1], 60):
        points[:, SLIP] = slip
        pole = domain.dynamics(problem, points).pole
        shares.append(recovery.per_deviation(problem, pole, pole / fall))
    guaranteed = np.minimum(1.0 / np.max(shares, axis=0), recovery.reach(problem))
    assert np.all(guaranteed <= 1.0001 * recovery.recoverable(problem, points))


def test_a_straight_line_of_friction_leaves_the_linear_limit(dry):
    """With one slope p and much room the condition is d exp(p h) <= g/(p (1 + p tau))."""
    wide = replace(dry, slips=(0.02, 1e6))
    pole, fall, lag = 5.0, 3.0, dry.vehicle.brake.vent_time
    limit = fall / (pole * (1.0 + pole * lag)) * math.exp(-pole * dry.sample_time)
    assert 1.0 / recovery.per_deviation(wide, pole, pole / fall) == pytest.approx(limit, rel=1e-9)


def test_growth_is_that_of_a_small_deviation(dry, refuted):
    (growth,) = (proof for proof in refuted.proofs if proof.claim == "growth within a sample")
    bound = float(json.loads(growth.certificate)["bound"])
    corners = product(
        np.linspace(dry.slip, dry.slips[1], 60),
        dry.speeds[:1],
        dry.mass_bounds,
        dry.inertia_bounds,
        dry.mu0_bounds,
    )
    points = np.array(list(corners))
    poles = domain.dynamics(dry, points).pole
    slip, speed, *plant = points[poles.argmax()]
    vehicle, rail = domain.varied(dry, *plant)
    holding = -slip_dynamics(vehicle, rail, slip, speed).drift

    def rate(_, state):
        return [slip_dynamics(vehicle, rail, state[0], speed).drift + holding]

    run = solve_ivp(rate, (0.0, dry.sample_time), [slip + 1e-6], rtol=1e-10, atol=1e-13)
    grown = (run.y[0, -1] - slip) / 1e-6
    assert grown == pytest.approx(math.exp(dry.sample_time * poles.max()), rel=1e-3)
    assert 0.999 * grown <= bound <= 1.01 * grown


def test_dry_rail_at_the_printed_sample_time_is_refuted(dry, refuted):
    assert refuted.status is Status.REFUTED
    assert refuted.margin.high < 0.0
    at = {point.name: point.value for point in refuted.witness}
    point = np.array([dry.slip, at["speed"] / domain.KMH, at["mass"], at["wheelset inertia"], at["mu0"]])
    assert at["slip"] == pytest.approx(slip_when_seen(dry, point, hard_limits.DEVIATION), rel=0.01)
    assert leaves(dry, point, hard_limits.DEVIATION)
    assert not leaves(dry, point, 0.99 * at["recoverable deviation"])
    assert "The lowest controllable speed lies between" in refuted.explanation


def test_wet_rail_is_proved(wet, proved):
    assert proved.status is Status.PROVED
    assert proved.margin.low > 0.0
    points = np.random.default_rng(10).uniform(*domain.box(wet), (500, 5))
    found = recovery.recoverable(wet, points).min()
    assert (
        hard_limits.DEVIATION + proved.margin.low
        <= found
        <= 1.05 * (hard_limits.DEVIATION + proved.margin.high)
    )
    assert found >= 0.999 * (hard_limits.DEVIATION + proved.margin.high)


def test_lowest_speed_agrees_with_the_root_at_nominal_parameters(dry):
    problem = pinned(dry)
    samples = recovery_samples.sample(problem)

    def excess(speed):
        fall = -slip_dynamics(dry.vehicle, dry.rail, dry.slip, speed).drift
        pole = slip_dynamics(
            dry.vehicle, dry.rail, np.linspace(dry.slip, dry.slips[1], 400), speed
        ).pole.max()
        grown, lag = hard_limits.DEVIATION * math.exp(pole * dry.sample_time), dry.vehicle.brake.vent_time
        return (grown / 0.46) ** 2 + grown * pole * (1.0 + pole * lag) / fall - hard_limits.TIGHT

    # TIGHT is a share of the deviation; the condition is between linear and quadratic in it.
    root = brentq(excess, 10.0, 30.0)
    found = hard_limits.lowest_speed(problem, samples)
    step = (problem.speeds[1] / problem.speeds[0]) ** (1.0 / (recovery_samples.SPEEDS - 1))
    assert root / step <= found <= root * step


def test_larger_deviation_is_refuted(monkeypatch, wet):
    monkeypatch.setattr(hard_limits, "DEVIATION", 0.4)
    assert hard_limits.check(wet).status is Status.REFUTED


def test_a_refutation_that_is_not_certain_is_none(monkeypatch, dry):
    monkeypatch.setattr(hard_limits, "passes", lambda *_: None)
    found = hard_limits.check(dry)
    assert found.status is Status.UNDECIDED
    assert not found.witness
    assert 0.0 < found.undecided < 1.0


def test_it_speaks_about_every_law_and_the_valve_decides(
    make_problem, make_controller, fast_vehicle, refuted
):
    other = hard_limits.check(make_problem(make_controller("trenitalia", sample_time=0.1)))
    assert (other.status, other.margin) == (refuted.status, refuted.margin)
    quick = make_problem(make_controller("afsmc", sample_time=0.01), vehicle=fast_vehicle)
    assert hard_limits.check(quick).status is Status.PROVED


@pytest.mark.parametrize("slips", [(0.02, 0.18), (0.2, 0.6)])
def test_no_room_leaves_it_undecided(dry, slips):
    found = hard_limits.check(replace(dry, slips=slips))
    assert found.status is Status.UNDECIDED
    assert "no room" in found.claim


def forged(certificate, problem, **changes):
    """Replay a file with another content of the last proof."""
    content = json.loads(certificate_text(certificate))
    content["proofs"][-1].update(changes)
    return replay(problem, json.dumps(content))


def test_files_are_accepted(dry, wet, refuted, proved):
    found = replay(wet, certificate_text(proved))
    assert found.accepted
    assert not found.missing
    found = replay(dry, certificate_text(refuted))
    assert found.accepted, found.reason
    assert "for speed from" in found.shown[-1]


def test_forged_files_are_refused(dry, wet, refuted, proved):
    assert not forged(proved, wet, bound="0.3").accepted
    assert not forged(proved, replace(wet, sample_time=0.12)).accepted
    assert not forged(refuted, dry, part={"speed": [repr(dry.speeds[0]), repr(dry.speeds[1])]}).accepted


def test_arranged_form_is_the_model_also_with_a_fixed_contact(make_reference_problem):
    problem = replace(make_reference_problem(1.0), speeds=(25.0, 33.0), mu0_bounds=(0.3, 0.4))
    assert hard_limits.check(problem).status is Status.PROVED
