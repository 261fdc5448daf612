"""The fastest axle with a limited fall, and what it is worth where all axles slide."""

import pytest

from wspd_design.controllers.observers.fastest import FastestAxle

PERIOD = 0.02
SOURCE = FastestAxle(sample_time=PERIOD, wheel_radius=0.55, wheelsets=4)


def test_the_fastest_axle_counts(seen, follow):
    assert follow(SOURCE, [seen([20.0, 29.0, 30.0, 25.0])])[-1].speed == pytest.approx(30.0)


def test_a_lost_sensor_does_not_count_however_fast_it_shows(seen, follow):
    estimates = follow(SOURCE, [seen([20.0, 90.0, 30.0, 25.0], healthy=(1.0, 0.0, 1.0, 1.0))])
    assert estimates[-1].speed == pytest.approx(30.0)


def test_where_all_axles_slide_the_speed_falls_at_the_limit(seen, follow):
    steps = 50
    estimates = follow(SOURCE, [seen([30.0] * 4), *[seen([10.0] * 4)] * steps])
    assert estimates[-1].speed == pytest.approx(30.0 - SOURCE.largest_fall * PERIOD * steps)
    assert estimates[-1].acceleration == pytest.approx(-SOURCE.largest_fall, rel=0.05)


def test_a_wheel_that_rolls_again_lifts_the_speed_at_once(seen, follow):
    estimates = follow(SOURCE, [seen([30.0] * 4), *[seen([10.0] * 4)] * 50, seen([10.0, 29.9, 10.0, 10.0])])
    assert estimates[-1].speed == pytest.approx(29.9)


def test_speed_is_never_negative(seen, follow):
    assert follow(SOURCE, [seen([0.01] * 4), *[seen([0.0] * 4)] * 5])[-1].speed == 0.0
