"""The attacker's own equations: against SciPy, against published numbers, and against the package at random points."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tests.attack import linear, motion
from tests.attack.case import read_case, read_data
from tests.attack.counterexamples import coach, torque_feedback
from tests.attack.laws import adaptation, feedback_duty, fuzzy_torque, sampled_duty
from tests.attack.plant import (
    adhesion_peak,
    axle_rates,
    creep_force,
    deceleration,
    drift,
    filled,
    filling_duty,
    gain,
    load_shares,
    resistance,
    slip_pole,
    slip_rate,
    static_load,
    vented,
)

RNG_SEED = 7


@pytest.fixture(scope="module")
def wet():
    return read_data("er24pc", "polach-wet")


def test_numbers_and_bounds_are_those_of_the_files(wet):
    assert (wet.plant.mass, wet.plant.max_torque, wet.plant.wheel_radius) == (76841.0, 60e3, 0.55)
    assert wet.bounds["mass"] == (61473.0, 92209.0)
    assert wet.bounds["vent_time"] == (0.3, 0.9)
    assert wet.bounds["slip_reduction"] == (0.08, 0.12)
    assert "wheel_damping" not in wet.bounds
    service = read_data("er24pc-service", "polach-wet").plant
    assert service.max_torque < wet.plant.max_torque


def test_published_points_of_the_wet_and_dry_rail():
    """Data book 0.3 with its contact: slip of the peak, adhesion there and at slip 0.14, by speed."""
    table = {
        "polach-dry": ((33.3, 0.019, 0.375, 0.237), (10.0, 0.035, 0.439, 0.356), (2.0, 0.078, 0.495, 0.486)),
        "polach-wet": ((33.3, 0.053, 0.211, 0.182), (10.0, 0.096, 0.244, 0.241), (2.0, 0.209, 0.273, 0.271)),
    }
    for rail, rows in table.items():
        plant = read_data("er24pc", rail).plant.with_numbers({"kalker_c11": 4.62})
        load = static_load(plant)
        for speed, slip, peak, held in rows:
            at, force = adhesion_peak(plant, speed)
            assert at == pytest.approx(slip, abs=6e-4)
            assert force / load == pytest.approx(peak, abs=6e-4)
            assert creep_force(plant, 0.14, speed, load) / load == pytest.approx(held, abs=6e-4)


def test_slip_poles_of_the_calibrated_vehicle():
    """Findings, section 2: poles at slip 0.14 and fixed speed."""
    for rail, poles in {
        "polach-dry": {33.3: 1.00, 20.0: 3.01, 10.0: 6.79, 5.0: 9.92, 2.0: 11.4, 1.0: 9.92},
        "polach-wet": {33.3: 0.97, 20.0: 1.27, 10.0: 1.25, 5.0: 0.49, 2.0: -2.50, 1.0: -7.74},
    }.items():
        plant = read_data("er24pc", rail).plant
        for speed, pole in poles.items():
            assert slip_pole(plant, 0.14, speed) == pytest.approx(pole, abs=6e-3, rel=5e-3)
    assert gain(plant, 20.0) * 1e6 == pytest.approx(36.6, abs=0.05)


def test_the_slip_rate_is_that_of_the_package(wet):
    from dataclasses import replace

    from wspd_design.model.slip import slip_dynamics
    from wspd_design.parameters.loading import load_rail, load_vehicle

    vehicle, rail = load_vehicle("er24pc"), load_rail("polach-wet")
    rng = np.random.default_rng(RNG_SEED)
    for _ in range(200):
        slip, speed, torque = rng.uniform(0.001, 0.9), rng.uniform(0.5, 34.0), rng.uniform(0.0, 6e4)
        drawn = {name: rng.uniform(*wet.bounds[name]) for name in ("mass", "wheelset_inertia", "mu0")}
        at = slip_dynamics(
            replace(vehicle, mass=drawn["mass"], wheelset_inertia=drawn["wheelset_inertia"]),
            replace(rail, mu0=drawn["mu0"]),
            slip,
            speed,
        )
        plant = wet.plant.with_numbers(drawn)
        assert at.drift + at.gain * torque == pytest.approx(slip_rate(plant, slip, speed, torque), rel=1e-10)
        assert at.deceleration == pytest.approx(deceleration(plant, slip, speed), rel=1e-12)
        assert at.pole == pytest.approx(slip_pole(plant, slip, speed), rel=1e-8, abs=1e-9)


def test_axles_share_one_deceleration(wet):
    """Equal axles move like one; with load transfer the momentum of train and wheels still balances."""
    slips, torques, speed = [0.1, 0.14, 0.2, 0.05], [2e4, 3e4, 4e4, 1e4], 15.0
    plant = wet.plant.with_numbers({"wheel_damping": 0.0})
    rates, slowing = axle_rates(plant, [1.0] * 4, [0.14] * 4, speed, [3e4] * 4)
    assert rates == pytest.approx(slip_rate(plant, 0.14, speed, 3e4))
    assert slowing == pytest.approx(deceleration(plant, 0.14, speed))
    rates, slowing = axle_rates(plant, load_shares(plant, wet.body, 0.2), slips, speed, torques)
    spins = [
        -(rate * speed + (1.0 - slip) * slowing) / plant.wheel_radius
        for rate, slip in zip(rates, slips, strict=True)
    ]
    momentum = -plant.mass * slowing * plant.wheel_radius + plant.wheelset_inertia * sum(spins)
    assert momentum == pytest.approx(-resistance(plant, speed) * plant.wheel_radius - sum(torques))


@pytest.mark.parametrize("name", ["smc", "feedback-wet", "adaptive"])
def test_the_laws_are_those_that_run(name, design):
    from wspd_design.controllers.protocol import Measurement
    from wspd_design.design.file import read_design
    from wspd_design.parameters.loading import load_rail, load_vehicle

    case = read_case(design(name))
    law = read_design(design(name)).build(load_vehicle("er24pc"), load_rail("polach-wet"))
    rng = np.random.default_rng(RNG_SEED)
    for _ in range(200):
        slip, speed = rng.uniform(0.0, 0.8), rng.uniform(0.05, 34.0)
        torque, integral = rng.uniform(0.0, 6e4), rng.normal(0.0, 0.3)
        seen = Measurement(speed, speed * (1.0 - slip) / case.model.wheel_radius, torque)
        if name != "adaptive":
            state = (integral,) if name == "smc" else ()
            _, command = law.step(state, seen)
            held = np.maximum(speed, 0.1)
            duty = sampled_duty(case, slip, held, torque, integral)
            if name == "feedback-wet" and speed < 0.1:
                continue
            assert command.fill == pytest.approx(float(duty), abs=1e-9)
            continue
        weights, bound = rng.uniform(-40.0, 60.0, 5), rng.uniform(0.0, 30.0)
        (_, *after), command = law.step((integral, *weights, bound), seen)
        s = case.slip - slip + case.gains["integral_gain"] * integral
        demand = fuzzy_torque(case, s, weights * 1e3, bound * 1e3)
        assert command.fill == pytest.approx(float(np.clip(demand / 6e4, 0.0, 1.0)), abs=1e-9)
        rates = adaptation(case, s, speed)
        held = (demand > 6e4 and s > 0.0) or (demand < 0.0 and s < 0.0)
        grown = (np.array([*weights, bound]) + 0.0 * bound) * 1e3
        if not held:
            grown = grown + case.sample_time * np.append(*rates)
        assert np.array(after) * 1e3 == pytest.approx(grown, rel=1e-9, abs=1e-6)


def test_filling_is_exact_while_the_supply_builds_up(wet):
    plant = wet.plant.with_numbers({"supply_rate": 1.1, "fill_time": 0.4})
    for start, since in ((0.0, 0.0), (2e4, 0.7)):

        def rate(t, torque, since=since):
            supply = plant.max_torque * (1.0 - np.exp(-plant.supply_rate * (since + t)))
            return (supply - torque) / plant.fill_time

        done = solve_ivp(rate, (0.0, 0.5), [start], rtol=1e-10, atol=1e-6)
        assert filled(plant, start, 0.5, since=since) == pytest.approx(done.y[0, -1], rel=1e-7)
    near = wet.plant.with_numbers({"supply_rate": 2.5, "fill_time": 0.4})
    beside = near.with_numbers({"supply_rate": 2.5 * (1 + 1e-6)})
    assert filled(near, 0.0, 0.3, since=0.0) == pytest.approx(filled(beside, 0.0, 0.3, since=0.0), rel=1e-5)
    assert filled(plant, 1e4, 0.5) > filled(plant, 1e4, 0.5, since=1.0)


def test_pulses_move_the_slip_as_scipy_says(wet):
    """One sample with T_F not equal to T_V, down to the adhering side, at frozen and at falling speed."""
    plant = wet.plant.with_numbers({"fill_time": 0.5, "vent_time": 0.2})
    rng = np.random.default_rng(RNG_SEED)
    for frozen in (True, False):
        for _ in range(12):
            slip, speed = rng.uniform(0.02, 0.5), rng.uniform(2.8, 33.0)
            torque, duty, sample = rng.uniform(5e3, 5e4), rng.uniform(0.0, 1.0), 0.1
            state = motion.wheels(slip, speed, torque)
            motion.pulse(plant, state, duty, sample, steps=60, frozen=frozen)

            def rates(t, y, torque=torque, filling=duty * sample, frozen=frozen):
                top = filled(plant, torque, min(t, filling))
                now = top if t < filling else vented(plant, top, t - filling)
                slowing = 0.0 if frozen else -deceleration(plant, y[0], y[1])
                return [slip_rate(plant, y[0], y[1], now), slowing]

            done = solve_ivp(
                rates, (0.0, sample), [slip, speed], method="Radau", rtol=1e-9, atol=1e-11, max_step=0.002
            )
            locked = done.y[0].max() >= 1.0
            assert locked or state.slip == pytest.approx(done.y[0, -1], abs=3e-5)
            assert locked or state.speed == pytest.approx(done.y[1, -1], abs=1e-6)


def test_the_sampled_map_is_the_derivative_of_the_pulses():
    """Differences of the nonlinear one-sample map at its fixed point, T_F three times T_V."""
    case = coach(0.1)
    plant, speed = case.data.plant, np.array([40.0 / 3.6])

    def step(x):
        state = motion.wheels(x[0], speed, x[1])
        duty = feedback_duty(case, state.slip, speed, state.torque)
        motion.pulse(plant, state, duty, case.sample_time, steps=20, frozen=True)
        return np.array([state.slip, state.torque]), duty

    point = np.array([[0.14], [3800.0]])
    for _ in range(150):
        point, duty = step(point)
    slip, torque = 1e-6, 1e-1
    ahead = [step(point + np.array([[slip], [0.0]]))[0], step(point + np.array([[0.0], [torque]]))[0]]
    behind = [step(point - np.array([[slip], [0.0]]))[0], step(point - np.array([[0.0], [torque]]))[0]]
    columns = [(a - b)[:, 0] / (2.0 * h) for a, b, h in zip(ahead, behind, (slip, torque), strict=True)]
    numeric = np.linalg.eigvals(np.array(columns).T)
    matrix = linear.sampled_map(case, plant, point[0], speed, duty, q=slip_pole(plant, point[0], speed))
    found = np.linalg.eigvals(matrix[..., 0])
    assert np.sort(found.real) == pytest.approx(np.sort(numeric.real), abs=2e-3)
    assert linear.spectral_radius(matrix)[0] == pytest.approx(abs(found).max())


def test_the_orbit_of_the_valve_is_periodic_and_its_mean_grows():
    plant = torque_feedback().data.plant.with_numbers({"vent_time": 0.2})
    duties = np.linspace(0.02, 0.98, 30)
    found = linear.orbit(plant, duties, 0.1)
    shares = filled(plant, found.start * plant.max_torque, duties * 0.1) / plant.max_torque
    assert shares == pytest.approx(found.top)
    assert vented(plant, found.top, (1.0 - duties) * 0.1) == pytest.approx(found.start)
    assert np.all(np.diff(found.mean) > 0.0)
    assert linear.duty_of(plant, found.mean, 0.1) == pytest.approx(duties, abs=1e-9)
    fine = linear.duty_of(plant, np.array([0.3, 0.7]), 1e-4)
    assert fine == pytest.approx(filling_duty(plant, np.array([0.3, 0.7])), abs=1e-4)


def test_the_ideal_stop_is_the_one_of_the_program(wet):
    """A simulation of its own that never locks: within half a percent of the program's ideal stop, 274.74 m."""
    time, way = motion.ideal_stop(wet.plant, np.array([120.0 / 3.6]))
    assert way[0] == pytest.approx(274.74, rel=5e-3)
    assert 15.0 < time[0] < 15.3
    assert drift(wet.plant, 0.0, 20.0) < 0.0
