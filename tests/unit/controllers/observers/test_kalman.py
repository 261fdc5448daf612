"""The filter against the textbook in matrices, its covariance, and planted faults."""

import numpy as np
import pytest

from wspd_design.controllers.observers.kalman import Belief, corrected, independent, predicted

COUNT = 4


def matrix(belief):
    """Covariance as a full matrix."""
    return np.array([[belief.between(i, j) for j in range(COUNT)] for i in range(COUNT)])


def textbook(mean, covariance, slopes, innovation, variance, common):
    """Joseph's form with a noise that process and measurement share."""
    h, c = np.array(slopes)[np.newaxis], np.array([[common], *[[0.0]] * (COUNT - 1)])
    total = (h @ covariance @ h.T + h @ c + c.T @ h.T + variance).item()
    gain = (covariance @ h.T + c) / total
    rest = np.eye(COUNT) - gain @ h
    after = rest @ covariance @ rest.T + gain * variance @ gain.T - rest @ c @ gain.T - gain @ c.T @ rest.T
    return mean + gain[:, 0] * innovation, after


def course(rng, steps, sign=1.0):
    """Lead filter and textbook through the same random samples; yield both after each."""
    belief = independent([30.0, 1.0, 0.0, 0.0], [0.05, 0.2, 0.03, 0.03])
    mean, covariance = np.array(belief.mean), matrix(belief)
    for _ in range(steps):
        transition = np.eye(COUNT)
        transition[0, 1:] = rng.normal(size=COUNT - 1) * [0.1, 0.0, 0.02]
        noise = np.array([1e-4, 1e-5, 0.0, 0.0]) * rng.uniform(0.5, 2.0)
        first = mean[0] - 0.1
        belief = predicted(belief, first, transition[0], noise)
        mean = np.array([first, *mean[1:]])
        covariance = transition @ covariance @ transition.T + np.diag(noise)
        common = 4e-4 * rng.uniform()
        for slopes, variance, shared in (
            ([0.0, -3.0 * rng.uniform(), 1.0, 0.0], 0.02, common),
            ([0.98, 0.0, 0.0, 0.0], 0.003, 0.0),
        ):
            innovation = rng.normal() * 0.1
            belief = corrected(belief, slopes, innovation, variance, common=sign * shared)
            mean, covariance = textbook(mean, covariance, slopes, innovation, variance, shared)
        yield belief, mean, covariance


def test_filter_equals_the_textbook():
    for belief, mean, covariance in course(np.random.default_rng(5), 200):
        assert np.array(belief.mean) == pytest.approx(mean, rel=1e-9, abs=1e-12)
        assert matrix(belief) == pytest.approx(covariance, rel=1e-7, abs=1e-14)


def test_a_wrong_sign_of_the_shared_noise_would_be_seen():
    *_, (belief, mean, _) = course(np.random.default_rng(5), 200, sign=-1.0)
    assert abs(np.array(belief.mean) - mean).max() > 1e-3


def test_covariance_stays_positive():
    for seed in range(5):
        for belief, _, _ in course(np.random.default_rng(seed), 500):
            assert np.linalg.eigvalsh(matrix(belief)).min() > 0.0


def test_a_measurement_that_is_not_used_changes_nothing():
    belief = independent([30.0, 1.0], [0.05, 0.2])
    assert corrected(belief, [1.0, 0.0], 3.0, 0.01, use=0.0) == belief


def test_spread_is_the_variance_of_the_first_unknown():
    belief = Belief((30.0, 1.0), (4.0, 0.5, 9.0))
    assert belief.spread == belief.between(0, 0) == 4.0
    assert belief.between(1, 0) == belief.between(0, 1) == 0.5
    assert belief.with_spread(1.0).covariance == (5.0, 0.5, 9.0)
