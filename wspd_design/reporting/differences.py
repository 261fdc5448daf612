"""What differs between the records of two reports: verdicts first, then numbers, then words."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from enum import Enum
from typing import Any

VERDICTS = (
    "verdict",
    "outcome",
    "status",
    "met",
    "holds",
    "ending",
    "stopped",
    "decision",
    "accepted",
    "search_cut",
    "sensitive",
)
"""Keys of what a report judges; everything else that is not a number is words."""

_NAMES = ("name", "controller", "requirement", "id", "subject", "words", "check", "text", "speed_m_s")
_NOTHING = object()


class Kind(Enum):
    """What is different; the value names it in sentences, where a number stands before it."""

    VERDICT = "verdict"
    NUMBER = "number"
    WORDS = "text"


@dataclass(frozen=True, slots=True, kw_only=True)
class Difference:
    """One entry that is not the same."""

    where: tuple[str, ...]  # keys, and names of items of lists
    kind: Kind
    before: str  # "none" where there was no such entry
    after: str

    @property
    def place(self) -> str:
        """Where it stands, in words."""
        return ": ".join(key.replace("_", " ") for key in self.where)


def differences(before: object, after: object) -> tuple[Difference, ...]:
    """Compare two records entry by entry.

    Parameters
    ----------
    before, after : object
        What ``json.loads`` returns for the ``report.json`` of two reports.

    Returns
    -------
    tuple of Difference
        In the order of the records, verdicts before numbers before words.
    """
    order = list(Kind)
    found = _differences(before, after, ())
    return tuple(sorted(found, key=lambda each: order.index(each.kind)))


def _differences(before: object, after: object, where: tuple[str, ...]) -> Iterator[Difference]:
    if isinstance(before, dict) and isinstance(after, dict):
        for key in dict.fromkeys((*before, *after)):
            yield from _differences(before.get(key, _NOTHING), after.get(key, _NOTHING), (*where, str(key)))
    elif isinstance(before, list) and isinstance(after, list):
        old, new = _named(before), _named(after)
        for key in dict.fromkeys((*old, *new)):
            yield from _differences(old.get(key, _NOTHING), new.get(key, _NOTHING), (*where, key))
    elif (judged := _judged(before) or _judged(after)) and _NOTHING in (before, after):
        was, now = (each[judged] if isinstance(each, dict) else each for each in (before, after))
        yield from _differences(was, now, (*where, judged))
    elif type(before) is not type(after) or before != after:
        yield Difference(
            where=where, kind=_kind(before, after, where), before=_said(before), after=_said(after)
        )


def _judged(entry: object) -> str:
    """Return the key of the verdict of an entry, if it has one."""
    return next((key for key in VERDICTS if key in entry), "") if isinstance(entry, dict) else ""


def _named(items: Sequence[object]) -> dict[str, object]:
    """Give each item of a list its name, or its place where names are missing or not of one item alone."""
    for key in _NAMES:
        names = [str(each[key]) for each in items if isinstance(each, Mapping) and key in each]
        if len(names) == len(items) == len(set(names)):
            return dict(zip(names, items, strict=True))
    return {str(number): each for number, each in enumerate(items, start=1)}


def _kind(before: object, after: object, where: tuple[str, ...]) -> Kind:
    if where and where[-1] in VERDICTS:
        return Kind.VERDICT
    both = [each for each in (before, after) if each is not None and each is not _NOTHING]
    are_numbers = all(isinstance(each, int | float) and not isinstance(each, bool) for each in both)
    return Kind.NUMBER if both and are_numbers else Kind.WORDS


def _said(value: Any) -> str:
    match value:
        case dict() | list():
            return f"{len(value)} entries"
        case bool():
            return "yes" if value else "no"
        case None:
            return "none"
        case _:
            return "none" if value is _NOTHING else str(value)
