"""Reading a witness, believing nothing, and the plant and the torque at it."""

import json
import math
from dataclasses import replace

import pytest

from wspd_design.certificates.kernel.file import SCHEMA
from wspd_design.certificates.records import Problem, Status
from wspd_design.certificates.witness import plant_at, read_witness, start_at
from wspd_design.design.problem import stated_bounds
from wspd_design.model.slip import slip_dynamics
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import load_rail

POINTS = {
    "slip": (0.2, "-"),
    "speed": (36.0, "km/h"),
    "mass": (70e3, "kg"),
    "wheelset inertia": (700.0, "kg m2"),
    "mu0": (0.3, "-"),
    "slip pole": (3.0, "1/s"),
}


def content(points=POINTS, **changes):
    witness = [{"name": name, "value": value, "unit": unit} for name, (value, unit) in points.items()]
    usual = {"schema": SCHEMA, "check": "open_loop_pole", "status": "REFUTED"}
    return usual | {"model_sha256": "abc", "findings": {}, "witness": witness} | changes


def read(what):
    return read_witness(what if isinstance(what, str) else json.dumps(what), "w.json")


def test_a_witness_in_si_units():
    found = read(content())
    assert (found.check, found.status, found.model_hash) == ("open_loop_pole", Status.REFUTED, "abc")
    assert found.slip == 0.2
    assert found.numbers == {"mass": 70e3, "wheelset inertia": 700.0, "mu0": 0.3}
    assert found.speed == pytest.approx(10.0, rel=1e-15)
    assert found.torque is None


def test_what_is_not_named_is_left_open():
    found = read(content({"slip": (0.0, "-"), "speed": (100, "km/h"), "torque": (5e3, "N m")}))
    assert (found.numbers, found.torque) == ({}, 5e3)


def without(name):
    return {key: value for key, value in POINTS.items() if key != name}


