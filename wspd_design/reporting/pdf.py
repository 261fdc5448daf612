"""A document as PDF through Typst: for screen readers (PDF/UA-1) and archives (PDF/A-3a), with its files attached.

The template gets the document as data, never as source: no text can turn into Typst markup.
"""

import json
import warnings
from collections.abc import Iterable
from functools import cache
from importlib.resources import files
from itertools import groupby
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
from wspd_design.reporting.template import ROLES, Template
from wspd_design.reporting.text import (
    CodeSpan,
    Emphasis,
    Inline,
    Link,
    Math,
    Text,
    plain,
    printable,
    spans,
    unbroken,
)


def render_pdf(document: Document) -> bytes:
    """Return a document as PDF.

    Fonts come from Typst and Matplotlib alone, so that every machine sets the same pages. What they cannot draw, such
    as Chinese or an emoji, is spelled by its code points; a warning says so.
    """
    import typst

    missing: set[str] = set()
    content = spelled(_document(document), missing)
    if missing:
        warnings.warn(
            f"the fonts of the PDF lack {' '.join(sorted(missing))}, which stand there by their code points, as in "
            f"{spelled(min(missing), set())}; the HTML has them",
            stacklevel=2,
        )
    source = files("wspd_design.reporting").joinpath("templates/report.typ").read_bytes()
    pdf: bytes = typst.compile(
        source,
        format="pdf",
        font_paths=typst.Fonts(include_system_fonts=False, font_paths=[_font_folder()]),
        sys_inputs={"document": json.dumps(content), "fallback": FONT_FAMILY},
        pdf_standards=["ua-1", "a-3a"],  # Typst refuses a document that breaks either
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


_AS_IT_IS = ("content", "stored")  # of an attachment: what no page shows


def spelled(value: Any, missing: set[str]) -> Any:
    """Return data for the template with code points in place of what no font of ours can draw.

    PDF/UA refuses a document with missing glyphs. Attached files stay as they are.

    Parameters
    ----------
    value : any
        Text, or lists and dictionaries of it.
    missing : set of str
        Gets the characters that were spelled.
    """
    match value:
        case str():
            lacking = set(value) - _drawable()
            if not lacking:
                return value
            missing |= lacking
            runs = groupby(value, key=lacking.__contains__)
            return "".join(_code_points(run) if lacks else "".join(run) for lacks, run in runs)
        case list():
            return [spelled(each, missing) for each in value]
        case dict():
            return {key: each if key in _AS_IT_IS else spelled(each, missing) for key, each in value.items()}
    return value


def _code_points(characters: Iterable[str]) -> str:
    return f"[{' '.join(f'U+{ord(each):04X}' for each in characters)}]"


def _document(document: Document) -> dict[str, Any]:
    numbering = number(document)
    return {
        "title": printable(document.title),
        "subtitle": printable(document.subtitle),
        "status-line": printable(document.status_line),
        "author": printable(document.author),
        "keywords": [printable(each) for each in document.keywords],
        "description": printable(plain(document.verdict.sentence)),
        "template": _template(document.template),
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
                "name": printable(each.name),
                "stored": each.name,
                "media-type": each.media_type,
                "content": each.content,
                "description": printable(each.description),
            }
            for each in document.attachments
        ],
    }


def _template(template: Template | None) -> dict[str, Any] | None:
    if template is None:
        return None
    logo = template.logo
    return {
        "organization": printable(template.organization),
        "document-number": printable(template.document_number),
        "issue": printable(template.issue),
        "logo": None if logo is None else {"format": logo.format, "content": list(logo.content)},
        "signatures": [
            {"role": role.capitalize(), "name": printable(getattr(template, role))} for role in ROLES
        ],
    }


def _text(text: Text) -> list[dict[str, str]]:
    return [_span(span) for span in spans(text)]


def _span(span: Inline) -> dict[str, str]:
    match span:
        case Emphasis():
            return {"kind": "emphasis", "text": printable(span.text)}
        case CodeSpan():
            return {"kind": "code", "text": printable(span.text)}
        case Math():
            return {"kind": "math", "source": span.source, "spoken": span.spoken}
        case Link():
            return {"kind": "link", "anchor": span.anchor, "text": printable(span.text)}
        case str():
            return {"kind": "plain", "text": unbroken(printable(span))}


