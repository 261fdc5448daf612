"""What a drift of the reference brings along, against courses of its acceleration within the sample."""

from dataclasses import replace

import numpy as np
import pytest
from flint import ctx

from tests.certificates.band.courses import laws, loop_in
from wspd_design.certificates.kernel.arb import ball, point
from wspd_design.certificates.setting.slip_loop import DISTURBANCES, STATES, with_reference
from wspd_design.certificates.theorems.slip_band import checker
from wspd_design.certificates.theorems.slip_band.checker import drifting
from wspd_design.certificates.theorems.slip_band.loop import Steady
from wspd_design.certificates.theorems.slip_band.pulses import loop_law
from wspd_design.certificates.theorems.slip_band.turning import brought_along

COUNT = 2000  # parts of a sample, over which its integrals are sums
TIMES = (np.arange(COUNT) + 0.5) / COUNT
FILTERED = 0.064
TORQUE, MEAN, REFERENCE, MEAN_REFERENCE, LAG = (
    DISTURBANCES.index(each)
    for each in ("torque drift", "mean torque drift", "reference drift", "mean reference drift", "lag drift")
)
WEIGHTS = (
    *(np.where(each > TIMES, 1.0, 0.0) for each in (0.3, 0.5, 0.7)),
    1.0 - TIMES,
    1.0 - TIMES**2,
    (1.0 - TIMES) ** 2,
)
"""Shares of the sample that are left after a change, whatever the weights of what it sees: they fall from 1 to 0."""


def courses(random, low, high):
    """Courses of h^2 w_r'': at one end and then at the other, and any."""
    jumps = [np.where(each > TIMES, low, high) for each in (0.25, 0.4, 0.5, 0.6, 0.75)]
    return [
        *jumps,
        *[low + high - each for each in jumps],
        random.uniform(low, high, COUNT),
        0.0 * TIMES + high,
    ]


def left_by(course, weight, numbers):
    """What is left of each disturbance, over the sample, beside what comes with the drift of the reference."""
    idle, brought, steady = numbers
    rate = course + steady
    turning = rate.mean()
    seen = {
        TORQUE: -idle * turning,
        MEAN: -idle * (rate * weight).mean(),
        MEAN_REFERENCE: (rate * (1.0 - TIMES)).mean(),
        LAG: (rate * (1.0 - FILTERED * (1.0 - TIMES))).mean(),
    }
    return {k: each - float(brought.shares[k].mid()) * turning for k, each in seen.items()}


@pytest.mark.parametrize("steady", [0.0, -3e-4])
@pytest.mark.parametrize("weight", WEIGHTS)
def test_what_no_course_leaves_is_more_than_what_is_told(weight, steady):
    """The worst of them come close to it, where the weight is the one that it is for."""
    low, high, idles, random = -1.3e-4, 5e-5, (1.05, 1.25), np.random.default_rng(3)
    with ctx.workprec(128):
        beside, turning = ball(low, high), ball(low + steady, high + steady)
        half_way = float(weight.mean())
        brought = brought_along(
            turning,
            beside,
            ball(*idles),
            (ball(half_way, half_way), ball(half_way, half_way)),
            ball(FILTERED, FILTERED),
        )
        told = {
            TORQUE: brought.torque,
            MEAN: brought.mean_torque,
            MEAN_REFERENCE: brought.mean_reference,
            LAG: brought.lag,
        }
        ends = {k: (float(each.lower()), float(each.upper())) for k, each in told.items()}
    left = {k: [] for k in told}
    for course in courses(random, low, high):
        for idle in (*idles, sum(idles) / 2.0):
            for k, each in left_by(course, weight, (idle, brought, steady)).items():
                assert ends[k][0] - 1e-9 <= each <= ends[k][1] + 1e-9, DISTURBANCES[k]
                left[k].append(abs(each))
    for k in (MEAN_REFERENCE, LAG):
        assert max(left[k]) > 0.99 * ends[k][1]
    if set(weight) == {0.0, 1.0} and half_way == 0.5:
        assert max(left[MEAN]) > 0.8 * max(map(abs, ends[MEAN]))


def test_drift_of_the_reference_comes_with_its_shares_of_the_others():
    """A row of units for each number: that of the drift is in those of what it brings along."""
    units = list(np.eye(STATES + len(DISTURBANCES)))
    shares = [0.0] * len(DISTURBANCES)
    shares[TORQUE], shares[LAG] = -1.2, 0.97
    found = np.array(with_reference(units, shares))
    drift = STATES + REFERENCE
    expected = np.eye(len(units))
    expected[STATES + TORQUE, drift], expected[STATES + LAG, drift] = -1.2, 0.97
    assert np.array_equal(found, expected)


def test_steady_drift_moves_the_torque_its_mean_and_the_reference():
    with ctx.workprec(128):
        none, share, lag = (point(each) for each in (0.0, 0.4, -0.1))
        found = [float(each.mid()) for each in drifting(Steady(none, none, (none, none), share, lag))]
    expected = [0.0] * len(DISTURBANCES)
    expected[TORQUE], expected[MEAN], expected[REFERENCE] = 1.0, 0.4, -0.1
    assert found == expected


def test_errors_within_a_sample_see_the_mean_torque_that_the_reference_brings_along(plain):
    """Also what of it goes with the steady drift; all of a sample adds the effect of the torque times its length."""
    law = laws(plain)[0]
    loop = loop_in(plain, law)
    with ctx.workprec(128):
        none, one, half, at_once = (point(each) for each in (0.0, 1.0, 0.5, 1e-9))
        center = [none] * STATES
        states = checker.Set(
            [[at_once * (i == j) for j in range(STATES)] for i in range(STATES)], center, center
        )
        steady = Steady(none, half, (none, none), none, one)
        found = []
        for brought in (0.0, -2.0):
            shares = [none] * len(DISTURBANCES)
            shares[MEAN] = point(brought)
            ends = list(loop.disturbances)
            ends[REFERENCE] = none, half
            there = replace(
                loop,
                steady=steady,
                disturbances=tuple(ends),
                ranges=replace(loop.ranges, brought=tuple(shares)),
            )
            found.append(float(checker._within(loop_law(law), there, states)[0].lower()))
        h, effect = float(law.sample_time), float(loop.ranges.effects[1].mid())
        secant = float(loop.ranges.secants[1].mid())
    psi = np.expm1(secant * h) / secant / h
    # Half of it is the drift beside, the other half what goes with the steady one.
    assert found[1] - found[0] == pytest.approx(-2.0 * effect * psi, rel=1e-3)
