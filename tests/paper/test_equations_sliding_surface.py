"""Eqs. (21)-(28) along integrated trajectories of the slip, and the loop with valve lag as a matrix."""

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp

from tests.lazily import Lazily
from wspd_design.model.generated.sliding_surface import (
    equivalent_torque,
    lag_characteristic,
    lyapunov_surface,
    sliding_variable,
    slip_error,
)
from wspd_design.model.generated.slip import slip_drift, slip_gain

sliding_surface = Lazily("sliding_surface")

K_P, K_I = 1800.0, 550.0
RATE, DECELERATION, REFERENCE = 2.0, 3.0, 0.14
VEHICLE = (76841.0, 331.0, 0.55, 1.0)  # mass, inertia per wheel, wheel radius, damping


def drift(slip, speed):
    force = 3e4 * (1.0 - 0.5 * slip)  # any creep force that depends on slip
    return slip_drift(slip, speed, force, 5e3, *VEHICLE)


def gain(speed):
    return slip_gain(speed, 331.0, 0.55)


def trajectory(control, disturbance=0.0, slip0=0.05):
    """Integrate slip and error integral over 3 s under a torque ``control(slip, speed, e, int e)``."""

    def rates(t, state):
        slip, integral = state
        speed, error = 30.0 - DECELERATION * t, slip_error(REFERENCE, slip)
        return drift(slip, speed) + gain(speed) * control(slip, speed, error, integral) + disturbance, error

    times = np.linspace(0.0, 3.0, 61)
    run = solve_ivp(rates, (0.0, 3.0), [slip0, 0.0], t_eval=times, rtol=1e-10, atol=1e-12, max_step=0.02)
    return times, slip_error(REFERENCE, run.y[0]), run.y[1]


def equivalent(slip, speed, error, _integral):
    return equivalent_torque(drift(slip, speed), gain(speed), 0.0, error, RATE)


def test_surface():
    assert slip_error(0.14, 0.05) == pytest.approx(0.09)
    assert sliding_variable(0.09, 0.2, K_P, K_I) == pytest.approx(K_P * 0.09 + K_I * 0.2)
    assert lyapunov_surface(-3.0) == 4.5
    assert float(
        -sliding_surface.sliding_pole.subs({sliding_surface.K_I: 550, sliding_surface.K_P: 1800})
    ) == (pytest.approx(0.3056, abs=1e-4))


def test_equivalent_control_keeps_the_surface():
    times, error, integral = trajectory(equivalent)
    assert error == pytest.approx(0.09 * np.exp(-RATE * times), rel=1e-6, abs=1e-9)
    s = sliding_variable(error, integral, 1.0, RATE)
    assert np.ptp(s) < 1e-8
    # The printed law has the slip for the error: what (19) makes of it does not tend to the reference.
    assert sliding_surface.printed_contradiction != 0
    assert sliding_surface.equivalent_residual_printed != 0
    assert sliding_surface.ideal_residual_printed != 0

    def with_slip_for_error(slip, speed, _error, _integral):
        return equivalent_torque(drift(slip, speed), gain(speed), 0.0, slip, RATE)

    _, error, _ = trajectory(with_slip_for_error)
    assert abs(error[-1]) > 0.14


@pytest.mark.parametrize("disturbance", [-0.2, 0.0, 0.2])
def test_reaching_condition(disturbance):
    bound = 0.3  # W, in 1/s

    def control(slip, speed, error, integral):
        s = sliding_variable(error, integral, 1.0, RATE)
        return equivalent(slip, speed, error, integral) + bound * np.clip(s / 1e-3, -1, 1) / gain(speed)

    times, error, integral = trajectory(control, disturbance)
    s = sliding_variable(error, integral, 1.0, RATE)
    outside = np.abs(s) > 2e-3
    expected = s[0] - (bound + disturbance) * times  # s' = -delta - W outside the layer, for s > 0
    assert s[outside] == pytest.approx(expected[outside], abs=1e-6)
    assert (np.abs(s[~outside]) <= 1e-3 + 1e-9).any()
    assert np.abs(s[-1]) <= 1e-3
    assert sliding_surface.worst_case_rate == 0  # |delta| = W: V' is not negative


