"""Creep force for the records of a rail and a contact: limits, symmetry and derivatives."""

import math
from dataclasses import replace

import mpmath
import numpy as np
import pytest

from wspd_design.model import adhesion
from wspd_design.parameters.loading import load_rail

LOAD = 94.2e3  # N
RAILS = ("polach-dry", "polach-wet", "table10-dry", "table10-wet", "eurosprinter127", "low-adhesion")


def test_stiffness_of_the_calibrated_contact(er24pc):
    # Data book section 13: pi G a b c11 / 4 = 1.107e7 N at 94.2 kN per wheel.
    assert adhesion.contact_stiffness(er24pc.contact, LOAD) == pytest.approx(1.107e7, rel=1e-3)


def test_stiffness_grows_with_load_to_two_thirds(er24pc):
    light, heavy = (adhesion.contact_stiffness(er24pc.contact, load) for load in (LOAD, 8.0 * LOAD))
    assert heavy == pytest.approx(4.0 * light, rel=1e-14)


@pytest.mark.parametrize(("name", "share"), [("polach-dry", 0.70), ("polach-wet", 0.20)])
def test_small_slip_keeps_a_share_of_kalkers_slope(er24pc, name, share):
    # Data book section 1: the slope at small slip is (kA + kS)/2 of Kalker's G a b c11.
    contact = er24pc.contact
    kalker = (
        contact.shear_modulus * contact.semi_axis_rolling * contact.semi_axis_lateral * contact.kalker_c11
    )
    load = contact.reference_load
    force = adhesion.creep_force(1e-7, 0.0, load, load_rail(name), adhesion.contact_stiffness(contact, load))
    assert force / 1e-7 == pytest.approx(share * kalker, rel=1e-4)


@pytest.mark.parametrize("name", RAILS)
def test_large_slip_without_sliding_gives_full_friction(er24pc, name):
    rail = load_rail(name)
    force = adhesion.creep_force(1e6, 0.0, LOAD, rail, adhesion.contact_stiffness(er24pc.contact, LOAD))
    assert force == pytest.approx(rail.mu0 * LOAD, rel=1e-6)


@pytest.mark.parametrize("name", [name for name in RAILS if name != "eurosprinter127"])
def test_friction_bounds_the_force(er24pc, name):
    # Rigorous for kS <= kA: x/(1 + x^2) + atan(x) rises to pi/2.
    rail = load_rail(name)
    assert rail.slip_reduction <= rail.adhesion_reduction
    stiffness = adhesion.contact_stiffness(er24pc.contact, LOAD)
    slips = np.geomspace(1e-6, 1.0, 2000)
    for speed in (0.1, 5.0, 40.0):
        force = adhesion.creep_force(slips, slips * speed, LOAD, rail, stiffness)
        friction = rail.mu0 * (
            rail.friction_ratio + (1 - rail.friction_ratio) * np.exp(-rail.friction_decay * slips * speed)
        )
        assert np.all(force > 0.0)
        assert np.all(force < friction * LOAD)


def test_force_is_odd_in_the_slip(er24pc):
    rail, stiffness = load_rail("polach-wet"), adhesion.contact_stiffness(er24pc.contact, LOAD)
    braking = adhesion.creep_force(0.03, 0.2, LOAD, rail, stiffness)
    assert adhesion.creep_force(-0.03, 0.2, LOAD, rail, stiffness) == -braking


def polach_mp(slip, speed, rail, stiffness):
    """Eqs. (5)-(7) in many digits."""
    mu = mpmath.mpf(rail.mu0) * (
        (1 - mpmath.mpf(rail.friction_ratio)) * mpmath.exp(-mpmath.mpf(rail.friction_decay) * speed * slip)
        + rail.friction_ratio
    )
    epsilon = stiffness * slip / (LOAD * mu)
    x = rail.adhesion_reduction * epsilon
    return 2 * LOAD * mu / mpmath.pi * (x / (1 + x**2) + mpmath.atan(rail.slip_reduction * epsilon))


@pytest.mark.parametrize("name", RAILS)
def test_force_and_its_slope_against_many_digits(er24pc, name):
    rail, stiffness = load_rail(name), adhesion.contact_stiffness(er24pc.contact, LOAD)
    with mpmath.workdps(40):
        for slip in (1e-4, 0.005, 0.14, 0.6):
            for speed in (0.5, 10.0, 33.3):
                force = adhesion.creep_force(slip, slip * speed, LOAD, rail, stiffness)
                assert force == pytest.approx(
                    float(polach_mp(mpmath.mpf(slip), speed, rail, stiffness)), rel=1e-13
                )
                slope = adhesion.creep_force_slip_derivative(slip, speed, LOAD, rail, stiffness)
                exact = mpmath.diff(lambda s, v=speed: polach_mp(s, v, rail, stiffness), mpmath.mpf(slip))
                assert slope == pytest.approx(float(exact), rel=1e-10)


def test_slope_with_a_wrong_friction_decay_is_seen(er24pc):
    rail, stiffness = load_rail("polach-dry"), adhesion.contact_stiffness(er24pc.contact, LOAD)
    wrong = replace(rail, friction_decay=1.01 * rail.friction_decay)
    slope = adhesion.creep_force_slip_derivative(0.14, 10.0, LOAD, wrong, stiffness)
    exact = mpmath.diff(lambda s: polach_mp(s, 10.0, rail, stiffness), mpmath.mpf("0.14"))
    assert not math.isclose(slope, float(exact), rel_tol=1e-3)
