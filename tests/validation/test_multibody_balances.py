"""Balances of multibody vehicles on their rails: power at any state, energy and momentum of a braked run.

What locomotive.md of the prototype calls V1, V3, V4, V6 and V11. No tolerance is fitted to our own results: energy and
momentum are exact, the weight transfer is that of a free-body diagram.
"""

import math
from dataclasses import replace

import casadi as ca
import numpy as np
import pytest
from multibody_runs import Vehicle, runge_kutta

from wspd_design.plants.multibody import mechanics as mechanics_module
from wspd_design.plants.multibody import wheels as wheels_module
from wspd_design.plants.multibody.loading import load_multibody
from wspd_design.plants.multibody.mechanics import mechanics
from wspd_design.plants.multibody.preloads import at_rest, balanced, force_at_rest

GRAVITY = 9.81
SPEED = 120 / 3.6
VEHICLES = {"er24pc-82": "er24pc", "manchester-1": "coach", "two-axle-wagon": "two-axle-wagon"}


@pytest.fixture(scope="module")
def locomotive():
    return Vehicle()


def power_gap(vehicle, seed=1):
    """Rate of the stored energy plus all power that leaves, at a state with yaw, roll and slip; and that power."""
    stored, *leaving, couples = vehicle.account()
    gap = ca.jtimes(stored, vehicle.state, vehicle.rates) + sum(leaving)
    function = ca.Function("gap", [vehicle.state, vehicle.torques, vehicle.locked], [gap, *leaving, couples])
    draw = np.random.default_rng(seed)
    state = vehicle.at_speed(20.0) * (1.0 + 0.03 * draw.standard_normal(vehicle.state.numel()))
    # Little of what would lift wheels from the rails, much of what yaws them.
    sizes = [
        5e-2 if name.endswith("'") else 1e-5 if name.endswith((".z", ".roll")) else 5e-4
        for name in vehicle.names
    ]
    state += np.array(sizes) * draw.standard_normal(state.size)
    torques = 1e4 * (1.0 + draw.random(vehicle.axles))
    gap, *powers, couples = (float(each) for each in function(state, torques, 0))
    return gap, powers, couples


@pytest.mark.parametrize("name", VEHICLES)
def test_power_balance_at_any_state(name):
    gap, powers, _ = power_gap(Vehicle(name, contact=VEHICLES[name]))
    assert min(abs(power) for power in powers) > 100.0
    assert abs(gap) < 1e-9 * max(abs(power) for power in powers)


def test_contact_point_that_does_not_turn_with_the_axle_is_seen(monkeypatch):
    """A normal force at a point in track axes does work on the spin of a yawed wheelset."""
    right = wheels_module._wheel

    def wrong(*arguments):
        wheel = right(*arguments)
        row = ca.SX(wheel.approach_row)
        row[4] += -(1.0 if wheel.side == "left" else -1.0) * 0.75 * ca.sin(wheel.yaw)
        return wheel._replace(approach_row=row)

    monkeypatch.setattr(wheels_module, "_wheel", wrong)
    gap, powers, _ = power_gap(Vehicle("two-axle-wagon", contact="two-axle-wagon"))
    assert abs(gap) > 1e-5 * max(abs(power) for power in powers)


def test_brake_without_the_force_on_its_caliper_is_seen(monkeypatch):
    """A pure couple on the axle leaves out the work of the caliper on the vertical motion between frame and axle."""

    def couple(model, brake, _, v):
        column = ca.SX.zeros(v.numel())
        column[mechanics_module.first_coordinates(model)[brake.wheelset] + 4] = -1.0
        return column

    vehicle = Vehicle("manchester-1", contact="coach")
    gap, powers, couples = power_gap(vehicle)
    assert abs(powers[0] - couples) > 1e-5 * abs(powers[0])  # what the force does beyond the couple
    with monkeypatch.context() as planted:
        planted.setattr(mechanics_module, "_brake_direction", couple)
        wrong = Vehicle("manchester-1", contact="coach")
    symbols = [[each.state, each.torques, each.locked] for each in (wrong, vehicle)]
    (vehicle.rates,) = ca.substitute([wrong.rates], *symbols)
    missing, _, _ = power_gap(vehicle)
    assert abs(missing) > 1e3 * abs(gap)


