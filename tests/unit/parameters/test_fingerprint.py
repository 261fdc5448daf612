"""Fingerprints see everything that a result rests on, are the same in every run, and refuse what has no content."""

import subprocess
import sys
from dataclasses import replace
from enum import Enum
from fractions import Fraction
from functools import partial

import numpy as np
import pytest

from wspd_design.design.records import vehicle_hash
from wspd_design.parameters.bounds import EXACT
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.fingerprint import fingerprint
from wspd_design.parameters.loading import constants, load_rail, load_vehicle
from wspd_design.parameters.records import Brake, Contact, DynamicBrake, Pads, Rail, TrackBrake, Vehicle


class Colour(Enum):
    RED = 1
    BLUE = 2


class Own:
    """A controller of a user, with gains of any kind."""

    name, sample_time = "own", 0.1

    def __init__(self, **attributes):
        vars(self).update(attributes)

    def step(self, state, measurement):
        return state, measurement


def test_constants_are_seen():
    heavier = replace(constants(), gravity=9.0)
    rail = load_rail("polach-wet")
    assert fingerprint(rail, constants()) != fingerprint(rail, heavier)


@pytest.mark.parametrize(
    ("one", "other"),
    [
        (1.0, 1.0 + 2**-52),
        (0.0, -0.0),
        (1, 1.0),
        (True, 1),
        ("1", 1),
        (None, "None"),
        ((1.0, 2.0), [1.0, 2.0]),
        ((1.0, (2.0,)), ((1.0, 2.0),)),
        ({"k": 1.0}, {"k": 2.0}),
        ({1.0, 2.0}, {1.0, 3.0}),
        (Colour.RED, Colour.BLUE),
        (Fraction(1, 3), Fraction(1, 3) + Fraction(1, 10**30)),
        (np.array([1.0, 2.0]), np.array([1.0, 2.0 + 2**-51])),
        (np.array([[1.0, 2.0]]), np.array([1.0, 2.0])),
        (np.array([1, 2]), np.array([1.0, 2.0])),
        (lambda x: x, lambda y: y + 1),
        (partial(max, 1.0), partial(max, 2.0)),
        (Own(gains=[1.0]), Own(gains=[2.0])),
        (Own(table=np.array([1.0])), Own(table=np.array([2.0]))),
        (Own(settings={"k": 1.0}), Own(settings={"k": 2.0})),
        (Own(_hidden=1.0), Own(_hidden=2.0)),
    ],
)
def test_other_content_has_another_fingerprint(one, other):
    assert fingerprint(one) != fingerprint(other)
    assert fingerprint([one]) != fingerprint([other])


def test_the_same_content_has_the_same_fingerprint():
    assert fingerprint(load_vehicle("er24pc")) == fingerprint(load_vehicle("er24pc"))
    assert fingerprint({"a": 1.0, "b": 2.0}) == fingerprint({"b": 2.0, "a": 1.0})
    assert fingerprint(Own(gains=[1.0], k=2)) == fingerprint(Own(k=2, gains=[1.0]))
    assert fingerprint(1.0, 2.0) != fingerprint((1.0, 2.0))


def by_factor(factor):
    return type("Made", (), {"step": lambda _self, state: factor * state})()


def test_what_a_step_closes_over_is_seen():
    assert fingerprint(by_factor(1.0)) == fingerprint(by_factor(1.0)) != fingerprint(by_factor(2.0))


GAIN = 1.0


class WithGlobal:
    def step(self, state):
        return GAIN * state


def test_a_number_of_the_module_that_a_step_uses_is_seen(monkeypatch):
    before = fingerprint(WithGlobal())
    monkeypatch.setattr(sys.modules[__name__], "GAIN", 2.0)
    assert fingerprint(WithGlobal()) != before


def test_an_edited_method_is_seen(monkeypatch):
    before = fingerprint(Own())
    monkeypatch.setattr(Own, "step", lambda _self, _state, _measurement: None)
    assert fingerprint(Own()) != before


def test_a_method_that_replaces_one_of_this_package_is_seen(monkeypatch, make_controller):
    law = make_controller("smc")
    before = fingerprint(law)
    monkeypatch.setattr(type(law), "step", lambda _self, _state, _measurement: None)
    assert fingerprint(law) != before


def test_an_object_that_contains_itself_has_a_fingerprint():
    own = Own()
    own.me = own
    assert len(fingerprint(own)) == 64


def test_what_has_no_content_is_refused():
    with pytest.raises(UserError, match="no content that can be told"):
        fingerprint(Own(file=object()))
    with pytest.raises(UserError, match="no content that can be told"):
        fingerprint(number for number in range(3))


def test_fingerprints_are_the_same_in_every_process():
    text = (
        "from wspd_design.parameters.fingerprint import fingerprint\n"
        "from wspd_design.parameters.loading import load_vehicle\n"
        "print(fingerprint(load_vehicle('er24pc'), {'a', 'b', 'c'}))"
    )
    found = {
        subprocess.run([sys.executable, "-c", text], check=True, capture_output=True, text=True).stdout
        for _ in range(2)
    }
    assert found == {fingerprint(load_vehicle("er24pc"), {"a", "b", "c"}) + "\n"}


def test_a_vehicle_without_something_has_the_fingerprint_of_before_it_was_known(er24pc):
    """What a file may leave out does not count while it is left out, and counts as soon as it is there."""
    plain = fingerprint(er24pc)
    assert vehicle_hash(er24pc).startswith("8faf1348b3d7")  # as in the designs of reports/, which are older
    for changes in ({"axles_per_bogie": 1}, {"bodies": 2}):
        assert fingerprint(replace(er24pc, **changes)) != plain
    unlike = replace(er24pc, brake=replace(er24pc.brake, axle_shares=(1.0, 0.0, 1.0, 1.0)))
    assert fingerprint(unlike) != plain
    assert fingerprint(replace(er24pc, bounds=EXACT)) != plain  # bounds count always


@pytest.mark.parametrize("kind", [Brake, Contact, DynamicBrake, Pads, Rail, TrackBrake, Vehicle])
def test_records_in_hashes_of_designs_stay_where_they_are(kind):
    assert kind.__module__ == "wspd_design.parameters.records"  # elsewhere every design of a user is outdated
