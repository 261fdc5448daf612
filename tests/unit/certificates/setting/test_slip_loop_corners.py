"""Corners of the sampled slip loop: they enclose what a sample can be."""

import math
from dataclasses import replace
from itertools import product

import flint
import numpy as np
import pytest
from scipy.optimize import linprog

from wspd_design.certificates.setting.slip_loop import (
    DISTURBANCES,
    REFERENCE_DRIFT,
    STATES,
    LoopLaw,
    LoopRanges,
    Way,
    corners,
    cut_to,
    latest_share,
    numbers_at_corners,
    polygon,
    sample,
    shares_together,
    wanted,
    ways_about,
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
            ways=tuple(
                Way(*map(number, each))
                for each in ((0.5, 0.5, 0.0, 0.625), (1.125, 1.125, 0.5, 0.25), (0.25, 0.5, 0.25, 0.5))
            ),
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
    assert found.shape == (6 * 2 * 3, 2, STATES, STATES + len(DISTURBANCES))
    np.testing.assert_allclose(found, wanted_ones, rtol=1e-9, atol=1e-12)


def test_constant_errors_are_at_rest():
    """Whatever pads, inertia and valve: without drift the loop stays where all deviations are zero, and only there."""
    ranges = LoopRanges(
        secants=(-3.0, 1.0),
        effects=(0.7, 1.3),
        ways=(Way(0.4, 0.4, 0.0, 0.3), Way(1.2, 1.2, 0.5, 0.6)),
        shares_center=(0.1, 0.5),
    )
    for matrix in (each for both in corners(LAW, ranges, UNITS) for each in both):
        rest = np.array(matrix)[:, :STATES] - np.eye(STATES)
        assert np.linalg.matrix_rank(rest) == STATES
    assert len(wanted(LAW)) == STATES


def test_drift_of_the_reference_brings_others_along_at_all_corners():
    """Its column has what it brings along of theirs, for the rest and for the center."""
    drift = STATES + DISTURBANCES.index(REFERENCE_DRIFT)
    alone = LoopRanges(
        secants=(-3.0, 1.0),
        effects=(0.7, 1.3),
        ways=(Way(0.4, 0.6, 0.0, 0.6), Way(1.2, 0.9, 0.5, 0.3)),
        shares_center=(0.1, 0.5),
    )
    shares = np.linspace(-1.0, 1.0, len(DISTURBANCES))
    shares[DISTURBANCES.index(REFERENCE_DRIFT)] = 0.0
    together = replace(alone, brought=tuple(shares))
    before, after = (np.array(list(corners(LAW, each, UNITS)), dtype=float) for each in (alone, together))
    before[..., drift] += before[..., STATES:] @ shares
    np.testing.assert_allclose(after, before, rtol=1e-12, atol=1e-12)


def test_center_has_its_own_part_and_share_and_all_else_of_the_sample():
    ranges = LoopRanges(
        secants=(-3.0, 1.0),
        effects=(0.7, 1.3),
        ways=(Way(0.4, 0.6, 0.0, 0.6), Way(1.2, 0.9, 0.5, 0.3)),
        shares_center=(0.1, 0.5),
        pulls=(1.0, 0.4),
    )
    found = list(numbers_at_corners(LAW, ranges))
    assert {(rest[3], center[3]) for rest, center in found} == {(0.4, 0.6), (1.2, 0.9)}
    assert {rest[4:6] for rest, _ in found} == {(0.0, 0.6), (0.5, 0.3)}
    assert {center[4:] for _, center in found} == {(0.1, 0.5, 1.0)}
    assert {rest[3:4] + rest[6:] for rest, _ in found} == {(0.4, 1.0), (0.4, 0.4), (1.2, 1.0), (1.2, 0.4)}
    assert all(rest[:3] == center[:3] for rest, center in found)
    for (rest, center), maps in zip(found, corners(LAW, ranges, UNITS), strict=True):
        for numbers, one in zip((rest, center), maps, strict=True):
            np.testing.assert_array_equal(np.array(one), np.array(sample(LAW, numbers, UNITS)))


def test_what_is_wanted_is_what_a_whole_way_leads_to():
    """The row of Y* against Y+ of a valve that goes the whole way; the lag counts as the error of the acceleration."""
    for pull in (1.0, 0.3):
        whole = np.array(sample(LAW, (1.0, 0.0, 0.0, 1.0, 0.0, 0.0, pull), UNITS))[3]
        assert wanted(LAW, pull) == pytest.approx(whole[:STATES])
        assert whole[4] == whole[STATES + DISTURBANCES.index("acceleration error")]
    assert wanted(LAW)[0] == pytest.approx(wanted(LAW, 0.5)[0] * 2.0)


def test_ways_that_are_cut_lose_the_same_share_of_what_goes_and_of_the_mean():
    """Y+ and the observer's mean of a way that is cut are those of so much less of the rest; not so the center's."""
    ways = (Way(0.4, 0.6, 0.1, 0.5), Way(1.2, 0.6, 0.2, 0.9))
    found = cut_to(ways, 0.25)
    assert found == (*ways, Way(0.1, 0.6, 0.1, 0.125), Way(0.3, 0.6, 0.2, 0.225))
    # A command error of 1 goes through the valve alone, and counts for as much less.
    column = STATES + DISTURBANCES.index("command error")
    whole, cut = (
        np.array(sample(LAW, (0.9, 0.8, 1.1, each.part, each.late, each.seen, 1.0), UNITS))[:, column]
        for each in (found[1], found[3])
    )
    assert cut[[0, 3]] == pytest.approx(0.25 * whole[[0, 3]])


def test_ways_are_those_of_both_signs():
    """Ways beside the center on its side have its part; of those across 0, the way at the center has the other part."""
    random, share = np.random.default_rng(2), (0.1, 0.5)
    for one, other in (((0.8, 1.1), (0.5, 1.4)), ((0.5, 1.4), (0.8, 1.1)), ((0.8, 1.1), (0.8, 1.1))):
        for far in (0.3, 1.0):
            ways = ways_about(one, other, far, ([share], [share]), share)
            for u_center in random.uniform(0.1, 1.0, 100):
                part, there = random.choice(one), random.choice(other)
                for u, gone in (
                    (random.uniform(0.0, 3.0), part),
                    (-u_center * far / (1.0 - far) * random.uniform() if far < 1.0 else -9.0, None),
                ):
                    whole = gone * u if gone is not None else there * u
                    ends = [each.part * (u - u_center) + each.part_center * u_center for each in ways]
                    assert min(ends) - 1e-12 <= whole <= max(ends) + 1e-12


def test_a_way_from_none_to_the_other_side_counts_with_its_own_shares():
    """As far as it can be: what is late there, and of the mean, each for its part of the distance."""
    (*_, last) = ways_about((0.8, 0.8), (1.2, 1.2), 0.75, ([(0.0, 0.6)], [(0.4, 0.3)]), (0.1, 0.55))
    assert last.part == pytest.approx(0.25 * 0.8 + 0.75 * 1.2)
    assert last.part_center == 0.8
    assert last.part * (1.0 - last.late) == pytest.approx(0.25 * 0.8 * 0.9 + 0.75 * 1.2 * 0.6)
    assert last.seen == pytest.approx(0.25 * 0.55 + 0.75 * 0.3)


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


def counted(way, part, late, seen):
    """What a wanted way goes, what of that the wheel sees, and what of it the law counts in its mean."""
    return np.array([part, part * (1.0 - late), seen]) * way


def distance(corners_of, there):
    """Least distance of a point from the mixtures of some points."""
    count, rows = len(corners_of), np.array(corners_of).T
    found = linprog(
        [*np.zeros(count), 1.0],
        A_ub=np.concatenate([np.column_stack([sign * rows, -np.ones(len(rows))]) for sign in (1.0, -1.0)]),
        b_ub=np.concatenate([there, -there]),
        A_eq=[[*np.ones(count), 0.0]],
        b_eq=[1.0],
    )
    assert found.status == 0
    return float(found.fun)


@pytest.mark.parametrize("seed", range(6))
def test_ways_with_any_shares_are_mixtures_of_the_corners(seed):
    """Further than the one at the center, by its own shares; and from none to the other side, by those of that side."""
    random = np.random.default_rng(seed)
    side, other = (tuple(np.sort(random.uniform(0.4, 1.2, 2))) for _ in range(2))
    own, opposite, center = random.random((3, 2)), random.random((4, 2)), random.random(2)
    most = random.uniform(0.3, 3.0)  # to the other side, over the way at the center
    ways = ways_about(side, other, most / (most + 1.0), (own, opposite), center)
    outline = [[*counted(1.0, each.part, each.late, each.seen), each.part_center] for each in ways]
    for rho in side:
        for share in own:
            assert distance(outline, np.array([*counted(1.0, rho, *share), rho])) < 1e-9
        for there, share, way in product(other, opposite, (0.0, -0.4 * most, -most)):
            beside = counted(way, there, *share) - counted(1.0, rho, *center)
            assert distance(outline, np.array([*beside / (way - 1.0), rho])) < 1e-9
