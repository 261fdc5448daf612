"""Proofs of the way from rolling into a band in cells: what they show, what is refused."""

import json
from dataclasses import replace
from fractions import Fraction
from itertools import product

import pytest

import wspd_design as wd
from tests.certificates.band.conftest import PLENTY, problem_of
from wspd_design.certificates import suite
from wspd_design.certificates.checks.region import slip_way_in
from wspd_design.certificates.kernel.checker import Refused, Work
from wspd_design.certificates.kernel.file import certificate_text
from wspd_design.certificates.records import Status
from wspd_design.certificates.replay import replay
from wspd_design.certificates.setting.plant import plant_with
from wspd_design.certificates.theorems.from_rolling import ways_in
from wspd_design.certificates.theorems.from_rolling.ways_in import ALL, EVERY, boxes_of, halves, read
from wspd_design.certificates.theorems.slip_band.way_in import NEAR, SUPPLY, around
from wspd_design.certificates.theorems.way_in import STRIPS
from wspd_design.simulation.records import Scenario
from wspd_design.simulation.stop import simulate

pytestmark = pytest.mark.slow
LOW = wd.load_rail("low-adhesion")
SHARE = Fraction(1, 16)
VARIED = ("max torque", "fill time", "vent time")  # with which simulated stops differ
BOX = tuple((float(k), float(k) + 1.0) for k in range(len(ALL)))


@pytest.fixture(scope="module")
def stop():
    """The whole stop at the nominal friction and a narrow range of supply rates, down to a high speed."""
    problem = problem_of(1.0, rail=LOW)
    ends = {name: problem.span(name) for name in NEAR} | {SUPPLY: (0.74, 0.76)}
    narrow = replace(problem, bounds=type(problem.bounds).of(ends), speeds=(80.0 / 3.6, problem.speeds[1]))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(slip_way_in, "IN_CELLS", (SHARE,))
        (found,) = suite.verify(narrow, only=["slip_way_in"], figures=False)
    return narrow, found


@pytest.fixture
def proof(stop):
    written = json.loads(certificate_text(stop[1]))["findings"][STRIPS]["proof"]
    assert isinstance(written, dict)
    return written


def decided(problem, proof):
    return ways_in.checker(problem, problem.controller)(proof, Work(PLENTY))


def why(problem, proof):
    with pytest.raises(Refused) as reason:
        decided(problem, proof)
    return str(reason.value)


def test_whole_stop_is_shown(stop):
    narrow, found = stop
    assert found.status is Status.PROVED
    numbers = found.findings[STRIPS].numbers
    assert numbers["share"] == float(SHARE)
    assert numbers[ways_in.CELLS] >= 1.0
    assert 0.14 < numbers["largest slip"] < 0.141
    assert "no farther from its nominal value than 6.25 % of the way" in found.claim
    assert "stays in a band around it down to 80 km/h" in found.claim
    assert f"{numbers[ways_in.CELLS]:g} cells of all numbers" in found.method
    assert found.reference == "docs/theory.md#ways-in-cells"
    assert replay(narrow, certificate_text(found)).accepted


def test_simulated_stops_go_no_farther_and_come_in_time(stop):
    """With the engine and the law that runs, at corners of the box."""
    narrow, found = stop
    numbers, near = found.findings[STRIPS].numbers, around(narrow, SHARE)
    farthest = 0.0
    for ends in product((0, 1), repeat=3):
        at = {name: near.span(name)[end] for name, end in zip(VARIED, ends, strict=True)}
        vehicle, rail = plant_with(near, at)
        run = simulate(
            vehicle, near.controller, Scenario(rail=rail, initial_speed=near.speeds[1]), plant="quarter"
        )
        so_far = run.speed >= near.speeds[0]
        farthest = max(farthest, float(run.slip[so_far].max()))
        late = so_far & (run.time >= numbers["time"])
        assert late.any()
        below, above = (numbers[f"band {k} {side}"] for k, side in ((0, "below"), (0, "above")))
        assert (run.slip[late] > near.slip - below).all()
        assert (run.slip[late] < near.slip + above).all()
    assert 0.139 < farthest < numbers["largest slip"]


