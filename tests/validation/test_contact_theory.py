"""Hertz's ellipse and Kalker's coefficient against published numbers and SciPy's elliptic integrals."""

import math

import pytest
from scipy.special import ellipe, ellipk

from wspd_design.model.hertz import contact_from_radii, elliptic_integrals
from wspd_design.model.kalker import creep_coefficients
from wspd_design.parameters.errors import UserError

STEEL = {"young": 210e9, "poisson": 0.25}
LOAD = 76841 * 9.81 / 8

# Classic table of Hertz: angle theta with cos(theta) = |A - B|/(A + B), factors m and n of the semi-axes.
CLASSIC = {
    85: (1.0609, 0.9442), 80: (1.1278, 0.8927), 75: (1.2020, 0.8448), 70: (1.2851, 0.7999), 65: (1.3788, 0.7575),
    60: (1.4858, 0.7171), 55: (1.6094, 0.6783), 50: (1.7541, 0.6407), 45: (1.9265, 0.6038), 40: (2.1357, 0.5673),
    35: (2.3961, 0.5306), 30: (2.7306, 0.4931), 20: (3.8160, 0.4121), 10: (6.6115, 0.3110),
}  # fmt: skip


@pytest.mark.parametrize("theta", CLASSIC)
def test_classic_table_of_hertz(theta):
    # A + B = 1/m and |A - B| = cos(theta): the wheel is the flatter body, the long axis along the rail.
    a, b = (0.5 * (1.0 - sign * math.cos(math.radians(theta))) for sign in (1.0, -1.0))
    contact = contact_from_radii(wheel_load=LOAD, wheel_radius=0.5 / a, rail_radius=0.5 / b, **STEEL)
    unit = (3.0 * LOAD * (1.0 - 0.25**2) / (2.0 * 210e9)) ** (1.0 / 3.0)
    m, n = CLASSIC[theta]
    assert contact.semi_axis_rolling / unit == pytest.approx(m, abs=6e-5 * m + 5e-5)
    assert contact.semi_axis_lateral / unit == pytest.approx(n, abs=6e-5 * n + 5e-5)


def test_equal_radii_give_a_circle():
    contact = contact_from_radii(wheel_load=LOAD, wheel_radius=0.4, rail_radius=0.4, **STEEL)
    assert contact.semi_axis_rolling == pytest.approx(contact.semi_axis_lateral, rel=1e-6)
    assert contact.kalker_c11 == pytest.approx(4.12, abs=1e-4)


@pytest.mark.parametrize(("radius", "a", "b", "c11"), [(0.55, 7.73, 5.17, 4.62), (0.51, 7.46, 5.24, 4.54)])
def test_locomotive_on_a_rail_crown_of_300_mm(radius, a, b, c11):
    contact = contact_from_radii(wheel_load=LOAD, wheel_radius=radius, rail_radius=0.3, **STEEL)
    assert 1e3 * contact.semi_axis_rolling == pytest.approx(a, abs=0.006)
    assert 1e3 * contact.semi_axis_lateral == pytest.approx(b, abs=0.006)
    assert contact.kalker_c11 == pytest.approx(c11, abs=0.01)
    assert contact.shear_modulus == pytest.approx(84e9)


def test_semi_axes_grow_with_the_cube_root_of_the_load():
    one, eight = (
        contact_from_radii(wheel_load=k * LOAD, wheel_radius=0.55, rail_radius=0.3, **STEEL)
        for k in (1.0, 8.0)
    )
    assert eight.semi_axis_rolling == pytest.approx(2.0 * one.semi_axis_rolling)
    assert eight.kalker_c11 == pytest.approx(one.kalker_c11)


@pytest.mark.parametrize("parameter", [0.0, 0.1, 0.5, 0.9, 0.999, 1.0 - 1e-9])
def test_elliptic_integrals(parameter):
    assert elliptic_integrals(parameter) == pytest.approx((ellipk(parameter), ellipe(parameter)), rel=1e-12)


# Some nodes of Kalker's table as printed: (a/b, nu, c11).
PRINTED = (
    (0.1, 0.0, 2.51), (0.1, 0.5, 4.85), (0.3, 0.25, 3.44), (0.5, 0.25, 3.62), (0.6, 0.5, 4.91), (0.9, 0.0, 3.29),
    (1.0, 0.25, 4.12), (1.0, 0.5, 5.20), (1 / 0.9, 0.25, 4.22), (1 / 0.7, 0.0, 3.82), (2.0, 0.25, 5.10),
    (1 / 0.3, 0.5, 7.34), (5.0, 0.25, 7.78), (10.0, 0.0, 10.7), (10.0, 0.25, 11.7), (10.0, 0.5, 12.9),
)  # fmt: skip


@pytest.mark.parametrize(("ratio", "poisson", "c11"), PRINTED)
def test_kalkers_table_to_its_printed_digits(ratio, poisson, c11):
    assert creep_coefficients(ratio, 1.0, poisson).c11 == pytest.approx(c11, rel=1e-9)


def test_between_the_nodes_it_is_monotone():
    values = [creep_coefficients(0.05 * k, 1.0, 0.28).c11 for k in range(2, 60)]
    assert values == sorted(values)


@pytest.mark.parametrize(
    ("a", "b", "nu"), [(0.0, 1.0, 0.25), (1.0, -1.0, 0.25), (1.0, 1.0, 0.6), (float("nan"), 1, 0.2)]
)
def test_impossible_ellipses_are_refused(a, b, nu):
    with pytest.raises(UserError, match="contact ellipse"):
        creep_coefficients(a, b, nu)


def test_impossible_radii_are_refused():
    with pytest.raises(UserError, match=r"rail radius = -0\.3"):
        contact_from_radii(wheel_load=LOAD, wheel_radius=0.55, rail_radius=-0.3, **STEEL)
