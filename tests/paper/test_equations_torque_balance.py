"""Table 10: the torque integral as a momentum balance, on an integrated stop."""

import pytest
from scipy.integrate import solve_ivp

from tests.lazily import Lazily
from wspd_design.model.generated import adhesion, motion

torque_balance = Lazily("torque_balance")

M, R, INERTIA = 76841.0, 0.55, 331.0


def damping(t):
    return 1e3 * motion.wheel_damping(t, 0.25, 0.3)  # falls, and is large enough to matter


def test_identity_on_a_simulated_stop():
    def rates(t, state):
        v, omega, *_ = state
        slip = (v - R * omega) / v
        force = adhesion.creep_force(slip, slip * v, M * 9.81 / 8, 0.4, 1.0, 0.0, 1.0, 0.4, 1.1e7)
        resistance = motion.running_resistance(v, 2000.0, 20.0, 3.0, 0.0, 0.0, 0.0)
        torque = 3.5e4 * (1.0 - 0.3 * t / 10.0)
        return (
            motion.train_acceleration(force, resistance, M),
            motion.wheel_acceleration(force, omega, torque, INERTIA, R, damping(t)),
            4.0 * torque,
            resistance,
            damping(t) * omega,
        )

    start = [33.3, 33.3 / R, 0.0, 0.0, 0.0]
    # It ends before the train stands, where the slip has no meaning.
    run = solve_ivp(rates, (0.0, 11.0), start, method="Radau", rtol=1e-9, atol=1e-9)
    v, omega, torque, resistance, damped = run.y[:, -1]
    assert 0.0 < v < 10.0
    taken = R * M * (start[0] - v) + 8 * INERTIA * (start[1] - omega)
    assert torque == pytest.approx(taken - R * resistance - 8 * damped, rel=1e-6)
    assert 8 * damped > 1e-3 * torque
    assert torque_balance.identity_residual == 0
    assert torque_balance.torque_coefficient == -4


def test_spread_of_table_10():
    assert float(torque_balance.spread(1)) == pytest.approx(0.0135, abs=5e-5)
    assert float(torque_balance.spread(0)) > 0.28


def test_implied_inertia():
    inertias = list(torque_balance.wheelset_inertias().values())
    assert inertias == pytest.approx([675, 643, 666, 692, 611, 666, 698, 648], abs=1)
