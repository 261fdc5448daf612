"""Inertia and forces of multibody vehicles against Lagrange's equations, and kinetic energy against moving matrices."""

import casadi as ca
import numpy as np
import pytest

from wspd_design.parameters.loading import constants
from wspd_design.plants.multibody.elements import act
from wspd_design.plants.multibody.inertia import inertia
from wspd_design.plants.multibody.kinematics import motions
from wspd_design.plants.multibody.loading import available_multibodies, load_multibody
from wspd_design.plants.multibody.mechanics import mechanics
from wspd_design.plants.multibody.preloads import balanced


@pytest.fixture(scope="module", params=available_multibodies())
def vehicle(request):
    return balanced(load_multibody(request.param))


@pytest.fixture(scope="module")
def symbols(vehicle):
    n = len(vehicle.coordinates)
    return ca.SX.sym("q", n), ca.SX.sym("v", n)


def drawn(count, seed, size=0.1):
    return size * np.random.default_rng(seed).standard_normal(count)


def values(expressions, inputs, at):
    function = ca.Function("f", inputs, [ca.densify(each) for each in expressions])
    results = function(*at)
    return [np.array(each) for each in (results if isinstance(results, (tuple, list)) else [results])]


def test_inertia_obeys_lagrange(vehicle, symbols):
    """M a - force = d/dt dT/dv - dT/dq at any place, velocity and acceleration; large turns included."""
    q, v = symbols
    a = ca.SX.sym("a", q.numel())
    mass_matrix, force, kinetic = inertia(vehicle, motions(vehicle, q, v), q, v)
    momentum = ca.gradient(kinetic, v)
    lagrange = ca.jtimes(momentum, q, v) + ca.jtimes(momentum, v, a) - ca.gradient(kinetic, q)
    state = [drawn(q.numel(), seed, 0.5) for seed in (1, 2, 3)]
    ours, theirs = values([ca.mtimes(mass_matrix, a) - force, lagrange], [q, v, a], state)
    assert np.abs(theirs).max() > 1e3
    np.testing.assert_allclose(ours, theirs, rtol=1e-9, atol=1e-7)


def test_forces_follow_from_energy_and_dissipation(vehicle, symbols):
    """Those of all springs, dampers, rods, stops, gears and weights, with preloads."""
    q, v = symbols
    bodies = motions(vehicle, q, v)
    forces = act(vehicle, bodies, q, v, constants().gravity)
    _, inertial, _ = inertia(vehicle, bodies, q, v)
    elements = mechanics(vehicle, q, v).force - inertial
    lagrange = -ca.gradient(forces.potential, q) - 0.5 * ca.gradient(forces.dissipation, v)
    state = [drawn(q.numel(), seed) for seed in (4, 5)]
    ours, theirs = values([elements, lagrange], [q, v], state)
    np.testing.assert_allclose(ours, theirs, rtol=1e-9, atol=1e-9 * np.abs(theirs).max())


def test_springs_push_nothing_but_each_other(vehicle, symbols):
    """Without weight all forces on the bodies cancel out, and a vehicle that moves as one feels none of them."""
    q, v = symbols
    forces = act(vehicle, motions(vehicle, q, v), q, v, 0.0)
    total = ca.vertcat(
        *(sum(force[k] for force, _ in forces.on_frames.values()) for k in range(3)),
    )
    (left,) = values([total], [q, v], [drawn(q.numel(), seed) for seed in (6, 7)])
    largest = max(abs(each) for each in vehicle.preloads.values())
    assert np.abs(left).max() < 1e-9 * largest


def rotation(axis, angle):
    """Rotation matrix about x, y or z, of a complex angle too."""
    c, s = np.cos(angle), np.sin(angle)
    i, j = [(1, 2), (2, 0), (0, 1)]["xyz".index(axis)]
    matrix = np.eye(3, dtype=complex)
    matrix[i, i], matrix[j, j], matrix[i, j], matrix[j, i] = c, c, -s, s
    return matrix


def places(model, q):
    """Position and rotation matrix of every body, spinning bodies turned for good, and of every pinion."""
    at, found, frames = dict(zip(model.coordinates, q, strict=True)), {}, {}
    for body in sorted(model.bodies, key=lambda each: bool(each.on)):
        rest = np.array(model.place(body.at), dtype=complex)
        if not body.on:
            x, y, z, roll, pitch, yaw = (at[name] for name in body.coordinates)
            level = rotation("z", yaw) @ rotation("x", roll)
            found[body.name] = rest + np.array([x, y, z]), level @ rotation("y", pitch)
            frames[body.name] = level if body.joint == "wheelset" else found[body.name][1]
        else:
            other = model.body(body.on)
            axis = np.array(model.place(body.axis or other.at))
            matrix = frames[other.name] @ rotation("y", at[f"{body.name}.turn"])
            hub = found[other.name][0] + frames[other.name] @ (axis - np.array(model.place(other.at)))
            found[body.name] = hub + matrix @ (rest - axis), matrix
            frames[body.name] = matrix
    pinions = {}
    for gear in model.gears:
        wheelset = model.body(gear.housing).on
        ratio = model.numbers[f"{gear.kind}.ratio"]
        turn = (1 + ratio) * at[f"{gear.housing}.turn"] - ratio * at[f"{wheelset}.pitch"]
        pinions[gear.name] = frames[wheelset] @ rotation("y", turn)
    return found, pinions


def turning(matrix):
    """Angular velocity in body axes of a rotation matrix whose imaginary part is its rate times 1e-30."""
    skew = matrix.real.T @ matrix.imag / 1e-30
    return np.array([skew[2, 1], skew[0, 2], skew[1, 0]])


def test_kinetic_energy_of_turning_matrices(vehicle, symbols):
    """Every body as a point and a matrix that really spins, moved by a complex step; pinions on the teeth of wheels."""
    q, v = symbols
    place, rate = drawn(q.numel(), 8, 0.4), drawn(q.numel(), 9, 3.0)
    found, pinions = places(vehicle, place + 1e-30j * rate)
    total = 0.0
    for body in vehicle.bodies:
        position, matrix = found[body.name]
        total += 0.5 * vehicle.mass(body) * np.sum((position.imag / 1e-30) ** 2)
        total += 0.5 * np.array(vehicle.inertia(body)) @ turning(matrix) ** 2
    for gear in vehicle.gears:
        moment = vehicle.numbers[f"{gear.kind}.pinion_inertia"]
        total += 0.5 * moment * turning(pinions[gear.name])[1] ** 2
    (ours,) = values([inertia(vehicle, motions(vehicle, q, v), q, v)[2]], [q, v], [place, rate])
    assert float(ours[0, 0]) == pytest.approx(total, rel=1e-12)
