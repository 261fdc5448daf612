"""A theorem speaks about the step that runs: edited steps are told apart, and the memory of a law is differentiated."""

from dataclasses import dataclass, fields, replace
from types import SimpleNamespace

import pytest

from wspd_design.certificates.setting.traced_law import law_of_theorem, memory, same_function, trace
from wspd_design.certificates.theorems.valve import integrals_of_slip
from wspd_design.controllers.adaptive_fuzzy import AdaptiveFuzzy
from wspd_design.controllers.family import FAMILIES
from wspd_design.controllers.protocol import Command, pulse_width
from wspd_design.controllers.sliding_mode import SlidingMode
from wspd_design.controllers.torque_feedback import TorqueFeedback
from wspd_design.design.catalog import controller
from wspd_design.design.problem import stability_problem
from wspd_design.design.records import Specification
from wspd_design.model.number import clip, exp, where
from wspd_design.parameters.loading import load_rail

LAWS = {"afsmc": AdaptiveFuzzy, "smc": SlidingMode, "torque-feedback": TorqueFeedback}
SPECIFICATION = Specification(sample_time=0.02)


@pytest.fixture(scope="module")
def made(er24pc):
    rail = load_rail("polach-wet")
    return {name: controller(name, er24pc, rail, SPECIFICATION) for name in FAMILIES}


@pytest.fixture(scope="module")
def problem_of(er24pc):
    return lambda law: stability_problem(er24pc, load_rail("polach-wet"), law, SPECIFICATION)


def as_class(law, kind):
    return kind(**{field.name: getattr(law, field.name) for field in fields(law)})


@pytest.mark.parametrize("name", FAMILIES)
@pytest.mark.parametrize("family", LAWS)
def test_a_theorem_speaks_about_the_laws_of_its_family_alone(made, problem_of, name, family):
    reason = law_of_theorem(problem_of(made[name]), family)
    assert (reason is None) is (name == family)


@pytest.mark.parametrize("dead_zone", [False, True])
@pytest.mark.parametrize("hold", [False, True])
@pytest.mark.parametrize("scheduled", [False, True])
def test_every_form_of_the_adaptive_law_is_recognized(made, problem_of, dead_zone, hold, scheduled):
    law = made["afsmc"]
    gains = replace(
        law.gains, dead_zone=dead_zone, hold_when_saturated=hold, scheduled_rates=scheduled, weight_rate=7.3
    )
    assert law_of_theorem(problem_of(replace(law, gains=gains)), "afsmc") is None
    # The same gains with another of the three switches are another law.
    other = replace(gains, scheduled_rates=not scheduled)
    assert not same_function(trace(replace(law, gains=gains)), trace(replace(law, gains=other)))


@pytest.mark.parametrize("name", LAWS)
def test_a_subclass_that_changes_nothing_is_the_law(made, problem_of, name):
    renamed = replace(as_class(made[name], type("Mine", (LAWS[name],), {})), name="mine")
    assert law_of_theorem(problem_of(renamed), name) is None


def full_brake(_self, state, _measurement):
    return state, Command(fill=1.0, vent=0.0)


def slightly(self, state, measurement):
    following, command = LAWS[self.name].step(self, state, measurement)
    return following, Command(fill=command.fill * (1.0 - 1e-15), vent=command.vent)


def without_digits(self, state, measurement):
    """The same function of real numbers, and another one in doubles: the duty is lost."""
    following, command = LAWS[self.name].step(self, state, measurement)
    return following, Command(fill=(2.0 * (command.fill + 1e30) - 2e30) / 2.0, vent=command.vent)


def sometimes(self, state, measurement):
    following, command = LAWS[self.name].step(self, state, measurement)
    return following, Command(fill=where(measurement.speed > 1e3, 1.0, command.fill), vent=command.vent)


def forgetful(self, state, measurement):
    following, command = LAWS[self.name].step(self, state, measurement)
    return (0.5 * following[0], *following[1:]), command


