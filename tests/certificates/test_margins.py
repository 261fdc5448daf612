"""Gain, phase, delay and disk margin against what happens when one uses them up."""

import json
import math
from dataclasses import replace

import control
import numpy as np
import pytest
from scipy.linalg import expm

from tests.attack.case import read_data
from tests.attack.plant import gain as attacker_gain
from tests.attack.plant import holding_torque, slip_pole
from tests.certificates.round_trip import forgeries, keep, no_word_can_be_changed, not_for, refused
from wspd_design.certificates.checks.linear import margins
from wspd_design.certificates.records import Status
from wspd_design.certificates.replay import replay
from wspd_design.certificates.setting.linear_loop import loop_at, outermost, variables
from wspd_design.certificates.theorems import linear
from wspd_design.controllers.protocol import Measurement
from wspd_design.model.slip import slip_dynamics
from wspd_design.parameters.bounds import EXACT


def in_control(*arguments, **named):
    """Return a loop as python-control's."""
    opened = margins.loop(*arguments, **named)
    return control.ss(*opened[:3], 0.0, opened.dt)


def test_known_loop():
    """4/(s (s + 1) (s + 3)): gain margin 3 at sqrt(3) rad/s; the phase margin follows from its own crossing."""
    opened = control.tf([4.0], np.polymul([1.0, 0.0], np.polymul([1.0, 1.0], [1.0, 3.0])))
    found = margins.margins(control.ss(opened))
    assert found.stable
    assert found.gain_up == pytest.approx(3.0, rel=1e-9)
    crossing = next(w for w in np.linspace(0.9, 1.2, 300_001) if abs(opened(1j * w)) <= 1.0)
    phase = math.pi - math.pi / 2.0 - math.atan(crossing) - math.atan(crossing / 3.0)
    assert found.phase == pytest.approx(phase, rel=1e-4)
    assert found.delay == pytest.approx(phase / crossing, rel=1e-4)


def unstable_below(opened):
    """First factor under 1 at which the closed loop is unstable, from its poles."""
    numerator, denominator = opened.num[0][0], opened.den[0][0]
    factors = np.geomspace(1.0, 1e-3, 3001)
    stable = [np.all(np.roots(np.polyadd(f * numerator, denominator)).real < 0.0) for f in factors]
    assert stable[0]
    changes = np.flatnonzero(np.diff(stable))
    return float(factors[changes[0]]), len(changes)


@pytest.mark.parametrize("zero", [1.0, 2.0])
def test_the_nearest_of_two_lower_gain_margins_counts(zero):
    """(s + z)^2/((s + 0.1)^3 (0.02 s + 1)) is unstable between two factors below 1; the larger one ends the margin."""
    lag = np.polymul(np.polymul([1.0, 0.1], [1.0, 0.1]), np.polymul([1.0, 0.1], [0.02, 1.0]))
    opened = control.tf(np.polymul([1.0, zero], [1.0, zero]), lag)
    factor, changes = unstable_below(opened)
    assert changes == 2
    assert margins.margins(control.ss(opened)).gain_down == pytest.approx(factor, rel=3e-3)


def balanced_peak(opened, low, high):
    """Largest abs(S - 1/2) of a loop on a grid of frequencies [rad/s] that is made finer around its peak."""
    for _ in range(4):
        frequencies = np.geomspace(low, high, 2001)
        at = np.exp(1j * frequencies * opened.dt) if opened.dt else 1j * frequencies
        peaks = np.abs(1.0 / (1.0 + opened(at)) - 0.5)
        middle = int(peaks.argmax())
        low, high = frequencies[max(middle - 2, 0)], frequencies[min(middle + 2, 2000)]
    return peaks.max()


@pytest.mark.parametrize("factor", [0.1, 0.5, 0.79, 0.7999])
def test_disk_margin_is_the_peak_of_the_balanced_sensitivity(factor):
    """Also where the loop is hardly damped: it is unstable from the factor 0.8 on."""
    opened = control.ss(control.tf([10.0], [1.0, 3.0, 3.0, 1.0])) * factor
    expected = 1.0 / balanced_peak(opened, 1e-2, 1e2)
    assert margins.margins(opened).disk == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize(("name", "sample_time"), [("smc", 0.005), ("torque-feedback", 0.02)])
