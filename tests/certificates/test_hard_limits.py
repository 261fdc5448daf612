"""What full venting brings back: against SciPy at single points, and with faults that must be seen."""

import json
import math
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tests.certificates.round_trip import keep, no_word_can_be_changed, not_for, refused
from wspd_design.certificates.checks.frame import accepted
from wspd_design.certificates.checks.valve import hard_limits
from wspd_design.certificates.kernel.checker import Refused, Work
from wspd_design.certificates.kernel.file import certificate_text
from wspd_design.certificates.quantities import QUANTITIES
from wspd_design.certificates.records import Status
from wspd_design.certificates.replay import replay
from wspd_design.certificates.search import recovery_samples
from wspd_design.certificates.search.recovery_samples import recoverable
from wspd_design.certificates.search.settle import enclose
from wspd_design.certificates.setting import domain
from wspd_design.certificates.setting.domain import INERTIA, MASS, MU0, SLIP, SPEED
from wspd_design.certificates.setting.plant import dynamics_at, plant_with
from wspd_design.certificates.theorems import recovery
from wspd_design.certificates.theorems.theorem import told
from wspd_design.model.slip import slip_dynamics


@pytest.fixture(scope="module")
def dry(make_problem, make_controller):
    return make_problem(make_controller("afsmc"))


@pytest.fixture(scope="module")
def wet(make_problem, make_controller):
    return make_problem(make_controller("smc", "polach-wet"), rail="polach-wet")


@pytest.fixture(scope="module")
def refuted_file(dry):
    return keep(hard_limits.CHECK, dry)


@pytest.fixture(scope="module")
def proved_file(wet):
    return keep(hard_limits.CHECK, wet)


@pytest.fixture(scope="module")
def refuted(refuted_file):
    return refuted_file.certificate


@pytest.fixture(scope="module")
def proved(proved_file):
    return proved_file.certificate


def nominal(problem, speeds):
    points = np.empty((len(speeds), 5))
    points[:, SLIP], points[:, SPEED], points[:, MU0] = problem.slip, speeds, problem.rail.mu0
    points[:, MASS], points[:, INERTIA] = problem.vehicle.mass, problem.vehicle.wheelset_inertia
    return points


def numbers(problem, point):
    """Speed and numbers of the plant at a point of the basic columns, with the nominal venting time."""
    basic = dict(zip(domain.BASIC, map(float, point), strict=True))
    return {
        "vent time": problem.vehicle.brake.vent_time,
        **{name: basic[name] for name in basic if name != "slip"},
    }


def certain(problem, point, deviation):
    return recovery.passes(problem, numbers(problem, point), deviation, Work())


def leaves(problem, point, deviation):
    """Integrate slip and torque forwards: held for a sample, then vented; does the slip pass the highest?"""
    vehicle, rail = plant_with(problem, dict(zip(domain.PARAMETERS, point[MASS:], strict=True)))
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
    vehicle, rail = plant_with(problem, dict(zip(domain.PARAMETERS, point[MASS:], strict=True)))
    holding = -slip_dynamics(vehicle, rail, problem.slip, point[SPEED]).drift

    def rate(_, state):
        return [slip_dynamics(vehicle, rail, state[0], point[SPEED]).drift + holding]

    run = solve_ivp(rate, (0.0, problem.sample_time), [problem.slip + deviation], rtol=1e-9)
    return run.y[0, -1]


@pytest.mark.parametrize("speed", [3.0, 7.0, 20.0])
def test_recoverable_deviation_parts_runs_that_return_from_runs_that_do_not(dry, speed):
    (point,) = nominal(dry, [speed])
    (found,) = recoverable(dry, point[None])
    assert not leaves(dry, point, 0.995 * found)
    assert leaves(dry, point, 1.005 * found)


def test_balls_are_certain_just_beyond_the_recoverable_deviation(dry):
    points = nominal(dry, [3.0, 7.0, 20.0])
    for point, found in zip(points, recoverable(dry, points), strict=True):
        with pytest.raises(Refused, match="not certain"):
            certain(dry, point, 0.98 * found)
        at = slip_dynamics(dry.vehicle, dry.rail, dry.slip, point[SPEED])
        seen = certain(dry, point, 1.05 * found)
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
        if recoverable(problem, drawn_within(problem, speed)).min() < 0.999 * worst
    ]


