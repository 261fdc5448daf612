"""Bounds of the friction in strips about the reference: what they enclose of a real friction curve."""

from dataclasses import replace
from fractions import Fraction
from itertools import pairwise

import numpy as np
import pytest
from flint import arb

import wspd_design as wd
from wspd_design.certificates.kernel.arb import ball, point
from wspd_design.certificates.kernel.checker import Refused
from wspd_design.certificates.theorems.slip_band import friction
from wspd_design.certificates.theorems.slip_band.friction import (
    FADINGS,
    PARTS,
    REACHES,
    SLOPES,
    Friction,
    Part,
    bounds_for,
    fading_at,
    mean_slope,
    parts_of,
    reached,
    slope_at,
    strip_of,
)
from wspd_design.model.slip import slip_dynamics
from wspd_design.parameters.loading import constants
from wspd_design.parameters.units import KMH

LOCO, WET = wd.load_vehicle("er24pc"), wd.load_rail("polach-wet")
SLOWEST, SLIP = 10.0 / KMH, 0.14
SPEED = 12.0 / KMH
FINE = 41  # points in a strip
ROUNDING = 1e-9  # s/m, of differences


def level_at(error, mu0=WET.mu0, speed=SPEED):
    """Force over mu0 Q of a wheel with an error, e R over the lowest speed."""
    slip = SLIP - error * SLOWEST / speed
    load = LOCO.mass * constants().gravity / 8.0
    return float(slip_dynamics(LOCO, replace(WET, mu0=mu0), slip, speed).creep_force) / (mu0 * load)


def secant(one, other, **where):
    """Mean of -S between two errors [s/m]."""
    return (level_at(other, **where) - level_at(one, **where)) / ((other - one) * SLOWEST)


def fading(error, mu0, speed):
    """By how much the force falls with the speed at the slip of an error, over the slip [s/m]."""
    slip, d = SLIP - error * SLOWEST / speed, 1e-4
    # At the same slip, the error is another one at another speed.
    ends = [level_at((SLIP - slip) * v / SLOWEST, mu0, v) for v in (speed - d, speed + d)]
    return (ends[1] - ends[0]) / (2.0 * d) / slip


def points_of(strip):
    return np.linspace(*map(float, strip), FINE)


def hull(values):
    return float(min(values)) - ROUNDING, float(max(values)) + ROUNDING


def bounds(*places):
    """Bounds of the curve at some mu0 and speeds: means between points are those of secants to the next point."""
    where = [{"mu0": mu0, "speed": speed} for mu0, speed in places]
    return Friction(
        slopes=tuple(
            hull([secant(a, b, **at) for at in where for a, b in pairwise(xs)])
            for xs in map(points_of, SLOPES)
        ),
        level=hull([level_at(0.0, **at) for at in where]),
        fadings=tuple(hull([fading(x, **at) for at in where for x in points_of(each)]) for each in FADINGS),
    )


@pytest.fixture(scope="module")
def curve():
    return bounds((WET.mu0, SPEED))


def error_points(reach):
    first, after = REACHES[reach]
    return [float(x) for strip in SLOPES[first:after] for x in points_of(strip)]


def inside(value, enclosure):
    return bool(enclosure.lower() <= value + ROUNDING) and bool(enclosure.upper() >= value - ROUNDING)


# Inside of a strip, on an edge, near one, and balls in which errors of one, of two and of three strips lie.
ERRORS = (
    ("0", "0"),
    ("0.007", "0.007"),
    ("0.0159", "0.0159"),
    ("0.004", "0.004"),
    ("-0.002", "-0.002"),
    ("0.01", "0.01"),
    ("0.00399", "0.00399"),
    ("0.0025", "0.0055"),
    ("0.009", "0.0101"),
    ("0.003", "0.011"),
    ("0.005", "0.009"),
)
CASES = [(reach, *each) for reach in range(len(REACHES)) for each in ERRORS]


def missed(curve, reach, low, high):
    """Secants between an error of the ball and any other of the reach that are not enclosed."""
    found = mean_slope(curve, ball(Fraction(low), Fraction(high)), reach)
    others, apart = error_points(reach), 1e-6
    means = [
        secant(one, other)
        for one in np.linspace(float(low), float(high), 1 if low == high else 9)
        for other in others
        if abs(other - one) > apart
    ]
    return sum(not inside(each, found) for each in means), found, means