def test_disk_margin_over_speed(make_problem, make_controller, name, sample_time):
    """Margins below 0.01 belong to peaks that are narrower than a grid of some hundred frequencies."""
    problem = make_problem(make_controller(name, "polach-wet"), rail="polach-wet")
    loops = [
        in_control(problem, float(speed), sample_time=sample_time)
        for speed in np.geomspace(*problem.speeds, 13)
    ]
    found = [(opened, margins.margins(opened)) for opened in loops]
    stable = [(opened, each.disk) for opened, each in found if each.stable]
    for opened, disk in stable:
        highest = math.pi / sample_time if sample_time else 1e3
        assert disk == pytest.approx(1.0 / balanced_peak(opened, 1.0, highest), rel=1e-6)
    assert len(stable) > 1
    assert (min(disk for _, disk in stable) < 0.01) is (name == "smc")


def test_the_printed_law_has_no_margin_at_any_speed(make_problem, make_controller):
    """Audit M1: with its adaptation; with held weights it looked stable on the wet rail."""
    problem = make_problem(make_controller("afsmc", "polach-wet"), rail="polach-wet")
    for speed in np.geomspace(*problem.speeds, 13):
        assert not margins.margins(in_control(problem, float(speed))).stable


def test_gain_and_phase_at_the_edge_of_the_disk(problem):
    """A factor on the rim of the disk makes the loop unstable, a little inside none does."""
    opened = in_control(problem, 12.0, sample_time=0.02)
    disk = margins.margins(opened).disk
    for size, unstable in ((1.001 * disk, True), (0.999 * disk, False)):
        turns = size * np.exp(1j * np.linspace(0.0, 2.0 * np.pi, 721))
        factors = (1.0 + turns / 2.0) / (1.0 - turns / 2.0)
        closed = [opened.A - factor * opened.B @ opened.C for factor in factors]
        assert (np.abs(np.linalg.eigvals(closed)).max() > 1.0) is np.bool_(unstable)


@pytest.mark.parametrize("sample_time", [None, 0.02])
def test_gain_and_phase_margins_are_those_of_python_control(problem, sample_time):
    """Stable at all speeds; python-control takes the transfer function apart."""
    compared = 0
    for speed in np.geomspace(*problem.speeds, 7):
        opened = in_control(problem, float(speed), sample_time=sample_time)
        found = margins.margins(opened)
        gains, phases, _, _, crossings, _ = control.stability_margins(opened, returnall=True)
        ends = [opened(z, warn_infinite=False).real for z in ((1.0, -1.0) if sample_time else (0.0,))]
        factors = [*gains, *(-1.0 / end for end in ends if -np.inf < end < 0.0)]
        lags = np.radians(np.mod(phases, 360.0))
        up = min((f for f in factors if f > 1.0), default=margins.MOST_GAIN)
        down = max((f for f in factors if f < 1.0), default=1.0 / margins.MOST_GAIN)
        assert found.gain_up == pytest.approx(min(up, margins.MOST_GAIN), rel=1e-6)
        assert found.gain_down == pytest.approx(max(down, 1.0 / margins.MOST_GAIN), rel=1e-6)
        assert found.phase == pytest.approx(min([np.pi, *np.minimum(lags, 2.0 * np.pi - lags)]), rel=1e-6)
        assert found.delay == pytest.approx(min([margins.MOST_DELAY, *(lags / crossings)]), rel=1e-6)
        compared += len(phases)
    assert compared > 3


@pytest.fixture(scope="module")
def problem(make_problem, make_controller):
    return make_problem(make_controller("torque-feedback"))


@pytest.mark.parametrize("sample_time", [None, 0.02])
@pytest.mark.parametrize("speed", [3.0, 25.0])
def test_gain_margin_is_where_the_loop_becomes_unstable(problem, sample_time, speed):
    opened = in_control(problem, speed, sample_time=sample_time)
    found = margins.margins(opened)
    assert found.stable
    for factor, side in ((found.gain_up, 1.0), (found.gain_down, -1.0)):
        if factor in (margins.MOST_GAIN, 1.0 / margins.MOST_GAIN):
            continue
        assert margins.margins(opened * (factor * (1.0 - 1e-3 * side))).stable
        assert not margins.margins(opened * (factor * (1.0 + 1e-3 * side))).stable


def pulses(pole, gain, limit, fill, vent, duty, span):
    """Transition of (error, share of T_max, 1) over a sample of filling and then venting."""
    found = np.eye(3)
    for part, aim, time in ((duty, 1.0, fill), (1.0 - duty, 0.0, vent)):
        rates = [[pole, -gain * limit, 0.0], [0.0, -1.0 / time, aim / time], [0.0, 0.0, 0.0]]
        found = expm(np.array(rates) * part * span) @ found
    return found


