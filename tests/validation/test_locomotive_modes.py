"""Modes, critical speeds and slip poles of the locomotive against the prototype, formulas and simulation.

The prototype of `locomotive.md` (sections 4.1, 4.3 and 6) was another program for the same topology. Where a motor
hangs on its mounts is not written there, so modes in which motors take part agree less. Its preloaded springs acted on
two bodies at two points and so had a moment that no body answered: sway, yaw and hunting of the car body differ by it.
"""

import math
from dataclasses import replace

import casadi as ca
import numpy as np
import pytest
from independent_multibody import GroundSprings, SmallVibrations

from wspd_design.analysis.critical_speed import critical_speed
from wspd_design.analysis.modes import modes, poles
from wspd_design.analysis.running import contact_of, full_slope, running_vehicle, steady
from wspd_design.analysis.state_space import linearization
from wspd_design.model.adhesion import contact_stiffness, creep_force_slip_derivative
from wspd_design.parameters.loading import load_rail
from wspd_design.plants.multibody.loading import load_multibody
from wspd_design.plants.multibody.motion import rest_names, vehicle_motion
from wspd_design.plants.multibody.records import effective_inertia
from wspd_design.plants.multibody.wheels import Irregularity

DRY, WET = load_rail("polach-dry"), load_rail("polach-wet")
KALKER = full_slope(DRY)


@pytest.fixture(scope="module")
def model():
    return load_multibody("er24pc-82")


@pytest.fixture(scope="module")
def vehicle(model):
    return running_vehicle(model, contact_of(model), KALKER)


@pytest.fixture(scope="module")
def dry(model):
    return running_vehicle(model, contact_of(model), DRY)


@pytest.fixture(scope="module")
def wet(model):
    return running_vehicle(model, contact_of(model), WET)


@pytest.fixture(scope="module")
def rolling(vehicle):
    return modes(steady(vehicle, 20.0).motion)


def named(found, name):
    """Natural frequencies [Hz] of the modes whose names begin like this."""
    return [mode.natural_frequency for mode in found if mode.name.startswith(name)]


def test_71_modes_oscillate_and_none_grows(rolling):
    assert sum(mode.oscillates for mode in rolling) == 71
    assert not any(mode.unstable for mode in rolling)


@pytest.mark.parametrize(
    ("name", "least", "most", "tolerance"),
    [
        ("car body bounce", 1.100, 1.100, 2e-3),
        ("car body pitch", 1.163, 1.163, 5e-3),
        ("bogie frames bounce", 3.78, 3.78, 6e-3),
        ("bogie frames roll", 8.1, 8.1, 2e-2),
        ("driveline", 10.8, 11.1, 5e-3),
        ("bogie frames yaw", 25.5, 25.5, 1e-2),
        ("axle boxes turn", 26.0, 27.0, 6e-2),
        ("bogie frames surge", 31.0, 32.0, 2e-2),
        ("gearboxes turn", 64.0, 64.0, 3e-3),
        ("wheelsets roll", 144.0, 144.0, 5e-3),
        ("wheelsets bounce", 167.0, 167.0, 2e-3),
        ("bogie frames pitch", 5.6, 5.7, 6e-2),  # with the motors
    ],
)
def test_natural_frequencies_are_those_of_the_prototype(rolling, name, least, most, tolerance):
    found = named(rolling, name)
    assert found
    assert min(found) >= least * (1.0 - tolerance)
    assert max(found) <= most * (1.0 + tolerance)


def test_damping_of_bounce_and_pitch_is_that_of_the_prototype(rolling):
    damping = {mode.name: mode.damping for mode in rolling}
    assert damping["car body bounce"] == pytest.approx(0.146, abs=1e-3)
    assert damping["car body pitch"] == pytest.approx(0.16, abs=5e-3)


def test_bounce_is_that_of_springs_in_series(model, rolling):
    numbers = model.numbers
    secondary, primary = 4.0 * numbers["secondary.stiffness_z"], 8.0 * numbers["primary.stiffness_z"]
    series = 1.0 / (1.0 / secondary + 1.0 / primary)
    by_hand = math.sqrt(series / model.mass(model.body("car_body"))) / (2.0 * math.pi)
    assert by_hand == pytest.approx(1.108, abs=5e-4)
    assert named(rolling, "car body bounce")[0] == pytest.approx(by_hand, rel=1e-2)


