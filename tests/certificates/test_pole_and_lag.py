"""The slip pole against the valve, and against what sampled feedback of the slip can stabilize through it."""

from dataclasses import replace

import flint
import numpy as np
import pytest
from scipy.signal import cont2discrete

from tests.attack.case import read_data
from tests.attack.plant import slip_pole
from tests.certificates.round_trip import (
    keep,
    no_proof_can_be_missed,
    no_word_can_be_changed,
    not_for,
    refused,
)
from wspd_design.certificates.checks.valve import open_loop_pole, sampling
from wspd_design.certificates.checks.valve.slip_pole import pole_map
from wspd_design.certificates.records import Status
from wspd_design.certificates.theorems import valve
from wspd_design.certificates.theorems.table import THEOREMS
from wspd_design.parameters.loading import load_rail

KNOWN = {  # nominal pole at slip 0.14 and 33.3, 20, 10, 5 m/s on the calibrated vehicle [1/s]
    "polach-dry": (1.00, 3.01, 6.79, 9.92),
    "polach-wet": (0.97, 1.27, 1.25, 0.49),
}


@pytest.mark.parametrize("rail", KNOWN)
def test_pole_over_speed_agrees_with_known_values(make_problem, make_controller, rail):
    problem = make_problem(make_controller("afsmc"), rail=rail)
    poles = pole_map(problem)
    found = np.interp((33.3, 20.0, 10.0, 5.0), poles.speeds, poles.nominal)
    assert found == pytest.approx(KNOWN[rail], rel=0.03)
    assert np.all(poles.worst >= poles.nominal)


VALVE = ("fill time", "vent time")
WITNESSED = ("mass", "wheel_radius", "wheelset_inertia", "resistance_constant", "resistance_linear",
             "resistance_quadratic", "semi_axis_rolling", "semi_axis_lateral", "mu0", "friction_ratio",
             "friction_decay", "adhesion_reduction", "slip_reduction")  # fmt: skip


@pytest.fixture(scope="module")
def refuted(make_problem, make_controller):
    return keep(open_loop_pole.CHECK, make_problem(make_controller("afsmc")))


def _attained(certificate):
    """The slip pole at the witness, by the attacker's equations."""
    at = {point.name.replace(" ", "_"): point.value for point in certificate.witness}
    plant = read_data("er24pc", "polach-dry").plant.with_numbers({name: at[name] for name in WITNESSED})
    return float(slip_pole(plant, at["slip"], at["speed"] / 3.6))


def test_pole_above_the_valve_is_refuted_on_dry_rail(refuted):
    certificate = refuted.certificate
    assert certificate.status is Status.REFUTED
    (lag,) = (point.value for point in certificate.witness if point.name == "valve time")
    assert lag == min(refuted.problem.span(name)[1] for name in VALVE) == 0.9
    assert certificate.margin.high < 0.0
    assert 1.0 - lag * _attained(certificate) == pytest.approx(certificate.margin.high, rel=1e-6)


def test_every_number_of_the_plant_and_the_valve_is_varied(refuted):
    bounded = {
        name for name, _ in refuted.problem.bounds.items() if name not in ("max torque", "supply rate")
    }
    assert bounded <= set(refuted.certificate.varied) | {"axle load share", "train deceleration"}
    for name in ("mass", "semi axis rolling", "friction decay"):
        low, high = refuted.problem.span(name)
        assert f"{name} {low:.6g} to {high:.6g}" in refuted.certificate.claim
    assert "fill and vent times up to 0.9 s" in refuted.certificate.claim


def test_words_and_proofs_of_the_pole(refuted, make_problem, make_controller):
    no_word_can_be_changed(refuted)
    assert not_for(refuted, make_problem(make_controller("afsmc"), slip=0.15))


@pytest.mark.parametrize(("fill", "vent", "status"), [
    ((0.02, 0.02), (0.02, 0.02), Status.PROVED),
    ((0.02, 0.02), (0.02, 5.0), Status.UNDECIDED),  # the share of filling decides
    ((0.02, 5.0), (0.02, 0.02), Status.UNDECIDED),
    ((0.02, 5.0), (0.02, 5.0), Status.REFUTED),
])  # fmt: skip
def test_the_slower_valve_is_not_the_safe_side(fast, make_controller, fill, vent, status):
    made = open_loop_pole.CHECK.run(fast(make_controller("afsmc"), **{"fill time": fill, "vent time": vent}))
    assert made.status is status
    if status is Status.UNDECIDED:
        assert "share of filling and venting" in made.explanation


