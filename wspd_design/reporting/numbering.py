"""Numbers of sections, figures and tables, given once so that HTML, PDF and every reference agree."""

import re
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, fields, is_dataclass

from wspd_design.reporting.blocks import Block, Document, Equation, Figure, Heading, Table
from wspd_design.reporting.text import Link, Math

CONTENTS, PROVENANCE = "contents", "provenance"
"""Anchors that every report has."""


@dataclass(frozen=True, slots=True, kw_only=True)
class NumberedBlock:
    """A block with its label, such as ``2.1`` or ``Figure 3``; empty for blocks without a number."""

    block: Block
    label: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Numbering:
    """The blocks of a document with their labels, and the label behind each anchor."""

    summary: tuple[NumberedBlock, ...]
    blocks: tuple[NumberedBlock, ...]
    labels: dict[str, str]
    headings: tuple[NumberedBlock, ...]


def number(document: Document) -> Numbering:
    """Number the blocks of a document.

    Raises
    ------
    ValueError
        If an anchor is malformed or used twice, a link leads nowhere, or the headings skip a level.
    """
    summary, blocks = _with_labels(document)
    labels = {CONTENTS: "Contents", PROVENANCE: "Provenance"}
    for numbered in summary + blocks:
        if isinstance(numbered.block, Heading | Figure | Table | Equation) and (
            anchor := numbered.block.anchor
        ):
            if not re.fullmatch(r"[a-z][a-z0-9-]*", anchor):
                raise ValueError(f"anchor {anchor!r}: must consist of lower-case letters, digits and hyphens")
            if anchor in labels:
                raise ValueError(f"anchor {anchor!r}: is used twice; every anchor must be unique")
            is_section = isinstance(numbered.block, Heading)
            labels[anchor] = f"Section {numbered.label}" if is_section else numbered.label
    for part in parts(document):
        if isinstance(part, Link) and part.anchor not in labels:
            raise ValueError(f"link to #{part.anchor}: the document has no such anchor")
    attached = [each.name for each in document.attachments]
    for numbered in summary + blocks:
        if isinstance(numbered.block, Figure) and numbered.block.data not in ("", *attached):
            raise ValueError(
                f"{numbered.label}: its numbers are in {numbered.block.data}, which is not attached"
            )
    headings = tuple(each for each in blocks if isinstance(each.block, Heading))
    return Numbering(summary=summary, blocks=blocks, labels=labels, headings=headings)


def _with_labels(document: Document) -> tuple[tuple[NumberedBlock, ...], tuple[NumberedBlock, ...]]:
    """Label the blocks in the order in which they appear."""
    section: list[int] = []
    seen: Counter[str] = Counter()

    def label(block: Block) -> str:
        match block:
            case Heading(level=level):
                if not 1 <= level <= len(section) + 1:
                    raise ValueError(f"heading {block.text!r}: level {level} skips a level")
                section[level - 1 :] = [section[level - 1] + 1 if level <= len(section) else 1]
                return ".".join(map(str, section))
            case Figure() | Table():
                kind = type(block).__name__
                seen[kind] += 1
                return f"{kind} {seen[kind]}"
            case Equation():
                return f"Eq. ({block.number})" if block.number else "the equation"
            case _:
                return ""

    if any(isinstance(block, Heading) for block in document.summary):
        raise ValueError("the summary stands on the first page and has no headings; move them to the blocks")
    summary = tuple(NumberedBlock(block=block, label=label(block)) for block in document.summary)
    return summary, tuple(NumberedBlock(block=block, label=label(block)) for block in document.blocks)


def parts(record: object) -> Iterator[object]:
    """Yield a record and everything inside it, in reading order."""
    yield record
    if isinstance(record, tuple):
        for item in record:
            yield from parts(item)
    elif is_dataclass(record):
        for field in fields(record):
            yield from parts(getattr(record, field.name))


def unreferenced(document: Document) -> tuple[str, ...]:
    """Return the labels of figures and tables to which no text of the document refers."""
    referred = {
        part.anchor
        for block in (document.verdict, *document.summary, *document.blocks, *document.provenance)
        for part in parts(block)
        if isinstance(part, Link)
    }
    numbering = number(document)
    return tuple(
        each.label
        for each in numbering.summary + numbering.blocks
        if isinstance(each.block, Figure | Table) and each.block.anchor not in referred
    )


def formulas(document: Document) -> tuple[Math | Equation, ...]:
    """Return every formula of a document, inline or displayed, in reading order."""
    return tuple(part for part in parts(document) if isinstance(part, Math | Equation))