def as_prototype(motion, model):
    """The same small motion with preloads that do not tilt and act at two points, a pair with a moment."""
    tilting = SmallVibrations(model, GroundSprings((0.0,) * 3, 0.0)).tilting()
    return replace(motion, stiffness=motion.stiffness - tilting)


def test_sway_and_yaw_of_the_prototype_had_preloads_whose_pair_turned_the_vehicle(model, vehicle):
    motion = steady(vehicle, 20.0).motion
    theirs = modes(as_prototype(motion, model))
    sways = named(theirs, "car body lower sway") + named(theirs, "car body lateral")
    assert max(sways) == pytest.approx(0.49, abs=5e-3)
    assert named(theirs, "car body yaw") == [pytest.approx(0.70, abs=5e-3)]
    assert named(theirs, "car body upper sway") == [pytest.approx(1.04, abs=5e-3)]
    assert named(modes(motion), "car body upper sway")[0] > 1.06


@pytest.mark.parametrize(
    ("conicity", "speed", "tolerance"),
    [(0.025, 63.8, 0.03), (0.05, 81.2, 0.03), (0.2, 73.8, 0.05), (0.4, 65.9, 0.10)],
)
def test_critical_speeds_are_near_those_of_the_prototype(vehicle, conicity, speed, tolerance):
    on_cone = vehicle if conicity == 0.025 else vehicle.with_conicity(conicity)
    found = critical_speed(on_cone, speeds=(50.0, 90.0))
    assert found.speed == pytest.approx(speed, rel=tolerance)
    assert 1.0 < found.mode.frequency < 5.0


def test_traction_factors_on_lateral_creep_make_the_car_body_grow_at_low_speed(model):
    """Polach's wet factors, fitted to traction, on lateral creep too: +0.34 1/s at 33 m/s (0.338 to 0.366)."""
    reduced = running_vehicle(model, contact_of(model, lateral_slope=0.2), WET)
    motion = steady(reduced, 33.0).motion
    theirs, ours = poles(as_prototype(motion, model))[0], poles(motion)[0]
    assert theirs.real == pytest.approx(0.35, abs=0.02)
    assert ours.real > 0.2
    assert 0.4 < abs(ours.imag) / (2.0 * math.pi) < 0.52
    assert critical_speed(reduced, speeds=(15.0, 30.0)).speed == pytest.approx(20.0, abs=3.0)


@pytest.mark.parametrize(("slope", "speed"), [(1.0, 94.0), (0.5, 58.0), (0.2, 26.0)])
def test_critical_speeds_of_manchester_vehicle_1_fall_with_the_slope_of_creep(slope, speed):
    """V11, conicity 0.1: the prototype's, on guessed dampers; no published ones were at hand."""
    coach = load_multibody("manchester-1").with_numbers({"conicity": 0.1})
    rail = replace(KALKER, adhesion_reduction=slope, slip_reduction=slope)
    vehicle = running_vehicle(coach, contact_of(coach, lateral_slope=slope), rail)
    assert critical_speed(vehicle, speeds=(15.0, 110.0)).speed == pytest.approx(speed, rel=0.1)


def at_rest_loads(vehicle, speed, slip):
    """Small motion about a slip with the loads of rest, as the prototype had it: no force has moved anything."""
    forward, *turning = vehicle.neutral.values()
    axles = len(turning)
    rates = forward * speed + sum(turning) * (1.0 - slip) * speed / vehicle.model.numbers["wheel_radius"]
    still = np.zeros(len(forward))
    preloads = [vehicle.model.preloads[name] for name in vehicle.model.preload_names]
    found = vehicle.balance(still, rates, still, np.zeros(axles), np.zeros(axles), 0.025, preloads)
    _, mass, _, stiffness, damping, *_ = (np.array(each) for each in found)
    return replace(steady(vehicle, speed).motion, mass=mass, stiffness=stiffness, damping=damping)


