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


def over_samples(plant, since, speed, wheel, torque, fill, vent, h, parts=PARTS):
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
        step = length / parts
        for k in range(parts):
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
    vehicle = replace(vehicle, wheel_damping_decay=0.0)  # claims take the damping as it is at the start
    run = wd.simulate(
        vehicle, law, wd.Scenario(rail=made, initial_speed=SPEED), plant="quarter", refinement=4
    )
    samples = run.axle_samples[0][:SAMPLES]
    plant = plant_of(
        replace(stated, vehicle=vehicle, rail=made), {k: np.array([v]) for k, v in numbers.items()}
    )
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
        told=(np.maximum(fill, vent) > 0.0)
        & (np.maximum(fill, vent) < h * (1.0 - 1e-9))
        & (torque > 0.02 * full),
        g=g,
        kappa=kappa,
        theta=theta,
        kept=math.exp(-h / law.source.acceleration_time),
        ahead=tracking.ahead,
        missed=missed,
    )


@pytest.fixture(
    scope="module", params=[(rail, number) for rail in RAILS for number in range(MEMBERS)], ids=str
)
def stop(request):
    return course(*request.param)


def told_by_map(stop, **changed):
    """States of the samples but the first by the map from those before, with some numbers changed."""
    now = {name: values[:-1] for name, values in stop.states.items()}
    before = stop.ahead_of[1:] - stop.ahead_of[:-1]
    slope = np.where(
        before == 0.0, 0.0, (stop.pull[1:] - stop.pull[:-1]) / np.where(before == 0.0, 1.0, before)
    )
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
    assert stop.missed < 5e-9


CLOSE = 2e-8


def test_next_sample_is_that_of_the_law(stop):
    found, _ = told_by_map(stop)
    for name in STATES:
        assert found[name] == pytest.approx(stop.states[name][1:], abs=CLOSE), name
    assert np.abs(stop.states["x"]).max() > 0.05
    assert np.count_nonzero(stop.states["x"] < 0.0) > 50


WRONG = {  # a number of the map, what is added to it, and the state that then is another
    "fall": ("y", 1e-4),
    "observed": ("z", 1e-4),
    "observer_error": ("p", 1e-4),
    "lag": ("e", 1e-4),
    "way": ("x", 1e-4),
    "pull": ("x", 1e-4),
    "change": ("y", 1e-4),
    "in_mean": ("x", 0.1),
    "means_apart": ("z", 1e-4),
    "friction_change": ("z", 1e-4),
    "drag_change": ("e", 1e-4),
    "g": ("y", 0.1),
    "kappa": ("e", 0.01),
    "observer_pole": ("p", 0.01),
    "kept": ("e", 0.01),
    "ahead": ("x", 0.1),
    "pull_slope": ("x", 0.01),
}


@pytest.mark.parametrize("name", WRONG)
def test_another_number_makes_another_sample(name):
    stop, heard = course("polach-wet", 0), []
    exact = rolling_sample.next_sample
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(
            rolling_sample,
            "next_sample",
            lambda **given: heard.append(given) or exact(**given),
        )
        told_by_map(stop)
    state, aside = WRONG[name]
    found, _ = told_by_map(stop, **{name: heard[0][name] + aside})
    assert np.abs(found[state] - stop.states[state][1:]).max() > 100.0 * CLOSE


def test_commands_tell_the_way_of_the_map(stop):
    """The pulses that the engine commanded, where they are not of the whole sample."""
    assert np.count_nonzero(stop.told) > 50
    np.testing.assert_allclose(stop.states["x"][stop.told], stop.asked[stop.told], atol=1e-9)


def test_wheel_falls_as_the_states_say(stop):
    z, p, e, x = (stop.states[name] for name in "zpex")
    fall = rolling_sample.fall_of_error(z, p, e, x, stop.pull, stop.theta)
    np.testing.assert_allclose(fall, stop.states["y"], atol=1e-9)
    fallen = fall + stop.g * stop.in_mean * stop.change
    np.testing.assert_allclose(stop.error[1:] - stop.error[:-1], -fallen[:-1], atol=CLOSE)
    np.testing.assert_allclose(stop.ahead_of, stop.error + stop.ahead * (x - stop.pull), atol=1e-9)
    apart = rolling_sample.unlike_means(stop.change, stop.in_mean, stop.own, stop.g)
    learned = rolling_sample.learned(z, p, e, apart, stop.theta, stop.kept)[:-1] + stop.cut[:-1]
    moved = stop.ahead * (learned - stop.change[:-1]) - fallen[:-1]
    np.testing.assert_allclose(np.diff(stop.ahead_of), moved, atol=CLOSE)