FAULTS = {
    "no JSON": ("{", "not complete JSON"),
    "nothing": ("", "not complete JSON"),
    "deep": ("[" * 100_000, "not complete JSON"),
    "a list": ("[]", "of another kind"),
    "another schema": (content(schema="wspd-certificate/9"), SCHEMA),
    "no check": (content(check=None), "no check"),
    "a check that is not a name": (content(check="\x1b[2J"), "no check"),
    "no status": (content(status="FALSE"), "no status"),
    "a status that is not text": (content(status=["REFUTED"]), "no status"),
    "proved": (content(status="PROVED", witness=[]), "open_loop_pole is PROVED, and only REFUTED"),
    "no witness key": (
        {k: v for k, v in content(status="UNDECIDED").items() if k != "witness"},
        "is UNDECIDED",
    ),
    "refuted without a point": (content(witness=[]), "REFUTED, but it states no point"),
    "a witness that is not a list": (content(witness={"slip": 0.1}), "no witness to start from"),
    "no slip": (content(without("slip")), "without slip"),
    "no speed": (content(without("speed")), "without speed"),
    "points that are none": (content(witness=[3, None, {"name": ["slip"]}]), "without slip"),
    "slip twice": (content(witness=content()["witness"] * 2), "names slip twice"),
    "another unit": (content(POINTS | {"speed": (10.0, "m/s")}), 'speed is not in its unit, "km/h"'),
    "NaN": (content(POINTS | {"slip": (math.nan, "-")}), "slip is not a finite number"),
    "infinite": (content(POINTS | {"mass": (math.inf, "kg")}), "mass is not a finite number"),
    "too large for a float": (content(POINTS | {"mass": (10**400, "kg")}), "mass is not a finite number"),
    "a word": (content(POINTS | {"mu0": ("0.3", "-")}), "mu0 is not a finite number"),
    "true": (content(POINTS | {"mu0": (True, "-")}), "mu0 is not a finite number"),
    "locked": (content(POINTS | {"slip": (1.0, "-")}), "slip 1,"),
    "traction": (content(POINTS | {"slip": (-0.1, "-")}), "slip -0.1,"),
    "standing": (content(POINTS | {"speed": (0.0, "km/h")}), "speed 0 km/h, .* between 0.36 and 500 km/h"),
    "too light": (content(POINTS | {"mass": (1.0, "kg")}), "mass 1 kg"),
    "no inertia": (content(POINTS | {"wheelset inertia": (1e-9, "kg m2")}), "wheelset inertia 1e-09 kg m2"),
    "no friction": (content(POINTS | {"mu0": (0.0, "-")}), "mu0 0,"),
    "a torque that drives": (content(POINTS | {"torque": (-1.0, "N m")}), "torque -1 N m"),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_what_is_no_state_is_refused_in_one_sentence(fault):
    what, words = FAULTS[fault]
    with pytest.raises(UserError, match=words) as caught:
        read(what)
    sentence = str(caught.value)
    assert sentence.startswith("w.json ")
    assert sentence.isprintable()


@pytest.fixture
def problem(er24pc, make_controller):
    return Problem(
        vehicle=er24pc,
        rail=load_rail("polach-dry"),
        controller=make_controller("smc"),
        slip=0.14,
        speeds=(3.0, 33.0),
        slips=(0.02, 0.6),
        bounds=stated_bounds(er24pc, load_rail("polach-dry")) | {"mu0": (0.2, 0.6)},
        sample_time=0.1,
    )


def test_the_plant_takes_the_numbers_of_the_witness(problem):
    vehicle, rail = plant_at(problem, read(content()))
    assert (vehicle.mass, vehicle.wheelset_inertia, rail.mu0) == (70e3, 700.0, 0.3)
    assert vehicle.body_mass - problem.vehicle.body_mass == pytest.approx(70e3 - problem.vehicle.mass)
    assert vehicle.contact == problem.vehicle.contact
    few = read(content({"slip": (0.2, "-"), "speed": (36.0, "km/h")}))
    assert plant_at(problem, few) == (problem.vehicle, problem.rail)


def test_a_mass_without_a_body_is_refused(problem):
    with pytest.raises(UserError, match=r"mass of 2000 kg, .* er24pc"):
        plant_at(problem, read(content(POINTS | {"mass": (2e3, "kg")})))


@pytest.mark.parametrize("grows", [True, False])
def test_the_torque_holds_the_slip_of_the_plant_of_the_claim(problem, grows):
    # (19) of the certificates: the contact follows the load or not, as the problem says.
    problem = replace(
        problem,
        contact_grows_with_load=grows,
        vehicle=replace(problem.vehicle, wheel_damping_decay=0.0),
    )
    witness = read(content())
    vehicle, rail = plant_at(problem, witness)
    start, holding = start_at(witness, vehicle, rail)
    known = problem.vehicle.contact.reference_load
    contact = vehicle.contact if grows else replace(vehicle.contact, reference_load=known * 70e3 / 76841.0)
    plant = replace(problem.vehicle, mass=70e3, wheelset_inertia=700.0, contact=contact)
    at = slip_dynamics(plant, replace(problem.rail, mu0=0.3), 0.2, witness.speed)
    assert at.drift + at.gain * holding == pytest.approx(0.0, abs=1e-12)
    assert (start.slip, start.torque) == (0.2, holding)


def test_the_brake_gives_no_more_than_it_has_and_does_not_drive(problem):
    grip = read(content(POINTS | {"mu0": (1.0, "-"), "slip": (0.05, "-")}))
    start, holding = start_at(grip, *plant_at(problem, grip))
    assert holding > 60e3
    assert start.torque == 60e3
    # At a slip of zero only the falling speed has to be followed: downhill the wheel would have to be driven.
    rolling = read(content(POINTS | {"slip": (0.0, "-")}))
    start, holding = start_at(rolling, *plant_at(problem, rolling), grade=-0.1)
    assert holding < 0.0
    assert start.torque == 0.0


def test_a_torque_of_the_witness_comes_first(problem):
    named = read(content(POINTS | {"torque": (5e3, "N m")}))
    start, holding = start_at(named, *plant_at(problem, named))
    assert start.torque == 5e3
    assert holding > 6e3
    strong = read(content(POINTS | {"torque": (61e3, "N m")}))
    with pytest.raises(UserError, match="torque of 61000 N m, more than the 60000 N m of er24pc"):
        start_at(strong, *plant_at(problem, strong))