def test_rail_without_falling_friction_passes(fast, make_controller):
    verdict = open_loop_pole.CHECK.run(fast(make_controller("afsmc"), "table10-dry", mu0=(0.4, 0.43)))
    assert verdict.status is Status.PROVED
    assert 0.0 < verdict.margin.low < verdict.margin.high


def test_fast_valve_passes(fast, make_controller):
    problem = fast(make_controller("afsmc", sample_time=0.005))
    kept = keep(open_loop_pole.CHECK, problem)
    assert kept.certificate.status is Status.PROVED
    no_word_can_be_changed(kept)
    assert sampling.CHECK.run(problem).status is Status.PROVED


LIGHT = {"mass": (61473.0, 92209.0), "wheelset inertia": (640.0, 860.0), "mu0": (0.44, 0.66)}
"""What is varied where a search has to prove something within seconds; the others are held at their nominal values."""


@pytest.fixture(scope="module")
def fast(make_problem, narrow, fast_vehicle):
    """Make a problem with a valve of 20 ms and few numbers that vary."""

    def made(law, rail="polach-dry", **ranges):
        bounds = narrow(fast_vehicle, load_rail(rail), **{**LIGHT, **ranges})
        return make_problem(law, rail=rail, vehicle=fast_vehicle, bounds=bounds)

    return made


def _stabilizable(pole, sample_time, lag):
    """Search a stabilizing gain among many by eigenvalues."""
    plant = (
        np.array([[pole, 1.0], [0.0, -1.0 / lag]]),
        np.array([[0.0], [1.0 / lag]]),
        np.array([[1.0, 0.0]]),
        np.zeros((1, 1)),
    )
    transition, entry, *_ = cont2discrete(plant, sample_time)
    gains = np.geomspace(pole * (1.0 + 1e-6), 50.0 * pole, 4001)
    closed = transition - gains[:, None, None] * (entry @ plant[2])
    return bool((np.abs(np.linalg.eigvals(closed)).max(axis=1) < 1.0).any())


@pytest.mark.parametrize(("sample_time", "lag"), [(0.1, 0.6), (0.02, 0.6), (0.3, 0.2), (1.0, 0.1)])
def test_largest_pole_parts_what_a_gain_can_stabilize(sample_time, lag):
    low, high = valve.largest_pole(sample_time, lag)
    assert low < high < 1.0 / lag
    assert high - low < 1e-14 * high
    assert _stabilizable(0.99 * low, sample_time, lag)
    assert not _stabilizable(1.01 * high, sample_time, lag)


def test_largest_pole_counts_half_a_sample_as_lag():
    assert valve.largest_pole(0.1, 0.6)[0] == pytest.approx(1.0 / 0.65, rel=1e-4)


@pytest.mark.parametrize("pole", [0.3, 1.2, 1.5384, 1.5386, 4.0])
def test_condition_on_the_pole_is_that_of_the_discretized_plant(pole):
    """SciPy's discretization: the second root of the loop with K = p leaves the circle where the condition says."""
    plant = ([[pole, 1.0], [0.0, -1.0 / 0.6]], [[0.0], [1.0 / 0.6]], [[1.0, 0.0]], [[0.0]])
    transition, entry, *_ = cont2discrete(tuple(map(np.array, plant)), 0.1)
    roots = np.linalg.eigvals(transition - pole * entry @ np.array([[1.0, 0.0]])).real
    assert np.abs(roots - 1.0).min() < 1e-9
    second = roots[np.argmax(np.abs(roots - 1.0))]
    assert bool(valve.lacking(pole, 0.1, 0.6) > 0) == (second > 1.0)
    expected = (second - 1.0) * (1.0 + pole * 0.6)
    assert float(valve.lacking(pole, 0.1, 0.6)) == pytest.approx(expected, abs=1e-9)


@pytest.fixture(scope="module")
def sampled(fast, make_controller):
    return keep(sampling.CHECK, fast(make_controller("smc", sample_time=0.005)))


