"""Rounded corners: convolutions of the sharp ones with a bump, equal to them further away."""

import pytest
from scipy.integrate import quad

from wspd_design.model.corners import corner, lower, step, table

POINTS, VALUES = (0.0, 3.0, 4.0, 10.0), (1.0, 0.7, 0.9, 0.5)


def bump(u, width):
    return 0.9375 * (1.0 - (u / width) ** 2) ** 2 / width


@pytest.mark.parametrize("x", [-0.49, -0.2, 0.0, 0.01, 0.3, 0.5])
def test_a_corner_is_the_sharp_one_smeared_by_a_bump(x):
    smeared, _ = quad(
        lambda u: max(x - u, 0.0) * bump(u, 0.5), -0.5, 0.5, points=[x] if abs(x) < 0.5 else None
    )
    assert corner(x, 0.5) == pytest.approx(smeared, rel=1e-10, abs=1e-14)


@pytest.mark.parametrize("x", [-7.0, -0.51, 0.51, 9.0])
def test_away_from_it_nothing_is_rounded(x):
    assert corner(x, 0.5) == pytest.approx(max(x, 0.0), abs=1e-15)


@pytest.mark.parametrize(
    ("x", "value"), [(-5.0, 1.0), (1.5, 0.85), (3.5, 0.8), (7.0, 0.7), (50.0, 0.5), (1e9, 0.5)]
)
def test_a_table_is_its_broken_line_between_the_corners(x, value):
    assert table(x, POINTS, VALUES, 0.4) == pytest.approx(value, rel=1e-6 if x > 1e6 else 1e-13)


def test_corners_of_a_table_are_rounded_by_what_the_slopes_change():
    # 5/32 of the width for each unit of slope, as the second integral of the bump is at its middle.
    assert table(3.0, POINTS, VALUES, 0.4) == pytest.approx(0.7 + (0.2 + 0.1) * 0.4 * 5.0 / 32.0, rel=1e-12)


def test_lower_and_step():
    assert lower(3.0, 5.0, 0.5) == pytest.approx(3.0, rel=1e-14)
    assert lower(5.0, 3.0, 0.5) == pytest.approx(3.0, rel=1e-14)
    assert lower(3.0, float("inf"), 0.5) == 3.0
    assert 2.9 < lower(3.0, 3.0, 0.5) < 3.0
    assert [step(x, 0.5) for x in (-1.0, 0.0, 1.0)] == pytest.approx([0.0, 0.5, 1.0], abs=1e-15)
