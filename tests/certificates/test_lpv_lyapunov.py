"""A common quadratic function: accepted if it falls, refused if anything is wrong with it."""

import json
import sys
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from scipy.linalg import expm

from wspd_design.certificates.checks.region import lpv_lyapunov
from wspd_design.certificates.kernel.arb import ball, point
from wspd_design.certificates.records import Status
from wspd_design.certificates.theorems import quadratic
from wspd_design.certificates.theorems.quadratic import (
    check_quadratic,
    contracts,
    decays,
    held,
    is_positive,
    loop_of,
)
from wspd_design.model.slip import slip_dynamics


@pytest.fixture(scope="module")
def problem(make_problem, make_controller):
    return make_problem(make_controller("torque-feedback"))


@pytest.fixture(scope="module")
def verdict(problem):
    return lpv_lyapunov.check(problem)


@pytest.fixture(scope="module")
def content(verdict):
    (proof,) = verdict.proofs
    return json.loads(proof.certificate)


def numbers(content, name):
    return [Fraction(each) for each in content[name]]


def test_proved_for_all_speeds(problem, verdict):
    assert verdict.status is Status.PROVED
    assert all(hypothesis.status is Status.PROVED for hypothesis in verdict.hypotheses)
    assert 0.0 < verdict.margin.low < verdict.margin.high
    assert check_quadratic(verdict.proofs[0].certificate, problem).accepted


def test_function_falls_along_random_courses(problem, content):
    """SciPy's matrix exponential at random speeds and parameters: an independent sample by sample run."""
    p = numbers(content, "sampled")
    matrix = np.array([[float(p[0]), float(p[1])], [float(p[1]), float(p[2])]])
    contraction = float(Fraction(content["contraction"]))
    rng, law, vehicle = np.random.default_rng(5), problem.controller, problem.vehicle
    for _ in range(20):
        x = rng.normal(size=2)
        for _ in range(50):
            speed, mass, inertia, mu0 = (
                rng.uniform(*bounds)
                for bounds in (
                    problem.speeds,
                    problem.mass_bounds,
                    problem.inertia_bounds,
                    problem.mu0_bounds,
                )
            )
            plant = slip_dynamics(
                replace(vehicle, mass=mass, wheelset_inertia=inertia),
                replace(problem.rail, mu0=mu0),
                0.14,
                speed,
            )
            q, gamma = plant.pole - plant.deceleration / speed, 0.55 * 60e3 / inertia
            generator = np.array([[q, -gamma, 0.0], [0.0, -1.0 / 0.6, 1.0 / 0.6], [0.0, 0.0, 0.0]])
            command = law.gains.sliding_gain * x[0] - law.gains.torque_gain * x[1]
            following = (expm(generator * 0.02) @ np.array([*x, command]))[:2]
            assert following @ matrix @ following <= contraction**2 * (x @ matrix @ x)
            x = following


def changed(content, **changes):
    return json.dumps({**content, **changes})


@pytest.mark.parametrize("name", ["continuous", "sampled"])
def test_false_matrices_are_refused(problem, content, name):
    p11, p12, p22 = content[name]
    for false in (
        [p11, str(-Fraction(p12)), p22],  # falls for a loop with the other sign of the feedback
        [p11, "0", p22],
        [f"-{p11}", p12, p22],  # not positive definite
        [p11, str(10 * Fraction(p12)), p22],
        ["1", "0", "0"],
        ["0", "0", "0"],
    ):
        assert not check_quadratic(changed(content, **{name: false}), problem).accepted


def test_faster_decay_than_there_is_is_refused(problem, content):
    assert not check_quadratic(changed(content, decay="40"), problem).accepted
    assert not check_quadratic(changed(content, contraction="1/2"), problem).accepted
    assert not check_quadratic(changed(content, contraction="3/2"), problem).accepted
    assert check_quadratic(changed(content, decay="0", contraction="1"), problem).accepted


def test_smaller_polytope_is_refused(problem, content):
    low, high = numbers(content, "poles")
    for poles in ((low, high / 2), (low + 5, high), (high, low)):
        refused = check_quadratic(changed(content, poles=[str(each) for each in poles]), problem)
        assert not refused.accepted
        assert "polytope" in refused.reason


def test_proofs_of_the_wrong_ends_are_refused(problem, content):
    assert not check_quadratic(changed(content, proofs=content["proofs"][::-1]), problem).accepted
    assert not check_quadratic(changed(content, proofs=["", ""]), problem).accepted


def test_other_loops_are_refused(problem, content, make_problem, make_controller):
    certificate = json.dumps(content)
    law = problem.controller
    brake = problem.vehicle.brake
    others = (
        replace(problem, speeds=(2.0, 120.0 / 3.6)),
        replace(problem, mu0_bounds=(0.44, 0.7)),
        replace(problem, inertia_bounds=(300.0, 860.0)),
        replace(problem, sample_time=0.1),
        replace(problem, slip=0.1),
        replace(problem, controller=replace(law, gains=replace(law.gains, torque_gain=1.0))),
        replace(problem, controller=replace(law, gains=replace(law.gains, sliding_gain=-20.0))),
        replace(
            problem, vehicle=replace(problem.vehicle, brake=replace(brake, fill_time=2.0, vent_time=2.0))
        ),
        make_problem(make_controller("smc")),
    )
    for other in others:
        assert not check_quadratic(certificate, other).accepted
    assert check_quadratic(certificate, problem).accepted