STEPS = [(name, step) for name in LAWS for step in (full_brake, slightly, without_digits, sometimes)]


@pytest.mark.parametrize(("name", "step"), [*STEPS, ("afsmc", forgetful), ("smc", forgetful)])
def test_a_subclass_with_another_step_inherits_no_theorem(made, problem_of, name, step):
    mine = as_class(made[name], type("Mine", (LAWS[name],), {"step": step}))
    assert "is not the" in law_of_theorem(problem_of(mine), name)


@pytest.mark.parametrize("name", LAWS)
def test_an_edited_class_inherits_no_theorem(made, problem_of, name, monkeypatch):
    monkeypatch.setattr(LAWS[name], "step", full_brake)
    assert "is not the" in law_of_theorem(problem_of(made[name]), name)


@pytest.mark.parametrize("name", LAWS)
def test_a_wrapper_with_the_same_attributes_inherits_no_theorem(made, problem_of, name):
    law = made[name]
    kept = {
        key: getattr(law, key, None) for key in ("gains", "vehicle", "rail", "wheel_radius", "max_torque")
    }
    wrapper = SimpleNamespace(name=name, sample_time=law.sample_time, start=law.start, step=law.step, **kept)
    assert law_of_theorem(problem_of(wrapper), name) is None
    wrapper.step = lambda state, _: (state, Command(fill=1.0, vent=0.0))
    assert "is not the" in law_of_theorem(problem_of(wrapper), name)


def test_another_start_is_another_law(made, problem_of):
    mine = type("Mine", (AdaptiveFuzzy,), {"start": lambda _self, _: (1.0, *([0.0] * 6))})
    assert "is not the" in law_of_theorem(problem_of(as_class(made["afsmc"], mine)), "afsmc")


def test_gains_that_the_step_does_not_use_are_told_apart(made, problem_of):
    law = made["smc"]
    other = replace(law, gains=replace(law.gains, switching_gain=2.0 * law.gains.switching_gain))
    lying = SimpleNamespace(
        name="x",
        sample_time=0.02,
        start=law.start,
        step=law.step,
        gains=other.gains,
        vehicle=law.vehicle,
        rail=law.rail,
    )
    assert "is not the" in law_of_theorem(problem_of(lying), "smc")


def test_a_step_that_cannot_be_traced_is_no_law_of_a_theorem(made, problem_of):
    def branching(_self, state, measurement):
        return state, Command(fill=1.0 if measurement.speed > 3.0 else 0.0, vent=0.0)

    mine = as_class(made["smc"], type("Mine", (SlidingMode,), {"step": branching}))
    assert "cannot be traced" in law_of_theorem(problem_of(mine), "smc")


@dataclass(frozen=True)
class OwnLaw:
    """A law by its start and its step."""

    begin: tuple
    rule: object
    name: str = "own"
    sample_time: float = 0.02

    def start(self, _):
        return self.begin

    def step(self, state, m):
        return self.rule(state, m)


def sliding(m):
    return 0.14 * m.speed - (m.speed - 0.55 * m.wheel_speed)


def proportional_integral(state, m):
    (total,) = state
    return (total + 0.02 * sliding(m),), pulse_width(clip(0.3 + 2.0 * sliding(m) + total, 0.0, 1.0))


def lead_filter(state, m):
    (filtered,) = state
    demand = 0.3 + 10.0 * (sliding(m) - filtered)
    return (filtered + 0.02 * 5.0 * (sliding(m) - filtered),), pulse_width(clip(demand, 0.0, 1.0))


def valve_copy(state, m):
    torque, time = state
    duty = clip(0.3 + 14.0 * sliding(m) - 29.0 * torque, 0.0, 1.0)
    decay = exp(-0.02 / 0.6)
    return (torque * decay + duty * (1.0 - decay), time + 0.02), pulse_width(duty)


