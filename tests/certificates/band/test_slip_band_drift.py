"""Drift of what holds a reference, and the lag of the filter behind it, in corners that no proof comes near.

Damped wheels, much resistance, a wandering slip: each against a train in equations of its own.
"""

import math
from dataclasses import replace
from fractions import Fraction
from itertools import product

import numpy as np
import pytest

from tests.certificates.band.courses import (
    SPEED,
    WINDOW,
    Steered,
    Stop,
    doubles,
    friction_of,
    laws,
    left_beside,
    loop_in,
    wandering,
    within,
)
from wspd_design.certificates.theorems.slip_band.friction import SLOPES
from wspd_design.certificates.theorems.slip_band.reference import slip_at, turning_at
from wspd_design.certificates.theorems.slip_band.statement import JERK_FACTORS


@pytest.mark.parametrize("settled", [-0.01, 0.05])
@pytest.mark.parametrize("number", range(4))
@pytest.mark.parametrize("kind", ["plain", "damped", "oiled"])
def test_what_disturbs_in_a_sample_is_within_its_bounds(request, kind, number, settled):
    """With errors that grow by either end of the secants, and other wheels at the ends of what is reached.

    Those that turn faster than the reference brake the train by another force: oiled wheels tell that.
    """
    problem = request.getfixturevalue(kind)
    law = laws(problem)[number]
    loop = loop_in(problem, law, settled)
    ends = [doubles(each) for each in loop.disturbances]
    pace, slip = wandering(law, problem)
    starts = np.linspace(0.0, 2.0 * math.pi / pace, 9) if pace else (0.0,)
    for others, start, secant in product((-0.02, 0.0, 0.04), starts, doubles(loop.ranges.secants)):
        stop = Stop(problem, law, slip, others)
        seen, steady = stop.disturbed(start, settled, secant), 0.0
        if not (law.falls or law.slip_error):
            steady, d = 0.0, 1e-4
            change = stop.holding(SPEED + d, 0.18, settled) - stop.holding(SPEED - d, 0.18, settled)
            h = float(law.sample_time)
            steady = -h * h * change / (2.0 * d) * stop.braking(SPEED, 0.18) / float(law.inertia)
            assert within(steady, doubles((loop.steady.low, loop.steady.high)))
        for k, value in left_beside(loop, seen, steady).items():
            assert within(value, ends[k], 2e-8), k


@pytest.mark.parametrize("number", range(4))
@pytest.mark.parametrize("factor", JERK_FACTORS)
def test_wheels_of_any_inertia_in_a_cell_are_disturbed_within_its_bounds(plain, number, factor):
    """What turns them is torque of their own inertia; what comes with the drift of the reference is that of one."""
    law, inertia = laws(plain)[number], plain.vehicle.wheelset_inertia
    ends = 0.8 * inertia, 1.3 * inertia
    loop = loop_in(plain, law, ranges={"wheelset inertia": ends})
    steady = 0.0
    if number == 0:
        stop = Steered(plain, law, wandering(law, plain)[1], float(factor))
        change = stop.holding(SPEED + 1e-4, 0.18, 0.0) - stop.holding(SPEED - 1e-4, 0.18, 0.0)
        steady = (
            -(float(law.sample_time) ** 2) * change / 2e-4 * stop.braking(SPEED, 0.18) / float(law.inertia)
        )
    for own, secant in product(ends, doubles(loop.ranges.secants)):
        there = replace(plain, vehicle=replace(plain.vehicle, wheelset_inertia=own))
        stop = Steered(there, law, wandering(law, there)[1], float(factor))
        left = left_beside(loop, stop.disturbed(0.0, 0.0, secant), steady)
        for k, value in left.items():
            assert within(value, doubles(loop.disturbances[k])), k


