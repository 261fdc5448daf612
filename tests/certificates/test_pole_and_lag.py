"""The slip pole against valve, sampling and boundary layer."""

from dataclasses import dataclass, replace

import flint
import numpy as np
import pytest
from scipy.signal import cont2discrete

from wspd_design.certificates.checks.valve import open_loop_pole, sampling
from wspd_design.certificates.checks.valve.slip_pole import pole_map
from wspd_design.certificates.kernel import checker
from wspd_design.certificates.records import Status
from wspd_design.controllers.protocol import pulse_width
from wspd_design.model.slip import slip_dynamics

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
    proved = 1.0 / problem.vehicle.brake.fill_time - open_loop_pole.check(problem).margin.low
    assert proved - 0.02 <= poles.worst.max() <= proved


def test_pole_above_the_valve_is_refuted_on_dry_rail(make_problem, make_controller):
    problem = make_problem(make_controller("afsmc"))
    verdict = open_loop_pole.check(problem)
    assert verdict.status is Status.REFUTED
    at = {point.name: point.value for point in verdict.witness}
    vehicle = replace(problem.vehicle, mass=at["mass"], wheelset_inertia=at["wheelset inertia"])
    rail = replace(problem.rail, mu0=at["mu0"])
    step, speed = 1e-6, at["speed"] / 3.6
    drifts = [slip_dynamics(vehicle, rail, 0.14 + side * step, speed).drift for side in (1.0, -1.0)]
    by_differences = (drifts[0] - drifts[1]) / (2.0 * step)
    assert by_differences == pytest.approx(at["slip pole"], rel=1e-5)
    assert by_differences > 1.0 / problem.vehicle.brake.fill_time


def test_rail_without_falling_friction_passes(make_problem, make_controller):
    verdict = open_loop_pole.check(make_problem(make_controller("afsmc"), rail="table10-dry"))
    assert verdict.status is Status.PROVED
    assert 0.0 < verdict.margin.low < verdict.margin.high


def test_fast_valve_passes(make_problem, make_controller, fast_vehicle):
    problem = make_problem(make_controller("afsmc"), vehicle=fast_vehicle)
    assert open_loop_pole.check(problem).status is Status.PROVED
    assert sampling.check(replace(problem, sample_time=0.01)).status is Status.PROVED


@dataclass(frozen=True, slots=True, kw_only=True)
class TorqueFeedback:
    """A law that the limit does not bind."""

    name: str = "torque feedback"
    sample_time: float = 0.1

    def start(self, _):
        return ()

    def step(self, state, measurement):
        return state, pulse_width(0.5 if measurement.torque > 20e3 else 1.0)


@pytest.mark.parametrize("name", ["trenitalia", "knorr-bremse", "mitsubishi"])
def test_laws_that_use_acceleration_are_not_bound(make_problem, make_controller, name):
    problem = make_problem(make_controller(name))
    assert open_loop_pole.check(problem).status is Status.NOT_APPLICABLE
    assert sampling.check(problem).status is Status.NOT_APPLICABLE


def test_law_that_uses_torque_is_not_bound(make_problem):
    verdict = open_loop_pole.check(make_problem(TorqueFeedback()))
    assert verdict.status is Status.NOT_APPLICABLE
    assert verdict.hypotheses[0].status is Status.REFUTED


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
    low, high = sampling.largest_pole(sample_time, lag)
    assert low < high < 1.0 / lag
    assert high - low < 1e-14 * high
    assert _stabilizable(0.99 * low, sample_time, lag)
    assert not _stabilizable(1.01 * high, sample_time, lag)


def test_largest_pole_counts_half_a_sample_as_lag():
    assert sampling.largest_pole(0.1, 0.6)[0] == pytest.approx(1.0 / 0.65, rel=1e-4)


@pytest.mark.parametrize("pole", [0.3, 1.2, 1.5384, 1.5386, 4.0])
def test_condition_on_the_pole_is_that_of_the_discretized_plant(pole):
    """SciPy's discretization: the second root of the loop with K = p leaves the circle where the condition says."""
    plant = ([[pole, 1.0], [0.0, -1.0 / 0.6]], [[0.0], [1.0 / 0.6]], [[1.0, 0.0]], [[0.0]])
    transition, entry, *_ = cont2discrete(tuple(map(np.array, plant)), 0.1)
    roots = np.linalg.eigvals(transition - pole * entry @ np.array([[1.0, 0.0]])).real
    assert np.abs(roots - 1.0).min() < 1e-9
    second = roots[np.argmax(np.abs(roots - 1.0))]
    assert bool(sampling.lacking(pole, 0.1, 0.6) > 0) == (second > 1.0)
    expected = (second - 1.0) * (1.0 + pole * 0.6)
    assert float(sampling.lacking(pole, 0.1, 0.6)) == pytest.approx(expected, abs=1e-9)


def test_sampling_is_proved_and_refuted_for_certain(make_problem, make_controller, fast_vehicle):
    problem = make_problem(make_controller("smc"), vehicle=fast_vehicle, sample_time=0.02)
    good = sampling.check(problem)
    assert good.status is Status.PROVED
    assert 0.0 < good.margin.low <= good.margin.high
    (proof,) = good.proofs
    assert checker.check(sampling.claim(problem), proof.certificate).accepted
    assert not checker.check(sampling.claim(replace(problem, sample_time=0.5)), proof.certificate).accepted
    bad = sampling.check(replace(problem, sample_time=0.5))
    assert bad.status is Status.REFUTED
    assert not bad.proofs
    pole = {point.name: point.value for point in bad.witness}["slip pole"]
    assert not _stabilizable(pole, 0.5, 0.02)


def test_pole_too_close_to_the_limit_is_neither(make_problem, make_controller, monkeypatch):
    """If the condition cannot tell the sign at the witness, nothing is refuted."""
    problem = make_problem(make_controller("smc"))
    assert sampling.check(problem).status is Status.REFUTED
    limit = sampling.largest_pole(0.1, 0.6)
    monkeypatch.setattr(sampling, "largest_pole", lambda *_: limit)
    monkeypatch.setattr(sampling, "lacking", lambda *_: flint.arb(0, 1))
    assert sampling.check(problem).status is Status.UNDECIDED