def test_the_worst_lies_where_the_brake_just_holds_the_reference(dry):
    """A wheel that is too heavily loaded for T_max, one sample late, comes back the easier."""
    samples = recovery_samples.sample(dry)
    assert not overlooked(dry, samples)
    assert np.all(np.diff(np.diff(samples.worst[samples.speeds < 10.0])) > -1e-3)  # no bump
    slow = int(np.searchsorted(samples.speeds, 24.0 / domain.KMH))
    point, worst = samples.tightest[slow], samples.worst[slow]
    assert dry.span("mass")[0] < point[MASS] < dry.span("mass")[1]
    plant = dynamics_at(dry, point[None])
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
    fall = -dynamics_at(problem, points).drift
    shares = []
    for slip in np.linspace(problem.slip, problem.slips[1], 60):
        points[:, SLIP] = slip
        pole = dynamics_at(problem, points).pole
        shares.append(recovery.per_deviation(problem, problem.vehicle.brake.vent_time, pole, pole / fall))
    guaranteed = np.minimum(1.0 / np.max(shares, axis=0), recovery.reach(problem))
    assert np.all(guaranteed <= 1.0001 * recoverable(problem, points))


def test_a_straight_line_of_friction_leaves_the_linear_limit(dry):
    """With one slope p and much room the condition is d exp(p h) <= g/(p (1 + p tau))."""
    wide = replace(dry, slips=(0.02, 1e6))
    pole, fall, lag = 5.0, 3.0, dry.vehicle.brake.vent_time
    limit = fall / (pole * (1.0 + pole * lag)) * math.exp(-pole * dry.sample_time)
    assert 1.0 / recovery.per_deviation(wide, lag, pole, pole / fall) == pytest.approx(limit, rel=1e-9)


def test_growth_is_that_of_a_small_deviation(dry, refuted):
    growth = refuted.findings["growth"]
    slip = growth.place["slip"]
    vehicle, rail = plant_with(
        dry, {name: growth.values[name] for name in QUANTITIES if name in growth.values}
    )
    speed = growth.values["speed"]
    holding = -slip_dynamics(vehicle, rail, slip, speed).drift

    def rate(_, state):
        return [slip_dynamics(vehicle, rail, state[0], speed).drift + holding]

    run = solve_ivp(rate, (0.0, dry.sample_time), [slip + 1e-6], rtol=1e-10, atol=1e-13)
    grown = (run.y[0, -1] - slip) / 1e-6
    assert growth.proved
    assert 0.99 * grown <= growth.low <= growth.high <= 1.05 * grown


def test_dry_rail_at_the_printed_sample_time_is_refuted(dry, refuted):
    assert refuted.status is Status.REFUTED
    at = {point.name: point.value for point in refuted.witness}
    assert set(at) >= {"speed", "mass", "mu0", "wheel radius", "vent time", "slip", "torque"}
    point = np.array([dry.slip, at["speed"] / domain.KMH, at["mass"], at["wheelset inertia"], at["mu0"]])
    pinned = recovery.pinned(dry, refuted.findings["escape"].place)
    vented = replace(
        pinned,
        vehicle=replace(pinned.vehicle, brake=replace(pinned.vehicle.brake, vent_time=at["vent time"])),
    )
    assert at["slip"] == pytest.approx(slip_when_seen(vented, point, recovery.DEVIATION), rel=0.01)
    assert leaves(vented, point, recovery.DEVIATION)
    assert "The lowest controllable speed lies between" in refuted.explanation


def test_wet_rail_is_proved(wet, proved):
    assert proved.status is Status.PROVED
    assert proved.margin.low > 0.0
    points = np.random.default_rng(10).uniform(*domain.box(wet), (300, 5))
    slow = replace(wet.vehicle.brake, vent_time=wet.span("vent time")[1])
    found = recoverable(replace(wet, vehicle=replace(wet.vehicle, brake=slow)), points).min()
    assert recovery.DEVIATION + proved.margin.low <= found


def test_the_sentence_says_no_more_than_the_proof(proved):
    words = proved.explanation.split("A deviation of ")[1].split()
    assert float(words[0]) <= recovery.DEVIATION + proved.margin.low
    share = proved.findings["share"]
    assert Fraction(proved.margin.low + recovery.DEVIATION) * Fraction(share.high) <= Fraction(
        recovery.DEVIATION
    ) * (1 + Fraction(1, 10**12))


