"""The verdict: what is proved, what is left open and why, and what it does not speak about."""

import json
import time
from dataclasses import replace
from itertools import count

import pytest

from tests.certificates.invariance.loops import feedback_problem
from wspd_design.certificates.checks.region import sampled_invariance as certificate
from wspd_design.certificates.checks.region.outlines import OUTLINES
from wspd_design.certificates.kernel.file import certificate_text
from wspd_design.certificates.records import Status
from wspd_design.certificates.search.prover import Budget, within
from wspd_design.certificates.theorems.invariant_sets.checker import Verdict, check
from wspd_design.controllers.protocol import Command
from wspd_design.design.records import Specification
from wspd_design.design.selection import design_controller
from wspd_design.model.number import where
from wspd_design.parameters.loading import load_rail


@pytest.fixture(scope="module")
def proved(problem):
    return certificate.check(problem)


def test_a_proved_range(problem, proved):
    assert proved.status is Status.PROVED
    assert proved.name == certificate.NAME
    assert proved.undecided == 0.0
    assert 0.0 < proved.margin.low < proved.margin.high == 1.0 - problem.slip
    (proof,) = proved.proofs
    assert json.loads(proof.certificate)["claim_sha256"] == proof.claim_hash == proved.model_hash
    again = check(problem, proof.certificate)
    assert again.accepted
    assert proved.margin.low == 1.0 - again.slips[1]
    assert f"{again.slips[1]:.3f}" in proved.claim
    assert any("full supply pressure" in each for each in proved.assumptions)


def test_the_designed_law_with_nominal_parameters(er24pc):
    """Fast windows, which need the finest cells; the designed gains are higher than those of the other tests."""
    rail, specification = load_rail("polach-wet"), Specification(sample_time=0.02)
    law = design_controller(er24pc, rail, specification, law="torque-feedback").build(er24pc, rail)
    found = certificate.check(feedback_problem(spread=0.0, speeds=(29.0, 33.0), controller=law))
    assert found.status is Status.PROVED
    assert "1/512" in found.resolution
    high = replace(law, gains=replace(law.gains, sliding_gain=8.0 * law.gains.sliding_gain))
    assert (
        certificate.check(feedback_problem(spread=0.0, speeds=(31.5, 33.0), controller=high)).status
        is Status.UNDECIDED
    )


def test_outlines_are_closed_and_physical(problem, proved):
    *outlines, reference, full = proved.series
    assert set(reference.x) == {problem.slip}
    assert set(full.y) == {problem.vehicle.brake.max_torque / 1e3}
    assert 1 <= len(outlines) <= OUTLINES
    for series in outlines:
        assert series.name.startswith("set at ")
        assert (series.x[0], series.y[0]) == (series.x[-1], series.y[-1])
        assert 0.0 < min(series.x) < problem.slip < max(series.x) < 1.0
        assert 0.0 <= min(series.y) <= max(series.y) <= problem.vehicle.brake.max_torque / 1e3


def test_without_the_checker_it_is_evidence(problem, monkeypatch):
    def no(_problem, _text):
        return Verdict(accepted=False, reason="for the test", leaves=0, seconds=0.0)

    monkeypatch.setattr(certificate.checker, "check", no)
    found = certificate.check(problem)
    assert found.status is Status.EVIDENCE
    assert not found.proofs
    assert "does not accept" in found.explanation
    assert found.series[0].name.startswith("unproved set at ")


@pytest.fixture(scope="module")
def wide():
    return feedback_problem(spread=0.2, speeds=(24.0, 26.0))


@pytest.fixture(scope="module")
def left_open(wide):
    return certificate.check(wide)


def test_a_wide_box_is_left_open_with_the_windows_and_the_reason(left_open):
    found = left_open
    assert found.status is Status.UNDECIDED
    assert found.undecided == 1.0
    assert "No set is found at 86.4 to 93.6 km/h" in found.explanation
    assert "Simulated at 2 of these speeds" in found.explanation
    assert "% of the full one over the box" in found.explanation
    assert "With nominal parameters the checker accepts" in found.explanation
    assert not found.proofs


