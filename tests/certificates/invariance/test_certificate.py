"""The verdict: what is proved, what is left open and why, and what it does not speak about."""

import json
import time
from dataclasses import replace
from itertools import count

import pytest

from tests.certificates.invariance.loops import check, feedback_problem
from tests.certificates.round_trip import (
    keep,
    no_proof_can_be_missed,
    no_word_can_be_changed,
    not_for,
    refused,
)
from wspd_design.certificates.checks.region.outlines import OUTLINES
from wspd_design.certificates.checks.region.sampled_invariance import CHECK
from wspd_design.certificates.kernel.checker import Refused
from wspd_design.certificates.kernel.file import certificate_text
from wspd_design.certificates.records import Status
from wspd_design.certificates.replay import replay
from wspd_design.certificates.search.budget import Budget, within
from wspd_design.certificates.theorems import region
from wspd_design.certificates.theorems.region import SETS
from wspd_design.controllers.protocol import Command
from wspd_design.design.records import Specification
from wspd_design.design.selection import design_controller
from wspd_design.model.number import where
from wspd_design.parameters.loading import load_rail


@pytest.fixture(scope="module")
def kept(problem):
    return keep(CHECK, problem)


@pytest.fixture(scope="module")
def proved(kept):
    return kept.certificate


def test_a_proved_range(problem, proved):
    assert proved.status is Status.PROVED
    assert proved.name == CHECK.name
    assert proved.undecided == 0.0
    assert 0.0 < proved.margin.low < proved.margin.high == 1.0 - problem.slip
    (found,) = proved.proved.values()
    again = check(problem, found.stated.proof)
    assert again.accepted
    assert found.stated.proof["claim_sha256"] == proved.model_hash
    assert proved.margin.low == 1.0 - again.slips[1]
    assert f"{again.slips[1]:.3f}" in proved.claim
    assert any("full supply pressure" in each for each in proved.assumptions)


def test_words_and_proofs(kept, problem):
    no_word_can_be_changed(kept)
    no_proof_can_be_missed(kept)
    assert not_for(kept, replace(problem, bounds=problem.bounds | {"mu0": (0.25, 0.35)}))


