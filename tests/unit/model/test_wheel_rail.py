"""Contact forces in space: the small model as a special case, linear theory, limits, and what CasADi differentiates."""

import math
from dataclasses import replace

import casadi
import numpy as np
import pytest

from wspd_design.model.adhesion import contact_stiffness, creep_force
from wspd_design.model.hertz import contact_from_radii
from wspd_design.model.wheel_rail import creep_forces, flange_force, normal_force, wheel_rail
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import load_rail
from wspd_design.parameters.records import Rail

LOAD, SPEED = 94.2e3, 20.0
ELLIPSE = contact_from_radii(wheel_load=LOAD, wheel_radius=0.55, rail_radius=0.3, young=210e9, poisson=0.25)
CONTACT = wheel_rail(ELLIPSE, poisson=0.25)
RAILS = ("polach-dry", "polach-wet", "eurosprinter127", "very-low")
KALKER = Rail(
    name="kalker",
    mu0=0.33,
    friction_ratio=1.0,
    friction_decay=0.0,
    adhesion_reduction=1.0,
    slip_reduction=1.0,
)
SLIPS = np.array([-0.9, -0.14, -1e-4, -1e-9, 1e-9, 1e-6, 1e-3, 0.02, 0.14, 1.0])


@pytest.mark.parametrize("name", RAILS)
@pytest.mark.parametrize("load", [2.0, 3e4, LOAD, 2e5])
def test_without_lateral_creep_and_spin_it_is_the_creep_force_of_the_small_model(name, load):
    rail = load_rail(name)
    small = creep_force(SLIPS, SPEED * np.abs(SLIPS), load, rail, contact_stiffness(ELLIPSE, load))
    along, across = creep_forces(SLIPS, 0.0 * SLIPS, 0.0, SPEED, load, rail, CONTACT)
    assert along == pytest.approx(small, rel=1e-15)
    assert not across.any()


def test_small_model_in_symbols():
    slip, load = casadi.SX.sym("slip"), casadi.SX.sym("load")
    rail = load_rail("polach-dry")
    small = creep_force(slip, SPEED * casadi.fabs(slip), load, rail, contact_stiffness(ELLIPSE, load))
    along, _ = creep_forces(slip, 0.0, 0.0, SPEED, load, rail, CONTACT)
    both = casadi.Function("both", [slip, load], [small, along])
    for value in SLIPS:
        ours, theirs = (float(each) for each in both(value, LOAD))
        assert ours == pytest.approx(theirs, rel=1e-15)


def test_small_creepages_are_kalkers_linear_theory():
    area = ELLIPSE.semi_axis_rolling * ELLIPSE.semi_axis_lateral
    force = ELLIPSE.shear_modulus * area
    x, y, spin = 1.3e-8, -2.1e-8, 3e-6
    along, across = creep_forces(x, y, spin, SPEED, LOAD, KALKER, CONTACT)
    assert along == pytest.approx(force * ELLIPSE.kalker_c11 * x, rel=1e-5)
    linear = CONTACT.kalker_c22 * y + CONTACT.kalker_c23 * math.sqrt(area) * spin
    assert across == pytest.approx(force * linear, rel=1e-5)


def test_lateral_slope_is_its_own_on_every_rail():
    slope = ELLIPSE.shear_modulus * ELLIPSE.semi_axis_rolling * ELLIPSE.semi_axis_lateral * CONTACT.kalker_c22
    for name in RAILS:
        for share in (1.0, 0.6):
            contact = replace(CONTACT, lateral_slope=share)
            _, across = creep_forces(0.0, 1e-9, 0.0, SPEED, LOAD, load_rail(name), contact)
            assert across / 1e-9 == pytest.approx(share * slope, rel=1e-4)
    # As Polach's own method has it on the wet rail: a fifth of Kalker's slope in both directions.
    _, across = creep_forces(
        0.0, 1e-9, 0.0, SPEED, LOAD, load_rail("polach-wet"), replace(CONTACT, lateral_slope=0.2)
    )
    assert across / 1e-9 == pytest.approx(0.2 * slope, rel=1e-4)


@pytest.mark.parametrize("name", RAILS)
def test_full_sliding_is_against_the_sliding_with_falling_friction(name):
    rail, x, y = load_rail(name), 0.8, 0.6
    along, across = creep_forces(x, y, 0.045, SPEED, LOAD, rail, CONTACT)
    friction = rail.mu0 * (
        rail.friction_ratio + (1.0 - rail.friction_ratio) * math.exp(-rail.friction_decay * SPEED)
    )
    assert across / along == pytest.approx(y / x, rel=2e-3)
    assert math.hypot(along, across) == pytest.approx(friction * LOAD, rel=0.08)


def test_a_sliding_wheel_loses_its_guidance():
    # Locomotive.md section 5: the lateral force of a sliding wheel is F y / x, not Kalker's slope.
    rail = load_rail("polach-dry")
    along, across = creep_forces(0.14, 1e-4, 0.0, SPEED, LOAD, rail, CONTACT)
    assert across == pytest.approx(along * 1e-4 / 0.14, rel=2e-3)
    _, rolling = creep_forces(0.0, 1e-4, 0.0, SPEED, LOAD, rail, CONTACT)
    assert across < 0.02 * rolling


