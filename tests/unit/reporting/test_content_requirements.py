"""Requirements, faults and estimates in the report: each finding is that of the records."""

from dataclasses import replace

import pytest

from tests.unit.reporting.sample_dossier import certificate, drawn, estimating, faults, judged, sample_dossier
from wspd_design.certificates.records import Status as Finding
from wspd_design.certificates.theorems.table import THEOREMS
from wspd_design.controllers.observers.sensors import Sensors
from wspd_design.design.stop_requirements import LOOPS, MODEL, paper_requirements
from wspd_design.reporting.blocks import Cell, Figure, Paragraph, Status, Table
from wspd_design.reporting.sections.requirements import requirements
from wspd_design.reporting.sections.robustness import robustness
from wspd_design.reporting.sections.stop import stop
from wspd_design.reporting.sections.summary import summary
from wspd_design.reporting.text import Link, plain

pytestmark = pytest.mark.usefixtures("blank_figures")

PLAIN = sample_dossier()
JUDGED = drawn(PLAIN, longest_lock=0.2)
FAULTED = replace(PLAIN, robustness=faults())


def _rows(blocks):
    (table,) = (each for each in blocks if isinstance(each, Table))
    return [[cell if isinstance(cell, Cell) else plain(cell) for cell in row] for row in table.rows]


def _said(blocks):
    return " ".join(plain(each.text) for each in blocks if isinstance(each, Paragraph))


def _table(blocks, anchor):
    return next(each for each in blocks if isinstance(each, Table) and each.anchor == anchor)


def test_every_report_has_a_table_of_requirements():
    assert _table(requirements(PLAIN), "requirement-sources").rows
    assert robustness(PLAIN) == ()


def test_limits_and_what_was_reached_stand_side_by_side():
    rows = {row[1]: row for row in _table(summary(JUDGED), "requirements-table").rows}
    mean, lock, switches = (
        rows[title]
        for title in (
            "mean efficiency",
            "longest lock above 10 km/h",
            "valve switches per second and axle, mean",
        )
    )
    assert mean[2:5] == ("≥ 97.5 %", "98.1 %", "+0.64 %")
    assert lock[2:5] == ("≤ 0.1 s", "0.2 s", "−100 %")
    assert switches[2:] == ("–", "12.3 1/s", "–", "200 simulated stops", "told")
    assert [mean[6].status, lock[6].status] == [Status.MET, Status.MISSED]


def test_the_source_of_a_limit_and_whether_it_was_verified_are_told():
    rows = {row[0]: row for row in _table(requirements(PLAIN), "requirement-sources").rows}
    assert rows["R2"][3:5] == ("a wish", "no")
    assert rows["R3"][3:5] == ("contract 12", "yes")


def test_requirements_checks_and_evidence_are_traced_both_ways():
    wanted = paper_requirements(PLAIN.specification)
    every = replace(PLAIN, certificates=tuple(certificate(name, Finding.PROVED) for name in THEOREMS))
    dossier = judged(every, wanted)
    blocks = requirements(dossier)
    decides = {plain(row[0]): row[4] for row in _table(blocks, "checks").rows}
    assert sorted(decides) == sorted(THEOREMS)
    shown = {
        row[0]: [part.text for part in row[5] if isinstance(part, Link)]
        if isinstance(row[5], tuple)
        else row[5]
        for row in _table(blocks, "requirement-sources").rows
    }
    for row in dossier.judgment.limited:
        assert shown[row.id] == (list(row.checks) or "one simulated stop")  # no requirement without evidence
        for name in row.checks:
            assert row.id in decides[name]
    deciding = {name for row in dossier.judgment.limited for name in row.checks}
    assert {name for name, ids in decides.items() if ids != "told only"} == deciding == {*MODEL, LOOPS[0]}


