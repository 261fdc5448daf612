"""Files appear whole or not at all."""

import os
from dataclasses import replace
from pathlib import Path

import pytest

from tests.unit.reporting.sample_report import sample
from wspd_design.parameters.errors import UserError
from wspd_design.reporting.blocks import Document, Equation
from wspd_design.reporting.output import write_document


@pytest.fixture(scope="module")
def document() -> Document:
    return replace(sample(), blocks=(), summary=(), verdict=replace(sample().verdict, sentence="short"))


@pytest.mark.parametrize(("name", "start"), [("a.html", b"<!DOCTYPE html>"), ("b.PDF", b"%PDF-")])
def test_writes_the_format_of_the_ending(document: Document, tmp_path: Path, name: str, start: bytes) -> None:
    path = tmp_path / name
    path.write_bytes(b"old")
    write_document(document, path)
    assert path.read_bytes().startswith(start)
    assert [each.name for each in tmp_path.iterdir()] == [name]
    assert path.stat().st_mode & 0o600 == 0o600


def test_unknown_ending(document: Document, tmp_path: Path) -> None:
    with pytest.raises(UserError, match=r"must end in \.html or \.pdf"):
        write_document(document, tmp_path / "report.docx")


@pytest.mark.parametrize("name", ["missing/report.html", "folder.html", "file/report.html"])
def test_a_place_that_cannot_be_written(document: Document, tmp_path: Path, name: str) -> None:
    (tmp_path / "folder.html").mkdir()
    (tmp_path / "file").touch()
    with pytest.raises(UserError, match="cannot be written"):
        write_document(document, tmp_path / name)
    assert {each.name for each in tmp_path.iterdir()} == {"folder.html", "file"}


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write everywhere")
def test_a_folder_without_permission(document: Document, tmp_path: Path) -> None:
    tmp_path.chmod(0o500)
    with pytest.raises(UserError, match="cannot be written"):
        write_document(document, tmp_path / "report.html")


def test_a_failing_rename_leaves_nothing(
    document: Document, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("os.replace", fail)
    with pytest.raises(UserError, match="No space left on device"):
        write_document(document, tmp_path / "report.html")
    assert list(tmp_path.iterdir()) == []


def test_a_formula_that_does_not_parse_writes_nothing(document: Document, tmp_path: Path) -> None:
    broken = replace(document, blocks=(Equation(source="frac(1", description="broken"),))
    for name in ("report.html", "report.pdf"):
        with pytest.raises(RuntimeError, match="unclosed delimiter"):
            write_document(broken, tmp_path / name)
    assert list(tmp_path.iterdir()) == []
