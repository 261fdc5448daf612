"""Contact of a wheel on a rail in space: Hertz's normal force and Polach's creep forces with lateral creep and spin.

Creepages are the velocity of the wheel against the rail at the contact point over the running speed; x points forward,
y to the left and z up. A creepage is positive where the rim moves forward (as braking makes it), to the left, or turns
to the left about the contact normal. Creep forces are positive against their creepages: what acts on the wheel is their
negative. All functions run on floats, arrays and symbols.
"""

import math
from dataclasses import dataclass

from wspd_design.model.adhesion import contact_stiffness, creep_force
from wspd_design.model.generated.adhesion import creep_gradient, friction_coefficient
from wspd_design.model.hertz import elliptic_integrals
from wspd_design.model.kalker import creep_coefficients
from wspd_design.model.number import Number, maximum, sqrt
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.records import Contact, Rail

_LEAST_LOAD = 1.0  # N; the creep force of a lighter wheel is in proportion to its load
_LEAST_APPROACH = 1e-15  # m; keeps the slope of the normal force finite on a lifted wheel
_HALF_TURNED = (
    3.0  # -, squared gradient where the force has turned halfway; as Kalker's simplified theory has it
)
_NOTHING = 1e-60  # square of a creepage; keeps the direction of no creepage defined


@dataclass(frozen=True, slots=True, kw_only=True)
class WheelRail:
    """What the forces of one wheel on a rail are made from, beyond load, creepages and the rail's friction."""

    contact: Contact
    normal_stiffness: Number  # N/m^1.5, of Hertz's normal force
    kalker_c22: Number  # -, lateral force by lateral creep
    kalker_c23: Number  # -, lateral force by spin
    lateral_slope: Number = 1.0  # -, slope of the lateral force at small creep over that of Kalker's theory


def wheel_rail(contact: Contact, *, poisson: float, lateral_slope: float = 1.0) -> WheelRail:
    """Complete a contact ellipse by Hertz's stiffness and the coefficients of lateral creep and spin.

    Parameters
    ----------
    contact : Contact
        Ellipse at its reference load, shear modulus and the longitudinal coefficient, which is kept as it is.
    poisson : float
        Poisson's ratio of wheel and rail [-].
    lateral_slope : float
        Slope of the lateral force at small creep over that of Kalker's theory [-]. The reduction factors kA and kS
        of a rail are fitted to traction; whether they hold for the small lateral creep of running is not known, and
        they make a vehicle hunt at low speed. Here they leave the lateral slope alone; Polach's own method is
        ``(kA + kS) / 2``, and 0.6 is usual for a contaminated rail.

    Raises
    ------
    UserError
        If the ellipse or a number is impossible.
    """
    if not 0.0 < lateral_slope < math.inf:
        raise UserError(
            f"lateral slope = {lateral_slope:g} must be finite and above 0; 1 is Kalker's theory, 0.6 a usual rail"
        )
    _, c22, c23 = creep_coefficients(contact.semi_axis_rolling, contact.semi_axis_lateral, poisson)
    return WheelRail(
        contact=contact,
        normal_stiffness=normal_stiffness(contact, poisson),
        kalker_c22=c22,
        kalker_c23=c23,
        lateral_slope=lateral_slope,
    )


def normal_stiffness(contact: Contact, poisson: float) -> float:
    """Stiffness C of Hertz's normal force C d^1.5, d the approach of wheel and rail [N/m^1.5].

    The approach at the reference load is 3 Q (1 - nu) K / (2 pi G a): a is the longer semi-axis, K the complete
    elliptic integral of the first kind of the ellipse.

    References
    ----------
    Johnson, Contact Mechanics, chapter 4.
    """
    axes = contact.semi_axis_rolling, contact.semi_axis_lateral
    longer, shorter = max(axes), min(axes)
    first, _ = elliptic_integrals(1.0 - (shorter / longer) ** 2)
    approach = (
        1.5 * contact.reference_load * (1.0 - poisson) * first / (math.pi * contact.shear_modulus * longer)
    )
    return contact.reference_load / float(approach**1.5)


