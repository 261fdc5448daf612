"""Wheels on the rails: how near a wheel comes to its rail, and how its rim moves against it.

The contact point of a wheel stays above its rail when the wheelset moves sideways, and turns with the axle when the
wheelset yaws: with the contact point in track axes the spin of a yawed wheelset would do work on the normal force. The
normal force acts on the coordinates as the gradient of the approach, so that it stores energy and makes none.
"""

from typing import Any, NamedTuple

from wspd_design.model.number import Number, sqrt
from wspd_design.model.wheel_profile import WheelProfile, cone
from wspd_design.plants.multibody.kinematics import first_coordinates
from wspd_design.plants.multibody.records import SIDES, Multibody

_SIGNS = dict(zip(SIDES, (1.0, -1.0), strict=True))


class Irregularity(NamedTuple):
    """Displacement of the track under one wheelset."""

    vertical: Number = 0.0  # m, upwards
    lateral: Number = 0.0  # m, to the left
    cross_level: Number = 0.0  # rad, left rail higher


class Wheel(NamedTuple):
    """One wheel; forces on it act through the rows, which are derivatives by the six coordinates of the wheelset."""

    axle: int
    side: str
    first: int  # index of the first coordinate of the wheelset
    position: Any  # 3, of the contact point against its place at rest, m
    approach: Number  # m, of wheel and rail beyond that at rest
    approach_row: Any  # 1 x 6
    velocity: tuple[
        Number, Number, Number
    ]  # of the rim against the rail, forward and left, m/s; about the normal, rad/s
    velocity_rows: tuple[Any, Any, Any]  # 1 x 6 each
    displacement: Number  # m, of the wheelset in the track, to the left
    displacement_row: Any  # 1 x 6
    roll: Number  # rad, of the wheelset
    yaw: Number  # rad


def wheels(
    model: Multibody,
    q: Any,
    v: Any,
    *,
    irregularities: tuple[Irregularity, ...] | None = None,
    profile: WheelProfile | None = None,
) -> tuple[Wheel, ...]:
    """Return all wheels: of each wheelset from the front the left one, then the right one.

    Parameters
    ----------
    model : Multibody
        Wheel radius, spacing of the rolling circles, and cone.
    q, v : casadi.SX
        Coordinates and their rates, n x 1.
    irregularities : tuple of Irregularity, optional
        Of the track under each wheelset; none by default.
    profile : WheelProfile, optional
        In place of the cone of the vehicle.
    """
    starts, shape = first_coordinates(model), profile or cone(model.numbers["conicity"])
    under = irregularities or (Irregularity(),) * model.wheelsets
    return tuple(
        _wheel(model, axle, side, starts[name], q, v, under[axle], shape)
        for axle, name in enumerate(model.wheelset_names)
        for side in SIDES
    )


def _wheel(
    model: Multibody,
    axle: int,
    side: str,
    first: int,
    q: Any,
    v: Any,
    track: Irregularity,
    profile: WheelProfile,
) -> Wheel:
    import casadi as ca

    own = slice(first, first + 6)
    x, y, z, roll, _, yaw = ca.vertsplit(q[own])
    forward_rate, left_rate, up_rate, roll_rate, pitch_rate, yaw_rate = ca.vertsplit(v[own])
    sign, half = _SIGNS[side], model.numbers["wheel_half_spacing"]
    radius = model.numbers["wheel_radius"]
    sx, cx, sz, cz = ca.sin(roll), ca.cos(roll), ca.sin(yaw), ca.cos(yaw)

    displacement = y + radius * sx - track.lateral
    along = (sign * half - displacement) / cz  # the axle, from its middle to above the rail
    to_flange = half - sign * along
    rolling = radius + profile.radius_growth(to_flange)
    rail = track.vertical + sign * half * track.cross_level
    lowest = z + along * sx + radius * (1.0 - cx) - profile.lift(to_flange)
    approach = rail - lowest

    # In the frame of the wheelset the arm of the contact point is (0, along, -rolling).
    spin, about_z = pitch_rate + yaw_rate * sx, yaw_rate * cx
    forward = cz * forward_rate + sz * left_rate - rolling * spin - along * about_z
    level = -sz * forward_rate + cz * left_rate  # across the axle, before it rolls
    leftward, upward = cx * level + sx * up_rate, -sx * level + cx * up_rate
    slope = sign * profile.contact_slope(to_flange)
    norm = sqrt(1.0 + slope * slope)
    left = (leftward + rolling * roll_rate + slope * (upward + along * roll_rate)) / norm
    about_normal = (about_z - slope * spin) / norm
    velocity = (forward, left, about_normal)
    return Wheel(
        axle=axle,
        side=side,
        first=first,
        position=ca.vertcat(x - sz * (cx * along + sx * rolling), displacement + track.lateral, lowest),
        approach=approach,
        approach_row=ca.jacobian(approach, q)[:, own],
        velocity=velocity,
        velocity_rows=tuple(ca.jacobian(each, v)[:, own] for each in velocity),
        displacement=displacement,
        displacement_row=ca.jacobian(displacement, q)[:, own],
        roll=roll,
        yaw=yaw,
    )