def test_the_stops_are_named_with_their_seed_and_what_is_drawn():
    said = _said(requirements(JUDGED))
    for words in (
        "200 stops that no search has seen, seed 77",
        "polach-wet and polach-dry in turn",
        "all numbers with bounds of the rail and sensing dead time",
    ):
        assert words in said


def test_a_lock_that_the_rail_forces_is_no_fault_of_the_law():
    sensor, holds, vents, fills, patches = _rows(robustness(FAULTED))
    assert [row[-1].status for row in (sensor, holds, vents, patches)] == [Status.HOLDS] * 4
    assert fills[-1].status is Status.PARTLY
    assert fills[:6] == ["valve stuck, fills", "2", "300.9", "0.3", "9.00", "0.02"]
    assert patches[0] == "rail patchy"
    assert "the rail takes 24.0 to 31.0 kN m" in _said(robustness(FAULTED))


@pytest.mark.parametrize(
    ("planted", "row", "found"),
    [
        ({"full_torque": 20e3}, 3, Status.FAILS),  # the rail would bear it: the law let the wheel lock
        ({"patches": replace(faults().patches, locks=(0.0, 0.51, 0.0, 0.0))}, 4, Status.FAILS),
        ({"patches": replace(faults().patches, stopped=False)}, 4, Status.BAD),
        (
            {"faults": (*faults().faults[:3], replace(faults().faults[3], locks=(0.6, 9.0, 0.0, 0.0)))},
            3,
            Status.FAILS,  # another wheelset, whose valve obeys
        ),
        (
            {"faults": (replace(faults().faults[0], locks=(0.0, 0.6, 0.0, 0.0)), *faults().faults[1:])},
            0,
            Status.FAILS,
        ),
    ],
)
def test_what_a_law_could_prevent_is_bad_news(planted, row, found):
    dossier = replace(PLAIN, robustness=faults(**planted))
    assert _rows(robustness(dossier))[row][-1].status is found


def test_a_law_that_is_told_the_speed_says_so():
    assert "is told the train speed" in _said(stop(PLAIN))
    assert "stop-estimate" not in [each.anchor for each in stop(PLAIN) if isinstance(each, Figure)]


def _with_sensors(own, **sensors):
    asked = replace(PLAIN.specification, sensors=Sensors(**sensors))
    return replace(PLAIN, specification=asked, trials=(own, *PLAIN.trials[1:]))


@pytest.mark.parametrize(
    ("sensors", "words"),
    [
        ({"speed": "fastest-axle"}, "takes the fastest wheelset for the train"),
        ({"speed": "wheels"}, "from its wheels."),
        ({"speed": "wheels", "accelerometer": True}, "from its wheels and an accelerometer."),
    ],
)
def test_the_estimated_speed_stands_beside_the_true_one(sensors, words):
    own = estimating(PLAIN.trials[0])
    dossier = _with_sensors(own, **sensors)
    assert "stop-estimate" in [each.anchor for each in stop(dossier) if isinstance(each, Figure)]
    said = _said(stop(dossier))
    assert words in said
    assert "wrong by at most 5 %" in said
    assert "0.65 of 5 m + 5 %, inside" in said
    assert "released a wheelset 2 times" in said
    outside = replace(own, metrics=replace(own.metrics, distance_error=1.01))
    assert "1 of 5 m + 5 %, outside" in _said(stop(_with_sensors(outside, **sensors)))


def test_a_speed_that_is_told_has_its_error_but_no_figure():
    dossier = _with_sensors(estimating(PLAIN.trials[0]), speed="told")
    assert "stop-estimate" not in [each.anchor for each in stop(dossier) if isinstance(each, Figure)]
    assert "is told the train speed, and scales it" in _said(stop(dossier))
    assert "wrong by at most 5 %" in _said(stop(dossier))
    own = estimating(PLAIN.trials[0])
    exact = _with_sensors(replace(own, metrics=replace(own.metrics, speed_error=1e-6)), speed="told")
    assert "told it without an error" in _said(stop(exact))
