"""The mended adaptive fuzzy law: weights that stay bounded, and deviations that fall, or grow along a course."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest

from tests.certificates.fuzzy_sector.conftest import certificate_of, problem_of
from wspd_design.certificates.kernel.checker import Refused, Work
from wspd_design.certificates.kernel.file import certificate_text
from wspd_design.certificates.records import Status
from wspd_design.certificates.replay import replay
from wspd_design.certificates.setting.fuzzy_loop import core_of
from wspd_design.certificates.setting.plant import plant_with
from wspd_design.certificates.setting.written_fuzzy import not_fuzzy
from wspd_design.certificates.theorems.fuzzy_sector.sector import falls, grows, in_words
from wspd_design.certificates.theorems.fuzzy_sector.theorem import COURSES, FUZZY_SECTOR, LOOP, WEIGHTS
from wspd_design.certificates.theorems.fuzzy_sector.weights import against_the_center, fading_time
from wspd_design.controllers.wheel_law import WheelView
from wspd_design.model.slip import slip_dynamics
from wspd_design.simulation.records import Scenario
from wspd_design.simulation.stop import simulate

PLENTY = 10**9


def view(core, error, torque=20e3):
    return WheelView(
        speed=20.0,
        acceleration=-1.0,
        wheel_speed=error / core.wheel_radius,
        rolling_speed=36.0,
        desired_speed=0.0,
        desired_acceleration=-2.0,
        friction_torque=torque,
        torque=torque,
        available=60e3,
        full_torque=60e3,
    )


# --- weights ----------------------------------------------------------------------------------------------------------


def test_weights_keep_their_signs_whatever_the_surface_does(known):
    """A steady surface drives the rule at 0 nearly as far as the bound says; no course drives a weight farther."""
    core = core_of(known)
    # A command that does not saturate at the edge of the layer, where the adaptation would be held.
    core = replace(core, gains=replace(core.gains, initial_bound=0.5, bound_rate=0.0))
    bound, random = against_the_center(core), np.random.default_rng(3)
    assert bound == pytest.approx(0.0104, rel=0.01)
    layer, rate, center = core.gains.layer, core.gains.surface_rate, 3 + core.gains.centres.index(0.0)
    steady = [1.15 * layer / rate] * 500
    worst = 0.0
    for errors in (steady, *(np.cumsum(size * random.normal(size=500)) for size in (0.05, 0.3))):
        state = core.start(view(core, errors[0]))
        for error in errors:
            state, _ = core.step(state, view(core, float(error)))
            assert state[2] == 0.5
            weights = zip(core.gains.centres, state[3:], strict=True)
            worst = max(
                worst, abs(state[center]), *(-math.copysign(1.0, c) * b for c, b in weights if c != 0.0)
            )
    assert 0.6 * bound < worst <= bound


@pytest.mark.parametrize(
    "gains",
    [
        {"leakage": 0.0},
        {"initial_weights": (0.1, 0.0, 0.0, 0.0, 0.0)},
        {"widths": (1.0, 1.0, 1.0, 1.0, 2.0)},
        {"weight_rate": 100.0},
    ],
    ids=["no leakage", "first weight of the wrong sign", "several widths", "overshoots"],
)
def test_weights_that_nothing_bounds_are_told(gains):
    problem = problem_of("polach-wet", 0.02, bounds=False, **gains)
    assert against_the_center(core_of(problem)) is None
    found = certificate_of(problem)
    assert found.status is Status.UNDECIDED
    assert found.findings[WEIGHTS].status is Status.REFUTED
    assert "Nothing bounds the weights" in found.explanation


def test_weights_fade_inside_the_layer(known):
    core = core_of(known)
    state = (0.0, 0.0, 1.0, *(0.5,) * 5)
    samples = round(fading_time(core) / core.sample_time)
    for _ in range(samples):
        state, _ = core.step((0.0, 0.0, *state[2:]), view(core, 0.0))
    assert state[3:] == pytest.approx([0.5 / math.e] * 5, rel=0.02)


def test_designed_adaptation_is_held_beyond_the_layer_after_one_sample(known):
    """psi_hat fills the whole sample at the edge: what the weights add saturates the command, which holds them."""
    core = core_of(known)
    error = 2.0 * core.gains.layer / core.gains.surface_rate
    state, weights = core.start(view(core, error)), []
    for _ in range(50):
        state, _ = core.step(state, view(core, error))
        weights.append(state[3:])
    assert max(weights[0]) > 0.0
    assert weights[-1] == weights[0]


# --- functions --------------------------------------------------------------------------------------------------------


def test_known_numbers_are_proved_and_accepted(known, proved):
    assert proved.status is Status.PROVED
    assert proved.findings[COURSES].numbers["contraction"] <= 0.95
    text = certificate_text(proved)
    assert len(text) < 100_000
    assert replay(known, text).accepted
    assert text == certificate_text(certificate_of(known))


def refused(problem, proof):
    with pytest.raises(Refused) as reason:
        falls(problem, proof, Work(PLENTY))
    return str(reason.value)


def test_forged_functions_are_refused(known, boxed, slow, proved):
    proof = json.loads(certificate_text(proved))["findings"][COURSES]["proof"]
    assert falls(known, proof, Work(PLENTY))["contraction"] < 1.0

    def forged(piece, place, value):
        made = json.loads(json.dumps(proof))
        made["pieces"][piece][place] = value
        return made

    assert "may not fall" in refused(known, forged(0, -1, "0.5"))
    assert "between 0 and 1" in refused(known, forged(0, -1, "1.5"))
    assert "not positive definite" in refused(known, forged(3, 0, "-1"))
    assert "may not fall" in refused(known, forged(7, 9, "3"))
    assert "for each of" in refused(known, proof | {"pieces": proof["pieces"][:-1]})
    assert refused(boxed, proof)
    assert "may not fall" in refused(replace(slow, bounds=known.bounds), proof)
    assert not replay(boxed, certificate_text(proved)).accepted


def test_function_of_other_gains_is_refused(known, proved):
    core = core_of(known)
    stiff = replace(core, gains=replace(core.gains, layer=core.gains.layer / 4.0))
    changed = replace(known, controller=replace(known.controller, core=stiff))
    assert not replay(changed, certificate_text(proved)).accepted


# --- courses ----------------------------------------------------------------------------------------------------------


def plant_at(problem, place):
    vehicle, rail = plant_with(problem, {k: v for k, v in place.items() if k != "speed"})
    plant = slip_dynamics(vehicle, rail, problem.slip, place["speed"])
    held = -plant.drift / plant.gain
    rates = ((vehicle.brake.max_torque - held) / vehicle.brake.fill_time, held / vehicle.brake.vent_time)
    return float(plant.pole - plant.deceleration / place["speed"]), rates, vehicle


def run(problem, place, error, samples, *, course=None):
    """Errors of the law itself on the linear wheel, without least pulse; along a course, or as its commands say."""
    slope, rates, vehicle = plant_at(problem, place)
    core = core_of(problem)
    core = replace(core, gains=replace(core.gains, least_pulse=0.0))
    h, torque = core.sample_time, 0.0
    state, errors = core.start(view(core, 0.0)), []
    for k in range(samples):
        state, command = core.step(state, view(core, error))
        share = command.fill - command.vent
        valve = (0 if share > 0.0 else 1) if course is None else course[k % len(course)]
        torque += h * share * rates[valve] * core.wheel_radius / vehicle.wheelset_inertia
        error = math.exp(slope * h) * error - math.expm1(slope * h) / slope * torque
        errors.append(error)
    return np.array(errors)


def per_sample(errors, samples):
    sizes = [np.abs(errors[begin : begin + samples]).max() for begin in (0, len(errors) - samples)]
    return (sizes[1] / sizes[0]) ** (1.0 / (len(errors) - samples))


def test_sector_of_the_box_is_too_wide_and_the_course_is_named(boxed):
    """A course in the sector along which a deviation grows; the loop does not take it, and settles there."""
    found = certificate_of(boxed)
    assert found.status is Status.UNDECIDED
    away = found.findings[COURSES]
    assert away.status is Status.REFUTED
    assert found.findings[LOOP].status is Status.UNDECIDED
    assert in_words(away.numbers["course"]) in found.explanation
    growth, samples = away.numbers["growth"], int(away.numbers["samples"])
    course = [0 if each == "fill" else 1 for each in in_words(away.numbers["course"]).split(", ")]
    along = run(boxed, away.place, 1e-9, 300 * samples, course=course)
    assert per_sample(along, 20 * samples) == pytest.approx(growth, rel=1e-3)
    alone = run(boxed, away.place, 1e-9, 300)
    assert np.abs(alone[-20:]).max() < 1e-3 * np.abs(alone[:20]).max()
    with pytest.raises(Refused):
        grows(boxed, away.place, Work(PLENTY), taken=True)
    assert replay(boxed, certificate_text(found)).accepted


def test_loop_that_swings_is_refuted_and_its_witness_run_again(slow):
    found = certificate_of(slow)
    assert found.status is Status.REFUTED
    away = found.findings[LOOP]
    assert "swings" in found.explanation
    errors = run(slow, away.place, 1e-9, 200)
    assert per_sample(errors, 20) == pytest.approx(away.numbers["growth"], rel=2e-3)
    text = certificate_text(found)
    assert replay(slow, text).accepted
    forged = json.loads(text)
    forged["findings"][LOOP]["place"]["fill time"] = 0.9
    forged["findings"][LOOP]["place"]["vent time"] = 0.9
    assert not replay(slow, json.dumps(forged)).accepted


def test_place_at_which_nothing_grows_is_refused(known, proved):
    place = {name: known.nominal(name) for name in known_names()} | {"speed": 10.0}
    for taken in (False, True):
        with pytest.raises(Refused):
            grows(known, place, Work(PLENTY), taken=taken)
    text = json.loads(certificate_text(proved))
    text["findings"][LOOP] = {"place": place}
    assert not replay(known, json.dumps(text)).accepted


def known_names():
    return ("mass", "wheelset inertia", "mu0", "max torque", "fill time", "vent time")


@pytest.mark.slow
def test_what_a_stop_does_at_these_places():
    """At 20 ms the slip settles where the argument fails; at 100 ms it swings where the loop is refuted."""

    def widest(problem, place):
        vehicle, rail = plant_with(problem, {k: v for k, v in place.items() if k != "speed"})
        stop = simulate(
            vehicle, problem.controller, Scenario(rail=rail, initial_speed=120.0 / 3.6), plant="quarter"
        )
        there = (stop.speed > 20.0 / 3.6) & (stop.speed < 60.0 / 3.6)
        slip = 1.0 - stop.wheel_speed[there, 0] * vehicle.wheel_radius / stop.speed[there]
        return float(np.ptp(slip))

    quick, slow = problem_of("low-adhesion", 0.02), problem_of("low-adhesion", 0.1)
    assert widest(quick, certificate_of(quick).findings[COURSES].place) < 0.01
    assert widest(slow, certificate_of(slow).findings[LOOP].place) > 0.1


# --- whom it is about -------------------------------------------------------------------------------------------------


class Gentle(type(core_of(problem_of("polach-wet", 0.02)))):
    """Claims to be the law and fills less."""

    def step(self, state, seen):
        state, command = super().step(state, seen)
        return state, command._replace(fill=0.9 * command.fill)


def test_step_that_runs_is_what_counts(known):
    law = known.controller
    assert not_fuzzy(law) == ""
    core = core_of(known)
    gentle = Gentle(**{name: getattr(core, name) for name in core.__dataclass_fields__})
    assert "is not shown" in not_fuzzy(replace(law, core=gentle))
    assert "is not shown" in FUZZY_SECTOR.speaks_about(replace(known, controller=replace(law, core=gentle)))


def test_other_laws_and_slips_are_not_spoken_about(known):
    assert FUZZY_SECTOR.speaks_about(known) == ""
    assert "holds slip 0.14" in FUZZY_SECTOR.speaks_about(replace(known, slip=0.15))
    law = replace(known.controller, cut_out_speed=5.0)
    assert "holds its valves" in FUZZY_SECTOR.speaks_about(replace(known, controller=law))
