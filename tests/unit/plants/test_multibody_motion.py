"""The motion of a multibody vehicle on its rails: order of the state, locks, parameters at run time."""

import casadi as ca
import numpy as np
import pytest

from wspd_design.model.wheel_rail import wheel_rail
from wspd_design.parameters.loading import load_rail, load_vehicle
from wspd_design.plants.multibody.factoring import factors, sparse
from wspd_design.plants.multibody.loading import load_multibody
from wspd_design.plants.multibody.mechanics import mechanics
from wspd_design.plants.multibody.motion import rest_names, rolling, vehicle_motion
from wspd_design.plants.multibody.preloads import balanced
from wspd_design.plants.multibody.wheels import Irregularity

CONTACT = wheel_rail(load_vehicle("two-axle-wagon").contact, poisson=0.25)
RAIL = load_rail("polach-dry")


@pytest.fixture(scope="module")
def wagon():
    return balanced(load_multibody("two-axle-wagon"))


def built(model, contact=CONTACT, parameters=None, track=None, **options):
    """Rates, transmitted torques, slips, forces and loads as a function of the state, torques and locks."""
    axles, rest = model.wheelsets, rest_names(model)
    x = ca.SX.sym("x", 1 + axles + len(rest))
    torques, locked = ca.SX.sym("t", axles), ca.SX.sym("l", axles)
    motion = vehicle_motion(
        model,
        contact,
        speed=x[0],
        wheel_speeds=ca.vertsplit(x[1 : 1 + axles]),
        rest=x[1 + axles :],
        torques=ca.vertsplit(torques),
        locked=ca.vertsplit(locked),
        rails=[RAIL] * axles,
        irregularities=track,
        **options,
    )
    outputs = [
        motion.acceleration,
        ca.vertcat(*motion.wheel_rates),
        ca.densify(motion.rest_rates),
        *(ca.vertcat(*each) for each in (motion.transmitted, motion.slips, motion.creep_forces)),
        *(ca.vertcat(*each) for each in (motion.wheel_loads, motion.wheel_loads_left)),
    ]
    inputs = [x, torques, locked] if parameters is None else [x, torques, locked, parameters]
    function = ca.Function("motion", inputs, outputs)
    return lambda *at: [np.array(each).ravel() for each in function(*at)]


def at_speed(model, speed, slip=0.0):
    wheel_speeds = ((1.0 - slip) * speed / model.numbers["wheel_radius"],) * model.wheelsets
    return np.array([speed, *wheel_speeds, *rolling(model, speed, wheel_speeds)])


def disturbed(model):
    draw = np.random.default_rng(3)
    state = at_speed(model, 15.0, 0.01)
    return state + 1e-5 * draw.standard_normal(state.size)


def test_state_is_all_but_the_forward_place():
    model = balanced(load_multibody("er24pc-82"))
    names = rest_names(model)
    assert len(names) == 81 + 77
    assert "car_body.x" not in names
    assert "wheelset_1.pitch" in names
    assert "wheelset_1.pitch'" not in names
    assert dict(zip(names, rolling(model, 20.0, (40.0,) * 4), strict=True))["rotor_2.turn'"] == -4.95 * 40.0


def test_straight_rolling_needs_no_force(wagon):
    acceleration, wheel_rates, rates, _, slips, forces, loads, _ = built(wagon)(at_speed(wagon, 20.0), 0, 0)
    assert acceleration == pytest.approx(0.0, abs=1e-9)
    assert np.abs(slips).max() < 1e-12
    assert np.abs(forces).max() < 1e-6
    assert loads.sum() * 2 == pytest.approx(13000 * 9.81)
    bodies = {name for name in rest_names(wagon) if name.endswith(".x")}
    drift = dict(zip(rest_names(wagon), rates, strict=True))
    assert [drift[name] for name in bodies] == pytest.approx([0.0] * len(bodies))
    assert np.abs(wheel_rates).max() < 1e-9


