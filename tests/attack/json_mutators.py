"""Ways to break any JSON: keys dropped, doubled and added, hostile values, text around it, other layouts.

A mutator takes a generator of random numbers, the texts of the genuine files, the name of one of them and the texts of
files of another design; it returns a text, or None where it has nothing to change.
"""

import json
import re
from collections.abc import Callable, Mapping
from copy import deepcopy
from fractions import Fraction
from random import Random
from typing import Any

Files = Mapping[str, str]
Mutator = Callable[[Random, Files, str, Files], str | None]
Path = tuple[Any, ...]

STATUSES = ("PROVED", "REFUTED", "UNDECIDED", "EVIDENCE", "VACUOUS", "NOT_APPLICABLE", "LIMITATION")
MARK = "@@raw@@"  # stands for JSON that the writer cannot make
RAW = (
    "NaN",
    "Infinity",
    "-Infinity",
    "1" + "0" * 400,
    "9" * 5000,
    "1e400",
    "-1e-400",
    "1e999999999",
    "[" * 500 + "]" * 500,
    "[" * 100_000 + "]" * 100_000,
    '{"a":' * 3000 + "1" + "}" * 3000,
)
HOSTILE = (
    None,
    True,
    False,
    0,
    -1,
    10**18,
    0.5,
    "",
    " ",
    "1/0",
    "0/0",
    "-1/3",
    "7" * 5000 + "/3",
    "1e5",
    "nan",
    "inf",
    "0x10",
    "1_000",
    "٣.٥",
    "０.３６",
    "½",
    "\x1b[2J\x1b[32m✓ accepted\x1b[0m",
    "\x1b]0;title\x07",
    "\u202egnp.exe",
    "\ud800",
    "\x00",
    "\r✓ accepted",
    "../../../etc/passwd",
    "__import__('os')",
    "a" * 200_000,
    [],
    {},
    [[]],
    [None],
    {"": ""},
)
NUMBER = re.compile(r"-?[0-9]+(\.[0-9]+)?(e-?[0-9]+)?(/[0-9]+)?")


# --- walking through JSON


def paths(content: Any, here: Path = ()) -> list[Path]:
    """Return the places of all values, texts that hold JSON of their own excepted."""
    found = [here]
    if isinstance(content, dict):
        items: Any = content.items()
    elif isinstance(content, list):
        items = enumerate(content[:60])
    else:
        items = ()
    for key, value in items:
        found += paths(value, (*here, key))
    return found


def value_at(content: Any, path: Path) -> Any:
    """Return the value at a place."""
    for key in path:
        content = content[key]
    return content


def put(content: Any, path: Path, value: Any) -> Any:
    """Return a copy with another value at a place."""
    if not path:
        return value
    copy = deepcopy(content)
    value_at(copy, path[:-1])[path[-1]] = value
    return copy


def text_of(content: Any) -> str:
    """Write JSON as the program does."""
    return json.dumps(content, indent=1, ensure_ascii=False) + "\n"


def pick(rng: Random, content: Any, wanted: Callable[[Any], bool]) -> Path | None:
    """Return the place of a value of some kind; a level of the file counts as much as any other."""
    found = [path for path in paths(content) if path and wanted(value_at(content, path))]
    if not found:
        return None
    depth = rng.choice(sorted({len(path) for path in found}))
    return rng.choice([path for path in found if len(path) == depth])


def number(value: Any) -> bool:
    """Whether a value is a number or a text that is one."""
    if isinstance(value, str):
        return len(value) < 60 and NUMBER.fullmatch(value) is not None
    return isinstance(value, int | float) and not isinstance(value, bool)


def nudged(rng: Random, value: Any) -> Any:
    """Return another number of the same form."""
    if isinstance(value, str):
        factor = Fraction(rng.choice(("1/2", "9/10", "99/100", "101/100", "11/10", "2", "-1", "0")))
        moved = Fraction(value) * factor if "/" not in value or factor else Fraction(value) + 1
        return str(moved) if "/" in value else repr(float(moved))
    return rng.choice((value * 0.5, value * 0.9, value * 1.01, value * 2, -value, value + 1, 0.0))


# --- any JSON


