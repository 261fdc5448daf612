"""Proofs in a report: what the checker accepted, how large it is, and the file to check again."""

import json
from dataclasses import replace
from datetime import UTC, datetime

import pytest

from tests.unit.reporting.sample_dossier import certificate, sample_dossier
from wspd_design.certificates.kernel.finding import Effort, Finding, Stated
from wspd_design.certificates.records import Domain, Interval, Proof, Status
from wspd_design.reporting.blocks import Code, Definitions, Table
from wspd_design.reporting.proofs import MOST, listed
from wspd_design.reporting.report import report_document
from wspd_design.reporting.sections.checks import checks
from wspd_design.reporting.text import plain

pytestmark = pytest.mark.usefixtures("blank_figures")

DATE = datetime(2026, 1, 2, tzinfo=UTC)
PROOF = {"format": "wspd-proof/2", "statement": {"kind": "inequality", "name": "p"}, "tree": "a.."}


def finding(**effort):
    return Finding(
        status=Status.PROVED,
        asked="p <= 3.5 1/s",
        shown="p <= 3.2 1/s",
        leaves=2,
        stated=Stated(proof=PROOF, effort=Effort(boxes=3, **effort)),
    )


def dossier(other=Status.EVIDENCE, **changes):
    proved = certificate("pole", Status.PROVED, findings={"pole": finding()})
    certificates = (replace(proved, **changes), certificate("other", other))
    return replace(sample_dossier(), certificates=certificates)


def attached(document):
    return {each.name: each for each in document.attachments}


def details(dossier):
    """Return what is said of each check, by its name."""
    rows = (
        {row.term: row.text for row in each.rows} for each in checks(dossier) if isinstance(each, Definitions)
    )
    return {each["Name, model"].partition(",")[0]: each for each in rows}


def test_each_proof_has_a_row_with_its_size():
    (table,) = [
        each for each in checks(dossier()) if isinstance(each, Table) and each.anchor.endswith("-proofs")
    ]
    assert [[plain(cell) for cell in row] for row in table.rows] == [["p at most 3.2 1/s", "2"]]
    assert "pole.json" in plain(table.caption)


def bounded(place, what="slope", relation="<=", unit=" 1/s"):
    """Proof of a bound, and of a range, of its own."""
    speed = Interval(name="speed", low=float(place), high=place + 1.0, unit="m/s")
    held = Interval(name="mass", low=2.0, high=2.0, unit="kg")
    statement = f"{what} {relation} {0.5 * place - 3.0:g}{unit}"
    return Proof(statement=statement, domain=Domain(varied=(speed,), held=(held,)), boxes=place + 1)


def test_many_proofs_of_a_kind_are_one_row():
    cells = Proof(statement="no sample leads out", domain=None, boxes=1)
    many = [bounded(place) for place in range(MOST)]
    upper, lower, last = listed([*many, bounded(3, relation=">="), cells])
    assert upper.statement == f"slope <= -3 to {0.5 * (MOST - 1) - 3.0:g} 1/s, in {MOST} parts"
    assert upper.boxes == MOST * (MOST + 1) // 2
    assert (
        upper.domain.text
        == Domain(
            varied=(Interval(name="speed", low=0.0, high=float(MOST), unit="m/s"),), held=many[0].domain.held
        ).text
    )
    assert lower == bounded(3, relation=">=")
    assert last == cells


def test_other_quantities_sides_units_and_ranges_are_kinds_of_their_own():
    many = [bounded(place) for place in range(MOST)]
    narrowed = replace(many[0], domain=replace(many[0].domain, held=()))
    others = [bounded(1, what="level"), bounded(1, relation=">="), bounded(1, unit=" s/m"), narrowed]
    assert listed([*many, *others])[1:] == tuple(others)


def test_few_proofs_are_listed_one_by_one():
    few = tuple(bounded(place) for place in range(MOST))
    assert listed(few) == few


def test_open_share_and_a_search_that_was_cut_are_stated():
    said = details(dossier(findings={"pole": finding(undecided=0.034, cut=True)}))
    assert said["pole"]["Left open"] == "3.4 % of the box"
    assert said["pole"]["Search"] == "ended by its budget"
    assert not {"Left open", "Search"} & said["other"].keys()


def test_what_samples_say_and_what_is_held_are_stated():
    said = details(dossier(held=("wheel radius", "max torque")))
    assert "held: wheel radius, max torque" in plain(said["pole"]["Domain"])
    assert plain(said["other"]["Samples"]) == "81 speeds were tried"


def test_the_proof_is_attached_and_running_times_change_nothing():
    document = report_document(dossier(), DATE)
    kept = json.loads(attached(document)["pole.json"].content)
    assert kept["findings"]["pole"]["proof"] == PROOF
    assert report_document(dossier(seconds=9.0), DATE) == document


def test_how_to_check_again_is_said_once():
    document = report_document(dossier(), DATE)
    (command,) = (each.text for each in document.blocks if isinstance(each, Code))
    assert command.splitlines() == ["wspd report --replay report.html", "wspd check report.html"]


def test_every_check_that_speaks_about_the_law_is_attached():
    document = report_document(dossier(findings={}, status=Status.REFUTED), DATE)
    files = attached(document)
    content = json.loads(files["pole.json"].content)
    assert (content["status"], content["findings"]) == ("REFUTED", {})
    assert files["pole.json"].description == "certificate of the check pole"
    assert "other.json" in files


def test_what_does_not_speak_about_the_law_is_not_attached():
    without = dossier(Status.NOT_APPLICABLE, findings={}, status=Status.NOT_APPLICABLE)
    document = report_document(without, DATE)
    assert not {"pole.json", "other.json"} & attached(document).keys()