def test_mean_of_the_drift_counts_for_errors_that_grow_and_for_those_that_fade(plain):
    """With a slope that may be anything in a wide range."""
    law = laws(plain)[0]
    friction = friction_of(plain, law, WINDOW)
    loop = loop_in(plain, law, friction=friction._replace(slopes=((-1.0, 1.0),) * len(SLOPES)))
    stop, h = Stop(plain, law, lambda *_: 0.18), float(law.sample_time)
    before, after = (stop.holding(SPEED + d, 0.18, 0.0) for d in (-1e-4, 1e-4))
    steady = -h * h * (after - before) / 2e-4 * stop.braking(SPEED, 0.18) / float(law.inertia)
    for secant in doubles(loop.ranges.secants):
        assert abs(secant) > 5.0
        value = left_beside(loop, stop.disturbed(0.0, 0.0, secant), steady)[3]
        assert within(value, doubles(loop.disturbances[3]), 1e-9)


@pytest.mark.parametrize("settled", [-0.06, 0.0, 0.13])
@pytest.mark.parametrize("factor", JERK_FACTORS)
@pytest.mark.parametrize("number", [0, 2])
def test_drift_of_a_train_whose_deceleration_rises_faster_or_slower_is_within_its_bounds(
    plain, number, factor, settled
):
    law = laws(plain)[number]
    loop, h = loop_in(plain, law, settled), float(law.sample_time)
    ends = [doubles(each) for each in loop.disturbances]
    _, slip = wandering(law, plain)
    stop, steady = Steered(plain, law, slip, float(factor)), [0.0, 0.0]
    if not law.falls:
        for k, v in enumerate((SPEED, stop.speeds(SPEED, (0.0, h))[1])):
            change = stop.holding(v + 1e-4, 0.18, settled) - stop.holding(v - 1e-4, 0.18, settled)
            steady[k] = -h * h * change / 2e-4 * stop.braking(v, 0.18) / float(law.inertia)
        assert within(steady[1] - steady[0], doubles(loop.steady.change))
    for secant in doubles(loop.ranges.secants):
        for k, value in left_beside(loop, stop.disturbed(0.0, settled, secant), steady[0]).items():
            assert within(value, ends[k]), k


@pytest.mark.parametrize(("number", "shown"), [(1, 1.0), (3, 1.0), (1, 0.0)])
def test_lag_of_the_filter_behind_a_slip_that_wanders_is_within_its_bounds(damped, number, shown):
    """Behind a slip that does not fall, also of a filter that has shown nothing yet."""
    law, window = laws(damped)[number], (8.0, 8.1)
    pace, slip = wandering(law, damped, 0.99)
    loop = loop_in(damped, law, window=window)
    h, radius = float(law.sample_time), damped.vehicle.wheel_radius
    kept = math.exp(-float(law.sample_time / law.acceleration_time))
    stop, seen = Stop(damped, law, slip), []
    for start, first in product(np.linspace(0.0, 2.0 * math.pi / pace, 9), (8.5, 8.51, 8.52)):
        speeds, filtered, times = [first], -shown * stop.braking(first, slip(start, first)), [start]
        lags, rates = [], []
        while speeds[-1] >= window[0]:
            speed, t = speeds[-1], times[-1]
            turning = turning_at(law, speed, radius) - (slip(t, speed) - slip_at(law, speed, radius))
            rates.append(-turning / radius * stop.braking(speed, slip(t, speed)))
            lags.append(h * rates[-1] - h * turning / radius * filtered)
            if len(lags) > 1 and speeds[-2] <= window[1]:
                seen.append({4: h * (rates[-1] - rates[-2]), 9: lags[-1] - kept * lags[-2]})
            speeds.append(stop.speeds(speed, t + np.linspace(0.0, h, 11))[-1])
            times.append(t + h)
            filtered += (1.0 - kept) * ((speeds[-1] - speed) / h - filtered)
    assert len(seen) >= 9
    assert all(within(left_beside(loop, each)[9], doubles(loop.disturbances[9])) for each in seen)


