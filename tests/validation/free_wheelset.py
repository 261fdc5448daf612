"""A free wheelset on straight track by Newton and Euler, six degrees of freedom, for the contact functions alone.

Independent of the multibody package: momentum and angular momentum in the frame that yaws and rolls with the axle but
does not spin. State: x, y, z, roll, yaw; forward, lateral and vertical speed; rates about the axle's own axes.
"""

import casadi as ca
import numpy as np

from wspd_design.model.hertz import contact_from_radii
from wspd_design.model.wheel_profile import WheelProfile
from wspd_design.model.wheel_rail import creep_forces, normal_force, wheel_rail
from wspd_design.parameters.records import Rail

RADIUS, HALF_GAUGE, LOAD = 0.55, 0.75, 94.2e3  # m, m, N per wheel
MASS, SPIN_INERTIA, CROSS_INERTIA = 2050.0, 300.0, 1250.0  # kg, kg m2
KALKER = Rail(
    name="kalker",
    mu0=0.5,
    friction_ratio=1.0,
    friction_decay=0.0,
    adhesion_reduction=1.0,
    slip_reduction=1.0,
)
ELLIPSE = contact_from_radii(wheel_load=LOAD, wheel_radius=RADIUS, rail_radius=0.3, young=210e9, poisson=0.25)
CONTACT = wheel_rail(ELLIPSE, poisson=0.25)
NAMES = ("x", "y", "z", "roll", "yaw", "vx", "vy", "vz", "roll_rate", "spin", "yaw_rate")


def rates(state, profile, *, turns_with_axle=True, rolls_over=True):
    """Derivative of the state."""
    _x, y, z, roll, yaw, *speeds = ca.vertsplit(state)
    velocity, turning = ca.vertcat(*speeds[:3]), ca.vertcat(*speeds[3:])
    c, s = ca.cos, ca.sin
    about_z = ca.vertcat(ca.horzcat(c(yaw), -s(yaw), 0), ca.horzcat(s(yaw), c(yaw), 0), ca.horzcat(0, 0, 1))
    about_x = ca.vertcat(
        ca.horzcat(1, 0, 0), ca.horzcat(0, c(roll), -s(roll)), ca.horzcat(0, s(roll), c(roll))
    )
    frame = about_z @ about_x
    omega = frame @ turning
    force = ca.vertcat(0, 0, -2.0 * LOAD)
    moment = ca.SX.zeros(3)
    # Rolling carries the treads to the side under the axle: what meets the rail moves by the radius times the roll.
    displacement = y + RADIUS * roll if rolls_over else y
    for side in (1.0, -1.0):
        towards_flange = side * displacement
        radius = RADIUS + profile.radius_growth(towards_flange)
        slope = ca.atan(profile.contact_slope(towards_flange))
        arm = frame if turns_with_axle else about_x
        lever = arm @ ca.vertcat(0, side * HALF_GAUGE - displacement, -radius)
        normal = frame @ ca.vertcat(0, -side * s(slope), c(slope))
        forward = ca.vertcat(c(yaw), s(yaw), 0)
        sideways = ca.cross(normal, forward)
        overlap = -(z + lever[2]) * normal[2]
        load = normal_force(overlap, CONTACT.normal_stiffness)
        speed = velocity[0]
        slip = (velocity + ca.cross(omega, lever)) / speed
        along, across = creep_forces(
            ca.dot(slip, forward),
            ca.dot(slip, sideways),
            ca.dot(omega, normal) / speed,
            speed,
            load,
            KALKER,
            CONTACT,
        )
        on_wheel = load * normal - along * forward - across * sideways
        force += on_wheel
        moment += ca.cross(lever, on_wheel)
    own = frame.T @ moment
    roll_rate, spin, yaw_rate = ca.vertsplit(turning)
    about_axle = yaw_rate * ca.tan(roll)  # of the frame
    angular = ca.vertcat(
        (own[0] - about_axle * CROSS_INERTIA * yaw_rate + yaw_rate * SPIN_INERTIA * spin) / CROSS_INERTIA,
        own[1] / SPIN_INERTIA,
        (own[2] - roll_rate * SPIN_INERTIA * spin + about_axle * CROSS_INERTIA * roll_rate) / CROSS_INERTIA,
    )
    return ca.vertcat(velocity, roll_rate, yaw_rate / ca.cos(roll), force / MASS, angular)


def run(profile: WheelProfile, *, speed: float, yaw: float, distance: float, step: float, **faults):
    """Integrate by Runge's and Kutta's method; a row of the state at each step, columns as in ``NAMES``."""
    state = ca.SX.sym("state", len(NAMES))
    f = ca.Function("f", [state], [rates(state, profile, **faults)])
    k1 = f(state)
    k2 = f(state + 0.5 * step * k1)
    k3 = f(state + 0.5 * step * k2)
    k4 = f(state + step * k3)
    move = ca.Function("move", [state], [state + step / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)])
    steps = round(distance / speed / step)
    # Of both wheels the normal forces carry the load, each under its contact angle.
    slope = float(profile.contact_slope(0.0))
    carried = LOAD / np.cos(np.arctan(slope))
    sink = (carried / CONTACT.normal_stiffness) ** (2.0 / 3.0) / np.cos(np.arctan(slope))
    start = [0.0, 0.0, RADIUS - sink, 0.0, yaw, speed, 0.0, 0.0, 0.0, speed / RADIUS, 0.0]
    return np.array(move.mapaccum(steps)(start)).T


def wavelength(states):
    """Distance between the first and the last upward crossing of the middle of the track, over the waves between."""
    x, y = states[:, 0], states[:, 1]
    up = np.flatnonzero((y[:-1] < 0.0) & (y[1:] >= 0.0))
    places = x[up] - y[up] * (x[up + 1] - x[up]) / (y[up + 1] - y[up])
    return (places[-1] - places[0]) / (len(places) - 1)