def test_mass_coordinates_and_wheel_loads_of_the_locomotive(locomotive):
    """V1: 76 841 kg, 82 coordinates, exact equilibrium; 95.20 and 93.26 kN, a gearbox is on the left."""
    model = locomotive.model
    assert sum(model.mass(body) for body in model.bodies) == 76841.0
    assert model.mass(model.bodies[0]) == 48841.0
    assert len(model.coordinates) == 82
    loads = np.array([model.preloads[name] for name in model.wheel_names]).reshape(4, 2)
    np.testing.assert_allclose(loads, [[95.20e3, 93.26e3]] * 4, rtol=1e-4)
    assert loads.sum() / GRAVITY == pytest.approx(76841.0, abs=1e-6)
    left_over = 330 * GRAVITY * 0.45 / 1.5  # weight of a gearbox beside the middle, about the rails
    np.testing.assert_allclose(loads[:, 0] - loads[:, 1], 2 * left_over, rtol=1e-9)
    pull, load = at_rest(model)
    assert np.abs(pull + load @ np.array(list(model.preloads.values()))).max() < 1e-9


@pytest.fixture(scope="module")
def braked(locomotive):
    """2 s at 30 kN m per axle from 120 km/h on the dry rail, with the integrals of all powers."""
    stored, *powers = locomotive.account()
    states, work, _ = runge_kutta(
        locomotive,
        lambda _: ca.SX.ones(4) * 30e3,
        speed=SPEED,
        duration=2.0,
        step=6.25e-4,
        integrals=powers,
    )
    energy = ca.Function("e", [locomotive.state], [stored])
    lost = float(energy(locomotive.at_speed(SPEED))) - float(energy(states[:, -1]))
    return states, lost, work[:, -1]


def test_energy_of_a_braked_run_closes(braked):
    """V3: within 1e-7 of what is dissipated, 13.4 MJ."""
    _, lost, (brakes, creepage, dampers, couples) = braked
    assert lost == pytest.approx(13.423e6, rel=1e-3)  # of the prototype
    assert abs(lost - brakes - creepage - dampers) < 1e-7 * lost
    assert abs(lost - couples - creepage - dampers) > 1e-4 * lost  # without the forces on the calipers


def test_torque_and_momentum_of_a_braked_run(braked, locomotive):
    """V4: the impulse of all torques is R times that of the train and J_eff times the change of the wheel speeds."""
    states, *_ = braked
    start, end = locomotive.at_speed(SPEED), states[:, -1]
    impulse = 76841.0 * (start[0] - end[0]) * 0.55 + 662.637 * (start[1:5] - end[1:5]).sum()
    assert impulse == pytest.approx(4 * 30e3 * 2.0, rel=1e-3)
    without_rotors = impulse - (662.637 - 300.0) * (start[1:5] - end[1:5]).sum()
    assert abs(without_rotors / (4 * 30e3 * 2.0) - 1.0) > 1e-2


def couple_of(brake):
    """The same brake with as many calipers on the other side of the axle."""
    lever = brake.levers[0]
    return replace(brake, levers=(lever, tuple(replace(term, factor=-term.factor) for term in lever)))


@pytest.mark.parametrize("calipers", ["as in the file", "on both sides"])
def test_weight_transfer(locomotive, calipers):
    """V6: moment and table 4.2 of the prototype, and the free-body diagram, at 0.85 m/s2 with axle 1 in front.

    Calipers on one side of the axles pitch the frames, and loaded springs that tilt with them move some of the load
    from axle to axle; the moment stays. The table is that of frames that calipers do not pitch.
    """
    model = locomotive.model
    if calipers == "on both sides":
        model = replace(model, brakes=tuple(couple_of(brake) for brake in model.brakes))
    vehicle = Vehicle(model=model, linear=True)

    def torque(t):
        """Rise from 0.5 s on within 2 s, so softly that nothing rings."""
        u = ca.fmin(ca.fmax((t - 0.5) / 2.0, 0.0), 1.0)
        return ca.SX.ones(4) * 10e3 * (10 * u**3 - 15 * u**4 + 6 * u**5)

    _, _, outputs = runge_kutta(
        vehicle,
        torque,
        speed=SPEED,
        duration=5.0,
        step=1.25e-3,
        outputs=[vehicle.motion.acceleration, *vehicle.motion.wheel_loads],
    )
    loads = 2.0 * outputs[1:]
    moved = loads[:, -1000:].mean(axis=1) - loads[:, 360:400].mean(axis=1)
    deceleration = -outputs[0, -1000:].mean()
    assert deceleration == pytest.approx(0.85, abs=1e-3)
    assert moved.sum() == pytest.approx(0.0, abs=50.0)  # of 754 kN
    formula = transfer(model, deceleration)
    places = np.array([5.181 + 1.35, 5.181 - 1.35, -5.181 + 1.35, -5.181 - 1.35])
    # By the compliance of rods and bushes the center of gravity moves forward, by 1.83 kN m at 0.85 m/s2.
    moment = formula @ places + 1.83e3 * deceleration / 0.85
    assert moved @ places == pytest.approx(moment, rel=5e-3)
    assert moved @ places == pytest.approx(96.14e3, rel=5e-3)  # of the prototype
    table = [9.67e3, -3.96e3, 3.96e3, -9.68e3]
    tolerance = 0.02 if calipers == "on both sides" else 0.05
    np.testing.assert_allclose(moved, table, atol=tolerance * 9.67e3)
    assert (calipers == "on both sides") == (np.abs(moved - table).max() < 0.02 * 9.67e3)


