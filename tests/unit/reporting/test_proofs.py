"""Proofs in a report: what the checker accepted, how large it is, and the file to check again."""

import json
from dataclasses import replace
from datetime import UTC, datetime

from tests.unit.reporting.sample_dossier import certificate, sample_dossier
from wspd_design.certificates.records import Proof, Status
from wspd_design.reporting.blocks import Code, Definitions, Table
from wspd_design.reporting.report import report_document
from wspd_design.reporting.sections.checks import checks

DATE = datetime(2026, 1, 2, tzinfo=UTC)
TEXT = json.dumps({"format": "wspd-proof/1", "claim": "p", "tree": "a..", "prover": {"boxes": 3}})
PROOF = Proof(
    claim="p", statement="p <= 3.2 1/s", claim_hash="abcdef" * 10, certificate=TEXT, leaves=2, seconds=0.7
)


def dossier(**changes):
    proved = certificate("pole", Status.PROVED, proofs=(PROOF,), engine="crival 1, flint 2")
    certificates = (replace(proved, **changes), certificate("other", Status.EVIDENCE))
    return replace(sample_dossier(), certificates=certificates)


def test_each_proof_has_a_row_with_its_size():
    tables = [
        each for each in checks(dossier()) if isinstance(each, Table) and each.anchor.endswith("-proofs")
    ]
    (table,) = tables
    assert table.rows == (("p <= 3.2 1/s", "2", str(len(TEXT)), "abcdefabcdefabcd"),)
    assert "pole.json" in table.caption


def test_open_share_and_engine_are_stated():
    details = [each.rows for each in checks(dossier(undecided=0.034)) if isinstance(each, Definitions)]
    sampled, shown = ({row.term: row.text for row in rows} for rows in details)
    assert "Left open" not in sampled
    assert shown["Left open"] == "3.4 % of the box"
    assert shown["Engine"] == "crival 1, flint 2"


def test_the_proof_is_attached_and_running_times_change_nothing():
    document = report_document(dossier(), DATE)
    (attached,) = (each for each in document.attachments if each.name == "pole.json")
    (kept,) = json.loads(attached.content)["proofs"]
    assert kept["tree"] == "a.."
    slower = replace(PROOF, seconds=9.0)
    assert report_document(dossier(proofs=(slower,)), DATE) == document


def test_how_to_check_again_is_said_once():
    (command,) = (each.text for each in checks(dossier()) if isinstance(each, Code))
    assert command == "wspd check pole.json --design design.toml --vehicle er24pc --rail polach-wet"


def test_a_witness_is_attached_without_proofs():
    document = report_document(dossier(proofs=(), status=Status.REFUTED), DATE)
    (attached,) = (each for each in document.attachments if each.name == "pole.json")
    content = json.loads(attached.content)
    assert (content["status"], content["proofs"]) == ("REFUTED", [])
    assert attached.description == "witness of the check pole"


def test_without_proofs_nothing_is_attached():
    without = dossier(proofs=())
    document = report_document(without, DATE)
    assert [each.name for each in document.attachments] == ["design.toml", "report.json"]
    assert not any(isinstance(each, Code) for each in checks(without))