@pytest.mark.parametrize(("fill", "vent"), [(0.6, 0.6), (0.4, 0.4), (0.6, 0.3)])
def test_sampled_loop_is_the_law_between_samples(problem, fill, vent):
    """Differences of one sample with its pulses, by exponentials of matrices; unlike times are enclosed only."""
    speed, span = 12.0, 0.02
    brake = replace(problem.vehicle.brake, fill_time=fill, vent_time=vent)
    vehicle = replace(problem.vehicle, brake=brake)
    changed = replace(problem, vehicle=vehicle, bounds=EXACT)
    opened = in_control(changed, speed, sample_time=span)
    closed = np.sort_complex(control.feedback(opened, 1).poles())
    plant = read_data("er24pc", "polach-dry").plant
    pole, gain = float(slip_pole(plant, 0.14, speed)), float(attacker_gain(plant, speed))
    limit = 60e3
    share = float(holding_torque(plant, 0.14, speed)) / limit
    duty = share * fill / ((1.0 - share) * vent + share * fill)
    kept = pulses(pole, gain, limit, fill, vent, duty, span)
    foot = kept[1, 2] / (1.0 - kept[1, 1])  # of the course that repeats itself
    gains = problem.controller.linear_form(speed)

    def after(error, torque):
        moved = gains.proportional / limit * error - gains.torque * torque
        start = np.array([error, foot + torque, 1.0])
        return (pulses(pole, gain, limit, fill, vent, duty + moved, span) @ start)[:2]

    step = 1e-6
    columns = [(after(*(step * unit)) - after(*(-step * unit))) / (2.0 * step) for unit in np.eye(2)]
    expected = np.sort_complex(np.linalg.eigvals(np.array(columns).T))
    assert closed == pytest.approx(expected, rel=1e-5 if fill == vent else 1e-2)


@pytest.fixture(scope="module")
def good(make_problem, make_controller):
    return keep(
        margins.CHECK, make_problem(make_controller("torque-feedback", "polach-wet"), rail="polach-wet")
    )


@pytest.fixture(scope="module")
def bad(make_problem, make_controller):
    return keep(margins.CHECK, make_problem(make_controller("afsmc")))


def test_verdicts(make_problem, make_controller, good, bad):
    assert good.certificate.status is Status.EVIDENCE
    assert 0.3 < good.certificate.margin.high < 2.0
    assert bad.certificate.status is Status.REFUTED
    assert bad.certificate.witness
    found = margins.CHECK.run(make_problem(make_controller("trenitalia")))
    assert found.status is Status.NOT_APPLICABLE


@pytest.mark.parametrize("vent", [0.1, 0.4])
def test_a_brake_without_the_torque_of_the_reference_is_not_judged(make_problem, make_controller, vent):
    """With a fast fill and a slow vent the averaged valve had a rate below zero, and the loop was refuted exactly."""
    problem = make_problem(make_controller("torque-feedback", "polach-wet"), rail="polach-wet")
    torque = max(float(linear.holding_torque(problem, v)) for v in np.geomspace(*problem.speeds, 25))
    own = problem.vehicle
    for share, status in ((1.001, None), (0.999, Status.NOT_APPLICABLE)):
        brake = replace(own.brake, max_torque=share * torque, fill_time=0.1, vent_time=vent, bounds=EXACT)
        other = replace(own, brake=brake)
        law = replace(problem.controller, vehicle=other)
        found = margins.CHECK.run(replace(problem, vehicle=other, controller=law))
        assert (found.status is Status.NOT_APPLICABLE) == (status is Status.NOT_APPLICABLE)
    assert f"and the brake of er24pc has {0.999 * torque:.4g} N m" in found.explanation


def test_words_of_evidence_and_of_a_refutation(good, bad):
    no_word_can_be_changed(good)
    no_word_can_be_changed(bad)


@pytest.mark.parametrize("number", ["-0.5", "0.0"])
def test_gains_of_which_no_sentence_can_be_made_are_refused(good, number):
    findings = json.loads(json.dumps(good.content["findings"]))
    findings["margins"]["numbers"]["gain up"] = number
    said = replay(good.problem, json.dumps(good.content | {"findings": findings}))
    assert not said.accepted
    assert "numbers cannot be those of margins" in said.reason


def test_a_place_that_is_not_unstable_refutes_nothing(good, bad):
    """The pole of a witness is enclosed again; samples cannot become a refutation."""
    findings = bad.content["findings"]
    for key in ("continuous", "sampled"):
        assert refused(bad, findings={name: each for name, each in findings.items() if name != key})
    forged = good.content["findings"] | {"sampled": findings["continuous"]}
    assert refused(good, findings=forged, status="REFUTED")
    assert not_for(bad, good.problem)
    assert {"status": "PROVED"} in forgeries(good)


