"""Eqs. (1), (2), (4) and B_W by numbers."""

import math

import pytest

from tests.lazily import Lazily
from wspd_design.model.generated.motion import (
    running_resistance,
    train_acceleration,
    wheel_acceleration,
    wheel_damping,
)

motion = Lazily("motion")

M, R, INERTIA, B, F, FD, T, V, OMEGA = 76841.0, 0.55, 331.0, 1.0, 2.5e4, 5e3, 3e4, 20.0, 32.0


def test_momentum_and_power_balance():
    a, alpha = train_acceleration(F, FD, M), wheel_acceleration(F, OMEGA, T, INERTIA, R, B)
    assert R * M * a + 8 * INERTIA * alpha == pytest.approx(-R * FD - 4 * T - 8 * B * OMEGA, rel=1e-12)
    gained = M * V * a + 8 * INERTIA * OMEGA * alpha
    lost = FD * V + 4 * T * OMEGA + 8 * B * OMEGA**2 + 8 * F * (V - R * OMEGA)
    assert gained == pytest.approx(-lost, rel=1e-12)


def test_locked_wheel_would_turn_backwards():
    assert wheel_acceleration(F, 0.0, 2.1 * R * F, INERTIA, R, B) < 0.0
    assert motion.wheel_acceleration_at_lock.has(motion.T)


def test_printed_damping_grows():
    printed = [0.25 ** (-0.01 * t) for t in (0.0, 50.0, 100.0)]
    assert printed == sorted(printed)
    assert printed[0] == 1.0
    model = [wheel_damping(t, 0.25, 0.01) for t in (0.0, 50.0, 100.0)]
    assert model == pytest.approx([0.25 * math.exp(-0.01 * t) for t in (0.0, 50.0, 100.0)])
    assert motion.damping_printed_growth > 0 > motion.damping_corrected_growth


def test_resistance_may_be_negative():
    assert running_resistance(20.0, 2000.0, 30.0, 6.0, 0.0, 0.0, 0.0) == 5000.0
    downhill = -0.03 * M * 9.81
    assert running_resistance(20.0, 2000.0, 30.0, 6.0, downhill, 0.0, 0.0) < 0.0
    assert motion.resistance_downhill == motion.f_r
