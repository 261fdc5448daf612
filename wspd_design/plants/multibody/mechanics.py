"""Equations of motion of a multibody vehicle on CasADi symbols, but for the forces of rails and brakes.

    M(q) v' = force(q, v) + brake_directions(q) torques + forces of the wheels on their rows

The coordinates are measured from rest; with the preloads of :mod:`preloads` rest is an exact equilibrium.
"""

from collections.abc import Mapping
from typing import Any, NamedTuple

from wspd_design.model.number import Number
from wspd_design.model.wheel_profile import WheelProfile
from wspd_design.parameters.loading import constants
from wspd_design.plants.multibody.elements import act
from wspd_design.plants.multibody.inertia import inertia
from wspd_design.plants.multibody.kinematics import BodyMotion, first_coordinates, motions
from wspd_design.plants.multibody.records import CaliperBrake, Multibody
from wspd_design.plants.multibody.vectors import Vector, add, cross, inward, scaled, subtract
from wspd_design.plants.multibody.wheels import Irregularity, Wheel, wheels


class Energies(NamedTuple):
    """Energy of a vehicle, without that of the contact springs."""

    kinetic: Number  # J
    potential: Number  # J, zero at rest


class Mechanics(NamedTuple):
    """Equations of motion at one state, as expressions."""

    mass_matrix: Any  # n x n
    force: Any  # n, of all but rails and brakes: springs, dampers, weight, preloads, inertia at velocity
    wheels: tuple[Wheel, ...]  # of each wheelset from the front left, then right
    brake_directions: Any  # n x wheelsets, generalized force of 1 N m of braking torque
    energies: Energies
    dissipation: Number  # W, of all dampers


def mechanics(
    model: Multibody,
    q: Any,
    v: Any,
    *,
    linear: bool = False,
    irregularities: tuple[Irregularity, ...] | None = None,
    profile: WheelProfile | None = None,
) -> Mechanics:
    """Build the equations of motion.

    Parameters
    ----------
    model : Multibody
        With preloads (:func:`wspd_design.plants.multibody.preloads.balanced`); numbers may be symbols.
    q, v : casadi.SX
        Symbols of the coordinates and of their rates, n x 1, in the order of ``model.coordinates``.
    linear : bool
        Whether suspension and inertia are expanded about rest. Mass matrix, stiffness and damping are constant then;
        the gyroscopic terms keep the speed of what spins, and the wheels on the rails stay as they are.
    irregularities : tuple of Irregularity, optional
        Of the track under each wheelset; none by default.
    profile : WheelProfile, optional
        In place of the cone of the vehicle.
    """
    import casadi as ca

    bodies = motions(model, q, v)
    forces = act(model, bodies, q, v, constants().gravity)
    mass_matrix, inertial, kinetic = inertia(model, bodies, q, v)
    exact = Mechanics(
        mass_matrix=mass_matrix,
        force=inertial + _generalized(bodies, forces.on_frames, v) + _on(forces.on_coordinates, v),
        wheels=wheels(model, q, v, irregularities=irregularities, profile=profile),
        brake_directions=_brake_directions(model, bodies, v),
        energies=Energies(kinetic, forces.potential),
        dissipation=forces.dissipation,
    )
    return _expanded(model, exact, q, v, ca) if linear else exact


def _generalized(
    bodies: Mapping[str, BodyMotion], on_frames: Mapping[str, tuple[Vector, Vector]], v: Any
) -> Any:
    """Project forces and moments on the frames of bodies to the coordinates."""
    import casadi as ca

    total = ca.SX.zeros(v.numel())
    for name, (force, moment) in on_frames.items():
        motion = bodies[name]
        rates = ca.vertcat(*motion.velocity, *motion.frame_turning)
        wrench = ca.vertcat(*force, *inward(motion.axes, moment))
        total += ca.mtimes(ca.jacobian(rates, v).T, wrench)
    return total


def _on(on_coordinates: Mapping[int, Number], v: Any) -> Any:
    import casadi as ca

    total = ca.SX.zeros(v.numel())
    for k, force in on_coordinates.items():
        total[k] += force
    return total


def _brake_directions(model: Multibody, bodies: Mapping[str, BodyMotion], v: Any) -> Any:
    """Generalized force of 1 N m on each axle: friction forces on the wheelset, their reactions on the calipers."""
    import casadi as ca

    columns = [ca.SX.zeros(v.numel()) for _ in model.wheelset_names]
    for brake in model.brakes:
        columns[model.wheelset_names.index(brake.wheelset)] = _brake_direction(model, brake, bodies, v)
    return ca.sparsify(ca.horzcat(*columns))


def _brake_direction(model: Multibody, brake: CaliperBrake, bodies: Mapping[str, BodyMotion], v: Any) -> Any:
    wheelset, frame = bodies[brake.wheelset], bodies[brake.frame]
    between = model.offset(wheelset.body.at, frame.body.at)
    apart = add(between, subtract(wheelset.displacement, frame.displacement))
    share = 1.0 / len(brake.levers)
    lift: Number = 0.0
    on_frame: tuple[Vector, Vector] = ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    for terms in brake.levers:
        lever = model.length(terms)
        upward = share / lever  # that brakes a wheel which rolls forward
        lift += upward
        force = scaled(-upward, wheelset.axes[2])
        arm = add(apart, scaled(lever, wheelset.axes[0]))
        on_frame = add(on_frame[0], force), add(on_frame[1], cross(arm, force))
    on_wheelset = {brake.wheelset: (scaled(lift, wheelset.axes[2]), (0.0, 0.0, 0.0))}
    column = _generalized(bodies, on_wheelset | {brake.frame: on_frame}, v)
    pitch = first_coordinates(model)[brake.wheelset] + 4
    return column + _on({pitch: -1.0}, v)


def _expanded(model: Multibody, exact: Mechanics, q: Any, v: Any, ca: Any) -> Mechanics:
    """Expand suspension and inertia about rest, where only wheelsets and rotors may spin."""
    starts = first_coordinates(model)
    spinning = [starts[body.name] + 4 for body in model.bodies if body.joint == "wheelset"]
    spinning += [starts[body.name] for body in model.bodies if body.joint == "rotor"]
    spins, others = ca.SX.zeros(v.numel()), ca.SX(v)
    for k in spinning:
        spins[k], others[k] = v[k], 0.0
    rest = ca.SX.zeros(q.numel())

    def at_rest(expression: Any, rates: Any = rest) -> Any:
        return ca.sparsify(ca.substitute(expression, ca.vertcat(q, v), ca.vertcat(rest, rates)))

    by_place, by_rate = (ca.jacobian(exact.force, each) for each in (q, v))
    stiffness, damping = at_rest(by_place), at_rest(by_rate)
    mass_matrix = at_rest(exact.mass_matrix)
    force = (
        at_rest(exact.force, spins)
        + ca.mtimes(at_rest(by_place, spins), q)
        + ca.mtimes(at_rest(by_rate, spins), others)
    )
    return Mechanics(
        mass_matrix=mass_matrix,
        force=force,
        wheels=exact.wheels,
        brake_directions=at_rest(exact.brake_directions),
        energies=Energies(
            0.5 * ca.dot(v, ca.mtimes(mass_matrix, v)),
            -ca.dot(at_rest(exact.force), q) - 0.5 * ca.dot(q, ca.mtimes(stiffness, q)),
        ),
        dissipation=-ca.dot(v, ca.mtimes(damping, v)),
    )
