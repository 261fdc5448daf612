"""Hoisted kernels mean the same as the functions they are made of."""

import casadi as ca
import numpy as np
import pytest

from wspd_design.codegen.hoisting import hoist
from wspd_design.codegen.kernels import plant_kernels
from wspd_design.codegen.plant_numbers import PARAMETERS, Surroundings, parameter_values
from wspd_design.model import adhesion
from wspd_design.parameters.loading import load_rail
from wspd_design.plants.planar import Planar


def operations(function):
    return [function.instruction_id(k) for k in range(function.n_instructions())]


def evaluated(function, *inputs):
    results = function(*inputs)
    return [np.array(x).ravel() for x in (results if isinstance(results, tuple) else (results,))]


RNG = np.random.default_rng(11)
FRACTIONS = {
    "divided by a parameter": lambda p, x: x[0] / p[0] + p[1] / (p[0] * p[2]),
    "chain": lambda p, x: x[0] / x[1] / (p[0] + x[2]) * p[1],
    "by a fraction": lambda p, x: p[0] * x[0] / (x[1] / x[2]),
    "square below": lambda p, x: (p[0] * x[0] / x[1]) / ((p[2] * x[0] / x[1]) ** 2 + 1.0),
    "angle": lambda p, x: ca.atan(p[1] * (x[0] / x[1])),
    "value and square": lambda p, x: x[0] / x[1] + (x[0] / x[1]) ** 2 - p[0],
    "only parameters": lambda p, x: p[0] / p[1] + ca.exp(p[2]),  # noqa: ARG005
    "difference": lambda p, x: p[0] - x[0] / x[1],
}


@pytest.mark.parametrize("name", FRACTIONS)
def test_rewritten_fractions(name):
    p, x = ca.SX.sym("p", 3), ca.SX.sym("x", 3)
    function = ca.Function("f", [p, x], [FRACTIONS[name](p, x)])
    constants, (kernel,) = hoist([function], 1, "constants")
    for _ in range(20):
        a, b = RNG.uniform(0.1, 3.0, (2, 3))
        (expected,), (got,) = evaluated(function, a, b), evaluated(kernel, constants(a), b)
        np.testing.assert_allclose(got, expected, rtol=2e-14)


def test_only_what_moves_is_left():
    p, x = ca.SX.sym("p", 2), ca.SX.sym("x")
    function = ca.Function("f", [p, x], [ca.exp(p[0]) * x / (p[0] + p[1])])
    constants, (kernel,) = hoist([function], 1, "constants")
    assert ca.OP_EXP in operations(constants)
    assert operations(kernel).count(ca.OP_MUL) == 2
    assert not {ca.OP_DIV, ca.OP_EXP, ca.OP_ADD} & set(operations(kernel))


def test_the_creep_force_divides_three_times(er24pc):
    kernels = plant_kernels(Planar(er24pc), disturbed=False)
    # slip, area of adhesion, and angle
    assert (
        operations(kernels.split.axle).count(ca.OP_DIV) + operations(kernels.split.axle).count(ca.OP_ATAN2)
        == 3
    )
    assert ca.OP_DIV not in operations(kernels.split.train)
    assert ca.OP_DIV not in operations(kernels.actuator)


@pytest.mark.parametrize("rail_name", ["polach-dry", "polach-wet", "table10-dry"])
def test_the_axle_kernel_is_the_model(er24pc, rail_name):
    rail = load_rail(rail_name)
    kernels = plant_kernels(Planar(er24pc), disturbed=False)
    values = parameter_values(er24pc, rail, Surroundings())
    assert len(values) == len(PARAMETERS)
    constants = kernels.lane_constants(values)
    for _ in range(50):
        speed, share, load = RNG.uniform(0.01, 40.0), RNG.uniform(-0.02, 1.0), RNG.uniform(4e4, 1.5e5)
        wheel = (1.0 - share) * speed / er24pc.wheel_radius
        (contact,) = evaluated(
            kernels.split.contact, constants, load * RNG.uniform(0.98, 1.02)
        )  # a step began there
        stiffness = adhesion.contact_stiffness(er24pc.contact, load)
        force, rolling, slip, damping, passed, given, dynamic = (
            float(x[0])
            for x in evaluated(kernels.split.axle, constants, speed, wheel, load, 2e4, 1.0, 0.0, contact, 0.2)
        )
        referred = (speed - er24pc.wheel_radius * wheel) / max(speed, 0.1)
        expected = adhesion.creep_force(
            referred, abs(speed - er24pc.wheel_radius * wheel), load, rail, stiffness
        )
        assert force == pytest.approx(expected, rel=1e-9, abs=1e-6)
        assert slip == pytest.approx(referred, rel=1e-12, abs=1e-15)
        balance = (er24pc.wheel_radius * force - 1e4 - damping) / er24pc.wheel_inertia
        assert rolling == pytest.approx(balance, rel=1e-9, abs=1e-9)
        assert (passed, given, dynamic) == (2e4, 2e4, 0.0)  # there is no electrodynamic brake
        locked = evaluated(kernels.split.axle, constants, speed, wheel, load, 2e4, 1.0, 1.0, contact, 0.2)
        assert float(locked[1][0]) == 0.0
        assert float(locked[4][0]) == pytest.approx(2.0 * er24pc.wheel_radius * force, rel=1e-12, abs=1e-6)
