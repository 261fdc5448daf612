"""Gain, phase, delay and disk margin against what happens when one uses them up."""

import math
from dataclasses import replace

import control
import numpy as np
import pytest

from wspd_design.certificates import margins
from wspd_design.certificates.linear_loop import feedback
from wspd_design.certificates.records import Status


def test_known_loop():
    """4/(s (s + 1) (s + 3)): gain margin 3 at sqrt(3) rad/s; the phase margin follows from its own crossing."""
    opened = control.tf([4.0], np.polymul([1.0, 0.0], np.polymul([1.0, 1.0], [1.0, 3.0])))
    found = margins.margins(control.ss(opened))
    assert found.stable
    assert found.gain_up == pytest.approx(3.0, rel=1e-9)
    crossing = next(w for w in np.linspace(0.9, 1.2, 300_001) if abs(opened(1j * w)) <= 1.0)
    phase = math.pi - math.pi / 2.0 - math.atan(crossing) - math.atan(crossing / 3.0)
    assert found.phase == pytest.approx(phase, rel=1e-4)
    assert found.delay == pytest.approx(phase / crossing, rel=1e-4)


def test_disk_margin_is_the_peak_of_the_balanced_sensitivity():
    opened = control.ss(control.tf([10.0], [1.0, 3.0, 3.0, 1.0])) * 0.5
    frequencies = np.geomspace(1e-2, 1e2, 4000)
    loop = np.array([complex(opened(1j * w)) for w in frequencies])
    sensitivity = 1.0 / (1.0 + loop)
    expected = 1.0 / np.abs(sensitivity - 0.5).max()
    assert margins.margins(opened).disk == pytest.approx(expected, rel=5e-3)


@pytest.fixture(scope="module")
def problem(make_problem, make_controller):
    return make_problem(make_controller("torque-feedback"))


@pytest.mark.parametrize("sample_time", [None, 0.02])
@pytest.mark.parametrize("speed", [3.0, 25.0])
def test_gain_margin_is_where_the_loop_becomes_unstable(problem, sample_time, speed):
    opened = margins.loop(problem, problem.controller, speed, sample_time=sample_time)
    found = margins.margins(opened)
    assert found.stable
    for factor, side in ((found.gain_up, 1.0), (found.gain_down, -1.0)):
        if factor in (margins.MOST_GAIN, 1.0 / margins.MOST_GAIN):
            continue
        assert margins.margins(opened * (factor * (1.0 - 1e-3 * side))).stable
        assert not margins.margins(opened * (factor * (1.0 + 1e-3 * side))).stable


def test_sampled_loop_is_the_law_between_samples(problem):
    """Eigenvalues of a simulated pair of samples, without python-control's discretization."""
    speed = 12.0
    opened = margins.loop(problem, problem.controller, speed, sample_time=0.02)
    closed = np.sort_complex(control.feedback(opened, 1).poles())
    dynamics = margins.nominal(problem.vehicle, problem.rail, 0.14, speed)
    gains, lag, limit = feedback(problem.controller, speed), 0.6, 60e3
    steps, h = 4000, 0.02
    a = np.array([[dynamics.pole, dynamics.gain * limit], [0.0, -1.0 / lag]])
    matrix = np.empty((2, 2))
    for column in range(2):
        x = np.eye(2)[column]
        command = -(gains.proportional / limit * x[0] + gains.torque * x[1])
        drive = np.array([0.0, command / lag])
        for _ in range(steps):  # Heun
            k = a @ x + drive
            x = x + h / steps * 0.5 * (k + a @ (x + h / steps * k) + drive)
        matrix[:, column] = x
    assert closed == pytest.approx(np.sort_complex(np.linalg.eigvals(matrix)), rel=1e-5)


def test_verdicts(make_problem, make_controller, problem):
    good = margins.check(problem)
    assert good.status is Status.EVIDENCE
    assert 0.3 < good.margin.high < 2.0
    bad = margins.check(make_problem(make_controller("afsmc")))
    assert bad.status is Status.REFUTED
    assert bad.witness
    assert margins.check(make_problem(make_controller("trenitalia"))).status is Status.NOT_APPLICABLE


def test_too_slow_sampling_is_seen(problem):
    """The planted fault: the gains that are right at 20 ms do not stand 100 ms."""
    slow = replace(problem, controller=replace(problem.controller, sample_time=0.1), sample_time=0.1)
    verdict = margins.check(slow)
    assert verdict.status is Status.REFUTED
    assert "at 0 of 25 speeds as continuous loop" in verdict.explanation
