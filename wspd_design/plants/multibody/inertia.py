"""Mass matrix of a vehicle, and the inertial forces that its velocities alone make.

By d'Alembert's principle in the form of Lagrange and Kane: with J the Jacobian of velocity and turning of a body in the
rates of the coordinates, M = sum J^T m J, and the forces are -sum J^T (m J' v + gyroscopic moments).
"""

from collections.abc import Mapping
from typing import Any

from wspd_design.model.number import Number
from wspd_design.plants.multibody.kinematics import BodyMotion
from wspd_design.plants.multibody.records import Multibody
from wspd_design.plants.multibody.vectors import cross


def inertia(model: Multibody, bodies: Mapping[str, BodyMotion], q: Any, v: Any) -> tuple[Any, Any, Number]:
    """Return mass matrix [n x n], inertial forces [n x 1] and kinetic energy [J]."""
    import casadi as ca

    mass_matrix, force, kinetic = ca.SX(v.numel(), v.numel()), ca.SX.zeros(v.numel()), ca.SX(0)
    for body in model.bodies:
        motion = bodies[body.name]
        mass, moments = model.mass(body), model.inertia(body)
        rates: Any = ca.vertcat(*motion.velocity, *motion.turning)
        weights = ca.vertcat(mass, mass, mass, *moments)
        jacobian = ca.jacobian(rates, v)
        bias = weights * ca.jtimes(rates, q, v)
        momentum = tuple(i * w for i, w in zip(moments, motion.turning, strict=True))
        gyroscopic = cross(motion.frame_turning, (momentum[0], momentum[1], momentum[2]))
        mass_matrix += ca.mtimes(jacobian.T, ca.mtimes(ca.diag(weights), jacobian))
        force -= ca.mtimes(jacobian.T, bias + ca.vertcat(0, 0, 0, *gyroscopic))
        kinetic += 0.5 * ca.dot(weights, rates**2)
    for gear in model.gears:
        housing = bodies[gear.housing]
        spin = _pinion_spin(model, gear.kind, housing, bodies[housing.body.on])
        moment = model.numbers[f"{gear.kind}.pinion_inertia"]
        row = ca.jacobian(spin, v)
        turning = ca.jacobian(ca.vertcat(*housing.frame_turning), v)
        gyroscopic = cross(housing.frame_turning, (0.0, moment * spin, 0.0))
        mass_matrix += moment * ca.mtimes(row.T, row)
        force -= row.T * moment * ca.jtimes(spin, q, v) + ca.mtimes(turning.T, ca.vertcat(*gyroscopic))
        kinetic += 0.5 * moment * spin**2
    return mass_matrix, force, kinetic


def _pinion_spin(model: Multibody, kind: str, housing: BodyMotion, wheelset: BodyMotion) -> Number:
    """Turning rate of a pinion about its axis: its teeth roll on those of the wheel."""
    ratio = model.numbers[f"{kind}.ratio"]
    return (1.0 + ratio) * housing.turning[1] - ratio * wheelset.turning[1]
