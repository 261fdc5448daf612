"""The map of a sample of the way in against the law that runs, on members of the box, with means over each sample."""

import math
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
import pytest

import wspd_design as wd
from tests.attack.plant import creep_force, filled, resistance, static_load, vented
from tests.certificates.band.conftest import problem_of
from tests.certificates.band.sampled_runs import BESIDE, BOX, plant_of
from wspd_design.certificates.setting.plant import plant_with
from wspd_design.controllers.observer_smc import approach
from wspd_design.model.generated import rolling_sample, slip_tracking

SPEED, SAMPLES = 120.0 / 3.6, 260
PARTS = 12  # of each span of a sample, for the method of Runge and Kutta
RAILS = ("low-adhesion", "polach-wet")
MEMBERS = 4
STATES = ("y", "z", "p", "e", "x")


@dataclass(frozen=True)
class Course:
    """Numbers of all samples of a stop, in rad/s: states, changes and means."""

    states: dict
    pull: np.ndarray
    change: np.ndarray
    in_mean: np.ndarray
    own: np.ndarray
    friction: np.ndarray
    drag: np.ndarray
    lost: np.ndarray
    ahead_of: np.ndarray
    error: np.ndarray
    cut: np.ndarray  # what the observer adds to a friction below 0
    put_in: np.ndarray
    filtered: np.ndarray
    observed: np.ndarray
    torque: np.ndarray
    asked: np.ndarray  # way by the commanded pulse, where that is not of the whole sample
    told: np.ndarray  # whether it tells the way
    g: float
    kappa: float
    theta: float
    kept: float
    ahead: float
    missed: float  # largest difference between the engine and the quadrature, rad/s


@cache
def problem(rail):
    return problem_of(1.0, rail=wd.load_rail(rail))


def member(rail, number):
    """Numbers of a member of the box, some of them at ends of their ranges."""
    random = np.random.default_rng((RAILS.index(rail), number))
    found = {}
    for name in (*BOX, *BESIDE):
        low, high = problem(rail).span(name)
        share = random.random()
        found[name] = low + (round(share) if random.random() < 0.4 else share) * (high - low)
    return found


def over_samples(plant, since, speed, wheel, torque, fill, vent, h):
    """Speeds and torque at the ends of many samples, and means of force, wheel speed, resistance and torque."""

    def pulled(span, t):
        full = filled(plant, torque, np.minimum(t, fill) if span == 0 else fill, since=since)
        gone = np.clip(t - fill, 0.0, vent)
        return vented(plant, full, gone)

    def rates(span, t, speed, wheel):
        force = creep_force(plant, 1.0 - plant.wheel_radius * wheel / speed, speed, static_load(plant))
        braked, held = pulled(span, t), resistance(plant, speed)
        turning = 2.0 * plant.wheel_radius * force - 2.0 * plant.wheel_damping * wheel - braked
        return np.array(
            [
                -(2.0 * plant.wheelsets * force + held) / plant.mass,
                turning / plant.wheelset_inertia,
                force,
                wheel,
                held,
                braked,
            ]
        )

    state = np.array([speed, wheel, *np.zeros((4, len(speed)))])
    begin = 0.0 * speed
    for span, length in enumerate((fill, vent, h - fill - vent)):
        step = length / PARTS
        for k in range(PARTS):
            t = begin + k * step
            first = rates(span, t, *state[:2])
            second = rates(span, t + step / 2, *(state + step / 2 * first)[:2])
            third = rates(span, t + step / 2, *(state + step / 2 * second)[:2])
            last = rates(span, t + step, *(state + step * third)[:2])
            state = state + step / 6 * (first + 2.0 * second + 2.0 * third + last)
        begin = begin + length
    return state[:2], state[2:] / h, pulled(2, h)


