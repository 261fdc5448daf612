"""The record of an older report, as it is attached to every report; it may come from a stranger."""

import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from wspd_design.parameters.errors import UserError
from wspd_design.studies.provenance import InputFile

PREVIOUS = "previous.json"
_SCHEMA = "wspd-report/"


@dataclass(frozen=True, slots=True, kw_only=True)
class Previous:
    """What an older report states."""

    text: str
    record: Mapping[str, Any]

    @property
    def sha256(self) -> str:
        """Of its ``report.json``."""
        return hashlib.sha256(self.text.encode()).hexdigest()

    @property
    def made_at(self) -> str:
        """Date and time of the older report; empty where it states none."""
        return _told(self.record, "provenance", "made_at")

    @property
    def law(self) -> str:
        """Name of the law that the older report is about; empty where it states none."""
        return _told(self.record, "law", "name") or _told(self.record, "design", "name")

    @property
    def input(self) -> InputFile:
        """The record as a file that a report is made from."""
        return InputFile(
            name=PREVIOUS, text=self.text, meaning="the numbers of the older report, for the changes"
        )


def previous(text: str, where: str) -> Previous:
    """Read the ``report.json`` of an older report.

    Raises
    ------
    UserError
        If it is something else.
    """
    try:
        record = json.loads(text)
    except (ValueError, RecursionError):
        raise UserError(
            f"{where} is not JSON that can be read; take the report.json that a report attaches"
        ) from None
    if not isinstance(record, dict) or not str(record.get("schema", "")).startswith(_SCHEMA):
        raise UserError(f"{where} is not the record of a report; take the report.json that a report attaches")
    return Previous(text=text, record=record)


def _told(record: Mapping[str, Any], *keys: str) -> str:
    found: Any = record
    for key in keys:
        found = found.get(key) if isinstance(found, dict) else None
    return found if isinstance(found, str) else ""