def test_sets_without_uncertainty_are_drawn_if_there_are_no_others(left_open):
    alone = certificate.check(feedback_problem(spread=0.0, speeds=(24.0, 26.0)))
    assert alone.status is Status.PROVED
    assert [(each.x, each.y) for each in left_open.series] == [(each.x, each.y) for each in alone.series]
    names = [each.name for each in left_open.series]
    assert names == ["nominal set at 90.7 km/h", "nominal set at 93.6 km/h", "reference", "full torque"]


def test_some_windows_of_a_range():
    # At 100 ms the slowest windows fail, the others have sets.
    problem = feedback_problem(spread=0.0, speeds=(3.0, 6.5), sliding_gain=0.64)
    gains = replace(problem.controller.gains, torque_gain=7.0)
    problem = replace(
        problem, sample_time=0.1, controller=replace(problem.controller, sample_time=0.1, gains=gains)
    )
    found = certificate.check(problem)
    assert found.status is Status.UNDECIDED
    assert 0.1 < found.undecided < 0.9
    assert "No set is found at 10.8 to" in found.explanation
    assert "nominal parameters already" in found.explanation
    speeds = [
        float(each.name.removeprefix("unproved set at ").removesuffix(" km/h")) for each in found.series[:-2]
    ]
    assert 10.8 < min(speeds) < max(speeds) == 23.4


def test_some_windows_of_a_range_without_uncertainty(wide):
    with within(Budget(seconds=1e-3)):
        found = certificate.check(wide)
    assert "With nominal parameters 1 of 2 windows have a set; the search time did not suffice for 1" in (
        found.explanation
    )
    names = [each.name for each in found.series]
    assert names == ["unproved nominal set at 90.7 km/h", "reference", "full torque"]


def test_search_time_that_runs_out_is_said(problem):
    with within(Budget(seconds=0.0)):
        found = certificate.check(problem)
    assert found.status is Status.UNDECIDED
    assert found.undecided == pytest.approx(1.0)
    assert "The search time, counted in steps of cells, ran out before 82.8 to 93.6 km/h" in found.explanation
    assert "the search time did not suffice for" in found.explanation
    assert not found.series


def test_search_time_decides_how_many_windows_are_searched(problem):
    """More time, more windows, and at last all of them."""
    left = []
    for seconds in (0.001, 0.5, 20.0):
        with within(Budget(seconds=seconds)):
            left.append(certificate.check(problem).undecided)
    assert 1.0 > left[0] > left[1] >= left[2] == 0.0


def test_the_same_problem_has_the_same_text_on_a_slow_machine(wide, left_open, monkeypatch):
    clock = count(step=1000.0)
    for name in ("time", "monotonic", "perf_counter", "process_time"):
        monkeypatch.setattr(time, name, lambda: next(clock))
    again = certificate.check(wide)
    assert again.seconds >= 1000.0
    assert certificate_text(again) == certificate_text(left_open)
    assert again.series == left_open.series


def test_wheels_that_lock_have_no_set(problem, make_controller):
    found = certificate.check(
        replace(problem, controller=replace(make_controller("none", "polach-wet"), sample_time=0.02))
    )
    assert found.status is Status.UNDECIDED
    assert found.undecided == 1.0


@pytest.mark.parametrize("name", ["smc", "afsmc", "trenitalia", "knorr-bremse", "mitsubishi"])
def test_laws_with_memory_are_none_of_its_business(problem, make_controller, name):
    controller = make_controller(name, "polach-wet", sample_time=0.02)
    found = certificate.check(replace(problem, controller=controller))
    assert found.status is Status.NOT_APPLICABLE
    assert "remembers" in found.explanation


class Unsmooth:
    """A law that asks which of two numbers is larger, which intervals cannot tell."""

    name, sample_time = "unsmooth", 0.02

    def start(self, _measurement):
        return ()

    def step(self, state, measurement):
        duty = where(measurement.torque > 2e4, 0.0, 1.0)
        return state, Command(fill=duty, vent=1.0 - duty)


def test_a_law_that_intervals_cannot_follow_is_left_open(problem):
    found = certificate.check(replace(problem, controller=Unsmooth()))
    assert found.status is Status.UNDECIDED
    assert "cannot be evaluated on intervals" in found.claim
