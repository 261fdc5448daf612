"""What a scenario can contain: rails of single axles, changes of rail, grade, noise, dead time, uneven loads."""

from dataclasses import replace

import numpy as np
import pytest

from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import constants, load_rail
from wspd_design.simulation.records import LoadIrregularity, Patch, Scenario, Sensing
from wspd_design.simulation.stop import simulate

DRY, WET = "polach-dry", "polach-wet"


@pytest.fixture
def dry():
    return Scenario(rail=load_rail(DRY), initial_speed=80.0 / 3.6)


@pytest.fixture
def run(er24pc, make_controller):
    return lambda scenario, name="trenitalia", plant="planar": simulate(
        er24pc, make_controller(name), scenario, plant=plant
    )


def test_wet_front_axles_slip_more_and_the_stop_lies_between(run, dry):
    wet = load_rail(WET)
    mixed = run(replace(dry, axle_rails=(wet, wet, dry.rail, dry.rail)), "none")
    all_dry, all_wet = run(dry, "none"), run(replace(dry, rail=wet), "none")
    assert all_dry.totals.distance < mixed.totals.distance < all_wet.totals.distance
    locked = [mixed.time[np.argmax(mixed.wheel_speed[:, axle] == 0.0)] for axle in range(4)]
    assert max(locked[:2]) < min(locked[2:])


def test_equal_axle_rails_are_the_rail(run, dry):
    same = run(replace(dry, axle_rails=(dry.rail,) * 4))
    assert same.totals == run(dry).totals


def test_a_wet_patch_lengthens_the_stop_by_what_lies_on_it(run, dry):
    wet = load_rail(WET)
    whole = run(replace(dry, rail=wet)).totals.distance
    patched = run(replace(dry, patches=(Patch(start=30.0, rail=wet), Patch(start=60.0, rail=dry.rail))))
    assert run(dry).totals.distance < patched.totals.distance < whole
    beyond = run(replace(dry, patches=(Patch(start=1e4, rail=wet),)))
    assert beyond.totals.distance == pytest.approx(run(dry).totals.distance, rel=1e-12)
    at_once = run(replace(dry, patches=(Patch(start=-0.0, rail=wet),)), plant="quarter")
    assert at_once.totals.distance == pytest.approx(
        run(replace(dry, rail=wet), plant="quarter").totals.distance
    )


def test_rear_axles_reach_a_patch_later(run, dry, er24pc):
    patched = run(replace(dry, patches=(Patch(start=25.0, rail=load_rail("low-adhesion")),)), "none")
    locked = [patched.distance[np.argmax(patched.wheel_speed[:, axle] == 0.0)] for axle in range(4)]
    assert locked[2] - locked[0] > 0.3 * er24pc.bogie_spacing  # torque grows meanwhile


def test_grade_acts_like_a_constant_force(run, dry, er24pc):
    level, down = run(dry), run(replace(dry, grade=-0.03))
    assert down.totals.distance > 1.03 * level.totals.distance
    force = er24pc.mass * constants().gravity * 0.03
    expected = -force * down.time[-1]
    change = down.totals.resistance_impulse - level.totals.resistance_impulse
    assert change == pytest.approx(expected, rel=0.05)


def test_noise_is_repeatable_and_depends_on_the_seed(run, dry):
    noisy = replace(dry, sensing=Sensing(speed_noise=0.2))
    first, again, other = run(noisy), run(noisy), run(replace(noisy, seed=1))
    assert first.totals == again.totals
    assert first.totals != other.totals
    assert first.totals != run(dry).totals
    rim = 0.55 * np.array([[s.seen.wheel_speed for s in axle] for axle in first.axle_samples]).T
    true = np.array(
        [np.interp([s.time for s in first.samples], first.time, w) for w in first.wheel_speed.T]
    ).T
    errors = (rim - 0.55 * true)[rim > 2.0]
    assert errors.std() == pytest.approx(0.2, rel=0.25)


def test_reference_error_is_seen_by_the_controller_only(run, dry):
    off = run(replace(dry, sensing=Sensing(reference_error=0.05)))
    assert off.samples[0].seen.speed == pytest.approx(1.05 * dry.initial_speed)
    assert off.speed[0] == dry.initial_speed


