"""Where the bodies of a vehicle are and how they move, with exact rotations.

Track axes: x forward, y to the left, z up. A free body turns by yaw, then roll, then pitch: R = Rz Rx Ry. The frame of
a wheelset is Rz Rx alone: it does not spin, and the pitch of the wheelset is its turn in this frame. Neither does the
frame of a rotor, which is that of its motor.
"""

from typing import Any, NamedTuple

from wspd_design.model.number import Number
from wspd_design.plants.multibody.records import Body, Multibody, Place
from wspd_design.plants.multibody.vectors import (
    Axes,
    Vector,
    add,
    cross,
    outward,
    scaled,
    subtract,
    turned,
)


class BodyMotion(NamedTuple):
    """One body at one instant; ``frame`` is what springs and bearings hold on to, which may not spin with it."""

    body: Body
    displacement: Vector  # of the center of gravity from rest, m
    axes: Axes  # of the frame
    velocity: Vector  # of the center of gravity, m/s
    turning: Vector  # of the body, in axes of the frame, rad/s
    frame_turning: Vector  # of the frame, likewise


def motions(model: Multibody, q: Any, v: Any) -> dict[str, BodyMotion]:
    """Return the motion of every body, by its name.

    Parameters
    ----------
    model : Multibody
        With n coordinates.
    q, v : casadi.SX
        Coordinates and their rates, n x 1.
    """
    starts, found = first_coordinates(model), dict[str, BodyMotion]()
    for body in sorted(model.bodies, key=lambda each: bool(each.on)):  # after those that they turn on
        k = starts[body.name]
        if body.on:
            found[body.name] = _carried(model, body, found[body.on], q[k], v[k])
        else:
            found[body.name] = _free(body, q[k : k + 6], v[k : k + 6])
    return found


def first_coordinates(model: Multibody) -> dict[str, int]:
    """Return the index of the first coordinate of every body."""
    counts = [len(body.coordinates) for body in model.bodies]
    return {body.name: sum(counts[:k]) for k, body in enumerate(model.bodies)}


def _free(body: Body, q: Any, v: Any) -> BodyMotion:
    import casadi as ca

    roll, pitch, yaw = q[3], q[4], q[5]
    about_x, about_y, about_z = v[3], v[4], v[5]
    sx, cx, sz, cz = ca.sin(roll), ca.cos(roll), ca.sin(yaw), ca.cos(yaw)
    axes: Axes = ((cz, sz, 0.0), (-sz * cx, cz * cx, sx), (sz * sx, -cz * sx, cx))
    frame = (about_x, about_z * sx, about_z * cx)
    body_turning = (frame[0], frame[1] + about_y, frame[2])
    if body.joint == "free":
        axes = about_own_y(axes, pitch)
        frame = body_turning = _seen_from_turned(body_turning, pitch)
    return BodyMotion(
        body=body,
        displacement=(q[0], q[1], q[2]),
        axes=axes,
        velocity=(v[0], v[1], v[2]),
        turning=body_turning,
        frame_turning=frame,
    )


def about_own_y(axes: Axes, angle: Number) -> Axes:
    """Turn axes about the second of them."""
    import casadi as ca

    s, c = ca.sin(angle), ca.cos(angle)
    first, second, third = axes
    return (
        subtract(scaled(c, first), scaled(s, third)),
        second,
        add(scaled(s, first), scaled(c, third)),
    )


def _seen_from_turned(a: Vector, angle: Number) -> Vector:
    """Return the components of a vector in axes that are turned about the second one."""
    import casadi as ca

    s, c = ca.sin(angle), ca.cos(angle)
    return c * a[0] - s * a[2], a[1], s * a[0] + c * a[2]


def _carried(model: Multibody, body: Body, other: BodyMotion, angle: Number, rate: Number) -> BodyMotion:
    axis = other.body.at if body.axis is None else body.axis
    to_axis, to_center = model.offset(axis, other.body.at), model.offset(body.at, axis)
    turning = (other.frame_turning[0], other.frame_turning[1] + rate, other.frame_turning[2])
    axes, frame = other.axes, other.frame_turning
    if body.joint == "revolute":
        axes = about_own_y(axes, angle)
        frame = turning = _seen_from_turned(turning, angle)
    return BodyMotion(
        body=body,
        displacement=add(add(other.displacement, turned(other.axes, to_axis)), turned(axes, to_center)),
        axes=axes,
        velocity=add(
            add(other.velocity, outward(other.axes, cross(other.frame_turning, to_axis))),
            outward(axes, cross(frame, to_center)),
        ),
        turning=turning,
        frame_turning=frame,
    )


class Marker(NamedTuple):
    """A point of a body."""

    arm: Vector  # from the center of gravity, m, in axes of the track
    displacement: Vector  # from rest, m
    velocity: Vector  # m/s


def marker(model: Multibody, motion: BodyMotion, point: Place) -> Marker:
    """Return the motion of the point of a body that is at a place at rest."""
    arm = model.offset(point, motion.body.at)
    return Marker(
        arm=outward(motion.axes, arm),
        displacement=add(motion.displacement, turned(motion.axes, arm)),
        velocity=add(motion.velocity, outward(motion.axes, cross(motion.frame_turning, arm))),
    )