@pytest.mark.parametrize(("reach", "low", "high"), CASES)
def test_mean_slope_encloses_secants_of_a_friction_curve(curve, reach, low, high):
    count, found, means = missed(curve, reach, low, high)
    assert count == 0
    if not reached(reach)[0] < Fraction(low) or not Fraction(high) < reached(reach)[1]:
        return
    # Not farther beyond them than by what the bounds of a strip leave open.
    first, after = REACHES[reach]
    left_open = max(high - low for low, high in curve.slopes[first:after])
    assert found.lower() >= min(means) - left_open
    assert found.upper() <= max(means) + left_open


def any_missed(curve):
    return any(missed(curve, *each)[0] for each in CASES)


def test_bounds_of_the_own_strip_alone_leave_secants_out(curve, monkeypatch):
    monkeypatch.setattr(friction, "_joined", lambda found, *_: found)
    assert all(missed(curve, reach, "0.007", "0.007")[0] for reach in range(len(REACHES)))


def test_means_that_do_not_count_lengths_leave_secants_out(curve, monkeypatch):
    def unweighted(found, _length, own, further):
        sums, count = [point(end) for end in own], 1
        for _, ends in further:
            sums, count = [each + point(end) for each, end in zip(sums, ends, strict=True)], count + 1
            found = found.union(sums[0] / count).union(sums[1] / count)
        return found

    monkeypatch.setattr(friction, "_joined", unweighted)
    assert any_missed(curve)


@pytest.mark.parametrize("left_out", [-1, 1], ids=["slower", "faster"])
def test_means_towards_one_side_alone_leave_secants_out(curve, monkeypatch, left_out):
    original = friction._joined

    def one_sided(found, length, own, further):
        """The first reach ends with the last strip."""
        side = 1 if further[-1][0] == SLOPES[-1] else -1
        return found if side == left_out else original(found, length, own, further)

    monkeypatch.setattr(friction, "_joined", one_sided)
    assert missed(curve, 0, "0.007", "0.007")[0]


def test_bounds_at_an_edge_and_across_it_are_those_of_both_strips(curve):
    edge = SLOPES[2][1]
    both = ball(*curve.slopes[2]).union(ball(*curve.slopes[3]))
    for error in (point(edge), ball(edge - Fraction(1, 10**6), edge + Fraction(1, 10**6))):
        assert slope_at(curve, error).contains(both)
    assert not slope_at(curve, point(Fraction(0))).contains(both)
    with_next = fading_at(curve, point(FADINGS[0][1]))
    assert all(with_next.contains(ball(*curve.fadings[k])) for k in (0, 1))


def test_fading_is_enclosed_at_errors_of_its_strips(curve):
    for strip in FADINGS:
        for x in points_of(strip)[1:-1]:
            assert inside(fading(float(x), WET.mu0, SPEED), fading_at(curve, arb(float(x))))


OUTSIDE = Fraction(1, 10**5)


@pytest.mark.parametrize(("at", "strips"), [(slope_at, SLOPES), (fading_at, FADINGS)])
def test_errors_outside_of_what_is_bounded_are_refused(curve, at, strips):
    low, high = strips[0][0], strips[-1][1]
    for beyond in (
        point(low - OUTSIDE),
        point(high + OUTSIDE),
        ball(low - OUTSIDE, low + OUTSIDE),
        ball(high - OUTSIDE, high + OUTSIDE),
        ball(low - OUTSIDE, high + OUTSIDE),
    ):
        with pytest.raises(Refused, match="where the friction is not bounded"):
            at(curve, beyond)
    assert at(curve, ball(low + OUTSIDE, high - OUTSIDE)).is_finite()


@pytest.mark.parametrize("reach", range(len(REACHES)))
def test_errors_outside_of_a_reach_count_what_lies_between(curve, reach):
    """A strip that is steep, and that neither the error nor the reach lies in, is on the way from one to the other."""
    low, high = reached(reach)
    assert (low, high) == (SLOPES[REACHES[reach][0]][0], SLOPES[REACHES[reach][1] - 1][1])
    first, after = REACHES[reach]
    for k in (*range(1, first), *range(after, len(SLOPES) - 1)):
        steep = [(0.0, 0.0)] * len(SLOPES)
        steep[k] = (1.0, 1.0)
        beyond = SLOPES[0][0] + OUTSIDE if k < first else SLOPES[-1][1] - OUTSIDE
        nearest = low if k < first else high
        own = (SLOPES[k][1] - SLOPES[k][0]) / abs(nearest - beyond)
        found = mean_slope(curve._replace(slopes=tuple(steep)), point(beyond), reach)
        assert inside(float(own), found)
        assert inside(0.0, found)


