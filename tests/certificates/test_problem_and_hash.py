"""Records: what a problem refuses, and what the fingerprint of a model sees."""

from dataclasses import fields, replace
from fractions import Fraction

import pytest

from wspd_design.certificates.kernel.finding import above, below
from wspd_design.certificates.records import Problem
from wspd_design.certificates.setting.fingerprint import model_hash
from wspd_design.parameters.bounds import Bounds
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import load_rail

BOUNDS = Bounds.of({"mass": (6e4, 9e4), "wheelset inertia": (640.0, 860.0), "mu0": (0.4, 0.6)})


@pytest.fixture
def problem(er24pc, make_controller):
    return Problem(
        vehicle=er24pc,
        rail=load_rail("polach-dry"),
        controller=make_controller("afsmc"),
        slip=0.14,
        speeds=(2.0, 33.0),
        slips=(0.02, 0.6),
        bounds=BOUNDS,
        sample_time=0.1,
    )


@pytest.mark.parametrize(
    "changes",
    [
        {"speeds": (33.0, 2.0)},
        {"slip": 1.4},
        {"slip": float("nan")},
        {"sample_time": 0.0},
    ],
)
def test_ranges_that_are_none_are_refused(problem, changes):
    with pytest.raises(UserError, match=next(iter(changes)).split("_")[0]):
        replace(problem, **changes)


@pytest.mark.parametrize(
    ("name", "ends", "words"),
    [
        ("mass", (float("nan"), 9e4), "mass.* finite"),
        ("mu0", (0.4, float("inf")), "mu0.* finite"),
        ("wheel radius", (0.55, 0.51), "wheel radius.* reversed"),
        ("wheel_radius", (0.51, 0.55), "wheel_radius: there is no such number; the names are mass"),
        ("speed", (2.0, 33.0), "speed: there is no such number"),
    ],
)
def test_bounds_that_are_none_are_refused_in_one_sentence(problem, name, ends, words):
    with pytest.raises(UserError, match=words) as refusal:
        replace(problem, bounds=problem.bounds | {name: ends})
    assert "\n" not in str(refusal.value)


def test_hash_is_the_same_for_the_same_numbers(problem):
    assert model_hash(problem) == model_hash(replace(problem))
    assert model_hash(problem) == model_hash(replace(problem, speeds=(2.0 + 0.0, 33.0)))


def test_hash_sees_every_field_of_a_problem(problem):
    known = {model_hash(problem)}
    other = {
        "vehicle": replace(problem.vehicle, brake=replace(problem.vehicle.brake, fill_time=0.61)),
        "rail": replace(problem.rail, friction_decay=0.61),
        "controller": replace(
            problem.controller, gains=replace(problem.controller.gains, centres=(1.0, 2.0, 3.0, 4.0, 5.0))
        ),
        "slip": 0.15,
        "speeds": (2.0, 33.000000000000007),
        "slips": (0.02, 0.61),
        "bounds": BOUNDS | {"fill time": (0.3, 0.9)},
        "sample_time": 0.11,
        "slip_tolerance": 0.04,
        "seed": 1,
        "contact_grows_with_load": False,
    }
    for name, (low, high) in BOUNDS.items():
        for ends in ((low, 1.01 * high), (0.99 * low, high)):
            changed = model_hash(replace(problem, bounds=BOUNDS | {name: ends}))
            assert changed not in known
            known.add(changed)
    assert set(other) == {field.name for field in fields(Problem)}
    for name, value in other.items():
        changed = model_hash(replace(problem, **{name: value}))
        assert changed not in known
        known.add(changed)


def test_hash_tells_users_own_controllers_apart(problem):
    class Own:
        def __init__(self, gain):
            self.name, self.sample_time, self.gain = "own", 0.1, gain

    hashes = {model_hash(replace(problem, controller=Own(gain))) for gain in (1.0, 2.0)}
    assert len(hashes) == 2
    assert model_hash(replace(problem, controller=Own(1.0))) in hashes


@pytest.mark.parametrize("number", [Fraction(1, 3), Fraction(-1, 3), Fraction(1, 2), Fraction(1, 10**400)])
def test_doubles_around_a_number_contain_it(number):
    low, high = below(number), above(number)
    assert Fraction(low) <= number <= Fraction(high)
    assert (low == high) is (number == Fraction(1, 2))
