"""Stiff runs side by side: the order of a step, another program's integrator, and runs that keep to themselves."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from wspd_design.certificates.checks import rosenbrock
from wspd_design.certificates.checks.rosenbrock import Rates, integrate
from wspd_design.model.number import exp


def pendulum(x):
    return [x[1], -4.0 * x[0] + x[0] ** 3 - 0.1 * x[1] * x[2], 1.0 - exp(-x[2])]


def robertson(x):
    """The classical stiff problem; its rates lie nine powers of ten apart."""
    slow, fast, twice = 0.04 * x[0], 1e4 * x[1] * x[2], 3e7 * x[1] ** 2
    return [-slow + fast, slow - fast - twice, twice]


def falling(x):
    """Over a wall of infinite slope."""
    return [-1.0 / (x[0] - 0.5) ** 3, 0.0 * x[1], 0.0 * x[2]]


def never(states):
    return np.ones((1, len(states)))


STARTS = {pendulum: [0.4, 0.1, 0.2], robertson: [1.0, 0.0, 0.0], falling: [1.0, 0.0, 0.0]}


def _integrated(*flows, events=never, until=2.0, tolerance=1e-8):
    starts = np.array([STARTS[flow] for flow in flows])
    rates = Rates(flows, 3)
    return integrate(rates, starts, events, until=until, relative=tolerance, absolute=tolerance / 100)


def _reference(flow, until):
    found = solve_ivp(
        lambda _, x: np.array(flow(x), dtype=float),
        (0.0, until),
        STARTS[flow],
        method="Radau",
        rtol=1e-12,
        atol=1e-14,
    )
    return found.y[:, -1]


def _errors(steps):
    wanted, rates = _reference(pendulum, 1.0), Rates([pendulum], 3)
    found = []
    for count in steps:
        x = np.array([STARTS[pendulum]])
        for _ in range(count):
            x, _ = rosenbrock._step(rates, x, np.array([1.0 / count]))
        found.append(np.abs(x[0] - wanted).max())
    return found


def test_order_four():
    coarse, fine = _errors((20, 40))
    assert 12.0 < coarse / fine < 24.0


@pytest.mark.parametrize(("stage", "place"), [(2, 0), (4, 3), (5, 2)])
def test_a_wrong_digit_costs_the_order(monkeypatch, stage, place):
    wrong = [list(row) for row in rosenbrock.MIXED]
    wrong[stage][place] *= 1.001
    monkeypatch.setattr(rosenbrock, "MIXED", wrong)
    coarse, fine = _errors((20, 40))
    assert coarse / fine < 8.0


@pytest.mark.parametrize("flow", [pendulum, robertson])
def test_same_end_as_radau(flow):
    (track,) = _integrated(flow, until=40.0 if flow is robertson else 2.0)
    assert track.states[-1] == pytest.approx(_reference(flow, track.times[-1]), rel=1e-6, abs=1e-11)
    assert len(track.times) < 400


def test_runs_side_by_side_are_the_runs_alone():
    together = _integrated(pendulum, robertson, falling)
    for flow, track in zip((pendulum, robertson, falling), together, strict=True):
        (alone,) = _integrated(flow)
        assert np.array_equal(track.times, alone.times)
        assert np.array_equal(track.states, alone.states)
        assert track.failed == alone.failed == (flow is falling)


def test_run_ends_at_the_first_event():
    def events(states):
        return np.array([states[:, 1] + 0.9, states[:, 0] - 0.3])

    (track,) = _integrated(pendulum, events=events)
    assert track.event == 1
    assert abs(track.states[-1][0] - 0.3) < 1e-9
    assert all(state[1] > -0.9 for state in track.states)