@pytest.mark.parametrize(
    ("rail", "fastest"),
    [(DRY, {33.3: 1.07, 15.0: 5.1, 5.0: 11.7}), (WET, {33.3: 1.07, 15.0: 1.43, 5.0: 0.27})],
)
def test_slip_poles_at_the_loads_of_rest_are_those_of_the_prototype(dry, wet, rail, fastest):
    vehicle = dry if rail is DRY else wet
    for speed, pole in fastest.items():
        found = [each for each in modes(at_rest_loads(vehicle, speed, 0.14)) if not each.oscillates]
        assert max(each.pole.real for each in found) == pytest.approx(pole, abs=0.05)


@pytest.mark.parametrize("speed", [100.0 / 3.0, 15.0])
def test_a_braked_axle_grows_as_the_slope_of_adhesion_says(model, dry, speed):
    """The pole of a wheelset alone, -2 (R^2/J) dF/ds / V at the loads that it has; what it hangs on adds to it."""
    running = steady(dry, speed, slip=0.14)
    assert running.slips == pytest.approx(0.14, abs=1e-6)
    assert (
        running.torques.sum() > -running.acceleration * model.numbers["mass"] * 0.55
    )  # the wheels slow down too
    growing = [mode for mode in modes(running.motion) if mode.name.startswith("slip") and mode.unstable]
    contact, factor = contact_of(model).contact, 0.55**2 / (effective_inertia(model, "wheelset_1") * speed)

    def slope(load):
        return creep_force_slip_derivative(0.14, speed, load, DRY, contact_stiffness(contact, load))

    alone = [-factor * sum(map(slope, loads)) for loads in running.loads]
    assert sorted(mode.pole.real for mode in growing) == pytest.approx(sorted(alone), rel=0.2)


@pytest.fixture(scope="module")
def rates(vehicle):
    """Rates, slips and loads of the plant of the closed loop over state, torques, track and rail; names of the state.

    Of the rail kA and kS are inputs.
    """
    model, axles = vehicle.model, vehicle.model.wheelsets
    names = rest_names(model)
    state, torques = ca.SX.sym("x", 1 + axles + len(names)), ca.SX.sym("t", axles)
    track, factors = ca.SX.sym("z", axles), ca.SX.sym("k", 2)
    rail = replace(DRY, adhesion_reduction=factors[0], slip_reduction=factors[1])
    motion = vehicle_motion(
        model,
        contact_of(model),
        speed=state[0],
        wheel_speeds=ca.vertsplit(state[1 : 1 + axles]),
        rest=state[1 + axles :],
        torques=ca.vertsplit(torques),
        locked=[0.0] * axles,
        rails=[rail] * axles,
        irregularities=tuple(map(Irregularity, ca.vertsplit(track))),
    )
    loads = ca.horzcat(ca.vertcat(*motion.wheel_loads_left), ca.vertcat(*motion.wheel_loads_right))
    rates = ca.vertcat(motion.acceleration, *motion.wheel_rates, motion.rest_rates)
    seen = ca.vertcat(state[: 1 + axles], *motion.slips, ca.vec(loads.T))
    pitches = (f"{name}.pitch'" for name in model.wheelset_names)
    return ca.Function("f", [state, torques, track, factors], [rates, seen]), (
        "car_body.x'",
        *pitches,
        *names,
    )


def in_the_loop(names, running):
    """Steady running as a state of the closed loop, and the matrices to its deviations and back."""
    motion = running.motion
    forward, *turning = motion.neutral.values()
    spins = running.speed * (1.0 - running.slips) / 0.55
    speeds = forward * running.speed + sum(a * b for a, b in zip(turning, spins, strict=True))
    values = dict(zip(motion.coordinates, running.coordinates, strict=True))
    values |= {f"{name}'": each for name, each in zip(motion.coordinates, speeds, strict=True)}
    back = np.zeros((len(motion.states), len(names)))
    for row, name in enumerate(motion.states):
        back[row, names.index(name)] = 1.0
        for neutral, moves in motion.neutral.items():
            if neutral in names and name in motion.coordinates:
                back[row, names.index(neutral)] -= moves[motion.coordinates.index(name)]
    into = np.zeros((len(names), len(motion.states)))
    into[[names.index(name) for name in motion.states], range(len(motion.states))] = 1.0
    assert back @ into == pytest.approx(np.eye(len(motion.states)))
    return np.array([values[name] for name in names]), into, back