@pytest.mark.parametrize("factor", JERK_FACTORS)
@pytest.mark.parametrize("number", [0, 1])
def test_filter_of_a_speed_that_is_told_wrong_lags_within_its_bounds(plain, number, factor):
    """What the law takes for its reference moves by the train and by the slip: the filter shows the one late.

    The other one is all wrong.
    """
    law = laws(plain)[number]
    loop = loop_in(plain, law)
    pace, slip = wandering(law, plain)
    h, radius = float(law.sample_time), plain.vehicle.wheel_radius
    kept = math.exp(-float(law.sample_time / law.acceleration_time))
    seen, rates = [], []
    for start in np.linspace(0.0, 2.0 * math.pi / pace, 17) if pace else (0.0,):
        stop = Steered(plain, law, slip, float(factor))
        sub = np.linspace(0.0, h, 41)
        speeds = stop.speeds(SPEED, sub)
        # Long before, the train lost speed in the same way, and slip and share of the rims were nearly the same.
        of_train = of_slip = 0.0

        def turning(t, v):
            return turning_at(law, v, radius) - (slip(t, v) - slip_at(law, v, radius))

        for j in range(200, 0, -1):
            t, v = start - j * h, SPEED + stop.most * j * h + stop.jerk * (j * h) ** 2 / 2.0
            rate = stop.most + stop.jerk * j * h
            of_train += (1.0 - kept) * (
                -(rate - stop.jerk * h / 2.0) * turning(t + h / 2.0, v) / radius - of_train
            )
            moved = (slip(t + h, SPEED) - slip(t, SPEED)) / h * SPEED / radius
            of_slip += (1.0 - kept) * (moved - of_slip)
        lag = h * (-stop.most * turning(start, SPEED) / radius - of_train)
        _, _, _, rate, _ = stop.sample(start, 0.0)
        mean = np.trapezoid(rate, sub) / h
        of_train += (1.0 - kept) * (mean - of_train)
        seen.append({4: h * (rate[-1] - rate[0]), 9: h * (rate[-1] - of_train) - kept * lag})
        rates.append(h * of_slip)
        assert speeds[-1] >= WINDOW[0]
    assert all(within(left_beside(loop, each)[9], doubles(loop.disturbances[9])) for each in seen)
    assert all(within(each, doubles(loop.disturbances[0])) for each in rates)


@pytest.mark.parametrize("factor", JERK_FACTORS)
@pytest.mark.parametrize("before", JERK_FACTORS)
@pytest.mark.parametrize("smoothing", [Fraction(1, 50), Fraction(3, 10), Fraction(20), Fraction(1000)])
def test_lag_that_has_settled_shrinks_with_what_the_rims_take_part_in(plain, smoothing, before, factor):
    """A slip that falls takes the rims less along at lower speeds, and a filter that is slow lags far behind."""
    law = replace(laws(plain)[2], acceleration_time=smoothing)
    loop = loop_in(plain, law)
    _, slip = wandering(law, plain)
    h, radius = float(law.sample_time), plain.vehicle.wheel_radius
    kept = math.exp(-float(law.sample_time / law.acceleration_time))

    def later(lag, factor):
        """The lag after a sample in which the deceleration rises by a factor of what it does, and what turns."""
        stop = Steered(plain, law, slip, float(factor))
        speeds = stop.speeds(SPEED, (0.0, h))
        turned = [h * turning_at(law, v, radius) / radius for v in speeds]
        braking = [stop.braking(speed, None) for speed in speeds]
        filtered = -braking[0] - lag / turned[0]
        filtered += (1.0 - kept) * ((speeds[1] - speeds[0]) / h - filtered)
        return turned[1] * (-braking[1] - filtered), turned[0] * braking[0] - turned[1] * braking[1]

    # What it is after a sample goes in proportion to what it was.
    settled = later(0.0, before)[0] / (1.0 - (later(1.0, before)[0] - later(0.0, before)[0]))
    assert later(settled, before)[0] == pytest.approx(settled)
    for lag in (0.0, settled):
        after, turns = later(lag, factor)
        left = left_beside(loop, {4: turns, 9: after - kept * lag})
        assert within(left[9], doubles(loop.disturbances[9]))
