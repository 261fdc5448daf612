"""Small deviations of the step that runs, against the loops that are known by other means."""

from dataclasses import dataclass, replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tests.certificates.own_laws import NOT_BOUND, OwnLaw, held_share, sliding
from tests.certificates.round_trip import keep, no_word_can_be_changed, not_for
from tests.unit.controllers.vehicle_cases import protection
from wspd_design.certificates.checks.linear import margins, traced_loop
from wspd_design.certificates.records import Status
from wspd_design.certificates.setting.traced_law import trace
from wspd_design.certificates.setting.traced_loop import NoRest, Rest, TracedLoop, _one_sample
from wspd_design.certificates.theorems.traced_loop import speeds
from wspd_design.controllers.protocol import ByWheelset, Command
from wspd_design.model.brake import pattern_pressure
from wspd_design.model.number import sqrt, where
from wspd_design.model.slip import slip_dynamics

WET = "polach-wet"


def rests(problem):
    loop = TracedLoop(problem, trace(problem.controller))
    return [loop.rest(speed) for speed in speeds(problem)]


@pytest.mark.parametrize(("name", "near"), [("afsmc", 1e-3), ("smc", 1e-3)])
@pytest.mark.parametrize("rail", [WET, "polach-dry"])
def test_poles_are_those_of_the_written_loop(make_problem, make_controller, name, near, rail):
    """Both linearize the same loop, one from formulas of the law, the other from its graph."""
    problem = make_problem(make_controller(name, rail), rail=rail)
    for found in rests(problem):
        assert isinstance(found, Rest)
        assert found.slip == pytest.approx(0.14, abs=1e-6)
        written = margins.loop(problem, found.speed, sample_time=problem.sample_time)
        known = np.abs(np.linalg.eigvals(written.A - written.B @ written.C)).max()
        assert found.radius == pytest.approx(known, rel=near)


def test_margins_are_those_of_the_written_loop(make_problem, make_controller):
    problem = make_problem(
        make_controller("torque-feedback", WET, sample_time=0.05), rail=WET, sample_time=0.05
    )
    found = rests(problem)[-1]
    known = margins.margins(margins.loop(problem, found.speed, sample_time=problem.sample_time))
    here = traced_loop.margins_at(found, problem.sample_time)
    for name in ("gain_up", "phase", "delay", "disk"):
        assert getattr(here, name) == pytest.approx(getattr(known, name), rel=0.03), name


@pytest.mark.parametrize(("fill", "vent"), [(0.3, 0.5), (0.0, 1.0), (0.0, 0.0), (1.0, 0.0)])
def test_a_sample_is_that_of_the_valve_and_of_the_slip_equation(make_problem, make_controller, fill, vent):
    import casadi as ca

    problem = make_problem(make_controller("smc", WET), rail=WET)
    vehicle, h, speed, slip, share = problem.vehicle, problem.sample_time, 15.0, 0.12, 0.4
    plant = slip_dynamics(vehicle, problem.rail, slip, speed)
    numbers = (ca.SX(float(each)) for each in (speed, plant.pole, slip, share, fill, vent))
    after, foot = (float(ca.DM(ca.evalf(each))) for each in _one_sample(problem, *numbers))
    brake, late = vehicle.brake, 1e3

    def pressure(time):
        times = late + fill * h, late + (fill + vent) * h
        return float(
            pattern_pressure(
                brake, late + time, (late, share * brake.max_pressure, *times, brake.max_pressure)
            )[0]
        )

    def rate(time, state):
        torque = brake.max_torque * pressure(time) / brake.max_pressure
        return [plant.drift + plant.pole * (state[0] - slip) + plant.gain * torque]

    run = solve_ivp(rate, (0.0, h), [slip], rtol=1e-10, atol=1e-12, max_step=h / 200)
    assert foot == pytest.approx(pressure(h) / brake.max_pressure, rel=1e-9)
    assert after == pytest.approx(run.y[0, -1], rel=1e-6)


def proportional(sign):
    """Feedback of the sliding speed about the torque that holds the reference; ``sign`` = -1 plants the fault."""
    return OwnLaw(rule=lambda state, m: (state, held_share(m.speed) + sign * 0.3 * sliding(m)), elements=0)


def test_an_own_law_is_judged_by_its_step(make_problem, fast_vehicle):
    kept = keep(traced_loop.CHECK, make_problem(proportional(1.0), sample_time=0.02, vehicle=fast_vehicle))
    assert kept.certificate.status is Status.EVIDENCE
    assert "It rests at 9 of 9 speeds" in kept.certificate.explanation
    assert "disk margin" in kept.certificate.explanation
    no_word_can_be_changed(kept)