def test_the_linearization_is_that_of_the_plant_of_the_closed_loop(vehicle, rates):
    """Central differences of rates, slips and loads, in random directions of states, torques and track."""
    function, names = rates
    running = steady(vehicle, 20.0)
    start, into, back = in_the_loop(names, running)
    ours, random = linearization(running), np.random.default_rng(14)
    for _ in range(5):
        small = 1e-7 * random.standard_normal(len(ours.states))
        inputs = random.standard_normal(8) * np.repeat([10.0, 1e-8], 4)  # N m, m
        ahead, behind = (
            [
                np.array(each)[:, 0]
                for each in function(start + sign * into @ small, sign * inputs[:4], sign * inputs[4:], 1.0)
            ]
            for sign in (1.0, -1.0)
        )
        expected = ours.a @ small + ours.b @ inputs
        assert back @ (0.5 * (ahead[0] - behind[0])) == pytest.approx(
            expected, abs=1e-6 * np.abs(expected).max()
        )
        assert 0.5 * (ahead[1] - behind[1]) == pytest.approx(
            ours.c @ small + ours.d @ inputs, rel=1e-4, abs=1e-12
        )


def grown(rates, running, pole, *, rail, duration, step):
    """Growth [1/s] of one mode in time: the whole nonlinear vehicle from 1e-6 of its shape, against that without."""
    function, names = rates
    start, into, back = in_the_loop(names, running)
    values, vectors = np.linalg.eig(running.motion.state_matrix())
    place = int(np.argmin(np.abs(values - pole)))
    watch = np.linalg.inv(vectors)[place] @ back
    state = ca.MX.sym("s", len(names))
    factors = [rail.adhesion_reduction, rail.slip_reduction]
    once = ca.Function(
        "step", [state], [_runge_kutta(lambda x: function(x, running.torques, 0.0, factors)[0], state, step)]
    )
    run = once.fold(round(duration / step))
    begun = start + into @ np.real(1e-6 * vectors[:, place])
    ended, still = (np.array(run(each))[:, 0] for each in (begun, start))
    return math.log(abs(watch @ (ended - still)) / abs(watch @ (begun - start))) / duration


def fastest_above(running, least):
    """Pole of the fastest growing mode above a frequency [Hz]."""
    return next(pole for pole in poles(running.motion) if pole.imag > 2.0 * math.pi * least)


@pytest.mark.parametrize("speed", [55.0, 75.0])
def test_hunting_grows_in_time_as_its_eigenvalue_says(vehicle, rates, speed):
    """V8, one second."""
    running = steady(vehicle, speed)
    pole = fastest_above(running, 0.2)
    found = grown(rates, running, pole, rail=KALKER, duration=1.0, step=1e-3)
    assert found == pytest.approx(pole.real, rel=1e-3)


@pytest.mark.parametrize(
    ("rail", "kmh", "grows"), [(DRY, 66.0, False), (DRY, 58.0, True), (WET, 20.0, False)]
)
def test_a_braked_driveline_grows_at_low_speed_where_friction_falls_steeply(dry, wet, rail, kmh, grows):
    vehicle = dry if rail is DRY else wet
    pole = fastest_above(steady(vehicle, kmh / 3.6, slip=0.14), 10.0)
    assert bool(pole.real > 0.0) is grows


def test_a_braked_driveline_grows_in_time_as_its_eigenvalue_says(dry, rates):
    """At slip 0.14 on dry rail; within a quarter of a second the train slows down, from 10 to 9.1 m/s."""
    before, after = (steady(dry, speed, slip=0.14) for speed in (10.0, 9.1))
    poles_there = [fastest_above(each, 10.0) for each in (before, after)]
    assert 1.0 < poles_there[0].real < poles_there[1].real
    found = grown(rates, before, poles_there[0], rail=DRY, duration=0.25, step=5e-4)
    assert 0.95 * poles_there[0].real < found < 1.05 * poles_there[1].real


def _runge_kutta(rates, state, step):
    k1 = rates(state)
    k2 = rates(state + 0.5 * step * k1)
    k3 = rates(state + 0.5 * step * k2)
    k4 = rates(state + step * k3)
    return state + step / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