def normal_force(approach: Number, stiffness: Number) -> Number:
    """Hertz's normal force [N]: zero, with slope zero, where wheel and rail are apart.

    Parameters
    ----------
    approach : number
        How far wheel and rail would overlap without deformation [m]; negative where they are apart.
    stiffness : number
        :func:`normal_stiffness` [N/m^1.5].
    """
    return stiffness * maximum(approach, 0.0) * sqrt(maximum(approach, _LEAST_APPROACH))


def flange_force(displacement: Number, clearance: Number, stiffness: Number) -> Number:
    """Lateral force of the flanges against the displacement of a wheelset in the track [N].

    A guard, no model of flange contact: beyond the clearance the force grows as that of Hertz.

    Parameters
    ----------
    displacement : number
        Of the wheelset against the middle of the track, to the left [m].
    clearance : number
        Displacement at which a flange meets its rail [m].
    stiffness : number
        Of the force beyond it [N/m^1.5].

    Returns
    -------
    number
        Positive against a displacement to the left.
    """
    left = normal_force(displacement - clearance, stiffness)
    return left - normal_force(-displacement - clearance, stiffness)


def creep_forces(
    longitudinal: Number,
    lateral: Number,
    spin: Number,
    speed: Number,
    load: Number,
    rail: Rail,
    contact: WheelRail,
) -> tuple[Number, Number]:
    """Creep forces of one wheel by Polach's method with longitudinal and lateral creep, spin and falling friction.

    The size of the force is :func:`wspd_design.model.adhesion.creep_force` of one equivalent creepage: longitudinal
    creep, and lateral creep and spin in proportion to the forces that they have in Kalker's linear theory. Its
    direction turns from that of Kalker's theory at small creep into that of the sliding at large creep; so it has a
    derivative at zero creep, which the direction that Polach takes, that of the creepages, has not. Without lateral
    creep and spin it is the longitudinal creep force of the small vehicle models.

    Parameters
    ----------
    longitudinal, lateral : number
        Creepages [-].
    spin : number
        Turning rate about the contact normal over the running speed [1/m].
    speed : number
        Speed by which the creepages were divided [m/s].
    load : number
        Normal force [N]; not negative.
    rail : Rail
        Friction and reduction factors.
    contact : WheelRail
        Ellipse and coefficients.

    Returns
    -------
    longitudinal, lateral : number
        Forces on the wheel, positive against their creepages [N].

    References
    ----------
    Polach (1999), Vehicle System Dynamics Supplement 33, 728-739; Polach (2005), Wear 258, 992-1000.
    """
    ellipse = contact.contact
    carried = maximum(load, _LEAST_LOAD)
    stiffness = contact_stiffness(ellipse, carried)
    # kA and kS reduce the slope of the longitudinal force; the lateral one has its own factor.
    reduction = 0.5 * (rail.adhesion_reduction + rail.slip_reduction)
    weight = contact.lateral_slope * contact.kalker_c22 / (ellipse.kalker_c11 * reduction)
    mean_axis = sqrt(4.0 * stiffness / (math.pi * ellipse.shear_modulus * ellipse.kalker_c11))
    turning = contact.kalker_c23 / contact.kalker_c22 * mean_axis * spin
    elastic = weight * (lateral + turning)
    creep = _length(longitudinal, elastic)
    sliding_speed = speed * _length(longitudinal, lateral)
    force = creep_force(creep, sliding_speed, carried, rail, stiffness) * (load / carried)

    friction = friction_coefficient(sliding_speed, rail.mu0, rail.friction_ratio, rail.friction_decay)
    gradient = creep_gradient(creep, carried, friction, stiffness)
    sliding = gradient * gradient / (_HALF_TURNED + gradient * gradient)
    sideways = (1.0 - sliding) * elastic + sliding * lateral
    # What spin makes slide does so in all directions, and that part of the force cancels out: the force of spin alone
    # falls as one over the spin in the end, as it does in Kalker's simplified theory.
    around = sliding * (1.0 - sliding) * (weight * turning) ** 2
    whole = sqrt(longitudinal * longitudinal + sideways * sideways + around + _NOTHING)
    return force * longitudinal / whole, force * sideways / whole


def _length(longitudinal: Number, lateral: Number) -> Number:
    """Length of a vector of creepages, with a derivative at zero too."""
    return sqrt(longitudinal * longitudinal + lateral * lateral + _NOTHING)
