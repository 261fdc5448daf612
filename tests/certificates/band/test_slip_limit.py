"""A slip that takes more than full pressure: proved, told, attacked with any torque, and refused where it is false."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest

import wspd_design as wd
from tests.certificates.band.conftest import LOCO, WET, problem_of
from tests.certificates.round_trip import (
    keep,
    no_proof_can_be_missed,
    no_word_can_be_changed,
    not_for,
    refused,
)
from wspd_design.certificates.checks.region.slip_limit import CHECK
from wspd_design.certificates.records import Status
from wspd_design.certificates.theorems.limit import FADES, HOLDS, limited

DRY = wd.load_rail("polach-dry")
WHEELS, G = 8, 9.81
STARTS, STEP = 40, 0.002


@pytest.fixture(scope="module")
def kept():
    return keep(CHECK, problem_of(1.0, rail=DRY))


def force_of(at):
    """Polach's creep force of a wheel, written once more, over slip and speed."""
    contact, load = LOCO.contact, at["mass"] * G / WHEELS
    area = at["semi axis rolling"] * at["semi axis lateral"] * (load / contact.reference_load) ** (2.0 / 3.0)
    stiffness = contact.shear_modulus * math.pi * area * contact.kalker_c11 / 4.0

    def force(slip, speed):
        fading = (1.0 - DRY.friction_ratio) * np.exp(-DRY.friction_decay * np.abs(slip) * speed)
        friction = at["mu0"] * (fading + DRY.friction_ratio)
        strain = stiffness * slip / (load * friction)
        weak, slow = at["adhesion reduction"] * strain, at["slip reduction"] * strain
        return 2.0 * load * friction / math.pi * (weak / (1.0 + weak**2) + np.arctan(slow))

    return force


def held(at, slip, speed, *, braking_wheels=2.0):
    """Torque that holds a slip while so many wheels slow the train down."""
    force = force_of(at)(slip, speed)
    slowing = braking_wheels * force / at["mass"]
    turning = at["wheelset inertia"] * (1.0 - slip) * slowing / at["wheel radius"]
    damped = 2.0 * LOCO.wheel_damping * (1.0 - slip) * speed / at["wheel radius"]
    return 2.0 * at["wheel radius"] * force + turning - damped


def largest_slip(at, torque_of, *, speed, slip, low=25.0 / 3.6):
    """Largest slip on the way down, of starts with torques of their own, while one wheelset alone slows the train."""
    random, force = np.random.default_rng(5), force_of(at)
    radius, inertia = at["wheel radius"], at["wheelset inertia"]
    v = np.full(STARTS, speed)
    w = (1.0 - slip * random.choice([1.0, 0.5], STARTS)) * v / radius
    found = np.zeros(STARTS)
    while np.any(v > low):
        torque = torque_of(random)
        for _ in range(10):

            def rates(v, w, torque=torque):
                pull = force(1.0 - radius * w / v, v)
                return -2.0 * pull / at["mass"], (
                    2.0 * radius * pull - 2.0 * LOCO.wheel_damping * w - torque
                ) / inertia

            a1, b1 = rates(v, w)
            a2, b2 = rates(v + STEP / 2.0 * a1, np.maximum(w + STEP / 2.0 * b1, 0.0))
            v, w = np.maximum(v + STEP * a2, 1.0), np.maximum(w + STEP * b2, 0.0)
            found = np.where(v > low, np.maximum(found, 1.0 - radius * w / v), found)
    return float(found.max())


def corner_of(kept):
    found = limited(kept.certificate.findings)
    return {**found.values, "max torque": kept.problem.span("max torque")[0]}


def test_it_is_proved_and_told(kept):
    found = kept.certificate
    assert found.status is Status.PROVED
    at = corner_of(kept)
    assert f"{at['max torque'] / 1e3:g} kN m" in found.explanation
    assert f"{at['speed'] * 3.6:.3g} km/h down" in found.explanation
    # At the place full pressure is what holds the slip, worked out by hand; a little faster it is more.
    assert held(at, at["slip"], at["speed"]) == pytest.approx(at["max torque"], rel=1e-6)
    assert held(at, at["slip"], 1.01 * at["speed"]) < at["max torque"]
    assert found.findings[FADES].status is Status.PROVED
    assert "this is no band about the reference" in found.assumptions[-1]
    no_word_can_be_changed(kept)
    stripped = {key: each for key, each in kept.content["findings"].items() if key != FADES}
    assert refused(kept, findings=stripped)


def full(at):
    """Full pressure all the time."""
    return lambda _random: np.full(STARTS, at["max torque"])


def anything(at):
    """Full pressure, none, or something between, drawn anew every 20 ms."""
    return lambda random: at["max torque"] * random.choice([0.0, 0.5, 0.9, 1.0, 1.0], STARTS)


def test_no_torque_leads_beyond(kept):
    at = corner_of(kept)
    start = {"speed": 0.999 * at["speed"], "slip": at["slip"]}
    for torques in (full(at), anything(at)):
        assert largest_slip(at, torques, **start) <= at["slip"] * (1.0 + 1e-6)


def test_the_attack_sees_a_limit_that_is_too_high(kept):
    """Plant the fault: a speed at which full pressure suffices; the deceleration of eight wheels, not of two."""
    at = corner_of(kept)
    assert largest_slip(at, full(at), speed=1.05 * at["speed"], slip=at["slip"]) > 1.01 * at["slip"]
    fast = at["speed"]
    while held(at, at["slip"], 1.001 * fast, braking_wheels=8.0) >= at["max torque"]:
        fast *= 1.001
    assert fast > 1.02 * at["speed"]
    assert largest_slip(at, full(at), speed=fast, slip=at["slip"]) > 1.01 * at["slip"]


def test_a_place_where_full_pressure_suffices_is_refused(kept):
    findings = json.loads(json.dumps(kept.content["findings"]))
    for key, each in findings.items():
        if key.startswith(HOLDS):
            each["place"]["speed"] = repr(1.5 * float(each["place"]["speed"]))
    assert refused(kept, findings=findings)


def test_friction_that_rises_with_the_speed_shows_nothing(kept):
    rising = replace(kept.problem, rail=replace(DRY, friction_ratio=1.2))
    found = CHECK.run(rising)
    assert found.findings[FADES].status is Status.REFUTED
    assert found.status is Status.UNDECIDED
    assert not_for(kept, rising)


def test_a_brake_that_is_nowhere_the_limit():
    kept = keep(CHECK, problem_of(1.0, rail=WET))
    assert kept.certificate.status is Status.VACUOUS
    assert "nowhere the limit" in kept.certificate.explanation
    no_proof_can_be_missed(kept)
    # With a third of the torque it is.
    weak = replace(LOCO, brake=replace(LOCO.brake, max_torque=LOCO.brake.max_torque / 3.0))
    assert not_for(kept, replace(kept.problem, vehicle=weak))


def test_the_law_does_not_matter(kept, make_controller):
    found = CHECK.run(replace(kept.problem, controller=make_controller("trenitalia")))
    assert (found.status, found.claim) == (Status.PROVED, kept.certificate.claim)
