"""From window to window: ellipsoids lie in each other, and none of them is missing."""

import json
from dataclasses import replace
from fractions import Fraction

import pytest

from tests.certificates.band.conftest import refused
from tests.certificates.band.forging import INSIDE
from wspd_design.certificates.kernel.arb import point
from wspd_design.certificates.setting.slip_loop import STATES
from wspd_design.certificates.theorems.slip_band.checker import lies_in
from wspd_design.certificates.theorems.slip_band.loop import Steady
from wspd_design.certificates.theorems.slip_band.proof import Ellipsoid

pytestmark = pytest.mark.slow


def ellipse(size, center, inside, moves=0, drift=0):
    """A ball of this radius about a point on the first axis."""
    matrix = tuple(tuple(Fraction(size) ** 2 * (i == j) for j in range(STATES)) for i in range(STATES))
    numbers = dict.fromkeys(
        ("pulse", "supply", "alpha", "offset", "longest", "back", "room", "lag", "beyond", "curve"),
        Fraction(1),
    )
    return Ellipsoid(
        **numbers,
        near=0,
        settled=Fraction(0),
        shortest=Fraction(0),
        matrix=matrix,
        center=(Fraction(center), *[Fraction(0)] * (STATES - 1)),
        drift=Fraction(drift),
        moves=(Fraction(moves), *[Fraction(0)] * (STATES - 1)),
        shares=(),
        steady=Fraction(1),
        change=Fraction(1),
        inside=inside,
    )


def steady(low, high):
    """A steady drift between two ends."""
    low, high, none, half = (point(Fraction(each)) for each in (low, high, 0, "1/2"))
    return Steady(low, high, (none, none), half, none)


CALM = steady(0, 0)


def around_it():
    """The ball of radius 1 about 0 with every multiplier."""
    return [ellipse(1, 0, Fraction(t, 100)) for t in range(1, 100)]


@pytest.mark.parametrize(("apart", "lies"), [("0.49", True), ("0.51", False)])
def test_balls_lie_in_each_other_as_long_as_radius_and_way_reach(apart, lies):
    inner = ellipse("1/2", apart, Fraction(0))
    assert any(lies_in((inner, CALM), (each, CALM)) for each in around_it()) is lies


def test_balls_about_other_errors_do_not_lie_in_each_other():
    inner = ellipse("1/2", "0", Fraction(0))
    assert any(lies_in((inner, CALM), (each, CALM)) for each in around_it())
    other = replace(inner, settled=Fraction(1, 10**6))
    assert not any(lies_in((other, CALM), (each, CALM)) for each in around_it())


@pytest.mark.parametrize(
    ("faster", "slower", "moves", "center", "lies"),
    [
        ((-9, 11), (-9, 11), "1/10", 0, True),  # alike: apart at no drift
        ((0, 10), (-10, 10), "1/10", "1/2", False),
        (("-4.9", "4.9"), ("-4.9", "4.9"), 0, 0, True),
        (("-5.1", "5.1"), ("-5.1", "5.1"), 0, 0, False),
        ((-9, 9), ("-4.9", "4.9"), 0, 0, True),  # only drifts that both know
        ((-9, 9), ("-4.9", "5.1"), 0, 0, False),
        ((-9, 9), ("-5.1", "4.9"), 0, 0, False),
    ],
)
def test_balls_whose_centers_move_lie_in_each_other_at_every_drift_that_both_know(
    faster, slower, moves, center, lies
):
    inner = ellipse("1/2", 0, Fraction(0), moves="1/10"), steady(*faster)
    outer = [ellipse(1, center, each.inside, moves=moves) for each in around_it()]
    assert any(lies_in(inner, (each, steady(*slower))) for each in outer) is lies


def test_centers_for_other_drifts_are_compared_at_one():
    """A center that is for another drift is where it moves to from there."""
    inner = ellipse("1/2", 0, Fraction(0), moves="1/10"), steady(-9, 9)
    for center, lies in (("1/2", True), (0, False)):
        outer = [ellipse(1, center, each.inside, moves="1/10", drift=5) for each in around_it()]
        assert any(lies_in(inner, (each, steady(-9, 9))) for each in outer) is lies


def test_hole_between_windows_is_refused(half, proof):
    """An ellipsoid may be invariant in its own window and still not lie in that of the next slower one."""
    cells = proof["cells"][0]
    cells[0], cells[-1] = cells[-1], cells[0]
    assert "may" in refused(half, proof)
    cells[0], cells[-1] = cells[-1], cells[0]
    proof["ellipsoids"][0][INSIDE] = "0.9999"
    assert "next slower" in refused(half, proof)


def test_dropped_window_and_dropped_cell_are_refused(half, proof):
    missing = json.loads(json.dumps(proof))
    missing["cells"][0].pop()
    assert "one entry for each" in refused(half, missing)
    halved = json.loads(json.dumps(proof))
    halved["steps"] = "m.."
    assert "do not match" in refused(half, halved)


def test_ellipsoid_that_is_not_there_is_refused(half, proof):
    proof["cells"][0][0] = 99
    assert "not there" in refused(half, proof)
