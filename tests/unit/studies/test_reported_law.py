"""What a report knows about a law before anything is computed."""

from dataclasses import dataclass

import pytest

from wspd_design.controllers.observers.sensors import Sensors
from wspd_design.controllers.protected import protected
from wspd_design.controllers.protocol import Command
from wspd_design.studies.reported_law import reported_law


@dataclass(frozen=True)
class Branches:
    """A law that only Python can run."""

    name: str = "branches"
    sample_time: float = 0.02

    def start(self, _):
        return ()

    def step(self, state, measurement):
        return state, Command(fill=1.0 if measurement.wheel_speed > 1.0 else 0.0, vent=0.0)


def test_what_commands_read_decides_whether_the_law_is_told_the_speed(er24pc, make_controller):
    law = make_controller("smc", sample_time=0.02)
    assert reported_law(law, None, written="smc").told_speed
    blind = protected(law, er24pc, Sensors(speed="wheels", accelerometer=True))
    found = reported_law(blind, None, written="smc")
    assert not found.told_speed
    assert "acceleration" in found.reads
    assert reported_law(make_controller("none"), None, written="none").reads == ()


def test_of_a_law_that_cannot_be_traced_the_speed_counts_as_told():
    found = reported_law(Branches(), None, written="")
    assert (found.reads, found.told_speed) == (None, True)
    assert (found.own, found.called, found.origin) == (True, "", "made in Python")


@pytest.mark.parametrize(
    ("written", "called", "own"),
    [
        ("folder/mine.py:Mine", "mine.py:Mine", True),
        ("trenitalia:textbook", "trenitalia:textbook", False),
        ("none", "none", False),
    ],
)
def test_what_commands_call_a_law(make_controller, written, called, own):
    found = reported_law(make_controller("trenitalia"), None, written=written)
    assert (found.called, found.own) == (called, own)
