"""A document as PDF through Typst: tagged for screen readers (PDF/UA-1), with its files attached.

The template gets the document as data, never as source: no text can turn into Typst markup.
"""

import json
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any

from wspd_design.reporting.blocks import (
    Block,
    Bullets,
    Cell,
    Code,
    Definitions,
    Document,
    Equation,
    Figure,
    Heading,
    KeyNumbers,
    Paragraph,
    Status,
    Table,
    Verdict,
)
from wspd_design.reporting.figure_style import FONT_FAMILY
from wspd_design.reporting.numbering import PROVENANCE, NumberedBlock, number
from wspd_design.reporting.svg import size
from wspd_design.reporting.text import CodeSpan, Emphasis, Inline, Link, Math, Text, plain, printable, spans


def render_pdf(document: Document) -> bytes:
    """Return a document as PDF.

    Fonts come from Typst and Matplotlib alone, so that every machine sets the same pages.
    """
    import typst

    source = files("wspd_design.reporting").joinpath("templates/report.typ").read_bytes()
    pdf: bytes = typst.compile(
        source,
        format="pdf",
        font_paths=typst.Fonts(include_system_fonts=False, font_paths=[_font_folder()]),
        sys_inputs={"document": json.dumps(_document(document)), "fallback": FONT_FAMILY},
        pdf_standards="ua-1",
        timestamp=int(document.timestamp.timestamp()),
    )
    return pdf


def _font_folder() -> Path:
    import matplotlib

    return Path(matplotlib.get_data_path()) / "fonts" / "ttf"


@cache
def _drawable() -> frozenset[str]:
    """Return the characters that the fallback font can draw."""
    from matplotlib.ft2font import FT2Font

    font = FT2Font(str(_font_folder() / f"{FONT_FAMILY.replace(' ', '')}.ttf"))
    return frozenset(map(chr, font.get_charmap())) | {"\n", "\t"}


def _plain(text: str) -> str:
    """Replace what no font of ours can draw: PDF/UA refuses a document with missing glyphs."""
    return "".join(c if c in _drawable() else "\N{REPLACEMENT CHARACTER}" for c in printable(text))


def _document(document: Document) -> dict[str, Any]:
    numbering = number(document)
    return {
        "title": _plain(document.title),
        "subtitle": _plain(document.subtitle),
        "status-line": _plain(document.status_line),
        "verdict": _verdict(document.verdict),
        "summary": [_block(each) for each in numbering.summary],
        "blocks": [_block(each) for each in numbering.blocks],
        "labels": numbering.labels,
        "provenance": {
            "anchor": PROVENANCE,
            "rows": [{"term": _text(row.term), "text": _text(row.text)} for row in document.provenance],
        },
        "attachments": [
            {
                "name": _plain(each.name),
                "media-type": each.media_type,
                "content": each.content,
                "description": _plain(each.description),
            }
            for each in document.attachments
        ],
    }


def _text(text: Text) -> list[dict[str, str]]:
    return [_span(span) for span in spans(text)]


def _span(span: Inline) -> dict[str, str]:
    match span:
        case Emphasis():
            return {"kind": "emphasis", "text": _plain(span.text)}
        case CodeSpan():
            return {"kind": "code", "text": _plain(span.text)}
        case Math():
            return {"kind": "math", "source": span.source, "spoken": span.spoken}
        case Link():
            return {"kind": "link", "anchor": span.anchor, "text": _plain(span.text)}
        case str():
            return {"kind": "plain", "text": _plain(span)}


def _status(status: Status) -> dict[str, str]:
    return {"sign": status.sign, "word": status.word, "tone": status.tone}


def _verdict(verdict: Verdict) -> dict[str, Any]:
    return {"kind": "verdict", "status": _status(verdict.status), "sentence": _text(verdict.sentence)}


def _cell(cell: Text | Cell) -> dict[str, Any]:
    if isinstance(cell, Cell):
        return {"status": _status(cell.status), "text": _text(cell.text or cell.status.word)}
    return {"status": None, "text": _text(cell)}


LONG_TEXT = 25  # characters


def _length(cell: Text | Cell) -> int:
    """Return the characters of a cell; the sign of a status and the space behind it count."""
    if isinstance(cell, Cell):
        return len(plain(cell.text or cell.status.word)) + 2
    return len(plain(cell))


def _shares(table: Table) -> list[int]:
    """Return for each column its share of the free width; 0 for columns as wide as their content.

    Columns of long texts share what the short ones leave, in proportion to their longest text; without a long
    text all share.
    """
    longest = [
        max(len(plain(column.title)), *map(_length, cells)) if cells else len(plain(column.title))
        for column, *cells in zip(table.columns, *table.rows, strict=True)
    ]
    if max(longest) < LONG_TEXT:
        return longest
    return [min(length, 80) if length >= LONG_TEXT else 0 for length in longest]


def _block(numbered: NumberedBlock) -> dict[str, Any]:
    """Return a block as the plain data that the template expects."""
    block: Block = numbered.block
    match block:
        case Heading():
            return {
                "kind": "heading",
                "text": _plain(block.text),
                "level": block.level,
                "anchor": block.anchor,
            }
        case Paragraph():
            return {"kind": "paragraph", "text": _text(block.text)}
        case Bullets():
            return {"kind": "bullets", "items": [_text(item) for item in block.items]}
        case Definitions():
            rows = [{"term": _text(row.term), "text": _text(row.text)} for row in block.rows]
            return {"kind": "definitions", "rows": rows}
        case Code():
            return {"kind": "code", "text": _plain(block.text)}
        case Equation():
            return {
                "kind": "equation",
                "source": block.source,
                "spoken": block.description,
                "number": _plain(block.number),
                "anchor": block.anchor,
            }
        case Figure():
            return {
                "kind": "figure",
                "svg": block.svg,
                "width": size(block.svg)[0],
                "alt": _plain(block.alt),
                "label": numbered.label,
                "caption": _text(block.caption),
                "anchor": block.anchor,
            }
        case Table():
            return {
                "kind": "table",
                "label": numbered.label,
                "caption": _text(block.caption),
                "anchor": block.anchor,
                "columns": [
                    {
                        "title": _text(column.title),
                        "unit": _plain(column.unit),
                        "align": column.align,
                        "share": share,
                    }
                    for column, share in zip(block.columns, _shares(block), strict=True)
                ],
                "rows": [[_cell(cell) for cell in row] for row in block.rows],
            }
        case Verdict():
            return _verdict(block)
        case KeyNumbers():
            return {
                "kind": "key-numbers",
                "numbers": [
                    {
                        "label": _plain(each.label),
                        "value": _plain(each.value),
                        "unit": _plain(each.unit),
                        "note": _text(each.note),
                    }
                    for each in block.numbers
                ],
            }