def test_too_slow_sampling_is_seen(problem):
    """The planted fault: the gains that are right at 20 ms do not stand 200 ms."""
    slow = replace(problem, controller=replace(problem.controller, sample_time=0.2), sample_time=0.2)
    verdict = margins.CHECK.run(slow)
    assert verdict.status is Status.REFUTED
    assert verdict.findings["continuous"].status is Status.UNDECIDED
    assert verdict.findings["sampled"].status is Status.REFUTED
    assert "magnitude of a sampled pole is at least" in verdict.explanation


@pytest.mark.parametrize("name", ["afsmc", "smc", "torque-feedback"])
@pytest.mark.parametrize("sampled", [False, True])
def test_enclosed_poles_are_those_of_the_floats(make_problem, make_controller, name, sampled):
    problem = make_problem(make_controller(name))
    for speed in (3.0, 9.0, 30.0):
        sample_time = problem.sample_time if sampled else None
        opened = in_control(problem, speed, sample_time=sample_time)
        poles = control.feedback(opened, 1).poles()
        expected = np.abs(poles).max() if sampled else poles.real.max()
        found = outermost(problem, speed, sampled=sampled)
        assert found == pytest.approx(expected, rel=1e-6, abs=1e-9)


@pytest.mark.parametrize("name", ["afsmc", "smc"])
def test_witness_is_unstable(make_problem, make_controller, name):
    """Eigenvalues of the continuous loop in slip, torque and integrals, from differences of the drift."""
    problem = make_problem(make_controller(name))
    verdict = margins.CHECK.run(problem)
    assert verdict.status is Status.REFUTED
    at = {point.name: point.value for point in verdict.witness}
    speed, gains = at["speed"] / 3.6, problem.controller.linear_form(at["speed"] / 3.6)
    step = 1e-6
    more, less = (slip_dynamics(problem.vehicle, problem.rail, 0.14 + d, speed) for d in (step, -step))
    pole, gain = (more.drift - less.drift) / (2.0 * step), more.gain
    matrix = [
        [pole, -gain, 0.0, 0.0],
        [gains.proportional / 0.6, -1.0 / 0.6, gains.integral / 0.6, gains.twice / 0.6],
        [1.0, 0.0, 0.0, 0.0],
        [0.0, 0.0, 1.0, 0.0],
    ]
    assert (gains.twice != 0.0) is (name == "afsmc")  # the weights of which adapt
    assert np.linalg.eigvals(matrix).real.max() == pytest.approx(at["real part of a pole"], rel=1e-4)
    assert at["real part of a pole"] > 0.0


def test_what_only_floats_see_is_undecided(make_problem, make_controller, monkeypatch):
    monkeypatch.setattr(linear, "outermost", lambda *_, **__: -math.inf)
    verdict = margins.CHECK.run(make_problem(make_controller("afsmc")))
    assert verdict.status is Status.UNDECIDED
    assert not verdict.witness
    assert "at no speed exact arithmetic shows a pole outside" in verdict.explanation


@pytest.mark.parametrize("name", ["afsmc", "smc", "torque-feedback"])
def test_a_law_for_another_brake_has_other_gains(make_problem, make_controller, er24pc, name):
    """By differences of what the law commands on a brake that is half as strong as its own."""
    weak = replace(er24pc, brake=replace(er24pc.brake, max_torque=30e3))
    law = make_controller(name, "polach-wet")
    problem = replace(make_problem(law, vehicle=weak, rail="polach-wet"), bounds=EXACT)
    speed, slip = 12.0, 0.14
    plant = slip_dynamics(er24pc, problem.rail, slip, speed)
    middle = -plant.drift / plant.gain  # holds the slip
    memory = law.start(Measurement(speed=speed, wheel_speed=0.0, torque=0.0))
    if name == "afsmc":  # weights that are moved alike move the torque into the limits and leave its slope
        memory = (0.0, *(each + 30.0 for each in memory[1:-1]), memory[-1])

    def commanded(slip, torque):
        wheel = speed * (1.0 - slip) / er24pc.wheel_radius
        _, command = law.step(memory, Measurement(speed=speed, wheel_speed=wheel, torque=torque))
        assert 0.0 < command.fill < 1.0
        return 30e3 * command.fill

    _, _, gains = loop_at(problem, {v.name: float(v.low) for v in variables(problem)} | {"speed": speed})
    step = 1e-7
    by_slip = (commanded(slip - step, middle) - commanded(slip + step, middle)) / (2.0 * step)
    by_torque = (commanded(slip, middle + 1.0) - commanded(slip, middle - 1.0)) / 2.0
    assert gains.proportional == pytest.approx(by_slip, rel=1e-4)
    assert gains.torque == pytest.approx(-by_torque, rel=1e-6, abs=1e-9)
    whole = law.linear_form(speed)
    assert gains.proportional == pytest.approx(0.5 * whole.proportional, rel=1e-12)