def test_error_inside_the_layer():
    # s at +Phi until the error has died out (integral Phi/K_I), then at once at -Phi: the worst case.
    layer = 3.0
    bound = float(
        sliding_surface.layer_error_bound.subs({sliding_surface.Phi: layer, sliding_surface.K_P: K_P})
    )
    assert sliding_variable(0.0, layer / K_I, K_P, K_I) == pytest.approx(layer)
    assert sliding_variable(-bound, layer / K_I, K_P, K_I) == pytest.approx(-layer)


def test_unit_of_the_printed_gains():
    """u in N m: a wheel that rolls, no limit of adhesion, lag .6 s: 294 m where Table 10 has 184 m."""

    def rates(t, state):
        speed, _, torque = state
        error = 0.14  # rolling: slip 0
        weights = 1 + 10.0 * (1800 * error * t + 550 * error * t**2 / 2)
        bound = 1 + 0.85 * (1800 * error * t + 550 * error * t**2 / 2)
        command = min(weights + bound, 60e3)
        return -4 * torque / 0.55 / (76841 + 8 * 331 / 0.55**2), speed, (command - torque) / 0.6

    def stop(_, state):
        return state[0]

    stop.terminal = True
    run = solve_ivp(rates, (0.0, 30.0), [120 / 3.6, 0.0, 0.0], events=stop, max_step=0.02)
    assert run.y[1, -1] == pytest.approx(294.0, abs=2.0)
    # The bound of the map: no lag and no limit of the torque, so at most this.
    assert sliding_surface.printed_distance < sliding_surface.distance_in_newton_metres < run.y[1, -1]
    assert sliding_surface.distance_in_newton_metres == pytest.approx(273.0, abs=1.0)
    assert float(sliding_surface.duty_at_start) == pytest.approx(2.0 / 60e3)


def test_torque_lags_behind_the_control_input():
    torque = sliding_surface.torque_of_duty
    assert sliding_surface.torque_residual == torque - sliding_surface.u != 0
    assert sliding_surface.torque_rate_of_surface != 0


def test_ideal_control_is_bounded_at_standstill():
    speeds = np.array([1e-1, 1e-3, 1e-6])
    drifts = np.array([drift(0.14, v) for v in speeds])
    torque = equivalent_torque(drifts, gain(speeds), 0.0, 0.0, RATE)
    assert abs(drifts[-1]) > 1e5 * abs(drifts[0]) / 10
    assert torque == pytest.approx(torque[-1], rel=1e-3)
    assert 0.0 < torque[-1] < 60e3
    assert sliding_surface.drift_at_standstill.has(sp.oo)
    assert not sliding_surface.ideal_at_standstill.has(sp.oo)


@pytest.mark.parametrize("pole", [-1.0, 0.5, 1.5, 3.0])
@pytest.mark.parametrize("layer_rate", [0.5, 5.0, 50.0])
def test_lag_polynomial_is_that_of_the_loop(pole, layer_rate):
    tau, c = 0.6, 0.3
    # States: slip error, its integral, lagged torque (times the gain); input of the lag from eq. (23).
    loop = np.array(
        [
            [pole, 0.0, -1.0],
            [1.0, 0.0, 0.0],
            [(pole + c + layer_rate) / tau, layer_rate * c / tau, -1.0 / tau],
        ]
    )
    coefficients = np.array(lag_characteristic(pole, tau, c, layer_rate))
    assert sliding_surface.characteristic_residual == (0, 0, 0, 0)
    assert np.poly(loop) * tau == pytest.approx(coefficients)
    stable = np.linalg.eigvals(loop).real.max() < 0
    routh = pole * tau < 1 and (1 - pole * tau) * (c + layer_rate) > tau * layer_rate * c
    assert stable == routh
