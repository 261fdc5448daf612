"""A told speed: calibrated while the wheels roll, and only then; its acceleration."""

from dataclasses import replace

import pytest

import wspd_design as wd
from wspd_design.controllers.observers.selection import speed_source
from wspd_design.controllers.observers.sensors import Sensors
from wspd_design.controllers.observers.told import SOURCE_ERROR, ToldSpeed
from wspd_design.parameters.bounds import EXACT

RADIUS, PERIOD, NONE = 0.55, 0.02, (0.0,) * 4
SOURCE = ToldSpeed(sample_time=PERIOD, wheel_radius=RADIUS, wheelsets=4)


def first(seen):
    return SOURCE.step(SOURCE.start(seen), seen, NONE, NONE)[1]


@pytest.mark.parametrize("error", [-0.02, 0.0, 0.02])
def test_wheels_that_roll_take_the_scale_of_the_source_away(seen, error):
    assert first(seen([30.0] * 4, speed=30.0 * (1.0 + error))).speed == pytest.approx(30.0, rel=1e-14)


def test_a_lost_sensor_does_not_count(seen):
    assert first(
        seen([30.0, 0.0, 30.0, 30.0], speed=30.3, healthy=(1.0, 0.0, 1.0, 1.0))
    ).speed == pytest.approx(30.0)


@pytest.mark.parametrize(
    ("rims", "demand", "healthy"),
    [
        ([28.0] * 4, 0.0, (1.0,) * 4),  # no wheel is 7 % slower than told unless it slides
        ([29.5] * 4, 0.5, (1.0,) * 4),  # the brake is on already
        ([0.0] * 4, 0.0, (0.0,) * 4),  # nothing to go by
    ],
)
def test_wheels_that_may_not_roll_leave_the_speed_as_told(seen, rims, demand, healthy):
    assert first(seen(rims, speed=30.0, demand=demand, healthy=healthy)).speed == 30.0


def test_scale_stays_while_the_wheels_slide(seen, follow):
    rolling, sliding = seen([30.0] * 4, speed=30.6), seen([20.0] * 4, speed=20.4 * 1.5, demand=1.0)
    *_, last = follow(SOURCE, [rolling, sliding])
    assert last.speed == pytest.approx(30.0)


def test_acceleration_is_that_of_the_calibrated_speed_after_the_filter(seen, follow):
    falling = [30.6 - 1.02 * PERIOD * k for k in range(100)]
    *_, last = follow(SOURCE, [seen([30.0] * 4, speed=each) for each in falling])
    assert last.acceleration == pytest.approx(-1.0, rel=2e-3)  # 2 s are seven times that of the filter


def test_nobody_is_released(seen):
    estimate = first(seen([30.0] * 4, speed=30.0))
    assert estimate.release == estimate.hold == NONE


def test_worn_wheels_roll_as_well(seen):
    """A wheel of 510 mm turns 7.8 % faster than one of 550, which a source that expects new wheels calls sliding."""
    worn = seen([30.0 * 550.0 / 510.0] * 4, speed=30.0)
    assert first(worn).speed == 30.0
    vehicle = wd.load_vehicle("er24pc")
    source = speed_source(Sensors(), vehicle, PERIOD)
    assert source.largest_scale_error == pytest.approx(SOURCE_ERROR + 40.0 / 510.0)
    assert source.start(worn)[0] == pytest.approx(30.0 * 550.0 / 510.0)
    known = speed_source(Sensors(), replace(vehicle, bounds=EXACT), PERIOD)
    assert known.largest_scale_error == SOURCE_ERROR
