"""Profiles of wheel and rail: cone, quasilinear and the table of the Manchester contact benchmark."""

import math

import casadi
import numpy as np
import pytest
from scipy.integrate import quad

from wspd_design.model.wheel_profile import Quasilinear, TableProfile, cone, s1002_on_uic60
from wspd_design.parameters.errors import UserError

S1002 = s1002_on_uic60()
MM = 1e-3

# Locomotive.md V12: displacement, half the difference of the rolling radii over it, both as printed; case.
CONICITY = {
    0.5: 0.397, 1.0: 0.302, 1.5: 0.235, 2.0: 0.199, 2.5: 0.178, 3.0: 0.165, 3.5: 0.157, 4.0: 0.154, 4.5: 0.154,
    5.0: 0.352, 5.5: 0.364, 6.0: 0.384, 6.5: 1.29,
}  # fmt: skip
# Roll of the wheelset that the benchmark prescribes, which the table does not hold [rad].
ROLL = {1.0: 5.049e-5, 2.0: 1.128e-4, 3.0: 1.803e-4, 4.0: 2.557e-4, 4.5: 2.977e-4}
APART = 1.5097  # m, of the contact points at the rails, 751.9 and 757.8 mm from the middle


def test_cone():
    profile = cone(0.025)
    assert profile.radius_growth(2 * MM) == pytest.approx(0.05 * MM)
    assert profile.contact_slope(-2 * MM) == 0.025
    assert profile.lift(-2 * MM) == pytest.approx(-0.05 * MM)


@pytest.mark.parametrize("profile", [cone(0.1), Quasilinear(conicity=0.2, slope=0.05, slope_gain=8.0), S1002])
def test_lift_is_the_integral_of_the_slope(profile):
    assert profile.lift(0.0) == pytest.approx(0.0, abs=1e-18)
    for displacement in (-5.2 * MM, -1e-4, 1.3 * MM, 4.4 * MM):
        nodes = [place * MM for place in np.arange(-6.0, 6.5, 0.5)]
        inside = [place for place in nodes if min(0.0, displacement) < place < max(0.0, displacement)]
        area, _ = quad(profile.contact_slope, 0.0, displacement, points=inside or None)
        assert profile.lift(displacement) == pytest.approx(area, rel=1e-9)


@pytest.mark.parametrize("displacement", CONICITY)
def test_conicity_of_s1002_on_uic60(displacement):
    y = displacement * MM
    found = (S1002.radius_growth(y) - S1002.radius_growth(-y)) / (2.0 * y)
    assert found == pytest.approx(CONICITY[displacement], abs=0.006)


@pytest.mark.parametrize("displacement", ROLL)
def test_contact_angles_give_the_roll_of_the_benchmark(displacement):
    y = displacement * MM
    assert (S1002.lift(y) - S1002.lift(-y)) / APART == pytest.approx(ROLL[displacement], rel=0.03)


def test_a_wrong_angle_is_seen():
    """The planted fault: one angle with its digits shifted."""
    slopes = list(S1002.slopes)
    slopes[S1002.displacements.index(1.0 * MM)] *= 0.1
    wrong = TableProfile(
        displacements=S1002.displacements, radius_growths=S1002.radius_growths, slopes=tuple(slopes)
    )
    for displacement in (1.0, 2.0):
        y = displacement * MM
        assert (wrong.lift(y) - wrong.lift(-y)) / APART != pytest.approx(ROLL[displacement], rel=0.1)


def test_flange_is_steep():
    assert math.degrees(math.atan(S1002.contact_slope(6.5 * MM))) > 60.0
    assert S1002.contact_slope(4.5 * MM) < 0.13


def test_table_in_symbols():
    y = casadi.SX.sym("y")
    all_three = casadi.Function("f", [y], [S1002.radius_growth(y), S1002.contact_slope(y), S1002.lift(y)])
    places = np.linspace(-8.0, 8.0, 161) * MM
    for place in places:
        ours = [float(each) for each in all_three(place)]
        numbers = [S1002.radius_growth(place), S1002.contact_slope(place), S1002.lift(place)]
        assert ours == pytest.approx(numbers, rel=1e-12, abs=1e-15)
    rows = np.interp(places, S1002.displacements, S1002.slopes)
    inside = np.abs(places) <= 6.5 * MM
    assert S1002.contact_slope(places)[inside] == pytest.approx(rows[inside], rel=1e-9)


@pytest.mark.parametrize(
    ("displacements", "slopes", "word"),
    [
        ((0.0,), (1.0,), "two or more rows"),
        ((0.0, 1.0), (1.0, 2.0, 3.0), "two or more rows"),
        ((0.0, 0.0), (1.0, 2.0), "must rise"),
        ((0.0, 1.0), (1.0, math.nan), "must be finite"),
    ],
)
def test_impossible_tables_are_refused(displacements, slopes, word):
    with pytest.raises(UserError, match=word):
        TableProfile(displacements=displacements, radius_growths=displacements, slopes=slopes)