@pytest.mark.parametrize(
    ("changed", "told"),
    [
        ({"format": "wspd-ways-in/0"}, "format"),
        ({"more": 1}, "format"),
        ({"share": "-1/16"}, "between 0 and 1"),
        ({"until": "1/5"}, "must end at a slip"),
        ({"groups": {}}, "no list"),
        ({"steps": "x"}, "letters of the ranges"),
        ({"groups": [{}]}, "a group needs"),
        ({"groups": [{"steps": ".", "first": 1.5, "pull": "1", "last": 2, "halved": ""}]}, "whole numbers"),
        ({"groups": [{"steps": ".", "first": 1, "pull": "1", "last": 2, "halved": "q"}]}, "unknown"),
        ({"groups": [{"steps": ".", "first": 1, "pull": "1" * 99, "last": 2, "halved": ""}]}, "letters"),
    ],
)
def test_proof_that_is_none_is_refused(changed, told):
    written = {
        "format": ways_in.FORMAT,
        "share": "1/16",
        "band": {},
        "until": "1/20",
        "steps": ".",
        "groups": [],
    }
    with pytest.raises(Refused, match=told):
        read(written | changed)


@pytest.mark.parametrize(("steps", "count"), [(".", 1), ("m..", 2), ("us...", 3), ("mi..t..", 4)])
def test_cells_cover_the_box(steps, count):
    cells = list(boxes_of(BOX, steps))
    assert len(cells) == count
    volume = sum(float(abs_of(cell)) for cell in cells)
    assert volume == pytest.approx(float(abs_of(BOX)))
    for letter, name in zip(EVERY, ALL, strict=True):
        low, high = halves(BOX, letter)
        k = ALL.index(name)
        assert low[k][1] == high[k][0] == pytest.approx(k + 0.5)


def abs_of(box):
    found = 1.0
    for low, high in box:
        found *= high - low
    return found


@pytest.mark.parametrize("steps", ["", "m.", "m...", "..", "m"])
def test_steps_that_leave_out_or_add_a_cell_are_refused(steps):
    with pytest.raises(Refused, match="the steps"):
        list(boxes_of(BOX, steps))


def test_group_too_few_and_too_many_are_refused(stop, proof):
    narrow, _ = stop
    assert "has no group" in why(narrow, proof | {"groups": []})
    assert "more groups" in why(narrow, proof | {"groups": proof["groups"] * 2})


def test_wider_box_than_was_shown_is_refused(stop, proof):
    """With the cells and the band of a smaller one."""
    narrow, _ = stop
    assert why(narrow, proof | {"share": "1/2"})


def test_end_of_the_rows_that_is_not_reached_is_refused(stop, proof):
    narrow, _ = stop
    (group,) = proof["groups"]
    assert "rows" in why(narrow, proof | {"groups": [group | {"pull": "10"}]})
    assert "ellipsoid" in why(narrow, proof | {"groups": [group | {"last": 1}]})


def test_wheels_that_still_fill_where_cells_end_are_lost(stop, proof):
    """The rows would end before the valves have paused."""
    narrow, _ = stop
    near = around(narrow, SHARE)
    (cell, *_) = boxes_of(ways_in.box_around(near), proof["groups"][0]["steps"])
    until = 0.004  # some valves pause at slips from here on, others later
    assert ways_in.caught_of(near, [cell], 0.06) != [None]
    assert ways_in.caught_of(near, [cell], until) == [None]


def test_law_with_a_dead_band_is_not_followed(stop):
    narrow, _ = stop
    core = narrow.controller.core
    banded = replace(core, tracking=replace(core.tracking, dead_band=100.0))
    assert "dead band" in ways_in.speaks_about(
        replace(narrow, controller=replace(narrow.controller, core=banded))
    )
    assert not ways_in.speaks_about(narrow)
