"""Attachments are taken out of a report whole; what is no report is refused in one sentence, whatever it holds."""

import base64
from dataclasses import replace
from datetime import UTC, datetime

import pytest

from tests.unit.reporting.sample_report import sample
from wspd_design.parameters.errors import UserError
from wspd_design.reporting import attached
from wspd_design.reporting.attached import attached_files, is_plain
from wspd_design.reporting.blocks import Attachment
from wspd_design.reporting.output import write_document

HOSTILE = [
    Attachment(name=name, media_type="text/plain", content=content, description="<a download='x'>")
    for name, content in (
        ("plain.txt", "a\nb\r\n\x00ü€😀"),
        ("empty.txt", ""),
        ("Käse & Brot.toml", '</a><a download="evil.txt" href="data:text/plain;base64,AAAA">'),
        ("铁路.toml", "x = 1\n"),
        ("עברית.toml", "y = 2\n"),
    )
]


@pytest.fixture(scope="module", params=[".html", ".pdf"])
def written(request, tmp_path_factory):
    path = tmp_path_factory.mktemp("attached") / f"report{request.param}"
    document = replace(sample(), attachments=tuple(HOSTILE), timestamp=datetime(2026, 1, 2, tzinfo=UTC))
    with pytest.warns(UserWarning, match="fonts of the PDF lack") if request.param == ".pdf" else nothing():
        write_document(document, path)
    return path


def nothing():
    from contextlib import nullcontext

    return nullcontext()


def test_every_attachment_comes_out_as_it_was_put_in(written):
    assert attached_files(written) == {each.name: each.content for each in HOSTILE}


def _page(*links):
    made = "".join(
        f'<li><a download="{name}" href="data:text/plain;base64,{base64.b64encode(content).decode()}">x</a></li>'
        for name, content in links
    )
    return f"<html><ul>{made}</ul></html>".encode()


@pytest.mark.parametrize(
    ("links", "why"),
    [
        ([("../x", b"")], "is not the name of an attachment"),
        ([("/etc/passwd", b"")], "is not the name of an attachment"),
        ([("a\\b", b"")], "is not the name of an attachment"),
        ([("c:x", b"")], "is not the name of an attachment"),
        ([(".bashrc", b"")], "is not the name of an attachment"),
        ([("-rf", b"")], "is not the name of an attachment"),
        ([("a&#10;b", b"")], "is not the name of an attachment"),
        ([("NUL.txt", b"")], "is not the name of an attachment"),
        ([("x" * 201, b"")], "is not the name of an attachment"),
        ([("a.txt", b""), ("A.TXT", b"")], "two attachments are called"),
        ([("a.txt", b"\xff\xfe")], "is not text"),
        ([(f"{number}.txt", b"") for number in range(301)], "more than 300 attachments"),
        ([], "nothing is attached"),
    ],
)
def test_what_is_no_report_is_refused(tmp_path, links, why):
    path = tmp_path / "hostile.html"
    path.write_bytes(_page(*links))
    with pytest.raises(UserError, match=why):
        attached_files(path)


def test_sizes_are_limited(tmp_path, monkeypatch):
    path = tmp_path / "large.html"
    monkeypatch.setattr(attached, "MOST_BYTES", 1000)
    path.write_bytes(b" " * 1001)
    with pytest.raises(UserError, match="no report is that large"):
        attached_files(path)
    path.write_bytes(_page(("a", b"x" * 600)))
    assert len(attached_files(path)["a"]) == 600


def test_a_pdf_that_unpacks_to_too_much_is_refused(tmp_path, monkeypatch):
    import pypdf

    writer = pypdf.PdfWriter()
    writer.add_blank_page(100, 100)
    for name in ("a.txt", "b.txt", "c.txt"):
        writer.add_attachment(name, b"0" * 2000)
    path = tmp_path / "bomb.pdf"
    writer.write(path)
    assert len(attached_files(path)) == 3
    monkeypatch.setattr(attached, "MOST_BYTES", 5000)
    with pytest.raises(UserError, match=r"more than 0\.005 MB|no report is that large"):
        attached_files(path)


DAMAGED = (b"", b"%PDF-1.7\n", b"%PDF-1.7\n1 0 obj<</Length 99999999999>>stream", b"\x00" * 99)


@pytest.mark.parametrize("content", DAMAGED)
def test_a_damaged_pdf_is_refused(tmp_path, content):
    path = tmp_path / "damaged.pdf"
    path.write_bytes(content)
    with pytest.raises(UserError, match="is not a report as wspd report writes it"):
        attached_files(path)


def test_what_is_no_file_is_refused(tmp_path):
    for name in ("missing.html", ""):
        with pytest.raises(UserError, match="is not a file"):
            attached_files((tmp_path / name) if name else tmp_path.with_suffix(".html"))
    (tmp_path / "report.txt").write_text("x")
    with pytest.raises(UserError, match="ends in"):
        attached_files(tmp_path / "report.txt")


def test_names_are_plain_on_every_system():
    assert all(
        map(
            is_plain,
            ("design.toml", "my loco.toml", "SHA256SUMS", "stop-1-a.csv", "console.txt", "铁路.toml"),
        )
    )
    assert not any(
        map(is_plain, ("", ".", "..", "a/b", "con", "LPT1.txt", "a.", "a ", 'a"b', "a<b", "a\x7f"))
    )