def test_what_is_varied_and_what_is_held_is_said(proved):
    assert "vent time 0.3 to 0.9 s" in proved.claim
    assert "held: semi axis rolling" in proved.claim
    assert set(proved.varied) & set(proved.held) == set()


def test_larger_deviation_is_refuted(monkeypatch, wet):
    for module in (recovery, hard_limits):
        monkeypatch.setattr(module, "DEVIATION", 0.4)
    assert hard_limits.CHECK.run(wet).status is Status.REFUTED


def test_a_refutation_that_is_not_certain_is_none(dry, refuted):
    found = {key: each.stated for key, each in refuted.findings.items() if key != "escape"}
    theorem = recovery.HARD_LIMITS
    made = told(theorem, dry, accepted(theorem.obligations(dry), found))
    assert made.status is Status.UNDECIDED
    assert not made.witness


def test_without_a_torque_that_holds_the_reference_nothing_is_said(wet, proved):
    found = {key: each.stated for key, each in proved.findings.items() if key != "torque"}
    made = told(recovery.HARD_LIMITS, wet, accepted(recovery.HARD_LIMITS.obligations(wet), found))
    assert made.status is Status.UNDECIDED


def test_a_recovery_up_to_less_than_the_highest_speed_is_no_recovery(wet, proved):
    """A forger proves the condition on the lowest speeds alone, where it is easy."""
    low = wet.speeds[0]
    short = enclose(recovery.share_claim(wet, recovery.DEVIATION, speed=(low, 1.01 * low)), tolerance=0.1)
    assert short.proof is not None
    found = {key: each.stated for key, each in proved.findings.items()} | {"share": short}
    made = told(recovery.HARD_LIMITS, wet, accepted(recovery.HARD_LIMITS.obligations(wet), found))
    assert made.findings["share"].status is Status.PROVED  # of what it states
    assert made.status is Status.UNDECIDED
    assert "proved from no speed on" in made.explanation


def test_it_speaks_about_every_law(make_problem, make_controller):
    for name in ("trenitalia", "torque-feedback", "afsmc"):
        assert recovery.HARD_LIMITS.speaks_about(make_problem(make_controller(name))) == ""


def test_the_valve_decides(make_problem, make_controller, fast_vehicle):
    problem = make_problem(
        make_controller("afsmc", sample_time=0.01), vehicle=fast_vehicle, bounds={"vent time": (0.02, 0.02)}
    )
    assert hard_limits.CHECK.run(problem).status is Status.PROVED


@pytest.mark.parametrize("slips", [(0.02, 0.18), (0.2, 0.6)])
def test_no_room_leaves_it_undecided(dry, slips):
    found = hard_limits.CHECK.run(replace(dry, slips=slips))
    assert found.status is Status.UNDECIDED
    assert "no room" in found.explanation


def test_files_say_what_is_shown(refuted_file, proved_file):
    for kept in (refuted_file, proved_file):
        no_word_can_be_changed(kept)
    assert not_for(proved_file, replace(proved_file.problem, sample_time=0.12))


@pytest.mark.parametrize("key", ["torque", "growth", "share"])
def test_a_proof_cannot_be_missed(proved_file, key):
    findings = proved_file.content["findings"]
    assert refused(proved_file, findings={name: each for name, each in findings.items() if name != key})


@pytest.mark.parametrize(
    ("name", "factor"), [("speed", 1.0 + 1e-15), ("speed", 1.005), ("mu0", 1.01), ("vent time", 2.0)]
)
def test_a_witness_outside_the_domain_by_any_amount_is_refused(refuted_file, name, factor):
    """Every coordinate stands in the box to the last bit."""
    findings = json.loads(json.dumps(refuted_file.content["findings"]))
    high = refuted_file.problem.speeds[1] if name == "speed" else refuted_file.problem.span(name)[1]
    findings["escape"]["place"][name] = repr(float(np.nextafter(high * factor, np.inf)))
    found = replay(refuted_file.problem, json.dumps(refuted_file.content | {"findings": findings}))
    assert "leaves the domain" in found.reason


def test_arranged_form_is_the_model_also_with_a_fixed_contact(make_reference_problem):
    problem = make_reference_problem(1.0)
    problem = replace(problem, speeds=(25.0, 33.0), bounds=problem.bounds | {"mu0": (0.3, 0.4)})
    made = hard_limits.CHECK.run(problem)
    assert made.status is Status.PROVED
    assert replay(problem, certificate_text(made)).accepted
