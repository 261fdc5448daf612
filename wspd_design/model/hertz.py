"""Hertz's contact ellipse of a wheel on a rail, from the exact elliptic integrals."""

import math

from wspd_design.model.kalker import creep_coefficients
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.records import Contact


def contact_from_radii(
    *, wheel_load: float, wheel_radius: float, rail_radius: float, young: float, poisson: float
) -> Contact:
    """Contact of a coned wheel on a rail crown.

    Parameters
    ----------
    wheel_load : float
        Vertical wheel load [N].
    wheel_radius : float
        Rolling radius [m].
    rail_radius : float
        Radius of the rail crown across the rail [m].
    young : float
        Young's modulus of wheel and rail [Pa].
    poisson : float
        Poisson's ratio of wheel and rail [-].

    Returns
    -------
    Contact
        Ellipse, shear modulus and Kalker's coefficient at this load.

    References
    ----------
    Hertz (1882); Johnson, Contact Mechanics, chapter 4.
    """
    given = {
        "wheel load": wheel_load,
        "wheel radius": wheel_radius,
        "rail radius": rail_radius,
        "modulus": young,
    }
    for name, value in given.items():
        if not (value > 0.0 and math.isfinite(value)):
            raise UserError(f"{name} = {value:g} of a contact must be a positive number")
    across, along = 1.0 / rail_radius, 1.0 / wheel_radius
    ratio = _axis_ratio(max(across, along) / min(across, along))
    _, second = elliptic_integrals(1.0 - 1.0 / ratio**2)
    modulus = young / (1.0 - poisson**2)
    major = (6.0 * ratio**2 * second * wheel_load / (math.pi * modulus * (across + along))) ** (1.0 / 3.0)
    # The longer axis lies along the direction of the smaller curvature.
    rolling, lateral = (major, major / ratio) if along <= across else (major / ratio, major)
    return Contact(
        shear_modulus=young / (2.0 * (1.0 + poisson)),
        semi_axis_rolling=rolling,
        semi_axis_lateral=lateral,
        kalker_c11=creep_coefficients(rolling, lateral, poisson).c11,
        reference_load=wheel_load,
    )


def _axis_ratio(curvature_ratio: float) -> float:
    """Ratio of the axes, at least 1, of the ellipse between surfaces of a ratio of relative curvatures.

    (k^2 E - K) / (K - E) rises with k from 1 to infinity; bisection in log k.
    """
    low, high = 0.0, math.log(1e4)
    for _ in range(100):
        middle = 0.5 * (low + high)
        k = math.exp(middle)
        first, second = elliptic_integrals(1.0 - 1.0 / k**2)
        beyond = k > 1.0 + 1e-12 and (k**2 * second - first) > curvature_ratio * (first - second)
        low, high = (low, middle) if beyond else (middle, high)
    return math.exp(0.5 * (low + high))


def elliptic_integrals(parameter: float) -> tuple[float, float]:
    """Complete elliptic integrals K(m) and E(m) by the arithmetic-geometric mean."""
    a, b, power, total = 1.0, math.sqrt(1.0 - parameter), 1.0, parameter
    while abs(a - b) > 1e-15 * a:
        a, b, c = 0.5 * (a + b), math.sqrt(a * b), 0.5 * (a - b)
        power *= 2.0
        total += power * c * c
    first = math.pi / (2.0 * a)
    return first, first * (1.0 - 0.5 * total)
