"""The document as a whole: sections, links, sources, the paper's table, and what programs read."""

import json
from dataclasses import replace
from datetime import UTC, datetime

import pytest
from jsonschema import Draft202012Validator

from tests.unit.reporting.sample_dossier import (
    WANTED,
    certificate,
    drawn,
    faults,
    judged,
    sample_dossier,
    trial,
)
from wspd_design.certificates.records import Status
from wspd_design.controllers.family import designed
from wspd_design.exchange.files import read_schema
from wspd_design.exchange.study_forms import REPORT
from wspd_design.parameters.errors import UserError
from wspd_design.reporting.blocks import Bullets, Figure, Heading, Paragraph, Table
from wspd_design.reporting.numbering import number, parts
from wspd_design.reporting.record import report_record
from wspd_design.reporting.report import report_document, write_report
from wspd_design.reporting.sections.comparison import comparison
from wspd_design.reporting.text import Link, plain
from wspd_design.simulation.records import FAULT_KINDS
from wspd_design.simulation.runs import Ending
from wspd_design.studies.paper.published import load_table10

pytestmark = pytest.mark.usefixtures("blank_figures")

DATE = datetime(2026, 1, 2, 3, 4, tzinfo=UTC)


@pytest.fixture(scope="module")
def document():
    return report_document(sample_dossier(), DATE)


def _table(blocks, anchor):
    return next(each for each in blocks if isinstance(each, Table) and each.anchor == anchor)


def test_every_check_that_speaks_about_the_design_links_to_a_section_of_its_own(document):
    number(document)  # refuses a link that leads nowhere
    headings = {each.anchor: each.text for each in document.blocks if isinstance(each, Heading)}
    linked = [part.anchor for part in parts(_table(document.blocks, "checks")) if isinstance(part, Link)]
    assert len(linked) == len(set(linked)) == len(Status)
    for each in sample_dossier().certificates:
        if each.status is Status.NOT_APPLICABLE:
            continue
        anchor = f"check-{each.name.replace('_', '-')}"
        assert anchor in linked
        assert headings[anchor] == each.title


def test_checks_that_do_not_apply_stand_in_one_line_with_their_reasons():
    silent = [certificate(name, Status.NOT_APPLICABLE, explanation="No.") for name in ("one", "two")]
    dossier = replace(sample_dossier(()), certificates=(*silent, certificate("three", Status.PROVED)))
    made = report_document(dossier, DATE)
    number(made)
    said = [plain(each.text) for each in made.blocks if isinstance(each, Paragraph)]
    assert "2 checks do not speak about this design: Check one and Check two (No)." in said
    told = _table(made.blocks, "checks").rows
    assert [plain(row[0]) for row in told] == ["three", "2 more"]
    assert told[1][2] == "one, two"
    assert told[1][0][0].anchor == "finding-not-applicable"


LAWS = [family.name for family in designed()]
WITHOUT_SURFACE = "afsmc"  # a report without the plane of a law is the same for all of them


@pytest.mark.parametrize(
    ("law", "has_surface"),
    [
        *((law, True) for law in LAWS),
        *(
            (law, False) if law == WITHOUT_SURFACE else pytest.param(law, False, marks=pytest.mark.reference)
            for law in LAWS
        ),
    ],
)
def test_every_law_has_a_report(law, has_surface):
    dossier = sample_dossier()
    made = replace(dossier.design, law=law)
    plane = dossier.phase_plane if has_surface else None
    document = report_document(replace(dossier, design=made, phase_plane=plane), DATE)
    assert "sliding mode" in document.subtitle.lower() or law == "torque-feedback"
    (figure,) = (
        each for each in document.blocks if isinstance(each, Figure) and each.anchor == "phase-plane"
    )
    assert ("Left:" in figure.alt) == ("Left:" in plain(figure.caption)) == has_surface
    assert ("slip error e" in figure.svg) == has_surface


def test_a_check_is_told_in_full(document):
    said = " ".join(plain(part) for part in parts(document) if isinstance(part, str))
    for each in sample_dossier().certificates:
        for text in (each.claim, each.explanation, each.hypotheses[0].text):
            assert text in said
    for text in ("T = u", "81 speeds", "speed 63.5 km/h", "sampling"):
        assert text in said


def test_no_section_is_empty(document):
    blocks = document.blocks
    for here, following in zip(blocks, (*blocks[1:], None), strict=True):
        if isinstance(here, Heading):
            assert following is not None
            assert not isinstance(following, Heading) or following.level > here.level


def test_every_figure_says_in_words_what_it_shows(document):
    figures = [each for each in document.blocks if isinstance(each, Figure)]
    wanted = {"pole-map", "stop-traces", "phase-plane", "distances", "slips"}
    assert wanted <= {each.anchor for each in figures}
    for each in figures:
        assert any(c.isdigit() for c in each.alt)
        assert "nan" not in each.alt


