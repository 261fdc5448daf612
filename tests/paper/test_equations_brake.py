"""Eqs. (8)-(15) against the integrated valve equation and a simulated pulse train."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tests.lazily import Lazily
from wspd_design.model.generated import brake

brake_actuator = Lazily("brake_actuator")

P_MAX, RATE, T_F, T_V, T_MAX = 6e5, 0.75, 0.6, 0.8, 6e4


def test_supply_is_a_first_order_lag():
    assert brake.supply_pressure(0.0, P_MAX, RATE) == 0.0
    assert brake.supply_pressure(3.99, P_MAX, RATE) == pytest.approx(0.95 * P_MAX, rel=1e-3)
    assert brake_actuator.supply_residual == 0


def test_valve_states_of_table_2():
    increase, hold, reduce = (1.0, 0.0), (0.0, 0.0), (0.0, 1.0)  # (fill, vent)
    rates = [brake.cylinder_pressure_rate(3e5, P_MAX, *state, T_F, T_V) for state in (increase, hold, reduce)]
    assert rates == pytest.approx([3e5 / T_F, 0.0, -3e5 / T_V])
    assert brake_actuator.pressure_rate_residual == 0
    assert brake_actuator.pressure_rate_on_hold == 0


@pytest.mark.parametrize(("start", "pressure"), [(0.0, 0.0), (0.5, 1.5e5), (2.0, 5.9e5)])
def test_exact_filling_law_solves_the_valve_equation(start, pressure):
    def rate(t, p):
        return brake.cylinder_pressure_rate(p, brake.supply_pressure(t, P_MAX, RATE), 1.0, 0.0, T_F, T_V)

    times = np.linspace(start, start + 3.0, 7)
    run = solve_ivp(rate, (start, start + 3.0), [pressure], t_eval=times, rtol=1e-10, atol=1e-6)
    law = brake.filled_pressure(times, start, pressure, P_MAX, RATE, T_F)
    assert law == pytest.approx(run.y[0], rel=1e-7, abs=1e-2)
    # Eq. (10) as printed, with the supply (8) inserted, misses it.
    supply = brake.supply_pressure(times, P_MAX, RATE)
    printed = pressure + (supply - pressure) * (1 - np.exp(-(times - start) / T_F))
    assert np.abs(printed - run.y[0]).max() > 0.01 * P_MAX
    assert brake_actuator.filled_residual_printed != 0
    assert brake_actuator.filled_residual == brake_actuator.filled_start_residual == 0


def test_venting():
    run = solve_ivp(
        lambda _, p: brake.cylinder_pressure_rate(p, P_MAX, 0.0, 1.0, T_F, T_V), (0, 1), [4e5], rtol=1e-10
    )
    assert brake.vented_pressure(1.0, 4e5, T_V) == pytest.approx(run.y[0, -1], rel=1e-7)


def test_torque_is_proportional_to_pressure():
    assert brake.braking_torque(P_MAX, T_MAX, P_MAX) == T_MAX
    assert brake.braking_torque(P_MAX / 3, T_MAX, P_MAX) == pytest.approx(T_MAX / 3)


def test_product_rule_term():
    def torque(t):
        return 0.1 * (0.35 + 0.05 * t) * brake.filled_pressure(t, 0.0, 0.0, P_MAX, RATE, T_F)

    t, step = 1.0, 1e-5
    pressure = brake.filled_pressure(t, 0.0, 0.0, P_MAX, RATE, T_F)
    rate = brake.cylinder_pressure_rate(pressure, brake.supply_pressure(t, P_MAX, RATE), 1.0, 0.0, T_F, T_V)
    difference = (torque(t + step) - torque(t - step)) / (2 * step)
    printed = 0.1 * 0.40 * rate
    assert difference == pytest.approx(printed + 0.1 * 0.05 * pressure, rel=1e-8)
    assert difference != pytest.approx(printed, rel=1e-2)
    assert brake_actuator.product_rule_residual != 0


def test_lag_under_full_supply():
    torque, tau = 2.5e4, 0.6
    for u in (0.0, 1.0):
        rate = T_MAX / P_MAX * brake.cylinder_pressure_rate(torque * P_MAX / T_MAX, P_MAX, u, 1 - u, tau, tau)
        assert brake.torque_rate(torque, u, T_MAX, tau) == pytest.approx(rate, rel=1e-12)
    at_half_supply = (
        T_MAX / P_MAX * brake.cylinder_pressure_rate(torque * P_MAX / T_MAX, P_MAX / 2, 1.0, 0.0, tau, tau)
    )
    assert brake.torque_rate(torque, 1.0, T_MAX, tau) != pytest.approx(at_half_supply, rel=0.1)
    assert brake_actuator.lag_residual != 0
    assert brake_actuator.bilinear_coefficient.subs(brake_actuator.T_F, brake_actuator.T_V) == 0


def test_supply_is_far_from_full_when_the_brake_is_applied():
    assert brake.supply_pressure(1.0 / RATE, P_MAX, RATE) == pytest.approx(0.632 * P_MAX, rel=1e-3)
    assert float(brake_actuator.supply_share) == pytest.approx(0.632, abs=1e-3)
    assert brake_actuator.supply_residual_of_lag != 0


@pytest.mark.parametrize("period", [0.1, 0.5, 2.0])
def test_average_of_a_simulated_pulse_train(period):
    """The moving average over a period of any length obeys (15) exactly, from the first period on."""
    tau, duty, steps = 0.6, 0.37, 1000
    step, torque, history = period / steps, 0.0, []
    for n in range(20 * steps):
        command = 1.0 if n % steps < duty * steps else 0.0
        torque = command + (torque - command) * np.exp(-step / tau)
        history.append(torque)
    total = np.concatenate([[0.0], np.cumsum(history)])
    average = (total[steps:] - total[:-steps]) / steps
    times = step * np.arange(len(average))
    expected = duty + (average[0] - duty) * np.exp(-times / tau)  # tau T' + T = dc, T_max = 1
    assert average == pytest.approx(expected, abs=1e-9)
    assert brake_actuator.average_residual == 0


@pytest.mark.parametrize("period", [0.1, 0.5, 2.0])
def test_ripple_of_a_simulated_pulse_train(period):
    tau, torque, steps = 0.6, 0.0, 20
    step, history = period / steps, []
    for n in range(int(20 * tau / period + 1) * steps):  # exact for a constant command over each step
        command = 1.0 if n % steps < steps // 2 else 0.0
        torque = T_MAX * command + (torque - T_MAX * command) * np.exp(-step / tau)
        history.append(torque)
    last = np.array(history[-steps - 1 :])
    assert brake.torque_ripple(T_MAX, period, tau) == pytest.approx(np.ptp(last), rel=1e-5)
    assert (last.max() + last.min()) / 2 == pytest.approx(T_MAX / 2, rel=1e-5)


def test_published_ripple():
    assert brake.torque_ripple(6e4, 0.1, 0.6) == pytest.approx(2.5e3, rel=1e-3)
