"""Eqs. (45)-(48): hypotheses of Barbalat's lemma, by numbers."""

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import quad, solve_ivp

from tests.lazily import Lazily
from wspd_design.model.generated.adaptive_fuzzy import lyapunov_printed_rate_true
from wspd_design.model.generated.slip import slip_gain

barbalat = Lazily("barbalat")


def test_gamma_exceeds_the_decrease():
    gain, gain_rate, psi, b_squared, psi_error = 0.1, 0.05, 1.0, 4.0, 0.5
    for s, xi in ((0.0, 0.0), (0.2, 0.7), (-1.5, -0.3)):
        gamma = abs(s) * gain * (psi - abs(xi))
        decrease = -lyapunov_printed_rate_true(s, gain, gain_rate, xi, psi, b_squared, psi_error, 10.0, 0.85)
        assert gamma > decrease
        assert gamma - decrease == pytest.approx(gain_rate / 2 * (b_squared / 10.0 + psi_error**2 / 0.85))
    assert barbalat.excess == 0
    assert barbalat.violation_on_surface != 0


def test_stop_is_finite_in_time_and_infinite_in_sigma():
    assert barbalat.stopping_time == barbalat.v0 / barbalat.a
    spans = [quad(lambda v: 1.0 / (3.3 * v), end, 33.3)[0] for end in (1.0, 0.1, 0.01)]
    assert np.diff(spans) == pytest.approx(np.log(10.0) / 3.3)  # as much for every decade of speed: no limit
    assert barbalat.sigma_horizon == sp.oo
    assert barbalat.sigma_rate_residual == 0
    assert barbalat.vacuous_limit_holds


def test_hypotheses_of_the_lemma():
    speeds = np.linspace(0.1, 33.3, 200)
    gains = slip_gain(speeds, 331.0, 0.55)
    assert gains.argmin() == len(speeds) - 1  # inf G is at the start of the stop, and positive
    assert barbalat.gain_infimum.is_positive
    assert barbalat.gain_slope_in_speed.is_negative
    assert barbalat.gain_rate_at_standstill == sp.oo  # no Lipschitz bound of Gamma
    assert barbalat.gamma_without_margin == 0  # psi = |xi|: Gamma = 0 for any s


def test_error_follows_the_surface_to_zero():
    """s -> 0 gives e -> 0: (22) integrated for an s that tends to zero."""
    rate, times = 0.306, np.linspace(0.0, 60.0, 6001)
    integral = solve_ivp(
        lambda t, i: np.exp(-t) - rate * i, (0.0, 60.0), [0.0], t_eval=times, rtol=1e-9, atol=1e-12
    )
    error = np.exp(-times) - rate * integral.y[0]  # s/K_P = e + c int e
    assert abs(error[-1]) < 1e-6 < abs(error[0])
    assert barbalat.error_after_step == barbalat.filter_residual == 0
