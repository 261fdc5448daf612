"""Eqs. (5)-(7) by limits, finite differences and the exact theory of rolling contact."""

import numpy as np
import pytest
import sympy as sp

from tests.lazily import Lazily
from wspd_design.model.generated.adhesion import (
    contact_stiffness,
    creep_force,
    creep_force_slip_derivative,
    creep_force_speed_derivative,
    creep_gradient,
    friction_coefficient,
)
from wspd_design.parameters.loading import load_rail

adhesion = Lazily("adhesion")

Q = 94226.0
STIFFNESS = contact_stiffness(84e9, 7.73e-3, 5.17e-3, 4.2)
DRY = {
    "mu0": 0.55,
    "friction_ratio": 0.4,
    "friction_decay": 0.6,
    "adhesion_reduction": 1.0,
    "slip_reduction": 0.4,
}
WET = {
    "mu0": 0.30,
    "friction_ratio": 0.4,
    "friction_decay": 0.2,
    "adhesion_reduction": 0.3,
    "slip_reduction": 0.1,
}


def force(slip, speed, rail):
    return creep_force(slip, speed * slip, Q, **rail, contact_stiffness=STIFFNESS)


def test_contact_stiffness_of_the_calibrated_vehicle():
    assert pytest.approx(1.107e7, rel=1e-3) == STIFFNESS


def test_limits_of_the_creep_force():
    constant = {**DRY, "friction_decay": 0.0}
    assert force(1e3, 1.0, constant) == pytest.approx(Q * 0.55, rel=1e-4)
    linear_theory = 4.0 / np.pi * STIFFNESS
    assert force(1e-7, 1.0, constant) / 1e-7 == pytest.approx(0.7 * linear_theory, rel=1e-4)
    assert adhesion.slope_at_zero == adhesion.kalker_slope * (adhesion.kA + adhesion.kS) / 2


def test_creep_force_is_judged_by_three_marks():
    assert adhesion.force_residual == 0
    planted = adhesion.force_of_gradient + 1  # neither odd nor Q mu for large slip
    assert sp.simplify(planted + planted.subs(adhesion.gradient, -adhesion.gradient)) != 0


def test_legible_cells_of_table_1():
    dry, wet = load_rail("polach-dry"), load_rail("polach-wet")
    assert (dry.friction_decay, dry.mu0, wet.mu0) == (0.6, 0.55, 0.3)


def test_gradient_from_linear_theory():
    a, b, c11, shear, mu, slip = 7.73e-3, 5.17e-3, 4.2, 84e9, 0.4, 0.01
    tangential = 3.0 / 8.0 * shear * c11 / a
    polach = 2.0 / 3.0 * tangential * np.pi * a**2 * b / (Q * mu) * slip
    assert creep_gradient(slip, Q, mu, contact_stiffness(shear, a, b, c11)) == pytest.approx(
        polach, rel=1e-12
    )


def test_friction_needs_the_magnitude_of_sliding():
    on_domain = adhesion.friction_printed - adhesion.friction_corrected.subs(sp.Abs(adhesion.w), adhesion.w)
    assert sp.simplify(on_domain) == 0  # the printed form, where v >= R omega
    assert friction_coefficient(5.0, 0.55, 0.4, 0.6) == pytest.approx(0.55 * (0.6 * np.exp(-3.0) + 0.4))
    assert friction_coefficient(-10.0, 0.55, 0.4, 0.6) > 100.0  # as printed, for v < R omega
    assert adhesion.friction_asymmetry != 0
    assert adhesion.friction_asymmetry_corrected == 0


@pytest.mark.parametrize("rail", [DRY, WET])
@pytest.mark.parametrize(("slip", "speed"), [(0.001, 30.0), (0.02, 20.0), (0.14, 10.0), (0.5, 2.0)])
def test_exact_derivatives_equal_finite_differences(rail, slip, speed):
    step = 1e-4
    by_slip = (force(slip * (1 + step), speed, rail) - force(slip * (1 - step), speed, rail)) / (
        2 * step * slip
    )
    by_speed = (force(slip, speed * (1 + step), rail) - force(slip, speed * (1 - step), rail)) / (
        2 * step * speed
    )
    scale = force(slip, speed, rail)
    exact = creep_force_slip_derivative(slip, speed, Q, **rail, contact_stiffness=STIFFNESS)
    assert exact == pytest.approx(by_slip, rel=1e-5, abs=1e-6 * scale / slip)
    exact = creep_force_speed_derivative(slip, speed, Q, **rail, contact_stiffness=STIFFNESS)
    assert exact == pytest.approx(by_speed, rel=1e-5, abs=1e-6 * scale / speed)


def test_exact_theory_of_rolling_contact():
    # EuroSprinter 127 at 10 m/s, Coulomb friction .33: Fx/Q of the program CONTACT (Kalker's exact theory).
    slip = np.array([1e-5, 4e-4, 8e-4, 1.2e-3, 1.6e-3, 2e-3, 2.4e-3, 2.8e-3, 3.2e-3, 4e-3, 1e-2])
    exact = np.array(
        [0.00231, 0.0854, 0.1565, 0.2139, 0.2584, 0.2909, 0.3124, 0.3245, 0.3292, 0.3297, 0.3300]
    )
    nu, c0, c25, c50 = 0.28, 2.88, 3.62, 4.83  # Kalker's c11 at a/b = .5 for Poisson's ratio 0, .25, .5
    c11 = 1 / (8 * (nu - 0.25) * (nu - 0.5) / c0 - 16 * nu * (nu - 0.5) / c25 + 8 * nu * (nu - 0.25) / c50)
    load, stiffness = 106.7e3, contact_stiffness(82e9, 6.304e-3, 12.61e-3, c11)
    found = creep_force(slip, 10.0 * slip, load, 0.33, 1.0, 0.0, 1.0, 1.0, stiffness) / load
    assert np.abs(found - exact).max() < 0.065 * 0.33