def _status(status: Status) -> dict[str, str]:
    return {"sign": status.sign, "word": status.word, "tone": status.tone}


def _verdict(verdict: Verdict) -> dict[str, Any]:
    return {"kind": "verdict", "status": _status(verdict.status), "sentence": _text(verdict.sentence)}


def _cell(cell: Text | Cell) -> dict[str, Any]:
    if isinstance(cell, Cell):
        return {"status": _status(cell.status), "text": _text(cell.text or cell.status.word)}
    return {"status": None, "text": _text(cell)}


LONG_TEXT = 25  # characters
LINE = 80  # characters that the columns of long texts have on a line, at least
SHORT_ROWS, SHORT_TEXT = 8, 1000  # rows and characters of a table that fits any page


def _length(cell: Text | Cell) -> int:
    """Return the characters of a cell; the sign of a status and the space behind it count."""
    if isinstance(cell, Cell):
        return len(plain(cell.text or cell.status.word)) + 2
    return len(plain(cell))


def _shares(table: Table) -> list[int]:
    """Return for each column its share of the free width; 0 for columns as wide as their content.

    Columns of long texts share what the short ones leave, in proportion to their longest text; without a long
    text all share. A column is as wide as its longest word.
    """
    longest = [
        max(len(plain(column.title)), *map(_length, cells)) if cells else len(plain(column.title))
        for column, *cells in zip(table.columns, *table.rows, strict=True)
    ]
    if max(longest) < LONG_TEXT:
        return longest
    wanted = [min(length, 80) if length >= LONG_TEXT else 0 for length in longest]
    words = [max(map(_longest_word, column)) for column in zip(_titles(table), *table.rows, strict=True)]
    return [
        max(share, -(-word * sum(wanted) // LINE)) if share else 0
        for share, word in zip(wanted, words, strict=True)
    ]


def _titles(table: Table) -> tuple[Text, ...]:
    return tuple(column.title for column in table.columns)


def _longest_word(cell: Text | Cell) -> int:
    """Return the characters of the longest part of a cell that no line breaks."""
    text = cell.text or cell.status.word if isinstance(cell, Cell) else cell
    return max(map(len, plain(text).split()), default=0)


def _is_long(table: Table) -> bool:
    """Tell whether a table may go over two pages; a short one stays whole."""
    return (
        len(table.rows) > SHORT_ROWS or sum(_length(cell) for row in table.rows for cell in row) > SHORT_TEXT
    )


def _block(numbered: NumberedBlock) -> dict[str, Any]:
    """Return a block as the plain data that the template expects."""
    block: Block = numbered.block
    match block:
        case Heading():
            return {
                "kind": "heading",
                "text": printable(block.text),
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
            return {"kind": "code", "text": printable(block.text)}
        case Equation():
            return {
                "kind": "equation",
                "source": block.source,
                "spoken": block.description,
                "number": printable(block.number),
                "anchor": block.anchor,
            }
        case Figure():
            return {
                "kind": "figure",
                "svg": block.svg,
                "width": size(block.svg)[0],
                "alt": printable(block.alt),
                "label": numbered.label,
                "caption": _text(block.caption),
                "anchor": block.anchor,
                "data": printable(block.data),
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
                        "unit": printable(column.unit).replace(" ", "\N{NO-BREAK SPACE}"),
                        "align": column.align,
                        "share": share,
                    }
                    for column, share in zip(block.columns, _shares(block), strict=True)
                ],
                "rows": [[_cell(cell) for cell in row] for row in block.rows],
                "breakable": _is_long(block),
            }
        case Verdict():
            return _verdict(block)
        case KeyNumbers():
            return {
                "kind": "key-numbers",
                "numbers": [
                    {
                        "label": printable(each.label),
                        "value": printable(each.unbroken),
                        "unit": printable(each.unit).replace(" ", "\N{NO-BREAK SPACE}"),
                        "note": _text(each.note),
                    }
                    for each in block.numbers
                ],
            }