def test_gains_stand_with_unit_and_reason(document):
    rows = {plain(row[0]): row for row in _table(document.blocks, "gains").rows}
    assert [plain(cell) for cell in rows["integral gain"]][1:] == ["0.3846", "1/s", "because of the valve"]
    assert plain(rows["centres"][1]) == "−0.14, 0, 0.14"
    assert plain(rows["dead zone"][1]) == "yes"


def test_every_parameter_stands_in_the_sources(document):
    dossier = sample_dossier()
    for each in (dossier.vehicle, dossier.rail, *dossier.other_parameters):
        rows = _table(document.blocks, f"sources-{each.kind}-{each.name}").rows
        assert [row[0] for row in rows] == [
            name.replace(".", ": ").replace("_", " ") for name in each.entries
        ]
        for row, entry in zip(rows, each.entries.values(), strict=True):
            assert row[-2] == entry.status
            assert plain(row[-1]).startswith(f"{entry.source}: {entry.at}")
            assert bool(row[2]) == (entry.bounds is not None)
    mass = next(row for row in _table(document.blocks, "sources-vehicle-er24pc").rows if row[0] == "mass")
    assert mass[1:4] == ("76841", "61473 to 92209", "kg")


# Data book, section 13: t_lag and plateau time that were worked out from the printed Table 10 by hand.
LAG_AND_PLATEAU = {
    ("trenitalia", "table10-dry"): (1.18, 8.72),
    ("knorr-bremse", "table10-dry"): (1.94, 8.56),
    ("mitsubishi", "table10-dry"): (1.58, 8.92),
    ("afsmc", "table10-dry"): (1.24, 8.56),
    ("trenitalia", "table10-wet"): (0.97, 11.33),
    ("knorr-bremse", "table10-wet"): (1.70, 11.40),
    ("mitsubishi", "table10-wet"): (1.32, 11.48),
    ("afsmc", "table10-wet"): (1.04, 11.16),
}


def test_table_10_is_typed_right():
    table = load_table10()
    start = table.initial_speed_kmh / 3.6
    assert {(each.controller, each.rail) for each in table.stops} == set(LAG_AND_PLATEAU)
    for each in table.stops:
        lag, plateau = LAG_AND_PLATEAU[each.controller, each.rail]
        assert 2.0 * each.distance_m / start - each.stopping_time_s == pytest.approx(lag, abs=0.006)
        assert 2.0 * (each.stopping_time_s - each.distance_m / start) == pytest.approx(plateau, abs=0.006)
        # The momentum balance makes the torque integral nearly the same in all rows.
        assert each.torque_integral_kNms == pytest.approx(1567.0, rel=0.0075)


@pytest.mark.parametrize(
    ("rail", "shown"), [("table10-dry", True), ("table10-wet", True), ("polach-dry", False)]
)
def test_the_papers_table_stands_only_beside_its_own_rails(rail, shown):
    blocks = comparison(sample_dossier(rail=rail))
    tables = [each.anchor for each in blocks if isinstance(each, Table)]
    assert ("table10" in tables) == shown
    if rail == "table10-wet":
        (row,) = _table(blocks, "table10").rows
        assert [plain(cell) for cell in row] == [
            "trenitalia", "221.15", "201.75", "12.3", "10.0", "1564.66", "1567.80"
        ]  # fmt: skip


def test_the_papers_table_needs_the_papers_speed():
    dossier = sample_dossier(rail="table10-dry")
    slower = replace(dossier.scenario, initial_speed=100.0 / 3.6)
    dossier = replace(dossier, scenario=slower)
    assert "table10" not in [each.anchor for each in comparison(dossier) if isinstance(each, Table)]


def test_the_ranking_says_what_separates_the_stops():
    def said(rail, **kwargs):
        blocks = comparison(sample_dossier(rail=rail, **kwargs))
        return plain(
            next(
                each.text for each in blocks if isinstance(each, Paragraph) and "built up" in plain(each.text)
            )
        )

    # 201.75 m against 187.65 m; built up after 62 m and 38.5 m.
    assert "is 14.1 m longer than the shortest" in said("polach-wet")
    assert "23.5 m longer until the brake is built up, 9.4 m shorter after it" in said("polach-wet")
    assert "friction falls with the sliding speed" in said("polach-wet")
    assert "says nothing about the control of slip" in said("table10-dry")
    alone = said("polach-wet", trials=(trial("mine"), trial("none", ending=Ending.TIME_LIMIT)))
    assert "longer than the shortest" not in alone


def test_sensitivity_is_told_where_the_numbers_stand():
    trials = (trial("mine"), trial("mitsubishi", spread=1.8, distance=350.64))
    document = report_document(sample_dossier(trials=trials), DATE)
    _, sensitive = _table(document.blocks, "stops-table").rows
    assert plain(sensitive[1]) == "351"  # its spread stands in the table of accuracy alone
    trusted, sensitive = _table(document.blocks, "accuracy-table").rows
    assert plain(trusted[1].text) == "1/1"
    assert plain(sensitive[1].text) == "1/1"  # that its steps are short enough is another finding
    assert plain(sensitive[4]) == "1.8"
    limits = [plain(item) for each in document.blocks if isinstance(each, Bullets) for item in each.items]
    assert any(
        item.startswith("Digits that a sensitive loop does not have") and "mitsubishi" in item
        for item in limits
    )
    calm = report_document(sample_dossier(trials=trials[:1]), DATE)
    said = [plain(item) for each in calm.blocks if isinstance(each, Bullets) for item in each.items]
    assert not any("Digits that" in item for item in said)


