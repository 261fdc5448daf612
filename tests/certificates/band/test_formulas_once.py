"""A formula that several statements have stands once in a certificate file; an older file has it in each of them."""

import json
import subprocess
import sys

import pytest

from wspd_design.certificates.kernel import checker
from wspd_design.certificates.kernel.file import certificate_text
from wspd_design.certificates.replay import replay

pytestmark = pytest.mark.slow


def statements(document):
    proofs = (each["proof"] for each in document["findings"].values() if "proof" in each)
    return [each["statement"] for each in proofs if each["format"] == checker.FORMAT]


@pytest.fixture
def older(document):
    """The file as version 2 has it."""
    formulas = document.pop("formulas")
    for statement in statements(document):
        for key in checker.FORMULAS:
            if key in statement:
                statement[key] = formulas[statement[key]]
    return document | {"schema": "wspd-certificate/2"}


def test_each_formula_is_written_once(document):
    named = {each[key] for each in statements(document) for key in checker.FORMULAS if key in each}
    assert named == set(range(len(document["formulas"])))
    assert len(document["formulas"]) < len(statements(document)) / 20
    assert len({json.dumps(each) for each in document["formulas"]}) == len(document["formulas"])


def test_file_of_version_2_is_accepted_and_says_the_same(half, proved, older):
    again = replay(half, json.dumps(older))
    assert again.accepted, again.reason
    assert certificate_text(again.certificate) == certificate_text(proved)
    assert len(certificate_text(proved)) < len(json.dumps(older)) / 3


def test_checker_alone_reads_both(proved, older, tmp_path):
    files = {"new.json": certificate_text(proved), "old.json": json.dumps(older)}
    said = []
    for name, text in files.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
        run = subprocess.run(
            [sys.executable, "-I", checker.__file__, name],
            cwd=tmp_path,
            capture_output=True,
            text=True,
            check=True,
        )
        said.append(run.stdout.replace(name, ""))
    assert said[0] == said[1]
    assert said[0].count("holds") == len(statements(older))


@pytest.mark.parametrize("number", [-1, 99])
def test_formula_that_is_not_there_is_refused(half, document, number):
    statement = statements(document)[0]
    statement["model"] = number
    assert not replay(half, json.dumps(document)).accepted
    content = checker.read(json.dumps(document))
    proof = next(each["proof"] for each in content["findings"].values() if "proof" in each)
    with pytest.raises(checker.Refused, match="formula is missing"):
        checker.decide(proof, checker.Work())


def test_other_formula_of_the_table_is_refused(half, document):
    statement = statements(document)[0]
    statement["model"] = next(k for k in range(len(document["formulas"])) if k != statement["model"])
    assert "belongs to another statement" in replay(half, json.dumps(document)).reason


@pytest.mark.parametrize("table", [{}, "formulas", None])
def test_table_that_is_none_is_refused(half, document, table):
    reason = replay(half, json.dumps(document | {"formulas": table})).reason
    assert "table of formulas" in reason
