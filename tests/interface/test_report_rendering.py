"""Both renderings of a document with every kind of block, seen from outside, as a reader's tools see them."""

import base64
import hashlib
import io
import re
import subprocess
import sys
import warnings
from collections.abc import Iterator
from dataclasses import replace
from datetime import timedelta
from html.parser import HTMLParser
from itertools import pairwise
from typing import Any

import pypdf
import pypdfium2
import pytest

from tests.unit.reporting.sample_report import HOSTILE, sample
from wspd_design.reporting.blocks import Code, Definition, Definitions, Document, Figure, Paragraph, Table
from wspd_design.reporting.figure_style import figure_style, figure_svg, new_figure
from wspd_design.reporting.html import render_html
from wspd_design.reporting.pdf import render_pdf
from wspd_design.reporting.text import plain, rich

VOID = {"meta", "br", "hr", "img", "link", "input"}


class Page(HTMLParser):
    """Tags with their attributes and text; complains about tags that do not close in order."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.texts: list[str] = []
        self._open: list[str] = []
        self.feed(text)
        self.close()
        assert self._open == []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))
        if tag not in VOID:
            self._open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self._open.pop() == tag

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))

    def handle_data(self, data: str) -> None:
        if self._open and self._open[-1] not in ("style", "script"):
            self.texts.append(data)

    def attributes(self, name: str) -> list[str]:
        """All values of an attribute."""
        return [attrs[name] or "" for _, attrs in self.tags if name in attrs]


@pytest.fixture(scope="module")
def document() -> Document:
    return sample()


@pytest.fixture(scope="module")
def html(document: Document) -> str:
    return render_html(document)


@pytest.fixture(scope="module")
def page(html: str) -> Page:
    return Page(html)


@pytest.fixture(scope="module")
def pdf(document: Document) -> bytes:
    return render_pdf(document)


@pytest.fixture(scope="module")
def reader(pdf: bytes) -> pypdf.PdfReader:
    return pypdf.PdfReader(io.BytesIO(pdf))


@pytest.fixture(scope="module")
def pdf_text(reader: pypdf.PdfReader) -> str:
    return "\n".join(sheet.extract_text() for sheet in reader.pages)


# HTML


def test_the_page_loads_nothing(html: str, page: Page) -> None:
    references = page.attributes("href") + page.attributes("src") + page.attributes("xlink:href")
    assert all(each.startswith(("#", "data:")) for each in references)
    assert not re.search(r"https?:|@import|url\((?!#)", html)
    assert {tag for tag, _ in page.tags} & {"link", "iframe", "object", "form"} == set()
    assert [attrs for tag, attrs in page.tags if tag == "script"] == [{}]  # inline


def test_the_policy_allows_the_style_sheet_and_the_script_and_nothing_else(html: str, page: Page) -> None:
    (policy,) = (a["content"] for t, a in page.tags if a.get("http-equiv") == "Content-Security-Policy")
    (style,) = re.findall(r"<style>(.*?)</style>", html, re.DOTALL)
    (script,) = re.findall(r"<script>(.*?)</script>", html, re.DOTALL)
    style, script = (
        base64.b64encode(hashlib.sha256(each.encode()).digest()).decode() for each in (style, script)
    )
    assert policy is not None
    assert policy.startswith(
        f"default-src 'none'; style-src 'sha256-{style}'; script-src 'sha256-{script}'; img-src data:;"
    )
    assert "unsafe" not in policy
    assert page.attributes("style") == []
    assert not any(name.startswith("on") for _, attrs in page.tags for name in attrs)


def test_the_script_is_small(html: str) -> None:
    (script,) = re.findall(r"<script>(.*?)</script>", html, re.DOTALL)
    assert len(script.encode()) < 10_000


def test_ids_are_unique_and_every_reference_resolves(html: str, page: Page) -> None:
    ids = page.attributes("id")
    assert len(ids) == len(set(ids))
    inside = {each[1:] for each in page.attributes("href") if each.startswith("#")}
    inside |= set(re.findall(r"url\(#([^)]*)\)", html))
    assert inside <= set(ids)


def test_screen_readers_get_words(page: Page, document: Document) -> None:
    pictures = [attrs for tag, attrs in page.tags if tag == "svg" and attrs.get("role") == "img"]
    figures = [block for block in document.blocks if isinstance(block, Figure)]
    assert [attrs["aria-label"] for attrs in pictures] == [figure.alt for figure in figures]
    hidden = [attrs for tag, attrs in page.tags if tag == "svg" and attrs.get("role") != "img"]
    assert all(attrs.get("aria-hidden") == "true" for attrs in hidden)
    formulas = [attrs for _, attrs in page.tags if attrs.get("role") == "math"]
    assert (formulas[0]["aria-label"] or "").startswith("The rate of slip equals")
    assert "T brake" in page.texts
    assert ("html", {"lang": "en"}) in page.tags


def test_every_status_is_a_sign_and_a_word(page: Page) -> None:
    text = "".join(page.texts)
    for shown in ("✓ proved", "✗ refuted", "? undecided", "≈ evidence", "∅ vacuous", "– not applicable"):
        assert shown in text


def test_downloads_hold_the_files(page: Page, document: Document) -> None:
    links = {a["download"]: a["href"] or "" for t, a in page.tags if t == "a" and "download" in a}
    for attachment in document.attachments:
        head, content = links[attachment.name].split(",", 1)
        assert head == f"data:{attachment.media_type};base64"
        assert base64.b64decode(content).decode() == attachment.content


def test_colors_follow_the_scheme(html: str) -> None:
    body = html.split("<body>", 1)[1]
    assert not re.search(r'(fill|stroke)="#', body)
    assert "prefers-color-scheme: dark" in html
    used = set(re.findall(r"var\((--[a-z0-9-]+)\)", html))
    assert used <= set(re.findall(r"(--[a-z0-9-]+):", html))


def test_html_is_reproducible(html: str) -> None:
    assert render_html(sample()) == html


def test_glyphs_are_shared(html: str) -> None:
    """Each glyph is drawn once, however often it is used, and none is drawn in vain."""
    drawn = re.findall(r'<symbol id="([^"]*)"', html)
    used = re.findall(r'<use [^>]*href="#(g[0-9A-F]+)"', html)
    assert sorted(drawn) == sorted(set(used))
    assert len(used) > 2 * len(drawn)


# PDF


def test_pdf_metadata(reader: pypdf.PdfReader, document: Document) -> None:
    assert reader.metadata is not None
    assert reader.metadata.title == document.title
    assert reader.metadata.creation_date == document.timestamp
    assert (reader.metadata.author, reader.metadata.keywords) == (
        document.author,
        ", ".join(document.keywords),
    )
    assert reader.metadata.subject == plain(document.verdict.sentence)
    assert reader.root_object["/Lang"] == "en-US"
    assert reader.viewer_preferences is not None
    assert reader.viewer_preferences.display_doctitle


def test_pdf_claims_to_be_accessible_and_archivable(reader: pypdf.PdfReader) -> None:
    told = reader.root_object["/Metadata"].get_object().get_data()
    for claim in (b"pdfuaid:part>1<", b"pdfaid:part>3<", b"pdfaid:conformance>A<"):
        assert claim in told
    (intent,) = reader.root_object["/OutputIntents"]
    assert intent.get_object()["/S"] == "/GTS_PDFA1"


def test_pdf_is_archivable(reader: pypdf.PdfReader, document: Document) -> None:
    """Nothing is missing that a viewer in thirty years needs, and nothing acts by itself."""
    root = reader.root_object
    assert root["/MarkInfo"]["/Marked"]
    assert not {"/OpenAction", "/AA", "/AcroForm"} & set(root)
    assert "/Encrypt" not in reader.trailer
    assert len(root["/AF"]) == len(document.attachments)
    for number in range(1, len(reader.xref[0]) + 1):
        record = reader.get_object(number)
        if not isinstance(record, dict):
            continue
        assert record.get("/S") not in ("/JavaScript", "/Launch", "/URI")
        if record.get("/Type") == "/FontDescriptor":
            assert {"/FontFile", "/FontFile2", "/FontFile3"} & set(record)
        if record.get("/Type") == "/Font" and record["/Subtype"] == "/Type0":
            assert "/ToUnicode" in record
        if record.get("/Type") == "/Filespec":
            assert {"/F", "/UF", "/AFRelationship", "/Desc"} <= set(record)


def structure(element: Any) -> Iterator[tuple[str, list[str], dict[str, Any]]]:
    """Role, roles of the children, and the record, of every element of the structure tree."""
    record = element.get_object()
    if isinstance(record, list):
        for each in record:
            yield from structure(each)
    elif isinstance(record, dict) and "/S" in record:
        children = record.get("/K", [])
        children = children.get_object() if hasattr(children, "get_object") else children
        children = children if isinstance(children, list) else [children]
        named = [each.get_object() for each in children if hasattr(each, "get_object")]
        yield record["/S"], [each["/S"] for each in named if isinstance(each, dict) and "/S" in each], record
        for each in children:
            if hasattr(each, "get_object"):
                yield from structure(each)


def test_pdf_structure_is_what_a_screen_reader_needs(reader: pypdf.PdfReader, document: Document) -> None:
    elements = list(structure(reader.root_object["/StructTreeRoot"]["/K"]))
    roles = [role for role, _, _ in elements]
    allowed = {
        "/Table": {"/Caption", "/THead", "/TBody", "/TR"},
        "/THead": {"/TR"},
        "/TBody": {"/TR"},
        "/TR": {"/TH", "/TD"},
        "/L": {"/LI", "/Caption"},
        "/LI": {"/Lbl", "/LBody"},
        "/TOC": {"/TOCI", "/TOC"},
    }
    for role, children, record in elements:
        if role in allowed:
            assert children, role
            assert set(children) <= allowed[role], (role, children)
        if role in ("/Figure", "/Formula"):
            assert record["/Alt"].strip()
    tables = [block for block in document.blocks + document.summary if isinstance(block, Table)]
    assert roles.count("/Table") == len(tables) + 1  # that of the signatures
    assert roles.count("/THead") == roles.count("/Table")
    rows = [block.rows for block in document.blocks if isinstance(block, Definitions)]
    assert roles.count("/Lbl") >= sum(map(len, rows)) + len(document.provenance)
    levels = [int(role[2:]) for role in roles if re.fullmatch("/H[1-6]", role)]
    assert levels[0] == 1
    assert all(after <= before + 1 for before, after in pairwise(levels))


def test_typst_refuses_what_would_break_the_standards(document: Document) -> None:
    """A picture without a text would be neither accessible nor archivable: the validator is at work."""
    mute = replace(next(each for each in document.blocks if isinstance(each, Figure)))
    object.__setattr__(mute, "alt", "")
    with pytest.raises(RuntimeError, match="PDF/UA-1 error: missing alt text"):
        render_pdf(
            replace(document, blocks=(mute,), summary=(), verdict=replace(document.verdict, sentence=""))
        )


def test_page_one_tells_the_result(reader: pypdf.PdfReader) -> None:
    first = " ".join(reader.pages[0].extract_text().split())
    order = ["Wheel slide protection of the ER24PC", "? undecided", "The reaching condition is proved"]
    order += ["219.8", "12.94", "Table 1.", "C9", "Role Name Signature Date", f"1/{len(reader.pages)}"]
    positions = [first.find(each) for each in order]
    assert -1 not in positions
    assert positions == sorted(positions)
    assert "Contents 1 The slip equation" in " ".join(reader.pages[1].extract_text().split())


def test_no_unit_breaks_away(pdf_text: str) -> None:
    assert "−3.2\N{NO-BREAK SPACE}kN\N{NO-BREAK SPACE}m" in pdf_text


def test_a_long_table_repeats_its_header(reader: pypdf.PdfReader) -> None:
    table = [text for sheet in reader.pages if "variant" in (text := sheet.extract_text())]
    assert len(table) >= 2
    assert all("Distance" in text and "Slip rms" in text for text in table)
    assert all(f"variant {row}" in "".join(table) for row in range(60))


def test_numbers_agree_with_html(pdf_text: str, page: Page) -> None:
    html_text = "".join(page.texts)
    for shown in (
        "1.1 Reaching condition",
        "1.1.1 In the worst corner",
        "2 Stops",
        "(19)",
        "Section 1.1",
        "Eq. (19)",
    ):
        assert shown in html_text, shown
        assert shown in pdf_text, shown
    for label in ("Figure 1.", "Figure 2.", "Table 1.", "Table 2."):
        assert label in html_text
        assert label in pdf_text


def test_pdf_alternative_texts(reader: pypdf.PdfReader, document: Document) -> None:
    found = set()
    for number in range(1, len(reader.xref[0]) + 1):
        record = reader.get_object(number)
        if isinstance(record, dict) and "/Alt" in record:
            found.add(record["/Alt"])
    assert {block.alt for block in document.blocks if isinstance(block, Figure)} <= found
    assert "T brake" in found
    assert "V equals one half of s squared." in found


def test_pdf_attachments(reader: pypdf.PdfReader, document: Document) -> None:
    for attachment in document.attachments:
        assert reader.attachments[attachment.name] == [attachment.content.encode()]


def test_figure_text_is_set_in_the_shipped_font(reader: pypdf.PdfReader, pdf_text: str) -> None:
    fonts = {
        font.get_object()["/BaseFont"].split("+")[-1]
        for sheet in reader.pages
        for font in sheet["/Resources"].get_object().get("/Font", {}).get_object().values()
    }
    assert "time [s]" in pdf_text
    assert any(name.startswith("DejaVuSans") for name in fonts)
    assert any(name.startswith("LibertinusSerif") for name in fonts)


def test_pdf_is_reproducible(pdf: bytes, document: Document) -> None:
    assert render_pdf(sample()) == pdf
    later = replace(document, timestamp=document.timestamp + timedelta(days=1))
    assert render_pdf(later) != pdf


# Cost


def test_the_block_model_is_cheap_to_import() -> None:
    """Whoever builds or writes a report loads the heavy libraries only when something is rendered."""
    program = (
        "import sys; from wspd_design.reporting import blocks, figure_style, html, output, pdf; "
        "print(sorted({'sympy', 'matplotlib', 'typst', 'jinja2', 'numpy'} & set(sys.modules)))"
    )
    printed = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    ).stdout
    assert printed == "[]\n"


# Text from outside


def test_long_words_stay_on_the_page(document: Document) -> None:
    blocks = (Paragraph(text="w" * 300), Code(text="c" * 300), *document.blocks)
    with pypdfium2.PdfDocument(render_pdf(replace(document, blocks=blocks))) as file:
        text = file[2].get_textpage()  # after result and contents
        boxes = [text.get_charbox(index) for index in range(text.count_chars())]
        width = file[2].get_width()
    assert len(boxes) > 600
    assert max(right for _, _, right, _ in boxes) < width - 60  # the margin is 22 mm


@pytest.fixture(scope="module")
def hostile() -> Document:
    """Foreign text in every place that takes text."""
    document = sample(HOSTILE)
    table = next(block for block in document.blocks if isinstance(block, Table))
    return replace(
        document,
        title=f"T {HOSTILE}",
        subtitle=HOSTILE,
        status_line=HOSTILE,
        verdict=replace(document.verdict, sentence=HOSTILE),
        blocks=(
            *(block for block in document.blocks if block is not table),
            replace(table, caption=HOSTILE, rows=((HOSTILE,) * 5, *table.rows)),
        ),
        provenance=(Definition(term=HOSTILE, text=rich("`" + HOSTILE.replace("`", "") + "`")),),
        attachments=tuple(replace(each, description=HOSTILE) for each in document.attachments),
    )


def test_hostile_text_is_shown_in_html(hostile: Document) -> None:
    html = render_html(hostile)
    page = Page(html)
    assert [tag for tag, _ in page.tags].count("script") == 1
    assert html.count("<style>") == html.count("</style>") == 1
    shown = HOSTILE.replace("\0", "\N{REPLACEMENT CHARACTER}")
    assert sum(shown in text for text in page.texts) >= 12
    assert "\0" not in html


def test_hostile_text_is_shown_in_pdf(hostile: Document) -> None:
    with pytest.warns(UserWarning, match="the fonts of the PDF lack .*\N{PILE OF POO}.*the HTML has them"):
        reader = pypdf.PdfReader(io.BytesIO(render_pdf(hostile)))
    text = "".join("".join(sheet.extract_text() for sheet in reader.pages).split())
    start, _ = HOSTILE.split("\N{PILE OF POO}")
    assert text.count("".join(start.split())) >= 10
    assert text.count("[U+1F4A9]") >= 10
    assert reader.metadata is not None
    assert (reader.metadata.title or "").startswith("T #import")


def test_no_name_turns_the_direction_of_the_text_around_it() -> None:
    """U+202E showed "evil" as "live" in the page and in the title of the PDF (finding 14)."""
    with figure_style():
        figure = new_figure(height=1.0)
        figure.subplots().set_title("\u202egnp.exe")
    picture = Figure(svg=figure_svg(figure), caption="\u2067x", alt="\u202ey", anchor="picture")
    document = sample("plain")
    hebrew = "\u05e9\u05dc\u05d5\u05dd \u05e8\u05db\u05d1\u05ea"
    document = replace(
        document,
        title="live \u202elive",
        blocks=(Paragraph(text=f"{hebrew} 3.2 and"), *document.blocks, picture),
    )
    turning = re.compile("[\u061c\u200e\u200f\u202a-\u202e\u2066\u2067]")
    html = render_html(document)
    assert not turning.search(html)
    assert "<title>live [U+202E]live</title>" in html
    for shown in ("[U+202E]gnp.exe", "[U+2067]x", 'aria-label="[U+202E]y"'):
        assert shown in html
    assert f"<p>\u2068{hebrew}\u2069 3.2 and</p>" in html
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # about Hebrew
        reader = pypdf.PdfReader(io.BytesIO(render_pdf(document)))
    assert reader.metadata is not None
    assert reader.metadata.title == "live [U+202E]live"
    text = "".join(sheet.extract_text() for sheet in reader.pages)
    assert not turning.search(text)
    assert "[U+202E]gnp.exe" in text


def test_names_that_the_fonts_lack_are_spelled_in_figures_too() -> None:
    """A Chinese name became U+FFFD without a word, and figures lost it altogether (case h10)."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")  # Matplotlib has nothing to say: the PDF does
        figure = new_figure(height=1.0)
        figure.subplots().set_title("afsmc-\u673a\u8f66")
        svg = figure_svg(figure)
    assert "\u673a\u8f66" in svg
    picture = Figure(svg=svg, caption="\u673a\u8f66", alt="\u673a", anchor="picture")
    document = sample("plain")
    document = replace(document, title="\u673a\u8f66", blocks=(*document.blocks, picture))
    assert "\u673a\u8f66" in render_html(document)
    with pytest.warns(UserWarning, match="lack \u673a \u8f66, .* as in \\[U\\+673A\\]; the HTML has them"):
        reader = pypdf.PdfReader(io.BytesIO(render_pdf(document)))
    text = "".join(" ".join(sheet.extract_text().split()) for sheet in reader.pages)
    assert text.count("[U+673A U+8F66]") >= 3  # title, figure and caption
    assert "\ufffd" not in text
