"""A multibody vehicle in the closed loop: from speed, wheel speeds and all other states to their rates.

The *rest* of the state are, in the order of ``rest_names``, the coordinates without the forward one of the first body,
to which those of all other free bodies are referred, and the rates without that of the first body and without the wheel
speeds. The numbers stay small however far the vehicle runs.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

from wspd_design.model.number import Number, maximum
from wspd_design.model.wheel_profile import WheelProfile
from wspd_design.model.wheel_rail import WheelRail, creep_forces, flange_force, normal_force
from wspd_design.parameters.loading import constants
from wspd_design.parameters.records import Rail
from wspd_design.plants.multibody.elements import gear_moment
from wspd_design.plants.multibody.factoring import Sparse, factors, sparse
from wspd_design.plants.multibody.kinematics import first_coordinates
from wspd_design.plants.multibody.mechanics import mechanics
from wspd_design.plants.multibody.records import Multibody, gears_of
from wspd_design.plants.multibody.wheels import Irregularity, Wheel

_PITCH = 4  # among the coordinates of a wheelset
_PER_AXLE = 2  # wheels
_SETTLING = 5e-3  # s, in which what still slides at a pad when its wheelset locks comes to rest


class MultibodyMotion(NamedTuple):
    """A vehicle at one instant; forces and slips of an axle are means of its wheels, positive when braking."""

    acceleration: Number  # m/s2, of the first body
    wheel_rates: tuple[Number, ...]  # rad/s2
    rest_rates: Any  # of the rest of the state
    creep_forces: tuple[Number, ...]  # N per wheel
    slips: tuple[Number, ...]  # -
    wheel_loads: tuple[Number, ...]  # N per wheel
    transmitted: tuple[
        Number, ...
    ]  # N m per wheelset, braking torque that acts; of a locked one, what holds it
    wheel_loads_left: tuple[Number, ...]  # N
    wheel_loads_right: tuple[Number, ...]  # N
    lateral: tuple[Number, ...]  # m, wheelset in the track, to the left
    torsion: tuple[Number, ...]  # N m, between rotor and pinion; 0 without a gear


def rest_names(model: Multibody) -> tuple[str, ...]:
    """Return the names of the rest of the state: coordinates, then rates, which end with a prime."""
    speed, wheel_speeds = _apart(model)
    names = model.coordinates
    return (
        *(name for k, name in enumerate(names) if k != speed),
        *(f"{name}'" for k, name in enumerate(names) if k != speed and k not in wheel_speeds),
    )


def vehicle_motion(
    model: Multibody,
    contact: WheelRail,
    *,
    speed: Any,
    wheel_speeds: Sequence[Any],
    rest: Any,
    torques: Sequence[Number],
    locked: Sequence[Number],
    rails: Sequence[Rail],
    irregularities: tuple[Irregularity, ...] | None = None,
    resistance: Number = 0.0,
    damping: Number = 0.0,
    linear: bool = False,
    profile: WheelProfile | None = None,
) -> MultibodyMotion:
    """Build the rates of a vehicle on its rails.

    Parameters
    ----------
    model : Multibody
        With preloads; numbers and preloads may be symbols.
    contact : WheelRail
        Of every wheel.
    speed : casadi.SX
        Forward speed of the first body [m/s].
    wheel_speeds : sequence of casadi.SX
        Pitch rates of the wheelsets in their frames, which do not spin [rad/s].
    rest : casadi.SX
        Rest of the state, in the order of :func:`rest_names`.
    torques : sequence of number
        Braking torque of each wheelset [N m].
    locked : sequence of number
        1 for a wheelset whose disc is held by its pads, 0 for one that rolls.
    rails : sequence of Rail
        Under each wheelset.
    irregularities : tuple of Irregularity, optional
        Of the track under each wheelset; none by default.
    resistance : number
        Running resistance and grade, backwards at the center of gravity of the first body [N].
    damping : number
        Of the spin, per wheel [N m s].
    linear : bool
        Whether suspension and inertia are expanded about rest.
    profile : WheelProfile, optional
        In place of the cone of the vehicle.
    """
    import casadi as ca

    n, starts = len(model.coordinates), first_coordinates(model)
    q, v = ca.SX.sym("q", n), ca.SX.sym("v", n)
    equations = mechanics(model, q, v, linear=linear, irregularities=irregularities, profile=profile)
    forward, spins = _apart(model)
    reference = maximum(v[forward], constants().slip_regularization_speed)
    force = equations.force
    force[forward] -= resistance
    for k in spins:
        force[k] -= _PER_AXLE * damping * v[k]
    touching = []
    for wheel in equations.wheels:
        one = wheel_on_rail(model, wheel, contact, rails[wheel.axle], reference)
        force[wheel.first : wheel.first + 6] += one.force
        touching.append(one)

    split = factors(equations.mass_matrix)
    free = split.solve(sparse(ca.sparsify(force)))
    columns = [
        split.solve(sparse(ca.sparsify(equations.brake_directions[:, axle])))
        for axle in range(model.wheelsets)
    ]
    transmitted = _transmitted(equations.brake_directions, columns, free, v, torques, locked)
    rates = free
    for column, torque in zip(columns, transmitted, strict=True):
        for k, value in column.items():
            rates[k] = rates[k] + value * torque

    referred = [starts[body.name] for body in model.bodies[1:] if not body.on]
    drift = ca.vertcat(*(v[k] - v[forward] if k in referred else v[k] for k in range(n) if k != forward))
    others = [rates[k] for k in range(n) if k != forward and k not in spins]
    pairs = [touching[_PER_AXLE * axle : _PER_AXLE * (axle + 1)] for axle in range(model.wheelsets)]
    motion = MultibodyMotion(
        acceleration=rates[forward],
        wheel_rates=tuple(rates[k] for k in spins),
        rest_rates=ca.vertcat(drift, *others),
        creep_forces=tuple(0.5 * (a.creep_force + b.creep_force) for a, b in pairs),
        slips=tuple(0.5 * (a.slip + b.slip) for a, b in pairs),
        wheel_loads=tuple(0.5 * (a.load + b.load) for a, b in pairs),
        transmitted=tuple(transmitted),
        wheel_loads_left=tuple(a.load for a, _ in pairs),
        wheel_loads_right=tuple(b.load for _, b in pairs),
        lateral=tuple(wheel.displacement for wheel in equations.wheels[::_PER_AXLE]),
        torsion=tuple(
            sum((gear_moment(model, gear, q, v) for gear in gears_of(model, name)), ca.SX(0))
            for name in model.wheelset_names
        ),
    )
    return _at_state(model, motion, (q, v), (speed, wheel_speeds, rest))


def _transmitted(
    directions: Any,
    columns: Sequence[Sparse],
    free: Sparse,
    v: Any,
    torques: Sequence[Number],
    locked: Sequence[Number],
) -> list[Number]:
    """Braking torques that act: those of the brakes, and of a lock what keeps its pads from sliding.

    Pads hang in a frame that moves: what a lock holds is the disc against its pads, not the spin. A wheelset that is
    held against the track drives the frame with torques that its motion does work on: the bogie swings ever more.
    """
    import casadi as ca

    axles = range(len(columns))
    rows = [sparse(ca.sparsify(directions[:, axle])) for axle in axles]
    matrix: list[Sparse] = [{} for _ in axles]
    right: list[Number] = []
    for i, row in enumerate(rows):
        for j, column in enumerate(columns):
            common = [k for k in row if k in column]
            if common:
                matrix[i][j] = locked[i] * sum(row[k] * column[k] for k in common)
        matrix[i][i] = matrix[i].get(i, 0.0) + (1.0 - locked[i])
        driven = sum(value * (free.get(k, 0.0) + v[k] / _SETTLING) for k, value in row.items())
        right.append((1.0 - locked[i]) * torques[i] - locked[i] * driven)
    for i in axles:  # Gauss; the pivots are positive, as the mass matrix is
        for j in range(i + 1, len(columns)):
            if i not in matrix[j]:
                continue
            factor = matrix[j].pop(i) / matrix[i][i]
            right[j] = right[j] - factor * right[i]
            for k in [k for k in matrix[i] if k > i]:
                matrix[j][k] = matrix[j].get(k, 0.0) - factor * matrix[i][k]
    for i in reversed(axles):
        known = sum(value * right[k] for k, value in matrix[i].items() if k > i)
        right[i] = (right[i] - known) / matrix[i][i]
    return right


class OnRail(NamedTuple):
    """One wheel that touches its rail."""

    force: Any  # 6, on the coordinates of the wheelset
    load: Number  # N
    creep_force: Number  # N
    slip: Number  # -


def wheel_on_rail(
    model: Multibody, wheel: Wheel, contact: WheelRail, rail: Rail, reference: Number
) -> OnRail:
    """Return what one wheel does on its rail; creepages are velocities over the reference speed [m/s]."""
    stiffness, at_rest = contact.normal_stiffness, model.preloads[model.wheel_names[_index(wheel)]]
    approach_at_rest = (at_rest / stiffness) ** (2.0 / 3.0)
    load = normal_force(approach_at_rest + wheel.approach, stiffness)
    longitudinal, lateral, spin = (each / reference for each in wheel.velocity)
    along, across = creep_forces(longitudinal, lateral, spin, reference, load, rail, contact)
    rows = wheel.velocity_rows
    force = -load * wheel.approach_row - along * rows[0] - across * rows[1]
    sideways = 0.5 * model.preloads[f"{model.wheelset_names[wheel.axle]}.sideways"]
    flange = 0.5 * flange_force(wheel.displacement, model.numbers["flange_clearance"], stiffness)
    force += (sideways - flange) * wheel.displacement_row
    return OnRail(force=force.T, load=load, creep_force=along, slip=longitudinal)


def _index(wheel: Wheel) -> int:
    return _PER_AXLE * wheel.axle + (wheel.side == "right")


def _apart(model: Multibody) -> tuple[int, tuple[int, ...]]:
    """Indices of the rates that are states of their own: speed, and wheel speeds."""
    starts = first_coordinates(model)
    return 0, tuple(starts[name] + _PITCH for name in model.wheelset_names)


def _at_state(
    model: Multibody, motion: MultibodyMotion, symbols: tuple[Any, Any], state: tuple[Any, Sequence[Any], Any]
) -> MultibodyMotion:
    """Put the states of the closed loop in place of coordinates and rates."""
    import casadi as ca

    forward, spins = _apart(model)
    speed, wheel_speeds, rest = state
    n, at = len(model.coordinates), 0
    q, v = ca.SX.zeros(n), ca.SX.zeros(n)
    for k in range(n):
        if k != forward:
            q[k], at = rest[at], at + 1
    v[forward] = speed
    for k in range(n):
        if k in spins:
            v[k] = wheel_speeds[spins.index(k)]
        elif k != forward:
            v[k], at = rest[at], at + 1
    flat = [ca.vertcat(*value) if isinstance(value, tuple) else ca.SX(value) for value in motion]
    placed = ca.cse(ca.substitute(flat, list(symbols), [q, v]))
    values: list[Any] = [
        tuple(ca.vertsplit(new)) if isinstance(old, tuple) else new
        for old, new in zip(motion, placed, strict=True)
    ]
    return MultibodyMotion(*values)


def rolling(model: Multibody, speed: float, wheel_speeds: Sequence[float]) -> tuple[float, ...]:
    """Return the rest of the state of a vehicle that rolls straight on, everything else at rest.

    Parameters
    ----------
    model : Multibody
        Its gears tell how fast rotors turn.
    speed : float
        Of all bodies [m/s].
    wheel_speeds : sequence of float
        Of the wheelsets [rad/s].
    """
    rates = dict.fromkeys(rest_names(model), 0.0)
    for body in model.bodies[1:]:
        if not body.on:
            rates[f"{body.name}.x'"] = speed
    for name, wheel_speed in zip(model.wheelset_names, wheel_speeds, strict=True):
        for gear in gears_of(model, name):
            rates[f"{gear.rotor}.turn'"] = -model.numbers[f"{gear.kind}.ratio"] * wheel_speed
    return tuple(rates.values())
