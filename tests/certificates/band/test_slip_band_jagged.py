"""Means of a friction whose slope jumps at the edges of its strips, and stays at either end of its bounds between them.

A friction curve of Polach has a slope that hardly changes; much of what its means lie between any bounds would hold.
"""

from fractions import Fraction

import numpy as np
import pytest

from wspd_design.certificates.kernel.arb import ball, point
from wspd_design.certificates.theorems.slip_band.friction import (
    FADINGS,
    REACHES,
    SLOPES,
    Friction,
    fading_at,
    mean_slope,
    reached,
    slope_at,
)

ROUNDING = 1e-12
INWARD = 1e-9  # an error that may lie outside is refused, if by rounding alone
COURSES = 12  # of the slope, within bounds that are drawn once


def edges_of(strips):
    return [float(strips[0][0]), *(float(high) for _, high in strips)]


class Course:
    """A slope over the errors of strips, the same everywhere in each."""

    def __init__(self, strips, values):
        self.edges, self.values = np.array(edges_of(strips)), np.array(values)
        self.whole = np.concatenate([[0.0], np.cumsum(self.values * np.diff(self.edges))])

    def mean(self, one, other):
        """Mean of the slope between two errors."""
        ends = np.interp([one, other], self.edges, self.whole)
        return (ends[1] - ends[0]) / (other - one)

    def at(self, error):
        """Slopes just below and just above an error."""
        places = [np.searchsorted(self.edges, error, side) - 1 for side in ("left", "right")]
        return self.values[np.clip(places, 0, len(self.values) - 1)]


def drawn(random):
    """Bounds of a slope and of a fading that differ from strip to strip."""
    pairs = [tuple(sorted(random.uniform(-1.0, 1.0, 2))) for _ in (*SLOPES, *FADINGS)]
    return Friction(tuple(pairs[: len(SLOPES)]), (0.8, 0.9), tuple(pairs[len(SLOPES) :]))


def courses(random, strips, bounds):
    return [
        Course(strips, [ends[side] for ends, side in zip(bounds, sides, strict=True)])
        for sides in random.integers(0, 2, (COURSES, len(strips)))
    ]


def errors_of(random, strips):
    """Balls of errors: edges, points, and ranges that are cut by an edge anywhere."""
    edges = edges_of(strips)
    edges[0], edges[-1] = edges[0] + INWARD, edges[-1] - INWARD
    found = [(each, each) for each in edges]
    found += [(x, x) for x in random.uniform(edges[0], edges[-1], 6)]
    found += [tuple(sorted(random.uniform(edges[0], edges[-1], 2))) for _ in range(6)]
    for edge in edges[1:-1]:
        found += [(edge - 3e-4, edge + 1e-4), (edge - 1e-4, edge + 3e-4)]
    return found


def encloses(found, value):
    return bool(found.lower() <= value + ROUNDING) and bool(found.upper() >= value - ROUNDING)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("reach", range(len(REACHES)))
def test_every_mean_from_an_error_to_another_is_between_its_bounds(reach, seed):
    random = np.random.default_rng(seed)
    friction = drawn(random)
    first, after = REACHES[reach]
    ends = [float(each) for each in reached(reach)]
    others = [*edges_of(SLOPES[first:after]), *random.uniform(*ends, 30)]
    for low, high in errors_of(random, SLOPES):
        found = mean_slope(friction, ball(*map(as_in_strips, (low, high))), reach)
        for course in courses(random, SLOPES, friction.slopes):
            for one in np.linspace(low, high, 1 if low == high else 7):
                means = [course.mean(one, other) for other in others if abs(other - one) > 1e-7]
                assert all(encloses(found, each) for each in (*means, *course.at(one)))


def as_in_strips(error):
    """The edge itself where an error is one, which no double is."""
    nearest = min(
        (end for strip in (*SLOPES, *FADINGS) for end in strip), key=lambda e: abs(e - Fraction(error))
    )
    return nearest if abs(nearest - Fraction(error)) < Fraction(1, 10**12) else Fraction(error)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize(
    ("at", "strips", "name"), [(slope_at, SLOPES, "slopes"), (fading_at, FADINGS, "fadings")]
)
def test_slope_and_fading_of_an_error_are_those_of_every_strip_it_may_lie_in(at, strips, name, seed):
    random = np.random.default_rng(seed)
    friction = drawn(random)
    for low, high in errors_of(random, strips):
        found = at(friction, ball(*map(as_in_strips, (low, high))))
        for course in courses(random, strips, getattr(friction, name)):
            for error in np.linspace(low, high, 1 if low == high else 7):
                assert all(encloses(found, each) for each in course.at(error))


def test_mean_of_one_strip_is_its_bound():
    """What is told is not more than the bounds say where there is one for all strips."""
    friction = Friction(((0.25, 0.5),) * len(SLOPES), (0.8, 0.9), ((0.1, 0.2),) * len(FADINGS))
    found = mean_slope(friction, point(Fraction(0)), 0)
    assert float(found.lower()) == pytest.approx(0.25)
    assert float(found.upper()) == pytest.approx(0.5)
