"""The open-loop slip pole over speed, at slip 0.14, against the numbers established with SymPy beforehand."""

from dataclasses import replace

import pytest

from wspd_design.analysis.linearization import linearize
from wspd_design.parameters.loading import load_rail

SPEEDS = (33.333, 20.0, 10.0, 5.0, 2.0, 1.0)  # m/s

# Findings section 2, 1/s.
POLES = {
    "polach-dry": (1.00, 3.01, 6.79, 9.92, 11.4, 9.92),
    "polach-wet": (0.97, 1.27, 1.25, 0.49, -2.50, -7.74),
    "table10-wet": (-0.38, -0.63, -1.27, -2.54, -6.35, -12.7),
    "table10-dry": (-0.055, -0.094, -0.19, -0.38, -0.95, -1.90),
}
GAINS = (21.9, 36.6, 73.1, 146.0, 366.0, 731.0)  # 1/(MN m s)


def poles(er24pc, rail):
    return [linearize(er24pc, rail, slip=0.14, speed=v).slip_pole for v in SPEEDS]


@pytest.mark.parametrize("name", ["polach-dry", "polach-wet", "table10-wet"])
def test_poles(er24pc, name):
    assert poles(er24pc, load_rail(name)) == pytest.approx(POLES[name], rel=0.03)


def test_poles_on_the_dry_rail_of_table_10(er24pc):
    """Data book and findings differ here, and the test says by how much.

    Data book section 13 calibrates mu0 = .4174, which gives the distances of Table 10 and is shipped. The poles of
    the findings belong to mu0 = .4105. With constant friction far beyond the peak the pole is the small difference
    of two large terms, so that 1.7 % in mu0 becomes 7 % in the pole.
    """
    shipped = load_rail("table10-dry")
    assert shipped.mu0 == 0.4174
    found = poles(er24pc, replace(shipped, mu0=0.4105))
    # Numbers printed with two digits are only known to half a unit of the last one.
    assert found == pytest.approx(POLES["table10-dry"], rel=0.03)
    ratios = [
        ours / theirs for ours, theirs in zip(poles(er24pc, shipped), POLES["table10-dry"], strict=True)
    ]
    assert ratios == pytest.approx([1.07] * 6, abs=0.025)


def test_gain(er24pc):
    rail = load_rail("polach-dry")
    found = [1e6 * linearize(er24pc, rail, slip=0.14, speed=v).gain for v in SPEEDS]
    assert found == pytest.approx(GAINS, rel=2e-3)
    assert found == pytest.approx([1e6 * 0.55 / (2 * 376 * v) for v in SPEEDS], rel=1e-12)


@pytest.mark.parametrize(("name", "speed"), [("polach-dry", 0.60), ("polach-wet", 4.6)])
def test_the_pole_changes_sign_where_the_adhesion_peak_is_at_slip_14(er24pc, name, speed):
    # Data book section 0.3: 0.14 lies on the falling side above 0.60 m/s dry and 4.6 m/s wet (for c11 = 4.62;
    # the deceleration and the wheel equation move the zero of the pole a little from that of the slope).
    rail = load_rail(name)
    assert linearize(er24pc, rail, slip=0.14, speed=1.35 * speed).slip_pole > 0.0
    assert linearize(er24pc, rail, slip=0.14, speed=0.5 * speed).slip_pole < 0.0


def test_a_wrong_sign_of_the_deceleration_part_is_seen(er24pc):
    # Findings: the deceleration part of the pole is +a/v. Without its sign the table is missed.
    from wspd_design.model.slip import slip_dynamics

    rail = load_rail("polach-dry")
    wrong = []
    for v in SPEEDS:
        point = slip_dynamics(er24pc, rail, 0.14, v)
        wrong.append(point.pole - 2.0 * point.deceleration / v)
    assert wrong != pytest.approx(POLES["polach-dry"], rel=0.03)