def test_a_lock_holds_the_disc_against_its_pads_and_tells_the_torque(wagon):
    motion, state = built(wagon), disturbed(wagon)
    torques = np.array([3e3, 4e3])
    _, rates, rest, transmitted, *_ = motion(state, torques, [1, 0])
    assert transmitted[1] == torques[1]
    # The torque that it tells, put on a free wheelset, just holds it.
    free = motion(state, transmitted, 0)
    np.testing.assert_allclose(free[1], rates, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(free[2], rest, rtol=1e-9, atol=1e-7)


@pytest.mark.parametrize("locks", [[1, 0], [1, 1]])
def test_what_still_slides_at_a_locked_pad_comes_to_rest(wagon, locks):
    """The power of a brake is its torque times the sliding of its pads, whose rate is that sliding over 5 ms."""
    n, axles = len(wagon.coordinates), wagon.wheelsets
    q, v = ca.SX.sym("q", n), ca.SX.sym("v", n)
    along_pads = ca.Function("pads", [q, v], [mechanics(wagon, q, v).brake_directions.T @ v])
    state = disturbed(wagon)
    state[-20:] += 0.01  # m/s and rad/s
    acceleration, wheel_rates, rest_rates, *_ = built(wagon)(state, 0, locks)
    place = np.array([0.0, *state[1 + axles :][: n - 1]])
    slides, changes = (
        np.array(along_pads(place, full_velocity(wagon, *each))).ravel()
        for each in (
            (state[0], state[1 : 1 + axles], state[1 + axles :][n - 1 :]),
            (acceleration, wheel_rates, rest_rates[n - 1 :]),
        )
    )
    for axle in range(axles):
        if locks[axle]:
            assert changes[axle] == pytest.approx(-slides[axle] / 5e-3, rel=1e-9)
        else:
            assert changes[axle] != pytest.approx(-slides[axle] / 5e-3, rel=1e-3)


def full_velocity(model, forward, wheels, others):
    """Return the rates of all coordinates from those of the state."""
    known = dict(zip((name for name in rest_names(model) if name.endswith("'")), others, strict=True))
    known |= {f"{name}.pitch'": wheel for name, wheel in zip(model.wheelset_names, wheels, strict=True)}
    known[f"{model.coordinates[0]}'"] = np.ravel(forward)[0]
    return np.array([known[f"{name}'"] for name in model.coordinates])


def test_resistance_slows_and_damping_acts_on_both_wheels(wagon):
    state = disturbed(wagon)
    plain = built(wagon)(state, 0, 0)
    resisted = built(wagon, resistance=960.0)(state, 0, 0)
    assert (plain[0] - resisted[0]) * 9600.0 == pytest.approx(960.0)
    damped = built(wagon, damping=5.0)(state, 0, 0)
    assert (plain[1] - damped[1]) * 125.0 == pytest.approx(2 * 5.0 * state[1:3], rel=1e-3)


def test_a_raised_track_raises_the_loads(wagon):
    state = at_speed(wagon, 20.0)
    none, raised, crossed = (
        built(wagon, track=(irregularity,) * 2)(state, 0, 0)
        for irregularity in (Irregularity(), Irregularity(vertical=1e-5), Irregularity(cross_level=1e-5))
    )
    stiffness = 1.5 * CONTACT.normal_stiffness ** (2 / 3) * none[6] ** (1 / 3)
    assert raised[6] - none[6] == pytest.approx(stiffness * 1e-5, rel=0.1)
    assert crossed[7] - none[7] == pytest.approx(stiffness * 0.75e-5, rel=0.1)
    assert crossed[6] == pytest.approx(none[6], rel=1e-2)


def test_parameters_at_run_time_are_those_of_the_file(wagon):
    symbols = ca.SX.sym("p", len(wagon.parameters))
    motion = built(wagon.with_parameters(ca.vertsplit(symbols)), parameters=symbols)
    heavier = balanced(wagon.with_numbers({"mass": 15000.0, "suspension.stiffness_z": 3e5}))
    for model in (wagon, heavier):
        state = disturbed(model)
        ours = motion(state, [2e3, 0], [0, 0], np.array(model.parameters))
        for a, b in zip(ours, built(model)(state, [2e3, 0], [0, 0]), strict=True):
            np.testing.assert_allclose(a, b, rtol=1e-8, atol=1e-7)


def test_linear_version_rolls_like_the_exact_one(wagon):
    state = disturbed(wagon)
    exact, linear = (built(wagon, linear=each)(state, [2e3, 1e3], 0) for each in (False, True))
    assert linear[0] == pytest.approx(exact[0], rel=1e-4)
    assert linear[1] == pytest.approx(exact[1], rel=1e-4)


def test_factors_solve_what_numpy_solves():
    draw = np.random.default_rng(4)
    dense = draw.standard_normal((7, 7)) * (draw.random((7, 7)) < 0.3)
    dense = dense @ dense.T + 7 * np.eye(7)
    right = draw.standard_normal(7)
    split = factors(ca.sparsify(ca.SX(dense)))
    solution = split.solve(sparse(ca.SX(right)))
    np.testing.assert_allclose(
        [float(solution[k]) for k in range(7)], np.linalg.solve(dense, right), rtol=1e-12
    )