@cache
def course(rail, number):
    """A stop of a member of the box by the engine, and what its law and its wheels say of each sample."""
    stated, numbers = problem(rail), member(rail, number)
    law = stated.controller
    tracking, h, inertia, radius = (
        law.core.tracking,
        law.sample_time,
        law.wheelset_inertia,
        law.wheel_radius,
    )
    vehicle, made = plant_with(stated, numbers)
    run = wd.simulate(
        vehicle, law, wd.Scenario(rail=made, initial_speed=SPEED), plant="quarter", refinement=4
    )
    samples = run.axle_samples[0][:SAMPLES]
    plant = plant_of(replace(stated, vehicle=vehicle, rail=made), {k: np.array([v]) for k, v in numbers.items()})
    time, fill, vent = np.array([(each.time, each.fill * h, each.vent * h) for each in samples]).T
    speed, wheel, braked = np.array([each.seen for each in samples]).T
    memory = {name: np.array([each.state[k] for each in samples]) for k, name in enumerate(law.memory)}
    effect = numbers["max torque"] / law.valve.brake.max_torque
    (speed_then, wheel_then), means, braked_then = over_samples(
        plant, time, speed, wheel, braked, fill, vent, h
    )
    missed = max(
        np.abs(wheel_then[:-1] - wheel[1:]).max(),
        np.abs(speed_then[:-1] - speed[1:]).max(),
        np.abs(braked_then[:-1] - braked[1:]).max() * h / inertia,
    )
    force, turning, held, braked_mean = means
    m, own_inertia, R = (numbers[name] for name in ("mass", "wheelset inertia", "wheel radius"))
    slip = law.reference.slip
    kappa = (1.0 - slip) * plant.wheelsets * own_inertia / (R**2 * m)
    damping = 2.0 * plant.wheel_damping * h / own_inertia
    friction = 2.0 * R * force * h / own_inertia - damping * turning
    drag = kappa * damping * turning + (1.0 - slip) * h * held / (R * m)
    g = effect * inertia / own_inertia
    unit = h / inertia
    torque, seen = braked / effect * unit, memory["friction_torque_1"] * unit
    change = (braked_then - braked) / effect * unit
    mean_change = (braked_mean - braked) / effect * unit
    own_change = memory["mean_torque_1"] * unit - torque
    rate = slip_tracking.reference_acceleration(0.0, memory["train_acceleration"], slip, 0.0, radius)
    error = wheel - (1.0 - slip) * memory["train_speed"] / radius
    ahead_of = slip_tracking.predicted_error(
        error, memory["friction_torque_1"], braked / effect, rate, inertia, h, tracking.ahead
    )
    pull = h * approach(ahead_of, tracking.approach_rate, law.core.torque_slew / inertia)
    way = unit * slip_tracking.target_torque(memory["friction_torque_1"], rate, pull / h, inertia) - torque
    observed = memory["observed_speed_1"] - wheel
    theta = math.exp(-law.observer_rate * h)
    lost = kappa * friction + drag
    moves = change != 0.0
    some = np.where(moves, change, 1.0)
    in_mean = np.where(moves, mean_change / some, 0.5)
    own = np.where(moves, own_change / np.where(moves, mean_change, 1.0), 0.0)
    put_in = friction - g * (torque + mean_change) + memory["mean_torque_1"] * unit
    uncut = seen + (1.0 - theta) ** 2 * (put_in - observed - seen)
    full = law.valve.brake.max_torque * unit
    room = full * -np.expm1(-numbers["supply rate"] * time) - torque
    length = law.valve.time_share * law.valve.brake.fill_time
    asked = np.where(fill > 0.0, -room * np.expm1(-fill / length), torque * np.expm1(-vent / length))
    states = {
        "y": g * torque - friction - lost,
        "z": seen - friction + (g - 1.0) * torque - (1.0 - theta) / theta * observed,
        "p": observed,
        "e": h * rate + lost,
        "x": way,
    }
    return Course(
        states=states,
        pull=pull,
        change=change,
        in_mean=in_mean,
        own=own,
        friction=friction,
        drag=drag,
        lost=lost,
        ahead_of=ahead_of,
        error=error,
        cut=np.maximum(-uncut, 0.0),
        put_in=put_in,
        filtered=h * rate,
        observed=seen,
        torque=torque,
        asked=asked,
        told=(np.maximum(fill, vent) > 0.0) & (np.maximum(fill, vent) < h * (1.0 - 1e-9)) & (torque > 0.02 * full),
        g=g,
        kappa=kappa,
        theta=theta,
        kept=math.exp(-h / law.source.acceleration_time),
        ahead=tracking.ahead,
        missed=missed,
    )


@pytest.fixture(scope="module", params=[(rail, number) for rail in RAILS for number in range(MEMBERS)], ids=str)
def stop(request):
    return course(*request.param)


def told_by_map(stop, **changed):
    """States of the samples but the first by the map from those before, with some numbers changed."""
    now = {name: values[:-1] for name, values in stop.states.items()}
    before = stop.ahead_of[1:] - stop.ahead_of[:-1]
    slope = np.where(before == 0.0, 0.0, (stop.pull[1:] - stop.pull[:-1]) / np.where(before == 0.0, 1.0, before))
    apart = rolling_sample.unlike_means(stop.change, stop.in_mean, stop.own, stop.g)
    given = {
        "fall": now["y"],
        "observed": now["z"],
        "observer_error": now["p"],
        "lag": now["e"],
        "way": now["x"],
        "pull": stop.pull[:-1],
        "change": stop.change[:-1],
        "in_mean": stop.in_mean[:-1],
        "means_apart": apart[:-1],
        "friction_change": np.diff(stop.friction),
        "drag_change": np.diff(stop.drag),
        "g": stop.g,
        "kappa": stop.kappa,
        "observer_pole": stop.theta,
        "kept": stop.kept,
        "ahead": stop.ahead,
        "pull_slope": slope,
    }
    found = dict(zip(STATES, rolling_sample.next_sample(**given | changed), strict=True))
    cut = stop.cut[:-1]
    found["z"] = found["z"] + cut
    found["x"] = found["x"] + cut * (1.0 + slope * stop.ahead)
    return found, slope


def test_engine_and_quadrature_agree(stop):
    assert stop.missed < 1e-7


def test_next_sample_is_that_of_the_law(stop):
    found, _ = told_by_map(stop)
    for name in STATES:
        assert found[name] == pytest.approx(stop.states[name][1:], abs=3e-7), name
    assert np.abs(stop.states["x"]).max() > 0.05
    assert np.count_nonzero(stop.states["x"] < 0.0) > 50