def test_way_is_the_same_by_parts_of_it(stop):
    z, p, e, x = (stop.states[name][:-1] for name in "zpex")
    _, slope = told_by_map(stop)
    apart = rolling_sample.unlike_means(stop.change, stop.in_mean, stop.own, stop.g)[:-1]
    laws = stop.g, stop.theta, stop.kept, stop.ahead, slope
    before = (z, p, e, x, stop.pull[:-1])
    change = rolling_sample.next_way(*before, stop.change[:-1], stop.in_mean[:-1], apart, *laws)
    part = np.where(x == 0.0, 0.0, stop.change[:-1] / np.where(x == 0.0, 1.0, x))
    by_part = rolling_sample.next_way_of_part(*before, part, stop.in_mean[:-1], apart, *laws)
    np.testing.assert_allclose(by_part, change, atol=1e-12)
    cut = stop.cut[:-1] * (1.0 + slope * stop.ahead)
    np.testing.assert_allclose(change + cut, stop.states["x"][1:], atol=CLOSE)


def test_change_of_the_pull_is_between_its_slopes(stop):
    """The curve is concave: k up to its beginning, beyond it the slew over the pull."""
    _, slope = told_by_map(stop)
    law = problem("polach-wet").controller
    h, rate = law.sample_time, law.core.tracking.approach_rate
    slew = (stop.pull[stop.ahead_of > 1.0] ** 2 / (2.0 * (stop.ahead_of[stop.ahead_of > 1.0]))).max()
    assert np.all(slope <= h * rate + 1e-9)
    steepest = np.maximum(stop.pull[:-1], stop.pull[1:])
    curve = (stop.ahead_of[:-1] > 1.0) & (stop.ahead_of[1:] > 1.0)
    assert np.all(slope[curve] >= 0.95 * slew / steepest[curve])


# --- sums over the samples before ------------------------------------------------------------------------------------
def sums(weights, values):
    """For each sample the sum of the values of those before, the last one with the first weight."""
    return np.array([weights[:n] @ values[:n][::-1] for n in range(len(values))])


def test_observer_and_filter_are_sums(stop):
    j, theta = np.arange(SAMPLES), stop.theta
    weights = (j + 1) * theta**j
    p, seen = stop.states["p"], stop.observed
    whole = (1.0 - theta) ** 2 * sums(weights, stop.put_in)
    error = -(theta**2) * sums(weights, np.diff(stop.put_in, prepend=0.0))
    # What the observer was cut by goes on as the map says.
    left_z, left_p, beta = 0.0, 0.0, (1.0 - theta) / theta
    for n in range(SAMPLES):
        assert seen[n] == pytest.approx(whole[n] + left_z + beta * left_p, abs=CLOSE)
        assert p[n] == pytest.approx(error[n] + left_p, abs=CLOSE)
        left_z, left_p = theta * left_z + stop.cut[n], theta * left_p + theta**2 * left_z
    filtered = -(1.0 - stop.kept) * sums(stop.kept**j, stop.lost)
    np.testing.assert_allclose(stop.filtered, filtered, atol=CLOSE)
    np.testing.assert_allclose(
        stop.states["x"] - stop.pull, stop.observed - stop.torque - stop.filtered, atol=1e-9
    )


def test_what_the_observer_is_cut_by_is_bounded(stop):
    """A rolling wheel that the resistance slows down: the friction is below 0 until the torque comes."""
    least = np.maximum.accumulate(np.maximum(-stop.put_in, 0.0))
    assert np.count_nonzero(stop.cut) > 1
    z = p = 0.0
    for n in range(SAMPLES):
        most = least[n]
        assert (
            stop.cut[n] <= (1.0 - stop.theta) * (most - stop.theta * z) - stop.theta * stop.observed[n] + 1e-9
            or stop.cut[n] == 0.0
        )
        z, p = stop.theta * z + stop.cut[n], stop.theta * p + stop.theta**2 * z
        assert 0.0 <= z <= most / (1.0 + stop.theta) + 1e-9
        assert 0.0 <= p <= stop.theta**2 * most / (1.0 - stop.theta**2) + 1e-9
    assert np.all(stop.cut[30:] == 0.0)
