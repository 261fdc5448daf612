"""Belief about the motion of the train: what torques, accelerometer and wheels teach."""

from dataclasses import replace

import pytest

from wspd_design.controllers.observers.train_motion import TrainMotion
from wspd_design.controllers.observers.wheel_filter_numbers import WheelFilterNumbers
from wspd_design.model.slip import resistance

PERIOD, RADIUS = 0.02, 0.55
NUMBERS = WheelFilterNumbers()


@pytest.fixture
def motion(er24pc):
    """Make a filter."""

    def make(*, accelerometer=False, grade=False):
        return TrainMotion(
            vehicle=er24pc, sample_time=PERIOD, accelerometer=accelerometer, grade=grade, numbers=NUMBERS
        )

    return make


def braked(filter_, *, scale, seconds, torques=60e3, bias=0.0, grade=0.0, rims=True):
    """Brake a train whose torques are wrong by a scale; the wheels show its speed, or not."""
    speed, belief = 30.0, filter_.start(30.0)
    vehicle = filter_.vehicle
    for _ in range(round(seconds / PERIOD)):
        specific = -scale * torques / (RADIUS * vehicle.mass) - resistance(vehicle, speed) / vehicle.mass
        speed += PERIOD * (specific - grade)
        belief = filter_.after_sample(belief, torques, specific + bias)
        if rims:
            belief = filter_.rim_seen(belief, speed, 0.0, 0.05**2, use=1.0, found=0.0)
    return speed, belief


def test_unknowns_follow_the_sensors(motion):
    assert motion().unknowns == ("train_speed", "torque_scale")
    assert motion(accelerometer=True, grade=True).unknowns == (
        "train_speed",
        "torque_scale",
        "accelerometer_bias",
        "grade_acceleration",
    )


@pytest.mark.parametrize("scale", [0.8, 1.0, 1.3])
def test_wheels_that_roll_teach_the_scale_of_the_torques(motion, scale):
    speed, belief = braked(motion(), scale=scale, seconds=6.0)
    assert belief.mean[1] == pytest.approx(scale, abs=0.01)
    assert belief.mean[0] == pytest.approx(speed, abs=0.02)


def test_torques_alone_are_wrong_by_their_scale(motion):
    speed, belief = braked(motion(), scale=1.3, seconds=6.0, rims=False)
    lost = 0.3 * 60e3 / (RADIUS * motion().vehicle.mass) * 6.0
    assert belief.mean[0] - speed == pytest.approx(lost, rel=0.02)
    assert belief.spread**0.5 > 0.6 * lost / 1.5  # and it knows: 1.5 deviations of the scale


def test_an_accelerometer_takes_the_scale_of_the_torques_away(motion):
    speed, belief = braked(motion(accelerometer=True), scale=1.3, seconds=6.0, bias=0.02, rims=False)
    assert belief.mean[0] == pytest.approx(speed, abs=0.15)
    assert belief.spread**0.5 < 0.3


def test_neither_torques_nor_accelerometer_feel_a_grade(motion):
    speed, belief = braked(motion(accelerometer=True), scale=1.0, seconds=6.0, grade=0.05, rims=False)
    assert belief.mean[0] - speed == pytest.approx(6.0 * 0.05, abs=0.02)


def test_wheels_that_roll_teach_what_neither_feels(motion):
    speed, belief = braked(motion(accelerometer=True, grade=True), scale=1.0, seconds=12.0, grade=0.05)
    assert belief.mean[2] + belief.mean[3] == pytest.approx(0.05, abs=0.005)  # only their sum counts
    assert belief.mean[3] > 0.02
    assert belief.mean[0] == pytest.approx(speed, abs=0.01)


def test_no_wheel_is_faster_than_the_train(motion):
    _, belief = braked(motion(), scale=1.0, seconds=3.0, rims=False)
    raised = motion().not_slower(belief, belief.mean[0] + 1.0)
    assert raised.mean[0] == belief.mean[0] + 1.0
    assert raised.mean[1] < belief.mean[1]  # the torques were believed to brake more than they do
    assert raised.spread == pytest.approx(1.0)
    assert motion().not_slower(belief, belief.mean[0] - 1.0) == belief


def test_a_surprise_by_a_wheel_that_was_found_is_not_one_about_the_scale(motion):
    _, belief = braked(motion(), scale=1.0, seconds=3.0, rims=False)
    rim = belief.mean[0] - 5.0
    told = {found: motion().rim_seen(belief, rim, 0.0, 0.0025, use=1.0, found=found) for found in (0.0, 1.0)}
    assert told[1.0].mean[0] == pytest.approx(rim, abs=0.05)
    assert abs(told[1.0].mean[1] - belief.mean[1]) < 0.5 * abs(told[0.0].mean[1] - belief.mean[1])


def test_numbers_are_those_of_the_record(motion):
    doubled = replace(motion(), numbers=replace(NUMBERS, scale_deviation=0.4))
    assert doubled.start(30.0).between(1, 1) == pytest.approx(0.16)