def test_ideal_stop_and_plant_stand_beside_the_stops(document):
    rows = _table(document.blocks, "stops-table").rows
    assert [plain(row[2]) for row in rows] == ["92.9"] * 3
    assert "ideal stop: 174.2 m" in plain(_table(document.blocks, "stops-table").caption)
    assert "planar" in plain(_table(document.blocks, "stops-table").caption)
    (traces,) = (
        each for each in document.blocks if isinstance(each, Figure) and each.anchor == "stop-traces"
    )
    assert "planar" in plain(traces.caption)


def test_programs_read_the_same_numbers(document):
    dossier = sample_dossier()
    record = next(each for each in document.attachments if each.name == "report.json")
    read = json.loads(record.content)
    assert read == report_record(dossier, DATE)
    assert read["schema"] == REPORT.schema
    Draft202012Validator(read_schema(REPORT.schema)).validate(read)
    assert read["stops"][0]["distance_m"] == dossier.trials[0].metrics.distance
    assert [each["status"] for each in read["checks"]] == [each.status.name for each in dossier.certificates]
    assert read["stops"][0]["step_check"]["sensitive"] is False
    assert read["stops"][0]["ideal_stop_m"] == 174.25
    assert read["parameters"][0]["entries"][0]["name"] == "mass"


def test_the_record_has_what_was_required_and_what_failed():
    dossier = replace(drawn(sample_dossier()), robustness=faults())
    record = report_record(dossier, DATE)
    Draft202012Validator(read_schema(REPORT.schema)).validate(record)
    assert [each["requirement"] for each in record["requirements"]] == [
        "sound",
        "efficiency_mean",
        "longest_lock",
        "standstill",
        "valve_switches",
    ]
    assert [each["outcome"] for each in record["requirements"]] == ["met", "met", "met", "met", "told"]
    assert record["requirements"][1]["margin"] == pytest.approx((0.9812 - 0.975) / 0.975)
    assert record["verdict"] == "accepted"
    assert [each["fault"] and each["fault"]["kind"] for each in record["faulted_stops"]] == [
        *FAULT_KINDS,
        None,
    ]
    assert record["faulted_stops"][3]["longest_locks_s"] == [0.0, 9.0, 0.0, 0.02]
    assert all(each["holds"] for each in record["faulted_stops"])
    without = report_record(sample_dossier(), DATE)
    assert (without["verdict"], without["faulted_stops"]) == ("accepted", [])


def test_the_record_has_neither_nan_nor_running_times():
    endless = trial("mine", ending=Ending.TIME_LIMIT, lag=float("nan"), plateau=float("inf"))
    record = report_record(sample_dossier(trials=(endless,)), DATE)
    assert record["stops"][0]["lag_s"] is None
    assert record["stops"][0]["plateau_m_s2"] is None
    json.dumps(record, allow_nan=False)
    slower = sample_dossier()
    slower = replace(slower, certificates=tuple(replace(each, seconds=99.0) for each in slower.certificates))
    assert report_document(slower, DATE) == report_document(sample_dossier(), DATE)


def test_the_date_comes_from_the_environment(tmp_path, monkeypatch):
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1790000000")
    paths = [tmp_path / "one.html", tmp_path / "two.html"]
    write_report(sample_dossier(), *paths)
    assert paths[0].read_bytes() == paths[1].read_bytes()
    assert "2026-09-21 14:13 UTC" in paths[0].read_text()
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "yesterday")
    with pytest.raises(UserError, match='SOURCE_DATE_EPOCH = "yesterday" must be a whole number'):
        write_report(sample_dossier(), tmp_path / "three.html")
    assert not (tmp_path / "three.html").exists()


def test_hostile_names_stay_text(tmp_path):
    hostile = "<script>alert(1)</script> $x$ `y` [z](#q)"
    dossier = sample_dossier(trials=(trial("mine"), trial(hostile, distance=300.0)))
    dossier = replace(
        dossier,
        law=replace(dossier.law, name=hostile, origin=hostile),
        design=replace(dossier.design, name=hostile),
        rail=replace(dossier.rail, name="../my rail.toml"),
        certificates=(certificate("one", Status.REFUTED, title=hostile, claim=hostile),),
    )
    dossier = judged(dossier, replace(WANTED, not_refuted=("one",)))
    write_report(dossier, tmp_path / "hostile.html", tmp_path / "hostile.pdf")
    assert "<script>alert" not in (tmp_path / "hostile.html").read_text()