def test_dead_time_delays_the_brake(run, dry):
    late = run(replace(dry, sensing=Sensing(dead_time=0.1)), "none")
    prompt = run(dry, "none")
    assert late.torque[late.time <= 0.1].max() == 0.0
    # The supply builds up all the same, so that the late cylinder fills faster.
    assert 0.0 < late.totals.distance - prompt.totals.distance < 0.1 * dry.initial_speed


def test_load_irregularity_changes_loads_and_hardly_the_distance(run, dry):
    generator = np.random.default_rng(3)
    rough = LoadIrregularity(
        spacing=0.5, factors=tuple(map(tuple, 1.0 + 0.04 * generator.standard_normal((4, 400))))
    )
    shaken, calm = run(replace(dry, load_irregularity=rough)), run(dry)
    spread = (shaken.wheel_load / np.mean(shaken.wheel_load, axis=0)).std()
    assert 0.02 < spread < 0.2
    assert shaken.totals.distance == pytest.approx(calm.totals.distance, rel=0.02)
    none = LoadIrregularity(spacing=1.0, factors=((1.0, 1.0),) * 4)
    level = run(replace(dry, load_irregularity=none)).totals  # its steps end at the points of the table
    assert level.distance == pytest.approx(calm.totals.distance, rel=1e-9)


def test_front_axles_carry_more_while_braking(run, dry):
    braking = run(dry)
    middle = braking.wheel_load[len(braking.time) // 2]
    assert middle[0] > middle[1] > middle[3]
    assert middle[0] > middle[2] > middle[3]
    assert middle.sum() == pytest.approx(76841 * 9.81 / 2, rel=1e-9)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"grade": 0.5}, "grade = 0.5 must lie in"),
        ({"initial_speed": -1.0}, "initial speed"),
        ({"seed": -1}, "seed = -1 must lie"),
        ({"initial_speed": float("nan")}, "initial speed"),
        (
            {"patches": (Patch(start=5.0, rail=load_rail(WET)), Patch(start=1.0, rail=load_rail(WET)))},
            "must rise",
        ),
    ],
)
def test_impossible_scenarios_are_refused(dry, change, words):
    with pytest.raises(UserError, match=words):
        replace(dry, **change)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"speed_noise": -0.1}, "speed noise = -0.1 m/s"),
        ({"speed_noise": float("inf")}, "speed noise = inf m/s"),
        ({"reference_noise": float("nan")}, "reference noise = nan m/s"),
        ({"dead_time": -1e-3}, "dead time = -0.001 s"),
        ({"shortest_pulse": -1e-3}, "shortest pulse = -0.001 s"),
        ({"reference_error": -1.0}, "reference error = -1 must lie .* a speed read too high"),
        ({"torque_error": 1.0}, "torque error = 1 must lie .* a torque computed too high"),
        ({"reference_drift": float("nan")}, "reference drift = nan m/s2"),
        ({"pulses_per_turn": -80}, "pulses per turn = -80 must be a whole number"),
        ({"pulses_per_turn": 80.5}, "pulses per turn = 80.5 must be a whole number"),
        ({"period_timing": True}, "period timing needs a pulse wheel"),
    ],
)
def test_impossible_disturbances_are_refused(change, words):
    with pytest.raises(UserError, match=words):
        Sensing(**change)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"spacing": 0.0}, "spacing = 0 m must be"),
        ({"factors": ((1.0,), ())}, "axle 2 must be one or more"),
        ({"factors": ((float("nan"),),)}, "axle 1 must be one or more"),
    ],
)
def test_impossible_wheel_loads_are_refused(change, words):
    with pytest.raises(UserError, match=words):
        LoadIrregularity(**{"spacing": 1.0, "factors": ((1.0,),)} | change)


@pytest.mark.parametrize(
    ("change", "plant", "words"),
    [
        ({"sensing": Sensing(shortest_pulse=0.2)}, "planar", "shortest pulse = 0.2 s must not exceed"),
        ({"axle_rails": (load_rail(WET),) * 4}, "quarter", "need the plant"),
        ({}, "six-axle", "unknown plant"),
    ],
)
def test_impossible_stops_are_refused(run, dry, change, plant, words):
    with pytest.raises(UserError, match=words):
        run(replace(dry, **change), plant=plant)
