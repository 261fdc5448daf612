"""Limits of the state and changes that are left out, where only one thing makes the difference.

Wheels much lighter than the law takes them for, a reference that drifts and no noise, a told speed that is too high.
"""

import math
from dataclasses import replace
from fractions import Fraction
from itertools import product

import pytest

from tests.certificates.band.conftest import WET
from tests.certificates.band.test_slip_band_numbers import (
    DRIFT,
    LEAST,
    NOISE,
    PULSE,
    Course,
    Stop,
    doubles,
    friction_of,
    laws,
    loop_in,
)
from tests.certificates.band.test_slip_band_reference import EXACT, WINDOW, falling_problem


@pytest.fixture(scope="module")
def plain():
    return falling_problem(WET, 0.0, slip=0.5, largest=0.5)


def limit_of(loop, what):
    """The row of a limit and its bound; the largest state in one of its directions at a time."""
    (found,) = (each for each in loop.limits if each.what == what)
    return [float(x.mid()) for x in found.row], float(found.bound.mid())


def test_friction_is_observed_above_0_by_a_law_that_takes_the_wheels_for_heavier(plain):
    """What turns them is taken off the observed friction with the inertia of the law, and was added with their own."""
    vehicle, law = plain.vehicle, laws(plain)[0]
    light = replace(plain, vehicle=replace(vehicle, wheelset_inertia=0.3 * vehicle.wheelset_inertia))
    row, bound = limit_of(loop_in(light, law), "the observed friction above 0")
    assert [k for k, each in enumerate(row) if each] == [2]
    h, inertia, course = float(law.sample_time), float(law.inertia), Course(light, law, None)
    slowing = max(Stop(light, law, None, x).braking(v, 0.18) for x in (-0.02, 0.04) for v in WINDOW)
    seen = []
    for v, slow in product(WINDOW, (0.0, slowing)):
        rate = -(1.0 - 0.18) / vehicle.wheel_radius * slow
        held = course.holding(v, 0.18, 0.0) - light.vehicle.wheelset_inertia * rate
        seen.append(held + inertia * (bound / row[2] / h + rate))
    assert 0.0 <= min(seen) < 0.1 * max(seen) + 0.01 * float(law.full_torque)


@pytest.mark.parametrize("number", [1, 3])
def test_error_is_below_the_braking_curve_while_the_reference_drifts(plain, number):
    """The law knows nothing of that drift: it predicts the error with another rate of the reference."""
    law = laws(plain)[number]
    row, bound = limit_of(loop_in(plain, law), "the beginning of the braking curve")
    h, k, ahead, slew = (float(x) for x in (law.sample_time, law.approach_rate, law.ahead, law.torque_slew))
    drifted = h * float(DRIFT) / plain.vehicle.wheel_radius  # h times the rate that is not known
    error = bound / row[0]
    assert error + ahead * drifted <= slew / float(law.inertia) / k**2 + 1e-12


@pytest.mark.parametrize(
    ("what", "time"), [("the torque that is left", 1), ("the torque that the brake can add", 0)]
)
def test_longest_pulse_leaves_the_least_torque_and_room(plain, what, time):
    """Of what is there after it, not before."""
    law = replace(laws(plain)[0], vent_time=laws(plain)[0].vent_time / 2)
    supply = Fraction(9, 10)
    loop = loop_in(plain, law, conditions=EXACT._replace(supply=supply))
    row, bound = limit_of(loop, what)
    h, full = float(law.sample_time), float(law.sample_time * law.full_torque / law.inertia)
    venting = doubles(loop.pulses[1].height)
    kept = math.exp(-float(PULSE) * h / float((law.fill_time, law.vent_time)[time]))
    y = bound / row[3]
    there = venting[0] + y if time else float(supply) * full - venting[1] - y
    assert there * kept == pytest.approx(LEAST * full, rel=1e-6)


def test_dead_band_is_that_of_the_told_speed(plain):
    """It narrows with the desired slip, of which a train speed that is told too high has more."""
    law = replace(laws(plain)[0], dead_band=Fraction(10**6), dead_band_share=Fraction(1, 5))
    friction = friction_of(plain, law, WINDOW)
    wide, none = (
        doubles(
            loop_in(
                plain,
                replace(law, dead_band_share=share),
                friction=friction,
                conditions=EXACT._replace(noise=NOISE),
            ).disturbances[1]
        )
        for share in (law.dead_band_share, Fraction(0))
    )
    sliding = 0.18 * (WINDOW[1] + float(NOISE)) / plain.vehicle.wheel_radius
    left_out = float(law.sample_time * law.dead_band_share * law.approach_rate) * sliding
    assert wide[1] - none[1] == pytest.approx(left_out, rel=1e-6)
    assert none[0] - wide[0] == pytest.approx(left_out, rel=1e-6)
