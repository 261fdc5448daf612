"""Laws that let the brake go before the train stands are told so, with the speed; laws that hold it are not."""

import math
from dataclasses import dataclass, replace

import numpy as np
import pytest

from wspd_design.controllers.protocol import Command
from wspd_design.model.number import where
from wspd_design.parameters.loading import load_rail
from wspd_design.simulation.metrics import metrics
from wspd_design.simulation.records import Scenario
from wspd_design.simulation.released import SHARE, SHORTEST, released_below, released_sentence
from wspd_design.simulation.runs import Ending
from wspd_design.simulation.stop import simulate

START = 30.0 / 3.6


@dataclass(frozen=True)
class Releasing:
    """Vent below a speed, fill above it."""

    below: float
    sample_time: float = 0.02
    name: str = "releasing"

    def start(self, measurement):  # noqa: ARG002 - remembers nothing
        return ()

    def step(self, state, measurement):  # noqa: ARG002 - remembers nothing
        vent = where(measurement.speed < self.below, 1.0, 0.0)
        return (), Command(fill=1.0 - vent, vent=vent)


@pytest.fixture(scope="module")
def gentle(er24pc):
    """Return a locomotive whose brake cannot slide."""
    return replace(er24pc, brake=replace(er24pc.brake, max_torque=7e3))


def judged(vehicle, law, rail="polach-wet", **changes):
    stop = Scenario(rail=load_rail(rail), initial_speed=START, **changes)
    return simulate(vehicle, law, stop), stop


def test_the_speed_is_that_at_which_the_torque_is_gone(gentle):
    run, stop = judged(gentle, Releasing(below=3.0))
    found = released_below(run, gentle, stop)
    torque = run.torque.mean(axis=1) / gentle.brake.max_torque
    last = np.flatnonzero(torque >= SHARE)[-1]
    assert run.speed[last + 1] == found
    assert 0.0 < found < 3.0
    assert metrics(run, gentle, stop, slip_reference=0.14).released_below == found


def test_a_law_that_never_brakes_released_it_at_the_start(gentle):
    run, stop = judged(gentle, Releasing(below=100.0), grade=0.002)
    assert released_below(run, gentle, stop) == pytest.approx(START)


def test_the_coast_to_the_time_limit_is_told(gentle):
    run, stop = judged(gentle, Releasing(below=1.0), grade=-0.005)
    assert run.ending is not Ending.STOPPED
    assert 0.0 < released_below(run, gentle, stop) < 1.0


@pytest.mark.parametrize("rail", ["polach-dry", "polach-wet", "low-adhesion"])
@pytest.mark.parametrize("name", ["none", "trenitalia", "torque-feedback", "afsmc"])
def test_a_brake_that_is_held_is_not_released(er24pc, make_controller, name, rail):
    """Locked wheels, and wheels on rails of little adhesion, do not look like a released brake."""
    run, stop = judged(er24pc, make_controller(name, rail=rail), rail)
    assert run.ending is Ending.STOPPED
    assert math.isnan(released_below(run, er24pc, stop))


def test_a_release_shorter_than_a_second_is_none(gentle):
    run, stop = judged(gentle, Releasing(below=0.05))
    torque = run.torque.mean(axis=1) / gentle.brake.max_torque
    gone = run.time[-1] - run.time[np.flatnonzero(torque >= SHARE)[-1]]
    assert gone < SHORTEST
    assert math.isnan(released_below(run, gentle, stop))


def test_the_sentence_names_law_and_speed():
    assert released_sentence([("none", math.nan)]) == ""
    said = released_sentence([("none", math.nan), ("mine", 0.25)])
    assert said.startswith("The brake was released by mine below v = 0.9 km/h")
