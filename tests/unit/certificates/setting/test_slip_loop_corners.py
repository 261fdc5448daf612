"""Corners of the sampled slip loop: they enclose what a sample can be."""

import math
from fractions import Fraction

import flint
import numpy as np
import pytest

from wspd_design.certificates.setting.slip_loop import (
    DISTURBANCES,
    STATES,
    LoopLaw,
    LoopRanges,
    corners,
    parts_of,
    polygon,
    wanted,
)

H = 0.02
UNITS = list(np.eye(STATES + len(DISTURBANCES)))
LAW = LoopLaw(sample_time=H, gain=0.16, ahead=0.5, pole=math.exp(-0.6))


def course(secants, random, pieces):
    """phi and psi/h of a course of the secant that changes at random."""
    ends = np.sort(np.concatenate([[0.0, H], random.uniform(0.0, H, pieces - 1)]))
    values = random.choice(secants, pieces) if pieces % 2 else random.uniform(*secants, pieces)
    phi, psi = 1.0, 0.0
    for span, q in zip(np.diff(ends), values, strict=True):
        grown = math.exp(q * span)
        phi, psi = phi * grown, psi * grown + (grown - 1.0) / q
    return phi, psi / H


def inside(point, outline):
    """Whether a point lies in the convex hull of the corners, by their sides."""
    middle = np.mean(outline, axis=0)
    order = sorted(outline, key=lambda each: math.atan2(each[1] - middle[1], each[0] - middle[0]))
    return all(
        (b[0] - a[0]) * (point[1] - a[1]) - (b[1] - a[1]) * (point[0] - a[0]) >= -1e-12
        for a, b in zip(order, order[1:] + order[:1], strict=True)
    )


@pytest.mark.parametrize("secants", [(-200.0, 5.0), (-7.0, 1.0), (2.0, 12.0)])
def test_polygon_encloses_every_course_of_the_secant(secants):
    outline, random = polygon(secants, H), np.random.default_rng(1)
    assert len(outline) == 6
    assert all(inside(course(secants, random, 2 + number % 5), outline) for number in range(400))


def test_polygon_without_a_corner_does_not():
    secants, random = (-200.0, 5.0), np.random.default_rng(1)
    outline = polygon(secants, H)
    courses = [course(secants, random, 2 + number % 5) for number in range(400)]
    for missing in range(2, 6):
        rest = [each for number, each in enumerate(outline) if number != missing]
        assert not all(inside(each, rest) for each in courses)


def test_corners_in_balls_are_those_in_doubles():
    def ranges(number):
        return LoopRanges(
            secants=(number(-7.0), number(1.0)),
            effects=(number(0.75), number(1.25)),
            parts=(number(0.5), number(1.125)),
            seen=(number(0.25), number(0.625)),
            pulse=number(0.5),
            delay=number(0.25),
            added=number(0.0),
        )

    law = LoopLaw(
        sample_time=flint.arb(H), gain=flint.arb(0.16), ahead=flint.arb(0.5), pole=flint.arb(LAW.pole)
    )
    balls = [flint.arb_mat([list(row)]) for row in np.eye(STATES + len(DISTURBANCES))]
    found = np.array(
        [[row.entries() for row in each] for each in corners(law, ranges(flint.arb), balls)], dtype=float
    )
    wanted_ones = np.array(list(corners(LAW, ranges(float), UNITS)), dtype=float)
    assert found.shape == (6 * 16, STATES, STATES + len(DISTURBANCES))
    np.testing.assert_allclose(found, wanted_ones, rtol=1e-9, atol=1e-12)


def test_constant_errors_are_at_rest():
    """Whatever pads, inertia and valve: without drift the loop stays where all deviations are zero, and only there."""
    ranges = LoopRanges(
        secants=(-3.0, 1.0),
        effects=(0.7, 1.3),
        parts=(0.4, 1.2),
        seen=(0.3, 0.6),
        pulse=1.0,
        delay=0.0,
        added=0.0,
    )
    for matrix in corners(LAW, ranges, UNITS):
        rest = np.array(matrix)[:, :STATES] - np.eye(STATES)
        assert np.linalg.matrix_rank(rest) == STATES
    assert len(wanted(LAW)) == STATES + 1


def test_part_of_the_way_is_the_assumed_time_over_the_true_one_for_short_pulses():
    assert parts_of((0.4, 1.2), 1e-9) == pytest.approx((0.4, 1.2))
    low, high = parts_of((0.4, 1.2), 0.5)
    assert low == pytest.approx(0.4)
    assert high == pytest.approx(1.2)
    assert parts_of((2.0, 2.0), float(Fraction(1, 2)))[0] < 2.0