def transfer(model, deceleration):
    """Change of the axle loads by the free-body diagram of body and bogies, from the front."""
    n, names = model.numbers, model.coordinates
    assert "rotor_1.turn" in names
    body = model.mass(model.bodies[0]) * deceleration
    spacing, base, rod = n["bogie_spacing"], n["wheelbase"], n["traction_rod.height"]
    lifted = body * (n["car_body.height"] - rod) / spacing
    # With each bogie: half of the pull of the body at its rod, its own parts, and what turns, rotors backwards.
    parts = [each for each in model.bodies[1:] if model.place(each.at)[0] > 0.0]
    turning = 300.0 - n["drive.ratio"] * (14.0 + 0.8)
    moment = (
        0.5 * body * rod + sum(model.mass(each) * model.place(each.at)[2] for each in parts) * deceleration
    )
    moment += 2.0 * turning * deceleration / n["wheel_radius"]
    return np.array([sign * lifted / 2 + way * moment / base for sign in (1, -1) for way in (1, -1)])


def test_weight_transfer_formula_is_that_of_the_table(locomotive):
    formula = transfer(locomotive.model, 0.85)
    np.testing.assert_allclose(formula, [9.54e3, -3.93e3, 3.93e3, -9.54e3], atol=10.0)


def frequencies(model, stiffness):
    """Own frequencies without dampers on springs below the wheels [Hz], and their shapes."""
    n = len(model.coordinates)
    q, v = ca.SX.sym("q", n), ca.SX.sym("v", n)
    parts = mechanics(model, q, v)
    force = parts.force
    for wheel in parts.wheels:
        own = slice(wheel.first, wheel.first + 6)
        force[own] += force_at_rest(model, wheel) - stiffness * wheel.approach * wheel.approach_row.T
    function = ca.Function("k", [q, v], [parts.mass_matrix, -ca.jacobian(force, q)])
    mass_matrix, stiff = (np.array(ca.DM(each)) for each in function(0, 0))
    squares, shapes = np.linalg.eig(np.linalg.solve(mass_matrix, stiff))
    return np.sqrt(np.abs(squares)) / (2 * math.pi), shapes.real


def pair(mass, below, spring, spring_below):
    """Frequencies of a mass on a spring on a mass on a spring [Hz]."""
    matrix = np.array([[spring / mass, -spring / mass], [-spring / below, (spring + spring_below) / below]])
    return np.sqrt(np.sort(np.linalg.eigvals(matrix).real)) / (2 * math.pi)


def test_own_modes_of_manchester_vehicle_1():
    """V11: bounce and pitch against two masses on two springs, 1 %; 1.074, 1.293 and 7.47 Hz of the prototype."""
    found, shapes = frequencies(balanced(load_multibody("manchester-1")), 1.4e9)
    names = load_multibody("manchester-1").coordinates

    def nearest(coordinate, frequency):
        """Frequency of the mode in which a coordinate moves most, next to an expected one."""
        row = np.abs(shapes[names.index(coordinate)]) / np.abs(shapes).max(axis=0)
        likely = found[row > 0.5 * row.max()]
        return likely[np.abs(likely - frequency).argmin()]

    low, high = pair(32000.0, 2 * 2615.0, 4 * 0.43e6, 8 * 1.22e6)
    assert nearest("car_body.z", low) == pytest.approx(low, rel=1e-2)
    assert nearest("bogie_frame_1.z", high) == pytest.approx(high, rel=1e-2)
    assert (low, high) == (pytest.approx(1.074, abs=2e-3), pytest.approx(7.47, abs=2e-2))
    # Pitch turns all springs by their arms of 9.5 m; the bogies follow by their mass at that arm.
    pitch, _ = pair(1.97e6, 2 * 2615.0 * 9.5**2, 4 * 0.43e6 * 9.5**2, 8 * 1.22e6 * 9.5**2)
    assert nearest("car_body.pitch", pitch) == pytest.approx(pitch, rel=1e-2)
    assert nearest("car_body.pitch", pitch) == pytest.approx(1.293, abs=2e-3)