def test_other_sets_prove_nothing_in_a_file(kept):
    """A cell less, from which nothing may be said, and half a file."""
    proof = kept.content["findings"][SETS]["proof"]
    row = proof["windows"][0]["columns"]["34"]
    middle = (row[0] + row[1]) // 2
    columns = proof["windows"][0]["columns"] | {"34": [row[0], middle, middle + 1, row[1]]}
    holed = proof | {"windows": [proof["windows"][0] | {"columns": columns}, *proof["windows"][1:]]}
    assert refused(kept, findings={SETS: {"proof": holed}})
    text = json.dumps(kept.content)
    assert not replay(kept.problem, text[: len(text) // 2]).accepted


def test_the_designed_law_with_nominal_parameters(er24pc):
    """Fast windows, which need the finest cells; the designed gains are higher than those of the other tests."""
    rail, specification = load_rail("polach-wet"), Specification(sample_time=0.02)
    law = design_controller(er24pc, rail, specification, law="torque-feedback").build(er24pc, rail)
    found = CHECK.run(feedback_problem(spread=0.0, speeds=(29.0, 33.0), controller=law))
    assert found.status is Status.PROVED
    assert max(each["per_unit"] for each in found.findings[SETS].stated.proof["windows"]) == 512
    high = replace(law, gains=replace(law.gains, sliding_gain=8.0 * law.gains.sliding_gain))
    assert (
        CHECK.run(feedback_problem(spread=0.0, speeds=(31.5, 33.0), controller=high)).status
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


def test_without_the_checker_nothing_is_proved(problem, monkeypatch):
    def no(*_):
        raise Refused("for the test")

    monkeypatch.setattr(region.invariance, "decide", no)
    found = CHECK.run(problem)
    assert found.status is Status.UNDECIDED
    assert not found.proved
    assert found.series[0].name.startswith("unproved set at ")


@pytest.fixture(scope="module")
def wide():
    return feedback_problem(spread=0.2, speeds=(24.0, 26.0))


@pytest.fixture(scope="module")
def left_open(wide):
    return CHECK.run(wide)


def test_a_wide_box_is_left_open_with_the_windows_and_the_reason(left_open):
    found = left_open
    assert found.status is Status.UNDECIDED
    assert found.undecided == 1.0
    assert "No set is found at 86.4 to 93.6 km/h" in found.remark
    assert "Simulated at 2 of these speeds" in found.remark
    assert "% of the full one over the box" in found.remark
    assert not found.proved
    assert not found.series


def test_some_windows_of_a_range():
    # At 100 ms the slowest windows fail, the others have sets.
    problem = feedback_problem(spread=0.0, speeds=(3.0, 6.5), sliding_gain=0.64)
    gains = replace(problem.controller.gains, torque_gain=7.0)
    problem = replace(
        problem, sample_time=0.1, controller=replace(problem.controller, sample_time=0.1, gains=gains)
    )
    found = CHECK.run(problem)
    assert found.status is Status.UNDECIDED
    assert 0.1 < found.undecided < 0.9
    assert "No set is found at 10.8 to" in found.remark
    speeds = [
        float(each.name.removeprefix("unproved set at ").removesuffix(" km/h")) for each in found.series[:-2]
    ]
    assert 10.8 < min(speeds) < max(speeds) == 23.4


def test_a_budget_that_runs_out_is_said(problem):
    with within(Budget(effort=0.0)):
        found = CHECK.run(problem)
    assert found.status is Status.UNDECIDED
    assert found.undecided == pytest.approx(1.0)
    assert "The budget of the search ran out before 82.8 to 93.6 km/h" in found.remark
    assert not found.series


def test_the_budget_decides_how_many_windows_are_searched(problem):
    """More work, more windows, and at last all of them."""
    left = []
    for effort in (5e-5, 0.025, 1.0):
        with within(Budget(effort=effort)):
            left.append(CHECK.run(problem).undecided)
    assert 1.0 > left[0] > left[1] >= left[2] == 0.0


def test_the_same_problem_has_the_same_text_on_a_slow_machine(wide, left_open, monkeypatch):
    clock = count(step=1000.0)
    for name in ("time", "monotonic", "perf_counter", "process_time"):
        monkeypatch.setattr(time, name, lambda: next(clock))
    again = CHECK.run(wide)
    assert again.seconds >= 1000.0
    assert certificate_text(again) == certificate_text(left_open)
    assert again.series == left_open.series


def test_wheels_that_lock_have_no_set(problem, make_controller):
    found = CHECK.run(
        replace(problem, controller=replace(make_controller("none", "polach-wet"), sample_time=0.02))
    )
    assert found.status is Status.UNDECIDED
    assert found.undecided == 1.0


@pytest.mark.parametrize("name", ["smc", "afsmc", "trenitalia", "knorr-bremse", "mitsubishi"])
def test_laws_with_memory_are_none_of_its_business(problem, make_controller, name):
    controller = make_controller(name, "polach-wet", sample_time=0.02)
    found = CHECK.run(replace(problem, controller=controller))
    assert found.status is Status.NOT_APPLICABLE
    assert "remembers" in found.explanation
    assert "slip and torque alone do not tell its next command" in found.explanation


class Unsmooth:
    """A law that asks which of two numbers is larger, which intervals cannot tell."""

    name, sample_time = "unsmooth", 0.02

    def start(self, _measurement):
        return ()

    def step(self, state, measurement):
        duty = where(measurement.torque > 2e4, 0.0, 1.0)
        return state, Command(fill=duty, vent=1.0 - duty)


def test_a_law_that_intervals_cannot_follow_is_left_open(problem):
    found = CHECK.run(replace(problem, controller=Unsmooth()))
    assert found.status is Status.UNDECIDED
    assert not found.proved
    assert not found.series
