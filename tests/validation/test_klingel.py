"""Klingel's wave of a free wheelset: 2 pi sqrt(R b0 / conicity), from the contact functions and Newton's equations.

Locomotive.md V5: 25.522 m, and 25.530 m from the motion in space; 12.761 and 12.825 m at 0.1; 7.368 and 7.702 m at 0.3,
where the contact points move under the rolling wheelset.
"""

import math

import numpy as np
import pytest
from free_wheelset import HALF_GAUGE, RADIUS, run, wavelength

from wspd_design.model.wheel_profile import Quasilinear, cone, s1002_on_uic60

SPEED, STEP = 10.0, 4e-4  # m/s, s: creep at this speed has a rate of 3e3 per second


def klingel(conicity):
    return 2.0 * math.pi * math.sqrt(RADIUS * HALF_GAUGE / conicity)


@pytest.mark.parametrize(
    ("conicity", "in_space", "known", "most"),
    [(0.025, 25.530, 5e-5, 1e-3), (0.1, 12.825, 1e-4, 6e-3), (0.3, 7.702, 1.5e-3, 0.05)],
)
def test_wave_of_a_free_wheelset(conicity, in_space, known, most):
    states = run(
        cone(conicity), speed=SPEED, yaw=4e-3 / klingel(conicity), distance=3.6 * klingel(conicity), step=STEP
    )
    found = wavelength(states)
    assert found == pytest.approx(klingel(conicity), rel=most)
    assert found == pytest.approx(in_space, rel=known)


def test_only_the_rolling_radius_makes_the_wave_at_small_slope():
    # The contact slope lifts the wheels and turns the normal forces, which at low speed moves nothing much.
    profile = Quasilinear(conicity=0.1, slope=0.025, slope_gain=0.5)
    found = wavelength(
        run(profile, speed=SPEED, yaw=4e-3 / klingel(0.1), distance=3.6 * klingel(0.1), step=STEP)
    )
    assert found == pytest.approx(klingel(0.1), rel=5e-3)


@pytest.mark.parametrize(("fault", "off"), [("turns_with_axle", -0.016), ("rolls_over", 0.0094)])
def test_faults_of_the_contact_point_are_seen(fault, off):
    """The planted faults: a lever in track axes, and treads that do not move sideways as the wheelset rolls."""
    found = wavelength(
        run(cone(0.025), speed=SPEED, yaw=1.6e-4, distance=3.6 * 25.5, step=STEP, **{fault: False})
    )
    assert found / klingel(0.025) - 1.0 == pytest.approx(off, abs=1e-3)


def test_a_rolling_wheelset_keeps_its_load_and_its_speed():
    states = run(cone(0.025), speed=SPEED, yaw=0.0, distance=20.0, step=STEP)
    assert np.abs(states[:, [1, 3, 4]]).max() < 1e-12
    assert states[-1, 5] == pytest.approx(SPEED, rel=1e-9)
    assert (
        states[:, 2].std() < 1e-7
    )  # of an approach of 99 micrometers: the lateral forces of spin have a part upwards


def quarter_wave(profile, amplitude, pieces=2000):
    """Quarter of the wave of y'' = -(r_left - r_right) / (2 b0 R) by quadrature [m]; the radii belong to the treads."""
    treads = np.linspace(0.0, 1.5 * amplitude, 4 * pieces)
    axle = treads - RADIUS * (profile.lift(treads) - profile.lift(-treads)) / (2.0 * HALF_GAUGE)
    angle = np.linspace(0.0, 0.5 * math.pi, 2 * pieces + 1)
    places = amplitude * np.sin(angle)
    met = np.interp(places, axle, treads)
    pull = (profile.radius_growth(met) - profile.radius_growth(-met)) / (2.0 * HALF_GAUGE * RADIUS)
    work = np.concatenate([[0.0], np.cumsum(0.5 * np.diff(places) * (pull[1:] + pull[:-1]))])
    middle = slice(1, None, 2)
    slope = np.sqrt(2.0 * (work[-1] - work[middle]))
    return np.sum(amplitude * np.cos(angle[middle]) / slope) * 2.0 * angle[1]


def test_quadrature_on_the_cone():
    # Linear: the treads move by 1 + R conicity / b0 of the axle.
    expected = 0.25 * klingel(0.025) * math.sqrt(1.0 - RADIUS * 0.025 / HALF_GAUGE)
    assert quarter_wave(cone(0.025), 1e-3) == pytest.approx(expected, rel=1e-4)


@pytest.mark.parametrize("yaw", [1.3e-3, 2.5e-3])
def test_wave_on_s1002_is_that_of_its_rolling_radii(yaw):
    """Within 7 %: the contact angles push the wheelset to the middle, which costs creep and lets the wave decay."""
    profile = s1002_on_uic60()
    states = run(profile, speed=SPEED, yaw=yaw, distance=20.0, step=STEP)
    y = states[:, 1]
    first, second = np.flatnonzero((y[:-1] < 0.0) & (y[1:] >= 0.0))[:2]
    amplitude = float(np.abs(y[first:second]).max())  # 1.1 and 2.9 mm
    assert wavelength(states) == pytest.approx(4.0 * quarter_wave(profile, amplitude), rel=0.07)
    assert wavelength(states) < 0.4 * klingel(0.025)
