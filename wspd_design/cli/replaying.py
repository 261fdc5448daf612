"""``wspd report --replay``: makes a report again from its attachments, and compares numbers, verdicts and bytes."""

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from wspd_design.cli.received import Received, damaged, laid_out, receive
from wspd_design.cli.report_call import compute, over_attachments
from wspd_design.design.case import load_case
from wspd_design.parameters.errors import UserError
from wspd_design.reporting.attached import read_limited
from wspd_design.reporting.attachments import RECORD, SUMS
from wspd_design.reporting.differences import differences
from wspd_design.reporting.output import rendered
from wspd_design.reporting.report import report_document
from wspd_design.reporting.template import BLANK, read_template
from wspd_design.studies.inputs import COMMAND, DESIGN
from wspd_design.studies.previous import previous

_MADE_BY = (
    "program_version",
    "package_sha256",
    "package_tree",
    "changed",
    "compiler",
    "platform",
    "versions",
)
"""What may differ from machine to machine; a report is compared as if it had been made by the same."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Replay:
    """What a replay found."""

    difference: str  # the first one, in words; empty where all is the same
    made_by: tuple[str, ...]  # what the report was made by and this machine has not
    entries: int  # numbers, verdicts and words that were compared
    files: int  # attachments


def replay(path: Path, *, law: str | None, progress: Callable[[str], None]) -> Replay:
    """Make a report again and compare.

    Parameters
    ----------
    path : Path
        The report; it may come from a stranger.
    law : str or None
        ``FILE.py:NAME`` that the user allows to run, for a report on a law of one's own.
    progress : callable
        Told each stage before it starts.

    Raises
    ------
    UserError
        If it is no report, or refers to what is not attached.
    """
    received = receive(path)
    content, (made_at, made_by) = read_limited(path), _stated(received)
    if wrong := damaged(received):
        return _found(received, f"the attachment {wrong!a} is not the one of {SUMS}")
    call = received.call
    with laid_out(received, law):
        template = BLANK if call.template is None else read_template(call.template)
        older = None if call.diff is None else previous(received.files[call.diff], call.diff)
        case = load_case(call.law, call.case_options)
        again, inputs = over_attachments(case, call, older)
        if again != call:
            return _found(received, f"{COMMAND} is not the command that the attached files give")
        with TemporaryDirectory(prefix="wspd-") as empty:
            loaded = None if call.law == DESIGN else case
            computed = compute(call, inputs, Path(empty), case=loaded, progress=progress)
    progress("typesetting")
    here = computed.provenance
    document = report_document(replace(computed, provenance=replace(here, **made_by)), made_at, template)
    texts = {each.name: each.content for each in document.attachments}
    difference = (
        _in_record(received.files[RECORD], texts[RECORD])
        or _in_files(received.files, texts)
        or _in_bytes(content, rendered(document, path))
    )
    others = {name: getattr(here, name) for name in made_by}
    return _found(received, difference, _told(made_by, others))


def _found(received: Received, difference: str, made_by: tuple[str, ...] = ()) -> Replay:
    return Replay(
        difference=difference, made_by=made_by, entries=_count(received.record), files=len(received.files)
    )


def _stated(received: Received) -> tuple[datetime, dict[str, Any]]:
    """Return when a report was made, and by what."""
    stated = received.record.get("provenance")
    stated = stated if isinstance(stated, dict) else {}
    kinds: dict[str, type] = dict.fromkeys(_MADE_BY, str) | {"changed": bool, "versions": dict}
    wrong = [name for name, kind in kinds.items() if not isinstance(stated.get(name), kind)]
    try:
        made_at = datetime.fromisoformat(str(stated.get("made_at")))
        wrong += [] if made_at.tzinfo == UTC else ["made_at"]
    except ValueError:
        wrong.append("made_at")
    if wrong or not all(isinstance(each, str) for each in stated["versions"].values()):
        missing = ", ".join(wrong) or "versions"
        raise UserError(
            f"{RECORD} of {received.path} does not state {missing} as a report does; take the original file"
        )
    return made_at, {name: stated[name] for name in _MADE_BY} | {
        "versions": tuple(stated["versions"].items())
    }


def _told(stated: Mapping[str, Any], here: Mapping[str, Any]) -> tuple[str, ...]:
    """Say what a report was made by and this machine has not."""
    old, new = ({**each, "versions": dict(each["versions"])} for each in (stated, here))
    return tuple(f"{each.place}: {each.before}, here {each.after}" for each in differences(old, new))


def _in_record(before: str, after: str) -> str:
    """Tell the first verdict or number that differs."""
    found = differences(json.loads(before), json.loads(after))
    if not found:
        return ""
    first = found[0]
    more = f", and {len(found) - 1} more" if found[1:] else ""
    return f"{first.kind.value} {first.place}: {first.before}, here {first.after}{more}"


def _in_files(before: Mapping[str, str], after: Mapping[str, str]) -> str:
    """Tell the first attachment that differs, and where."""
    for name in dict.fromkeys((*after, *before)):
        if name in (RECORD, SUMS) and before.get(name) != after[name]:
            continue  # what they say differs elsewhere, or below
        if name not in before:
            return f"the attachment {name!a} is missing"
        if name not in after:
            return f"the attachment {name!a} does not follow from the others"
        if before[name] != after[name]:
            lines = zip(before[name].splitlines(), after[name].splitlines(), strict=False)
            place = next((at for at, (old, new) in enumerate(lines, start=1) if old != new), "behind its end")
            return f"the attachment {name!a} in line {place}"
    return ""


def _in_bytes(before: bytes, after: bytes) -> str:
    """Tell the first byte that differs."""
    if before == after:
        return ""
    place = next((at for at, (old, new) in enumerate(zip(before, after, strict=False)) if old != new), None)
    at = min(len(before), len(after)) if place is None else place
    near = before[max(0, at - 30) : at + 30]
    return f"byte {at} of {len(before)}, near {near!r}; all numbers, verdicts and attachments are the same"


def _count(entry: object) -> int:
    """Count what a record states."""
    if isinstance(entry, dict):
        return sum(map(_count, entry.values()))
    return sum(map(_count, entry)) if isinstance(entry, list) else 1