def test_the_wrong_sign_is_refuted_and_its_witness_is_worked_out_again(make_problem, fast_vehicle):
    wrong = make_problem(proportional(-1.0), sample_time=0.02, vehicle=fast_vehicle)
    kept = keep(traced_loop.CHECK, wrong)
    assert kept.certificate.status is Status.REFUTED
    assert kept.certificate.witness[-1].value > 1.0
    no_word_can_be_changed(kept)
    assert not_for(kept, make_problem(proportional(1.0), sample_time=0.02, vehicle=fast_vehicle))


def test_a_law_of_the_vehicle_has_the_poles_of_each_wheelset(make_problem, make_controller):
    law = make_controller("smc", WET)
    alone = rests(make_problem(law, rail=WET))[3]
    together = rests(make_problem(ByWheelset(law=law, wheelsets=4), rail=WET))[3]
    assert len(together.poles) == 4 * len(alone.poles)
    assert np.sort(np.abs(together.poles))[-1] == pytest.approx(np.abs(alone.poles).max(), rel=1e-9)
    one, other = (traced_loop.margins_at(each, 0.1) for each in (alone, together))
    assert one.stable is other.stable


@dataclass(frozen=True)
class Relay:
    """Full on below the reference, full off above it."""

    name: str = "relay"
    sample_time: float = 0.02
    dead: float = 0.0  # m/s, within which it holds

    def start(self, _):
        return ()

    def step(self, state, m):
        error = sliding(m)
        fill, vent = where(error > self.dead, 1.0, 0.0), where(error < -self.dead, 1.0, 0.0)
        return state, Command(fill=fill, vent=vent)


def kinked(state, m):
    """An integral, so that it rests at the reference, and twice the gain on one side of it."""
    (total,) = state
    error = sliding(m)
    return (total + 0.02 * error,), held_share(m.speed) + where(error > 0.0, 0.2, 0.1) * error + total


@pytest.mark.parametrize(
    ("law", "said"),
    [
        (Relay(dead=0.5), "at 9 of 9 speeds it rests with commands that answer no small deviation"),
        (OwnLaw(rule=kinked, elements=1), "at 9 of 9 speeds it switches where it rests"),
        (NOT_BOUND["copy of the valve"], "element 2 of the state moves on from sample to sample"),
    ],
)
def test_where_small_deviations_say_nothing_a_sentence_says_why(make_problem, fast_vehicle, law, said):
    found = traced_loop.CHECK.run(make_problem(law, sample_time=0.02, vehicle=fast_vehicle))
    assert found.status is Status.NOT_APPLICABLE
    assert said in found.explanation
    assert found.explanation.startswith(f"{law.name} has no small deviations to speak of near slip 0.14")


@pytest.mark.parametrize("name", ["trenitalia", "knorr-bremse", "mitsubishi", "none"])
def test_rules_of_the_industry_have_no_small_deviations(make_problem, make_controller, name):
    found = traced_loop.CHECK.run(make_problem(make_controller(name), rail=WET))
    assert found.status is Status.NOT_APPLICABLE
    assert found.explanation.count(". ") == 0


def test_a_protection_that_holds_its_valves_says_so(make_problem, er24pc):
    found = traced_loop.CHECK.run(
        make_problem(protection(er24pc, "observer-smc"), rail=WET, sample_time=0.02)
    )
    assert found.status is Status.NOT_APPLICABLE


def test_what_the_brake_does_not_have_is_named(make_problem, make_controller, er24pc):
    weak = replace(er24pc, brake=replace(er24pc.brake, max_torque=5e3))
    problem = make_problem(make_controller("trenitalia"), rail=WET, vehicle=weak)
    found = rests(problem)
    assert all(
        isinstance(each, NoRest) and "torque that the brake does not have" in each.reason for each in found
    )


def test_numbers_that_are_not_finite_are_named(make_problem, fast_vehicle):
    def breaks(state, m):
        return state, held_share(m.speed) + sqrt(m.speed - 200.0)

    @dataclass(frozen=True)
    class Breaks(OwnLaw):
        """Without a limit in which a number that is not finite could get lost."""

        def step(self, state, m):
            following, duty = self.rule(state, m)
            return following, Command(fill=duty, vent=1.0 - duty)

    law = Breaks(rule=breaks, elements=0)
    found = traced_loop.CHECK.run(make_problem(law, sample_time=0.02, vehicle=fast_vehicle))
    assert found.status is Status.NOT_APPLICABLE
    assert "it gives a number that is not finite" in found.explanation