def test_strips_follow_each_other():
    for strips in (SLOPES, FADINGS):
        assert all(a[1] == b[0] for a, b in pairwise(strips))
    # The slope is bounded wherever the fading is, so that errors are counted from nowhere else.
    assert SLOPES[0][0] <= FADINGS[0][0] < FADINGS[-1][1] <= SLOPES[-1][1]


def test_names_tell_bounds_in_the_order_of_a_proof(curve):
    names = curve.named
    assert list(names) == [
        *(f"slope {k}" for k in range(1, 9)),
        "level",
        *(f"fading {k}" for k in range(1, 4)),
    ]
    assert Friction.of(tuple(names.values())) == curve
    assert strip_of("level") is None
    assert strip_of("slope 2") == SLOPES[1]
    assert strip_of("fading 3") == FADINGS[2]


# --- parts of the steepness ---------------------------------------------------------------------------------
WHOLE = 1.0 / 0.16, 1.0 / 0.08
"""Steepness of wheels that differ in mu0 alone, over that of one with mu0 = 1."""


@pytest.fixture(scope="module")
def parts():
    """Bounds at the ends of each part."""
    return tuple(
        Part(each, bounds(*((1.0 / steepness, SPEED) for steepness in each))) for each in parts_of(WHOLE)
    )


def test_parts_are_as_wide_as_each_other_and_leave_nothing_out():
    found = parts_of(WHOLE)
    assert len(found) == PARTS
    assert (found[0][0], found[-1][1]) == WHOLE
    assert all(one[1] == other[0] for one, other in pairwise(found))
    assert np.allclose(np.diff(found), (WHOLE[1] - WHOLE[0]) / PARTS)


def within(parts, first, last):
    """A range from the middle of one part to that of another."""
    return tuple(0.5 * sum(parts[k].steepness) for k in (first, last))


@pytest.mark.parametrize("part", range(PARTS))
def test_cell_in_a_part_has_the_bounds_of_that_part(parts, part):
    assert bounds_for(parts, within(parts, part, part)) == parts[part].friction


@pytest.mark.parametrize(("first", "last"), [(0, 1), (1, 3), (0, PARTS - 1)])
def test_cell_in_several_parts_has_the_bounds_of_all_of_them(parts, first, last):
    found = bounds_for(parts, within(parts, first, last))
    for name, (low, high) in found.named.items():
        ends = [each.friction.named[name] for each in parts[first : last + 1]]
        assert (low, high) == (min(low for low, _ in ends), max(high for _, high in ends))


def test_cell_where_two_parts_meet_has_the_bounds_of_both(parts):
    edge = parts[0].steepness[1]
    assert bounds_for(parts, (edge, edge)) == bounds_for(parts, within(parts, 0, 1))


def test_parts_that_leave_out_some_of_a_cell_are_refused(parts):
    first, second, third, last = parts
    whole = tuple(0.5 * sum(each.steepness) for each in (first, last))
    for wrong, steepness in (
        (parts, (0.99 * WHOLE[0], whole[1])),
        (parts, (whole[0], 1.01 * WHOLE[1])),
        (parts, (1.1 * WHOLE[1], 1.2 * WHOLE[1])),
        ((first, third, last), whole),
        ((first, third, second, last), whole),
        ((second, first, third, last), whole),
        ((), whole),
    ):
        with pytest.raises(Refused, match="leave out some of a cell"):
            bounds_for(wrong, steepness)
    assert bounds_for((first, third, last), within(parts, 2, 3)) == bounds_for(parts, within(parts, 2, 3))


def test_bounds_of_one_part_do_not_hold_in_another(parts):
    """Level and slopes over mu0 Q change with the steepness: bounds that are exchanged are wrong."""
    mu0 = 0.15
    exchanged = tuple(
        Part(one.steepness, other.friction) for one, other in zip(parts, parts[::-1], strict=True)
    )
    right, wrong = (bounds_for(each, (1.0 / mu0, 1.0 / mu0)) for each in (parts, exchanged))

    def holds(found):
        low, high = found.level
        secants = [secant(0.0, x, mu0=mu0) for x in error_points(0) if abs(x) > 1e-6]
        mean = mean_slope(found, point(Fraction(0)), 0)
        return low <= level_at(0.0, mu0) <= high, all(inside(each, mean) for each in secants)

    assert holds(right) == (True, True)
    assert holds(wrong)[0] is False