def test_friction_is_never_exceeded_and_work_is_never_given():
    generator = np.random.default_rng(1)
    x, y, spin = (generator.normal(size=4000) * 10.0 ** generator.uniform(-6, -0.5, 4000) for _ in range(3))
    for name in ("polach-dry", "polach-wet"):
        rail = load_rail(name)
        along, across = creep_forces(x, y, spin, SPEED, LOAD, rail, CONTACT)
        assert (np.hypot(along, across) <= rail.mu0 * LOAD * (1.0 + 1e-12)).all()
        along, across = creep_forces(x, y, 0.0, SPEED, LOAD, rail, CONTACT)
        assert (along * x + across * y >= 0.0).all()


def test_mirrored_creepages_give_mirrored_forces():
    rail = load_rail("polach-dry")
    along, across = creep_forces(2e-3, 1e-3, 0.1, SPEED, LOAD, rail, CONTACT)
    assert creep_forces(2e-3, -1e-3, -0.1, SPEED, LOAD, rail, CONTACT) == pytest.approx((along, -across))
    assert creep_forces(-2e-3, 1e-3, 0.1, SPEED, LOAD, rail, CONTACT) == pytest.approx((-along, across))


def symbols():
    point = casadi.SX.sym("point", 5)
    forces = casadi.vertcat(*creep_forces(*casadi.vertsplit(point), load_rail("polach-wet"), CONTACT))
    return casadi.Function("forces", [point], [forces, casadi.jacobian(forces, point)])


def test_derivatives_exist_without_creep_and_without_load():
    forces = symbols()
    for point in (
        [0, 0, 0, SPEED, LOAD],
        [0, 0, 0, SPEED, 0],
        [0.1, 0, 0.05, SPEED, 0],
        [0, 0, 0.05, 0, LOAD],
    ):
        for matrix in forces(point):
            assert np.isfinite(matrix.full()).all()
    _, slope = forces([0, 0, 0, SPEED, LOAD])
    area = ELLIPSE.semi_axis_rolling * ELLIPSE.semi_axis_lateral
    kalker = ELLIPSE.shear_modulus * area
    spin = kalker * math.sqrt(area) * CONTACT.kalker_c23
    expected = [[0.2 * kalker * ELLIPSE.kalker_c11, 0, 0, 0, 0], [0, kalker * CONTACT.kalker_c22, spin, 0, 0]]
    assert slope.full() == pytest.approx(np.array(expected), rel=1e-12)


def test_jacobian_is_that_of_differences():
    forces = symbols()
    for point in (
        [1e-3, 5e-4, 0.3, SPEED, LOAD],
        [0.14, 1e-3, 0.05, SPEED, LOAD],
        [1e-8, 0, 0.05, SPEED, LOAD],
    ):
        _, slope = forces(point)
        for place, step in enumerate((1e-9, 1e-9, 1e-7, 1e-4, 0.1)):
            low, high = np.array(point), np.array(point)
            low[place] -= step
            high[place] += step
            difference = (forces(high)[0] - forces(low)[0]).full().ravel() / (2.0 * step)
            rounding = 1e-11 * LOAD / step
            assert slope.full()[:, place] == pytest.approx(difference, rel=2e-4, abs=rounding)


def test_a_wheel_without_load_has_no_creep_force():
    rail = load_rail("polach-dry")
    assert creep_forces(0.1, 0.1, 0.0, SPEED, 0.0, rail, CONTACT) == (0.0, 0.0)
    light, lighter = (creep_forces(0.1, 0.0, 0.0, SPEED, load, rail, CONTACT)[0] for load in (1.0, 0.5))
    assert lighter == pytest.approx(0.5 * light)


def test_normal_force_of_the_locomotive():
    # Locomotive.md section 2: 0.0989 mm at 94.2 kN; rounded there.
    assert normal_force(0.0989e-3, CONTACT.normal_stiffness) == pytest.approx(LOAD, rel=2e-3)
    assert normal_force(-1e-3, CONTACT.normal_stiffness) == 0.0
    # The slope is 1.5 N / d: 1.4e9 N/m.
    step = 1e-9
    high, low = (normal_force(98.8e-6 + sign * step, CONTACT.normal_stiffness) for sign in (1, -1))
    slope = (high - low) / (2.0 * step)
    assert slope == pytest.approx(1.43e9, rel=0.01)


@pytest.mark.parametrize("approach", [-1e-3, 0.0, 1e-20])
def test_normal_force_lifts_smoothly(approach):
    d = casadi.SX.sym("d")
    slope = casadi.Function("slope", [d], [casadi.gradient(normal_force(d, CONTACT.normal_stiffness), d)])
    assert float(slope(approach)) == pytest.approx(0.0, abs=5e3)  # of 1.4e9 N/m under load


def test_flanges_keep_the_wheelset():
    assert flange_force(6e-3, 6.5e-3, 1e9) == 0.0
    assert flange_force(7.5e-3, 6.5e-3, 1e9) == pytest.approx(31.6e3, rel=1e-3)
    assert flange_force(-7.5e-3, 6.5e-3, 1e9) == -flange_force(7.5e-3, 6.5e-3, 1e9)


@pytest.mark.parametrize("slope", [0.0, -1.0, math.nan, math.inf])
def test_impossible_lateral_slopes_are_refused(slope):
    with pytest.raises(UserError, match="lateral slope"):
        wheel_rail(ELLIPSE, poisson=0.25, lateral_slope=slope)