@pytest.mark.parametrize(
    "text",
    [
        "",
        "{}",
        "[]",
        "null",
        '{"format": "wspd-quadratic/1"}',
        "[" * 100_000,
        "x" * (quadratic.MOST_BYTES + 1),
    ],
    ids=["empty", "object", "list", "null", "bare", "deep", "long"],
)
def test_garbage_is_refused(problem, text):
    assert not check_quadratic(text, problem).accepted


def test_numbers_that_are_none_are_refused(problem, content):
    for bad in ("1/0", "nan", "1" * 100, 3, None, "1e999999999"):
        assert not check_quadratic(changed(content, decay=bad), problem).accepted


def test_matrix_exponential_encloses_scipys(problem):
    gains = problem.controller.gains
    loop = loop_of(problem, problem.controller)
    for q, gamma in ((0.5, 40.0), (14.0, 51.0), (-5.0, 38.0)):
        step = held(loop, ball(q - 1e-9, q + 1e-9), point(gamma))
        generator = np.array([[q, -gamma, 0.0], [0.0, -1.0 / 0.6, 1.0 / 0.6], [0.0, 0.0, 0.0]])
        exact = expm(generator * 0.02)
        expected = exact[:2, :2] + np.outer(exact[:2, 2], [gains.sliding_gain, -gains.torque_gain])
        for i in range(2):
            for k in range(2):
                assert float(step[i][k]) == pytest.approx(expected[i, k], rel=1e-7)
                assert step[i][k].contains(point(expected[i, k]))


def test_forms_are_those_of_the_matrices():
    rng = np.random.default_rng(2)
    a, p = rng.normal(size=(2, 2)), np.array([[2.0, 0.3], [0.3, 1.0]])
    entries = (p[0, 0], p[0, 1], p[1, 1])
    rows = tuple(tuple(row) for row in a.tolist())
    falls = -(a.T @ p + p @ a) - 2.0 * 0.1 * p
    assert decays(entries, rows, 0.1) == pytest.approx((falls[0, 0], falls[0, 1], falls[1, 1]))
    shrinks = 0.81 * p - a.T @ p @ a
    assert contracts(entries, rows, 0.9) == pytest.approx((shrinks[0, 0], shrinks[0, 1], shrinks[1, 1]))
    assert is_positive(entries)
    assert not is_positive((1, 1, 1))
    assert not is_positive((point(1.0), point(0.0), ball(-1e-9, 1.0)))  # perhaps positive is not enough


def test_unstable_gains_are_refuted_with_a_witness(problem):
    law = problem.controller
    weak = replace(problem, controller=replace(law, gains=replace(law.gains, torque_gain=0.0)))
    verdict = lpv_lyapunov.check(weak)
    assert verdict.status is Status.REFUTED
    at = {each.name: each.value for each in verdict.witness}
    vehicle = replace(problem.vehicle, mass=at["mass"], wheelset_inertia=at["wheelset inertia"])
    plant = slip_dynamics(vehicle, replace(problem.rail, mu0=at["mu0"]), 0.14, at["speed"] / 3.6)
    q = plant.pole - plant.deceleration / (at["speed"] / 3.6)
    assert q == pytest.approx(at["p - a/v"], rel=1e-9)
    generator = np.array([[q, -0.55 * 60e3 / at["wheelset inertia"]], [20.0 / 0.6, -1.0 / 0.6]])
    assert np.linalg.eigvals(generator).real.max() > 0.0


def test_sampling_too_slowly_is_refuted(problem):
    slow = replace(problem, controller=replace(problem.controller, sample_time=0.1), sample_time=0.1)
    assert lpv_lyapunov.check(slow).status is Status.REFUTED


def test_without_a_solver_nothing_is_decided(problem, monkeypatch):
    monkeypatch.setitem(sys.modules, "cvxpy", None)
    verdict = lpv_lyapunov.check(problem)
    assert verdict.status is Status.UNDECIDED
    assert "cvxpy is missing" in verdict.explanation
    assert not verdict.proofs


def test_wrong_search_proves_nothing(problem, monkeypatch):
    right = lpv_lyapunov.search

    def wrong(loop, poles):
        found = right(loop, poles)
        return replace(found, sampled=(found.sampled[0], -found.sampled[1], found.sampled[2]))

    monkeypatch.setattr(lpv_lyapunov, "search", wrong)
    verdict = lpv_lyapunov.check(problem)
    assert verdict.status is Status.UNDECIDED
    assert not verdict.proofs


@pytest.mark.parametrize("name", ["afsmc", "smc", "trenitalia", "none"])
def test_speaks_about_linear_torque_feedback_alone(make_problem, make_controller, name):
    verdict = lpv_lyapunov.check(make_problem(make_controller(name)))
    assert verdict.status is Status.NOT_APPLICABLE
    assert ("no_go" in verdict.explanation) is (name != "trenitalia")