def changed_value(wanted: Callable[[Any], bool], change: Callable[[Random, Any], Any]) -> Mutator:
    """Change a value of some kind."""

    def mutate(rng: Random, files: Files, name: str, _others: Files) -> str | None:
        content = json.loads(files[name])
        path = pick(rng, content, wanted)
        return None if path is None else text_of(put(content, path, change(rng, value_at(content, path))))

    return mutate


def drop(rng: Random, files: Files, name: str, _others: Files) -> str | None:
    """Leave a key or an element out."""
    content = json.loads(files[name])
    path = pick(rng, content, lambda _value: True)
    if path is None:
        return None
    copy = deepcopy(content)
    del value_at(copy, path[:-1])[path[-1]]
    return text_of(copy)


def double(rng: Random, files: Files, name: str, _others: Files) -> str | None:
    """State a key twice, with another value first or last, or a list's element twice."""
    content = json.loads(files[name])
    path = pick(rng, content, lambda _value: True)
    if path is None:
        return None
    value = value_at(content, path)
    if isinstance(path[-1], int):
        owner = list(value_at(content, path[:-1]))
        return text_of(put(content, path[:-1], [*owner[: path[-1]], value, *owner[path[-1] :]]))
    owner = dict(value_at(content, path[:-1]))
    other = rng.choice((value, *HOSTILE[:12], *STATUSES[:2]))
    pair = [json.dumps(path[-1]) + ": " + json.dumps(each) for each in (other, value)]
    if rng.random() < 0.5:
        pair.reverse()
    rest = [json.dumps(key) + ": " + json.dumps(each) for key, each in owner.items() if key != path[-1]]
    raw = "{" + ", ".join([*pair, *rest]) + "}"
    return raw if len(path) == 1 else with_raw(content, path[:-1], raw)


def with_raw(content: Any, path: Path, raw: str) -> str:
    """Write content with a piece of text in the place of a value."""
    return text_of(put(content, path, MARK)).replace(json.dumps(MARK), raw, 1)


def raw_value(rng: Random, files: Files, name: str, _others: Files) -> str | None:
    """Put JSON in the place of a value that no writer makes: NaN, huge numbers, deep nesting."""
    content = json.loads(files[name])
    path = pick(rng, content, lambda _value: True)
    return None if path is None else with_raw(content, path, rng.choice(RAW))


def extra(rng: Random, files: Files, name: str, _others: Files) -> str | None:
    """Say something beside what is genuine."""
    content = json.loads(files[name])
    found = [path for path in paths(content) if isinstance(value_at(content, path), dict)]
    path = rng.choice(found)
    key = rng.choice(("note", "verdict", "Status", "check ", "proof", "\x1b[2J", "status\u200b"))
    return text_of(put(content, path, {**value_at(content, path), key: rng.choice(HOSTILE + STATUSES)}))


def around(rng: Random, files: Files, name: str, _others: Files) -> str | None:
    """Put something before, behind or into the text."""
    text = files[name]
    middle = rng.randrange(len(text))
    return rng.choice(
        (
            "\ufeff" + text,
            text + "{}",
            text + "true",
            text + "\x00",
            "\x00" + text,
            "[" + text + "]",
            text[:middle],
            text[:middle] + "\x00" + text[middle:],
            text[:middle] + text[middle + 1 :],
            text[:middle] + "\ufffd" + text[middle:],
            "// comment\n" + text,
            text.replace("\n", "\r\n") + "\x1b[2J",
            "",
            " " * 1000,
            text + text,
        )
    )


def layout(rng: Random, files: Files, name: str, _others: Files) -> str | None:
    """Write the same content in another way; this may be accepted."""
    content = json.loads(files[name])
    shuffled = dict(rng.sample(list(content.items()), len(content)))
    return rng.choice(
        (
            json.dumps(content),
            json.dumps(content, indent=4),
            json.dumps(content, ensure_ascii=True),
            json.dumps(shuffled, ensure_ascii=False),
            "\n\n" + files[name] + "  \n",
            files[name].replace("\n", "\r\n"),
            json.dumps(content, separators=(" ,\t", " : ")),
        )
    )


def swap_part(rng: Random, files: Files, name: str, _others: Files) -> str | None:
    """Take a field from another file of the folder."""
    content, other = json.loads(files[name]), json.loads(files[rng.choice(sorted(files))])
    shared = sorted(key for key in content if key in other and content[key] != other[key])
    return None if not shared else text_of({**content, (key := rng.choice(shared)): other[key]})