def previous_speed(state, m):
    (before,) = state
    return (m.wheel_speed,), pulse_width(clip(m.wheel_speed - before, 0.0, 1.0))


def swapped(state, m):
    """Two elements that pass each other on: a delay without anything on the diagonal but the ones of the sums."""
    one, two = state
    return (one - two, two + one + m.speed), pulse_width(clip(one, 0.0, 1.0))


def limited_integral(state, m):
    (total,) = state
    return (clip(total + 0.02 * sliding(m), -1.0, 1.0),), pulse_width(clip(total, 0.0, 1.0))


def switched_integral(state, m):
    (total,) = state
    following = where(m.speed > 5.0, total + 0.02 * sliding(m), total)
    return (following,), pulse_width(clip(total, 0.0, 1.0))


def torque_threshold(state, m):
    return state, Command(fill=where(m.torque > 1e4, 0.0, 1.0), vent=0.0)


def torque_remembered(state, m):
    (total,) = state
    return (total + 1e-5 * m.torque,), pulse_width(clip(1.0 - total, 0.0, 1.0))


KNOWN = {
    "integral": ((0.0,), proportional_integral, True, False),
    "integral that is held": ((0.0,), switched_integral, True, False),
    "lead filter": ((0.0,), lead_filter, False, False),
    "copy of the valve": ((0.0, 0.0), valve_copy, False, False),
    "previous wheel speed": ((0.0,), previous_speed, False, False),
    "elements in a circle": ((0.0, 0.0), swapped, False, False),
    "limited integral": ((0.0,), limited_integral, False, False),
    "torque in a comparison": ((), torque_threshold, True, True),
    "integral of the torque": ((0.0,), torque_remembered, True, True),
}


@pytest.mark.parametrize("name", KNOWN)
def test_memory_of_known_laws(problem_of, name):
    begin, rule, integrals, torque = KNOWN[name]
    law = OwnLaw(begin=begin, rule=rule)
    found = memory(law)
    assert found.integrals_alone is integrals
    assert (found.command_reads_torque or found.memory_reads_torque) is torque
    assert (integrals_of_slip(problem_of(law)) == "") is (integrals and not torque)


def test_only_the_copy_of_the_valve_has_dynamics_not_the_clock():
    found = memory(OwnLaw(begin=(0.0, 0.0), rule=valve_copy))
    assert found.own_dynamics == ("element 1 of the state",)


@pytest.mark.parametrize(
    ("name", "bound"),
    [
        ("afsmc", True),
        ("smc", True),
        ("torque-feedback", False),
        ("trenitalia", False),
        ("knorr-bremse", False),
        ("mitsubishi", False),
        ("none", True),
    ],
)
def test_which_laws_the_valve_binds(made, problem_of, name, bound):
    assert (integrals_of_slip(problem_of(made[name])) == "") is bound


@pytest.mark.parametrize(
    "changes", [{"dead_zone": True}, {"hold_when_saturated": True}, {"scheduled_rates": True}]
)
def test_adapted_weights_are_integrals(made, changes):
    law = made["afsmc"]
    found = memory(replace(law, gains=replace(law.gains, **changes)))
    assert found.integrals_alone
    assert found.names[0] == "integral of the slip error"
    assert len(found.names) == len(law.start(None))


def test_what_cannot_be_traced_is_undecided(problem_of):
    law = OwnLaw(begin=(0.0,), rule=lambda state, m: (state, pulse_width(1.0 if m.speed > 3.0 else 0.0)))
    assert "cannot be traced" in memory(law)
    assert "cannot be traced" in integrals_of_slip(problem_of(law))


def test_fingerprint_of_a_step_sees_a_constant(made):
    law = made["smc"]
    nearly = replace(law, gains=replace(law.gains, switching_gain=law.gains.switching_gain * (1.0 + 2**-52)))
    assert trace(law).fingerprint() == trace(replace(law)).fingerprint() != trace(nearly).fingerprint()
