"""Equations of motion of multibody vehicles: rest, mass, and the two versions of one source."""

import casadi as ca
import numpy as np
import pytest

from wspd_design.plants.multibody.loading import available_multibodies, load_multibody
from wspd_design.plants.multibody.mechanics import mechanics
from wspd_design.plants.multibody.preloads import at_rest, balanced, force_at_rest

GRAVITY = 9.81


@pytest.fixture(scope="module", params=available_multibodies())
def vehicle(request):
    return balanced(load_multibody(request.param))


@pytest.fixture(scope="module")
def symbols(vehicle):
    n = len(vehicle.coordinates)
    return ca.SX.sym("q", n), ca.SX.sym("v", n)


@pytest.fixture(scope="module")
def both(vehicle, symbols):
    """Exact and linear version."""
    return tuple(mechanics(vehicle, *symbols, linear=linear) for linear in (False, True))


def test_rest_is_an_exact_equilibrium(vehicle, symbols, both):
    for version in both:
        force = ca.SX(version.force)
        for wheel in version.wheels:
            force[wheel.first : wheel.first + 6] += force_at_rest(vehicle, wheel)
        left = np.array(ca.Function("f", [*symbols], [force])(0, 0))
        assert np.abs(left).max() < 1e-9


def test_wheels_carry_the_weight(vehicle):
    loads = [vehicle.preloads[name] for name in vehicle.wheel_names]
    assert sum(loads) / GRAVITY == pytest.approx(vehicle.numbers["mass"], rel=1e-12)
    assert min(loads) > 0.0


def test_preloads_have_the_least_sum_of_squares(vehicle):
    """No part of them lies in what moves nothing."""
    _, load = at_rest(vehicle)
    forces = np.array([vehicle.preloads[name] for name in vehicle.preload_names])
    _, values, rows = np.linalg.svd(load)
    rank = int((values > 1e-9 * values[0]).sum())
    assert np.abs(rows[rank:] @ forces).max() < 1e-6


def test_mass_matrix_is_symmetric_and_positive(symbols, both):
    function = ca.Function("m", [*symbols], [both[0].mass_matrix])
    state = 0.02 * np.random.default_rng(1).standard_normal(symbols[0].numel())
    matrix = np.array(ca.DM(function(state, 0)))
    assert np.abs(matrix - matrix.T).max() < 1e-9
    assert np.linalg.eigvalsh(matrix).min() > 0.0


def test_linear_version_is_the_first_order_of_the_exact_one(vehicle, symbols, both):
    """With wheelsets and rotors at speed the difference falls with the square of the other motion."""
    n = symbols[0].numel()
    functions = [ca.Function("f", [*symbols], [each.force]) for each in both]
    draw = np.random.default_rng(2)
    place, rate = 1e-2 * draw.standard_normal(n), 1e-1 * draw.standard_normal(n)
    spins = np.zeros(n)
    for k, name in enumerate(vehicle.coordinates):
        body = vehicle.body(name.rpartition(".")[0])
        if (body.joint, name.rpartition(".")[2]) in (("wheelset", "pitch"), ("rotor", "turn")):
            spins[k], rate[k], place[k] = 50.0 * draw.standard_normal(), 0.0, 0.0
    differences = []
    for size in (1.0, 0.1):
        exact, linear = (np.array(each(size * place, spins + size * rate)) for each in functions)
        differences.append(np.abs(exact - linear).max())
    assert differences[1] < 0.02 * differences[0]


def test_linear_version_is_constant_but_for_what_spins(symbols, both):
    _, linear = both
    assert not ca.symvar(linear.mass_matrix)
    assert not ca.symvar(linear.brake_directions)
    assert ca.jacobian(linear.force, symbols[0]).is_constant()
