"""The search for a maximum, on functions whose maximum is known."""

import numpy as np
import pytest

from wspd_design.design.maximize import maximize

LOW, HIGH = np.array([-1.0, 10.0, 0.0]), np.array([3.0, 20.0, 0.5])


def test_interior_maximum():
    def hill(points):
        return -((points[:, 0] - 0.7) ** 2) - (points[:, 1] - 13.0) ** 2 - (points[:, 2] - 0.2) ** 2

    found = maximize(hill, LOW, HIGH, seed=0)
    assert found.value == pytest.approx(0.0, abs=1e-6)
    assert found.point == pytest.approx([0.7, 13.0, 0.2], abs=2e-3)


def test_corner_is_found_exactly():
    found = maximize(lambda points: points @ np.array([1.0, -2.0, 30.0]), LOW, HIGH, seed=0)
    assert found.value == 3.0 - 20.0 + 15.0
    assert tuple(found.point) == (3.0, 10.0, 0.5)


def test_narrow_peak_between_the_samples():
    """A peak narrower than the distance of the samples, on a slope that leads to it."""

    def peak(points):
        distance = np.sum(((points - np.array([0.123, 17.7, 0.31])) / (HIGH - LOW)) ** 2, axis=1)
        return 1.0 / (1e-4 + distance)

    sampled = peak(np.random.default_rng(0).uniform(LOW, HIGH, (8192, 3))).max()
    found = maximize(peak, LOW, HIGH, seed=0)
    assert sampled < 0.9e4
    assert found.value == pytest.approx(1e4, rel=1e-3)


def test_fixed_coordinates_stay_fixed():
    low, high = np.array([0.14, 1.0]), np.array([0.14, 5.0])
    found = maximize(lambda points: points[:, 0] - (points[:, 1] - 2.0) ** 2, low, high, seed=0)
    assert found.point[0] == 0.14
    assert found.point[1] == pytest.approx(2.0, abs=1e-3)
    nothing_free = maximize(lambda points: points.sum(axis=1), low, low, seed=0)
    assert nothing_free.value == pytest.approx(1.14)


def test_same_seed_same_answer():
    def wavy(points):
        return np.sin(9.0 * points[:, 0]) + np.cos(7.0 * points[:, 1])

    first, second = (maximize(wavy, LOW, HIGH, seed=5) for _ in range(2))
    assert first.value == second.value
    assert tuple(first.point) == tuple(second.point)
