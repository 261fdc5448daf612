"""The change record: what an older report said and this one does not."""

import json
from datetime import UTC, datetime

from wspd_design.reporting import numbers
from wspd_design.reporting.blocks import Block, Heading, Paragraph, Table
from wspd_design.reporting.differences import Difference, Kind, differences
from wspd_design.reporting.record import report_record
from wspd_design.reporting.tables import ColumnOf, build
from wspd_design.reporting.text import CodeSpan, Inline, Link, rich
from wspd_design.studies.dossier import Dossier

CHANGES = "changes"
_OF_ITSELF = ("schema", "version", "provenance")
"""Entries that say how a report was made; those that matter have a table of their own."""
_MADE_BY = (
    "program_version",
    "package_sha256",
    "package_tree",
    "changed",
    "compiler",
    "platform",
    "versions",
    "seed",
    "searches_cut",
)
_HEADLINES = ("law", "specification", "design", "requirements", "uncertainty", "checks", "parameters")
_MOST_ROWS = 60
_LONGEST, _BEFORE = 70, 20  # characters of words that a table shows, and of them before what differs


def changes(dossier: Dossier) -> tuple[Block, ...]:
    """Return the section; without an older report it says that there is none."""
    heading = Heading(text="Change record", anchor=CHANGES)
    old = dossier.previous
    if old is None:
        text = "No older report was given to compare with; `wspd report --diff OLD` does."
        return (heading, Paragraph(text=rich(text)))
    found = since_previous(dossier)
    by_program = [each for each in found if each.where[0] == "provenance"]
    content = [each for each in found if each.where[0] != "provenance"]
    verdicts = [each for each in content if each.kind is Kind.VERDICT]
    values = [each for each in content if each.kind is Kind.NUMBER]
    headlines = [each for each in values if _is_headline(each, dossier)]
    words = [each for each in content if each.kind is Kind.WORDS]
    made_at = f" of {old.made_at}" if old.made_at else ""
    parts = (
        ("Verdicts that changed.", "changed-verdicts", verdicts),
        (
            "Numbers that changed: of the design, its requirements, its checks, its parameters and its own stop.",
            "changed-numbers",
            headlines,
        ),
        ("Sentences and words that changed.", "changed-words", words),
        ("What the two reports were made by.", "changed-program", by_program),
    )
    tables = [_table(rows, caption, anchor) for caption, anchor, rows in parts if rows]
    listed: list[Inline] = []
    for table in tables:
        listed += [", " if listed else "; see ", Link(anchor=table.anchor)]
    told = (
        f"Compared with the report{made_at} on {old.law or 'another law'}, whose report.json has the SHA-256 ",
        CodeSpan(text=old.sha256),
        f": {summary_of(found)}",
        *listed,
        ".",
    )
    left = len(values) - len(headlines)
    rest = f"{numbers.count(left, 'further number')}, of other stops and over speed, stand in the two attached records."
    return (heading, Paragraph(text=told), *tables, *([Paragraph(text=rest)] if left else []))


def since_previous(dossier: Dossier) -> tuple[Difference, ...]:
    """Return what differs from the older report; dates, commands and hashes of files, which always do, are left out."""
    if dossier.previous is None:
        return ()
    now = json.loads(
        json.dumps(report_record(dossier, datetime.fromtimestamp(0, UTC)))
    )  # as the older one was read
    before = dict(dossier.previous.record)
    content = differences(_content(before), _content(now))
    made_by = differences(*({"provenance": _made_by(each.get("provenance"))} for each in (before, now)))
    return (*content, *made_by)


def _content(record: dict[str, object]) -> dict[str, object]:
    return {key: each for key, each in record.items() if key not in _OF_ITSELF}


def summary_of(found: tuple[Difference, ...]) -> str:
    """Count differences in words."""
    totals = [(sum(each.kind is kind for each in found), kind.value) for kind in Kind]
    counts = [numbers.count(total, name) for total, name in totals if total]
    return f"{numbers.listing(counts)} differ{'s' if len(found) == 1 else ''}" if found else "nothing differs"


def _made_by(provenance: object) -> dict[str, object]:
    stated = provenance if isinstance(provenance, dict) else {}
    return {key: stated[key] for key in _MADE_BY if key in stated}


def _is_headline(each: Difference, dossier: Dossier) -> bool:
    own = each.where[:2] == ("stops", dossier.trials[0].run.controller)
    return own or each.where[0] in _HEADLINES


def _table(rows: list[Difference], caption: str, anchor: str) -> Table:
    more = f" The first {_MOST_ROWS} of {len(rows)}." if len(rows) > _MOST_ROWS else ""
    return build(
        rows[:_MOST_ROWS],
        (
            ColumnOf(title="What", read=lambda each: each.place),
            ColumnOf(title="Before", read=lambda each: shown(each)[0]),
            ColumnOf(title="Now", read=lambda each: shown(each)[1]),
        ),
        caption=f"{caption}{more}",
        anchor=anchor,
    )


def shown(each: Difference) -> tuple[str, str]:
    """Return both values short enough for a table, and so that what differs can be seen."""
    if each.kind is not Kind.WORDS:
        short = _six_digits(each.before), _six_digits(each.after)
        return short if short[0] != short[1] else (each.before, each.after)
    pairs = enumerate(zip(each.before, each.after, strict=False))
    same = next((at for at, (old, new) in pairs if old != new), 0)
    start = max(0, same - _BEFORE) if max(len(each.before), len(each.after)) > _LONGEST else 0
    return _from(each.before, start), _from(each.after, start)


def _six_digits(value: str) -> str:
    try:
        return f"{float(value):.6g}"
    except ValueError:
        return value


def _from(value: str, start: int) -> str:
    part = value[start : start + _LONGEST]
    return f"{'…' if start else ''}{part}{'…' if start + _LONGEST < len(value) else ''}"
