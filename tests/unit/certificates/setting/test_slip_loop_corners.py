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
    latest_share,
    numbers_at_corners,
    parts_about,
    parts_of,
    parts_of_longer,
    polygon,
    sample,
    shares_together,
    wanted,
)

H = 0.02
UNITS = list(np.eye(STATES + len(DISTURBANCES)))
LAW = LoopLaw(sample_time=H, gain=0.16, ahead=0.5, pole=math.exp(-0.6), kept=math.exp(-0.2))


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
            parts=((number(0.5), number(0.5)), (number(1.125), number(1.125)), (number(0.25), number(0.5))),
            shares=((number(0.0), number(0.625)), (number(0.5), number(0.25))),
            shares_center=(number(0.125), number(0.375)),
        )

    law = LoopLaw(
        sample_time=flint.arb(H),
        gain=flint.arb(0.16),
        ahead=flint.arb(0.5),
        pole=flint.arb(LAW.pole),
        kept=flint.arb(LAW.kept),
    )
    balls = [flint.arb_mat([list(row)]) for row in np.eye(STATES + len(DISTURBANCES))]
    found = np.array(
        [
            [[row.entries() for row in each] for each in both]
            for both in corners(law, ranges(flint.arb), balls)
        ],
        dtype=float,
    )
    wanted_ones = np.array(list(corners(LAW, ranges(float), UNITS)), dtype=float)
    assert found.shape == (6 * 2 * 3 * 2, 2, STATES, STATES + len(DISTURBANCES))
    np.testing.assert_allclose(found, wanted_ones, rtol=1e-9, atol=1e-12)


def test_constant_errors_are_at_rest():
    """Whatever pads, inertia and valve: without drift the loop stays where all deviations are zero, and only there."""
    ranges = LoopRanges(
        secants=(-3.0, 1.0),
        effects=(0.7, 1.3),
        parts=((0.4, 0.4), (1.2, 1.2)),
        shares=((0.0, 0.3), (0.5, 0.6)),
        shares_center=(0.1, 0.5),
    )
    for matrix in (each for both in corners(LAW, ranges, UNITS) for each in both):
        rest = np.array(matrix)[:, :STATES] - np.eye(STATES)
        assert np.linalg.matrix_rank(rest) == STATES
    assert len(wanted(LAW)) == STATES


def test_center_has_its_own_part_and_share_and_all_else_of_the_sample():
    ranges = LoopRanges(
        secants=(-3.0, 1.0),
        effects=(0.7, 1.3),
        parts=((0.4, 0.6), (1.2, 0.9)),
        shares=((0.0, 0.6), (0.5, 0.3)),
        shares_center=(0.1, 0.5),
    )
    found = list(numbers_at_corners(LAW, ranges))
    assert {(rest[3], center[3]) for rest, center in found} == {(0.4, 0.6), (1.2, 0.9)}
    assert {rest[4:] for rest, _ in found} == {(0.0, 0.6), (0.5, 0.3)}
    assert {center[4:] for _, center in found} == {(0.1, 0.5)}
    assert all(rest[:3] == center[:3] for rest, center in found)
    for (rest, center), maps in zip(found, corners(LAW, ranges, UNITS), strict=True):
        for numbers, one in zip((rest, center), maps, strict=True):
            np.testing.assert_array_equal(np.array(one), np.array(sample(LAW, numbers, UNITS)))


def test_what_is_wanted_is_what_a_whole_way_leads_to():
    """The row of Y* against Y+ of a valve that goes the whole way; the lag counts as the error of the acceleration."""
    whole = np.array(sample(LAW, (1.0, 0.0, 0.0, 1.0, 0.0, 0.0), UNITS))[3]
    assert wanted(LAW) == pytest.approx(whole[:STATES])
    assert whole[4] == whole[STATES + DISTURBANCES.index("acceleration error")]


def test_pairs_of_parts_are_those_of_both_signs():
    """Ways beside the center on its side have its part; across 0 the rest has a part of the other side at worst."""
    side, other = (0.8, 1.1), (0.5, 1.4)
    assert set(parts_about(side, other)) == {(0.8, 0.8), (1.1, 1.1), (0.5, 0.8), (1.4, 1.1)}
    assert set(parts_about(other, side)) == {(0.5, 0.5), (1.4, 1.4)}
    random = np.random.default_rng(2)
    for one, opposite in ((side, other), (other, side), (side, side)):
        pairs = parts_about(one, opposite)
        for u, u_center in random.uniform(-1.0, 1.0, (200, 2)):
            part = random.choice(one if u * u_center > 0.0 else opposite)
            gone = [rest * (u - u_center) + center * u_center for rest, center in pairs]
            assert min(gone) - 1e-12 <= part * u <= max(gone) + 1e-12


def test_a_longer_way_goes_further_by_the_rate_at_one_of_the_ends():
    """A slow valve goes ever more of what is wanted, a fast one ever less; the rate goes farther than the part."""
    for speedup in (0.4, 1.3):
        low, high = parts_of_longer(speedup, 0.5)
        assert low < speedup < high or speedup in (low, high)
        part = parts_of((speedup, speedup), 0.5)
        assert low <= part[0] <= part[1] <= high
        ends = np.linspace(0.0, 0.5, 21)
        asked, gone = 1.0 - np.exp(-ends), 1.0 - np.exp(-speedup * ends)
        rates = np.diff(gone) / np.diff(asked)
        assert low <= rates.min() <= rates.max() <= high
        assert rates.min() < part[0] or rates.max() > part[1]


def test_part_of_the_way_is_the_assumed_time_over_the_true_one_for_short_pulses():
    assert parts_of((0.4, 1.2), 1e-9) == pytest.approx((0.4, 1.2))
    low, high = parts_of((0.4, 1.2), 0.5)
    assert low == pytest.approx(0.4)
    assert high == pytest.approx(1.2)
    assert parts_of((2.0, 2.0), float(Fraction(1, 2)))[0] < 2.0


def test_a_pulse_sees_the_torque_before_it_until_it_has_begun_and_half_of_it_is_gone():
    """A steady rise over half of the sample after a quarter of it; what the supply adds may come last."""
    assert latest_share(1e-4, 0.5, 0.25, 0.0) == pytest.approx(0.5, abs=1e-3)
    assert latest_share(1e-4, 0.5, 0.25, 0.25) == pytest.approx(0.6, abs=1e-3)
    assert latest_share(0.5, 0.5, 0.25, 0.0) > 0.5  # earlier changes count more where errors grow


def test_shares_that_go_together_lie_between_their_corners():
    """All (1 - l a, l b) with one l; corners without what goes along with l, or aside, leave some out."""
    left, true, law = (0.4, 1.0), (0.9, 1.02), (0.58, 0.62)
    random = np.random.default_rng(3)
    points = [
        (1.0 - part * random.choice(true), part * random.choice(law))
        for part in (*left, *random.uniform(*left, 200))
    ]
    points += [(1.0 - part * a, part * b) for part in left for a in true for b in law]
    outline = shares_together(left, true, law)
    assert len(outline) == 4
    assert all(inside(each, list(outline)) for each in points)
    for narrower in (((0.55, 1.0), true, law), (left, true, (0.6, 0.6)), (left, (0.96, 0.96), law)):
        assert not all(inside(each, list(shares_together(*narrower))) for each in points)
    # Apart from each other they may be anything.
    assert not inside((0.0, 0.3), list(outline))
