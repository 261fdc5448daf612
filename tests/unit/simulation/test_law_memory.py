"""What a law of the vehicle remembers along a stop, against numbers worked out by hand."""

from dataclasses import replace

import numpy as np
import pytest

from tests.unit.reporting.sample_dossier import INITIAL_SPEED, estimating, trial
from wspd_design.simulation.description import held_slip
from wspd_design.simulation.law_memory import (
    reference_range,
    released,
    releases,
    rms_about_references,
    slip_references,
    speed_estimate,
)

PLAIN = trial("mine").run
TELLING = estimating(trial("mine")).run


def test_a_law_that_tells_nothing_has_nothing_to_show():
    for told in (speed_estimate, slip_references, released, releases, reference_range, rms_about_references):
        assert told(PLAIN) is None
    assert held_slip(PLAIN, 0.14) == "0.14"


def test_errors_of_the_speed_count_above_20_km_h_alone():
    estimate = speed_estimate(TELLING)
    fast = estimate.true_speed > 20.0 / 3.6
    assert 0 < fast.sum() < len(fast)
    assert estimate.error[fast] == pytest.approx(0.05, rel=1e-9)
    assert np.isnan(estimate.error[~fast]).all()


def test_distance_of_a_speed_that_is_5_percent_too_high():
    """The distance of the estimate is that of a constant deceleration, 5 % longer; the true one is the trace's."""
    estimate = speed_estimate(TELLING)
    t = estimate.time
    counted = 1.05 * INITIAL_SPEED * (t - t**2 / 20.0)
    true = np.interp(t, TELLING.time, TELLING.distance)
    assert estimate.distance_error == pytest.approx(counted - (true - true[0]), abs=1e-9)
    assert estimate.allowed == pytest.approx(5.0 + 0.05 * true)


def test_references_and_their_range_above_10_km_h():
    assert slip_references(TELLING).shape == (100, 4)
    low, high = reference_range(TELLING)  # the train is slower than 10 km/h from 9.17 s on
    assert (low, high) == pytest.approx((0.1, 0.191))
    assert held_slip(TELLING, 0.14) == "the law's own, 0.1 to 0.191"


def test_rms_is_about_the_slips_that_the_law_holds():
    t = np.array([sample.time for sample in TELLING.samples])
    judged = np.interp(t, TELLING.time, TELLING.speed) > 10.0 / 3.6
    off = [
        np.interp(t, TELLING.time, TELLING.slip[:, axle])[judged] - (0.1 + 0.01 * t[judged])
        for axle in range(4)
    ]
    assert rms_about_references(TELLING) == pytest.approx(np.sqrt(np.mean(np.square(off))))


def test_wheelsets_without_a_brake_do_not_count():
    moved = replace(TELLING, axle_samples=((), *TELLING.axle_samples[1:]))
    assert rms_about_references(moved) != pytest.approx(rms_about_references(TELLING))
    assert speed_estimate(moved).speed == pytest.approx(speed_estimate(TELLING).speed)


def test_a_release_is_counted_once():
    assert releases(TELLING) == 2
    assert released(TELLING).sum(axis=0).tolist() == [0, 10, 0, 0]