def test_sampling_is_proved_and_refuted_for_certain(sampled):
    good = sampled.certificate
    assert good.status is Status.PROVED
    assert 0.0 < good.margin.low <= good.margin.high
    no_word_can_be_changed(sampled)
    no_proof_can_be_missed(sampled)
    slower = replace(
        sampled.problem, sample_time=0.5, controller=replace(sampled.problem.controller, sample_time=0.5)
    )
    assert not_for(sampled, slower)
    bad = keep(sampling.CHECK, slower).certificate
    assert bad.status is Status.REFUTED
    pole = {point.name: point.value for point in bad.witness}["slip pole"]
    assert not _stabilizable(pole, 0.5, 0.02)


def test_the_slowest_valve_that_fills_as_it_vents_counts(sampled):
    """Both times have 0.3 to 0.9 s, of which 0.9 s is the worst; without a common one nothing is said."""
    spans = sampled.problem.bounds | {"fill time": (0.3, 0.9), "vent time": (0.2, 0.7)}
    assert valve.common_lag(replace(sampled.problem, bounds=spans)) == (0.3, 0.7)
    apart = replace(
        sampled.problem, bounds=sampled.problem.bounds | {"fill time": (0.3, 0.9), "vent time": (0.1, 0.2)}
    )
    made = sampling.CHECK.run(apart)
    assert made.status is Status.NOT_APPLICABLE
    assert "never fills as fast as it vents" in made.explanation
    limits = [valve.largest_pole(0.1, lag)[0] for lag in (0.3, 0.5, 0.7, 0.9)]
    assert limits == sorted(limits, reverse=True)


def test_pole_too_close_to_the_limit_is_neither(make_problem, make_controller, monkeypatch):
    """If the condition cannot tell the sign at the witness, nothing is refuted."""
    problem = make_problem(make_controller("smc"))
    assert sampling.CHECK.run(problem).status is Status.REFUTED
    limit = valve.largest_pole(0.1, 0.9)
    monkeypatch.setattr(valve, "largest_pole", lambda *_: limit)
    monkeypatch.setattr(valve, "lacking", lambda *_: flint.arb(0, 1))
    assert sampling.CHECK.run(problem).status is Status.UNDECIDED


@pytest.mark.parametrize("check", [sampling, open_loop_pole], ids=["sampling", "open_loop_pole"])
def test_theorems_on_feedback_of_the_slip_say_nothing_about_torque_feedback(check, fast, make_controller):
    """The forged file of the audit: the valve beats the pole, so that every inequality is proved; the law reads it."""
    genuine = keep(
        check.CHECK, fast(make_controller("afsmc", sample_time=0.01), "table10-wet", mu0=(0.32, 0.34))
    )
    assert genuine.certificate.status is Status.PROVED
    law = make_controller("torque-feedback", "table10-wet", sample_time=0.01)
    other = fast(law, "table10-wet", mu0=(0.32, 0.34))
    assert THEOREMS[check.CHECK.name].speaks_about(other)
    honest = keep(check.CHECK, other)
    assert honest.certificate.status is Status.NOT_APPLICABLE
    assert not_for(genuine, other)
    assert refused(honest, status="PROVED")
    assert refused(honest, findings=genuine.content["findings"])
    silenced = honest.content | {"findings": genuine.content["findings"]}
    assert refused(honest, **{name: genuine.content[name] for name in silenced if name != "model_sha256"})


def test_times_of_filling_and_venting_that_differ(make_problem, make_controller, er24pc):
    """fastvent.toml of the audit: T_V = 0.15 s; the rate of the valve lies between 1/0.6 and 1/0.15."""
    vehicle = replace(er24pc, brake=replace(er24pc.brake, vent_time=0.15))
    problem = make_problem(
        make_controller("smc"), vehicle=vehicle, bounds={"fill time": (0.6, 0.6), "vent time": (0.15, 0.15)}
    )
    made = open_loop_pole.CHECK.run(problem)
    (lag,) = (point.value for point in made.witness if point.name == "valve time")
    assert (made.status, lag) == (Status.REFUTED, 0.15)
    assert sampling.CHECK.run(problem).status is Status.NOT_APPLICABLE
