"""What commands depend on: a wheel that a law overlooks is seen, whatever else it reads."""

from dataclasses import dataclass, replace

import pytest

from tests.certificates.own_laws import BOUND, NOT_BOUND
from tests.certificates.round_trip import keep, no_word_can_be_changed, not_for, refused
from tests.unit.controllers.vehicle_cases import LAWS, protection
from wspd_design.certificates.checks.foundations import feedback
from wspd_design.certificates.records import Status
from wspd_design.certificates.setting.feedback import measured, read_by_commands
from wspd_design.certificates.setting.traced_law import trace
from wspd_design.controllers.observers.sensors import Sensors
from wspd_design.controllers.protected import protected
from wspd_design.controllers.protocol import ByWheelset, Command
from wspd_design.model.number import maximum, minimum, where


@dataclass(frozen=True)
class Overlooks:
    """Slip bands of four wheelsets; the fault: it takes the speed of another wheel for that of one of them."""

    overlooked: int | None = None  # counted from 1
    wheelsets: int = 4
    sample_time: float = 0.02
    slip: float = 0.14
    name: str = "overlooks"

    def start(self, measurement):
        return measurement.wheel_speeds

    def step(self, _state, measurement):
        speeds = list(measurement.wheel_speeds)
        if self.overlooked is not None:
            speeds[self.overlooked - 1] = speeds[self.overlooked % self.wheelsets]
        fastest = speeds[0]
        for each in speeds[1:]:
            fastest = maximum(fastest, each)
        slides = [1.0 - each / maximum(fastest, 0.1) > self.slip for each in speeds]
        commands = tuple(Command(fill=where(each, 0.0, 1.0), vent=where(each, 1.0, 0.0)) for each in slides)
        return measurement.wheel_speeds, commands


@dataclass(frozen=True)
class OnlyLater:
    """A law whose command follows the wheel speed through its memory alone, two samples later."""

    name: str = "later"
    sample_time: float = 0.02

    def start(self, measurement):
        return measurement.wheel_speed, measurement.wheel_speed

    def step(self, state, measurement):
        new, old = state
        return (measurement.wheel_speed, new), Command(fill=minimum(1.0, 0.01 * old), vent=0.0)


@dataclass(frozen=True)
class OnlyAtStart(OnlyLater):
    """A fault: it remembers the first speed for ever."""

    def step(self, state, _measurement):
        new, old = state
        return (new, old), Command(fill=minimum(1.0, 0.01 * old), vent=0.0)


def names(law, wheelset):
    return {each.text for each in read_by_commands(trace(law))[wheelset - 1]}


@pytest.mark.parametrize("wheelset", [1, 3, 4])
def test_an_overlooked_wheel_is_refuted_and_named(make_problem, wheelset):
    kept = keep(feedback.CHECK, make_problem(Overlooks(overlooked=wheelset)))
    found = kept.certificate
    assert found.status is Status.REFUTED
    assert (
        f"The command of wheelset {wheelset} does not depend on how its own wheel turns" in found.explanation
    )
    assert [each.status for each in found.hypotheses[:4]].count(Status.REFUTED) == 1
    no_word_can_be_changed(kept)
    assert not_for(kept, make_problem(Overlooks()))


def test_a_law_that_sees_all_wheels_is_proved(make_problem):
    kept = keep(feedback.CHECK, make_problem(Overlooks()))
    assert kept.certificate.status is Status.PROVED
    assert "They read the speeds of other wheels, too." in kept.certificate.explanation
    no_word_can_be_changed(kept)
    findings = {key: each for key, each in kept.content["findings"].items() if key != "histories, 3"}
    assert refused(kept, findings=findings)
    assert not_for(kept, make_problem(Overlooks(overlooked=3)))


def test_wheels_without_a_brake_may_be_overlooked(make_problem, er24pc):
    brake = replace(er24pc.brake, axle_shares=(1.0, 1.0, 0.0, 1.0))
    found = feedback.CHECK.run(make_problem(Overlooks(overlooked=3), vehicle=replace(er24pc, brake=brake)))
    assert found.status is Status.PROVED


def test_no_protection_is_no_feedback(make_problem, make_controller):
    found = feedback.CHECK.run(make_problem(make_controller("none")))
    assert found.status is Status.REFUTED
    assert "Commands read nothing" in found.explanation


@pytest.mark.parametrize(
    "name", ["afsmc", "smc", "torque-feedback", "trenitalia", "knorr-bremse", "mitsubishi"]
)
def test_laws_of_the_program_follow_their_wheel(make_problem, make_controller, name):
    found = feedback.CHECK.run(make_problem(make_controller(name)))
    assert found.status is Status.PROVED
    assert ("nothing leads to them from torque" in found.explanation) is (name != "torque-feedback")


@pytest.mark.parametrize("name", [*BOUND, *NOT_BOUND])
def test_own_laws_follow_their_wheel(make_problem, name):
    assert feedback.CHECK.run(make_problem((BOUND | NOT_BOUND)[name])).status is Status.PROVED


@pytest.mark.parametrize("law", LAWS)
def test_each_protection_follows_its_wheels(make_problem, er24pc, law):
    assert feedback.CHECK.run(make_problem(protection(er24pc, law))).status is Status.PROVED


def test_a_protection_without_radar_does_not_read_one(er24pc, make_controller):
    law = make_controller("smc", sample_time=0.02)
    blind = protected(law, er24pc, Sensors(speed="wheels", accelerometer=True))
    assert "train speed" not in names(blind, 1)
    assert {"wheel speed 1", "wheel speed 4", "acceleration"} <= names(blind, 1)
    assert "train speed" in names(protected(law, er24pc, Sensors()), 1)


def test_paths_lead_through_the_memory_and_not_through_the_start(make_problem):
    assert feedback.CHECK.run(make_problem(OnlyLater())).status is Status.PROVED
    assert feedback.CHECK.run(make_problem(OnlyAtStart())).status is Status.REFUTED


def test_each_wheelset_by_itself_reads_no_other(make_controller):
    law = ByWheelset(law=make_controller("trenitalia"), wheelsets=4)
    assert names(law, 2) == {"train speed", "wheel speed 2"}
    assert len(measured(trace(law))) == 5 * 4 + 3


def test_a_law_that_cannot_be_traced_says_so(make_problem):
    class Branches(OnlyLater):
        def step(self, state, measurement):
            if measurement.wheel_speed > 1.0:
                return state, Command(fill=1.0, vent=0.0)
            return state, Command(fill=0.0, vent=1.0)

    found = feedback.CHECK.run(make_problem(Branches()))
    assert found.status is Status.NOT_APPLICABLE
    assert "cannot be traced" in found.explanation
