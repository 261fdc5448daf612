"""Adhesion between wheel and rail: Polach's creep force for the records of a rail and a contact."""

import math

from wspd_design.model.generated import adhesion as generated
from wspd_design.model.number import Number
from wspd_design.parameters.records import Contact, Rail

_LOAD_EXPONENT = (
    2.0 / 3.0
)  # of the stiffness: both semi-axes of Hertz's ellipse grow with the cube root of the load
_BINOMIALS = tuple(math.prod((_LOAD_EXPONENT - j) / (j + 1) for j in range(k)) for k in range(5))


def contact_stiffness(contact: Contact, wheel_load: Number) -> Number:
    """Initial slope of the creep force, pi G a b c11 / 4 of eq. (6).

    Both semi-axes of Hertz's ellipse grow with the cube root of the load, so the slope grows with load^(2/3).

    Parameters
    ----------
    contact : Contact
        Ellipse at its reference load.
    wheel_load : number
        Vertical wheel load Q [N].

    Returns
    -------
    number
        Stiffness [N].
    """
    at_reference = generated.contact_stiffness(
        contact.shear_modulus, contact.semi_axis_rolling, contact.semi_axis_lateral, contact.kalker_c11
    )
    return at_reference * (wheel_load / contact.reference_load) ** _LOAD_EXPONENT


def stiffness_growth(ratio: Number) -> Number:
    """Growth of :func:`contact_stiffness` with a load that stays near its first value, by its power series.

    Within 5 % of the load the error is below 1e-8, and it falls with the fifth power of the change: an integrator
    of order four can follow the load within a step without a logarithm in each stage.

    Parameters
    ----------
    ratio : number
        Load over its first value [-].
    """
    change, growth = ratio - 1.0, 0.0
    for coefficient in reversed(_BINOMIALS):
        growth = coefficient + change * growth
    return growth


def creep_force(
    slip: Number, sliding_speed: Number, wheel_load: Number, rail: Rail, stiffness: Number
) -> Number:
    """Longitudinal creep force of one wheel by Polach's method, eqs. (5)-(7).

    Parameters
    ----------
    slip : number
        Longitudinal slip ratio, positive when braking [-].
    sliding_speed : number
        Speed of the wheel rim against the rail, v - R omega [m/s]; not negative.
    wheel_load : number
        Vertical wheel load Q [N].
    rail : Rail
        Friction and reduction factors.
    stiffness : number
        :func:`contact_stiffness` at this load [N].

    Returns
    -------
    number
        Force on the wheel rim, positive when it brakes the train [N].

    References
    ----------
    Polach (2005), Wear 258, 992-1000.
    """
    return generated.creep_force(
        slip,
        sliding_speed,
        wheel_load,
        rail.mu0,
        rail.friction_ratio,
        rail.friction_decay,
        rail.adhesion_reduction,
        rail.slip_reduction,
        stiffness,
    )


def creep_force_slip_derivative(
    slip: Number, speed: Number, wheel_load: Number, rail: Rail, stiffness: Number
) -> Number:
    """Derivative of the creep force with respect to slip at fixed train speed [N].

    Takes the train ``speed`` [m/s] in place of the sliding speed; the rest as in :func:`creep_force`.
    """
    return generated.creep_force_slip_derivative(
        slip,
        speed,
        wheel_load,
        rail.mu0,
        rail.friction_ratio,
        rail.friction_decay,
        rail.adhesion_reduction,
        rail.slip_reduction,
        stiffness,
    )
