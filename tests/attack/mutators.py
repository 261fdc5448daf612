"""Ways to forge a certificate file: hostile JSON for any content, and lies about what was proved.

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
UNITS = ("mph", "%", "km/h", "m/s", "", "-", "N m", "kg m²", "\x1b[31mm/s", None, 3)
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


def _changed(wanted: Callable[[Any], bool], change: Callable[[Random, Any], Any]) -> Mutator:
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


# --- lies


def of_another_problem(rng: Random, files: Files, name: str, others: Files) -> str | None:
    """Hand in the file of another design, as a whole, or its proofs under this one's words."""
    if name not in others:
        return None
    content, other = json.loads(files[name]), json.loads(others[name])
    if content == other:
        return None
    keys = rng.choice(
        (sorted(other), ["proofs"], ["proofs", "margin"], ["proofs", "model_sha256"], ["claim"])
    )
    return text_of({**content, **{key: other[key] for key in keys if key in other}})


def status(rng: Random, files: Files, name: str, others: Files) -> str | None:
    """State another status, with the witness, without it, or with that of a file that is refuted."""
    content = json.loads(files[name])
    stated = rng.choice([each for each in STATUSES if each != content.get("status")])
    forged = {**content, "status": stated}
    witnesses = [
        found for text in (*files.values(), *others.values()) if (found := json.loads(text).get("witness"))
    ]
    choice = rng.randrange(5)
    if choice == 1:
        forged["witness"] = []
    elif choice == 2 and witnesses:
        forged["witness"] = rng.choice(witnesses)
    elif choice == 3:
        forged["proofs"] = []
    elif choice == 4:
        forged["witness"] = content.get("worst_point", [])
    return text_of(forged)


def limitation(rng: Random, files: Files, name: str, _others: Files) -> str | None:
    """Turn what a loop cannot do into good news, or the other way around."""
    content = json.loads(files[name])
    forged = {**content, "limitation": not content.get("limitation", False)}
    if content.get("status") in ("PROVED", "LIMITATION"):
        forged["status"] = "PROVED" if content["status"] == "LIMITATION" else "LIMITATION"
    claim = content.get("claim")
    if isinstance(claim, str) and rng.random() < 0.5:
        forged["claim"] = claim.replace("No ", "Every ").replace("not ", "")
        if forged["claim"] == claim:
            forged["claim"] = f"No law can do otherwise: {claim}"
    return text_of(forged)


def witness(rng: Random, files: Files, name: str, _others: Files) -> str | None:
    """Change the witness: a place outside the domain, another unit, a name twice, names and values that are none."""
    content = json.loads(files[name])
    places = content.get("witness")
    if not places:
        return None
    index = rng.randrange(len(places))
    place = dict(places[index])
    match rng.randrange(7):
        case 0:
            place["value"] = place["value"] * rng.choice((1e-6, 0.5, 0.99, 1.001, 1.01, 2.0, 1e6, -1.0))
        case 1:
            place["unit"] = rng.choice([each for each in UNITS if each != place["unit"]])
        case 2:
            return text_of(put(content, ("witness",), [*places, {**place, "value": place["value"] * 1.5}]))
        case 3:
            return text_of(put(content, ("witness",), [{**place, "value": place["value"] * 30.0}, *places]))
        case 4:
            place["value"] = rng.choice(
                ("０.３６", "0.36", "1e400", True, None, [0.3], "nan", place["value"] + 1e-3)
            )
        case 5:
            place["name"] = rng.choice((place["name"].upper(), place["name"] + " ", "mu0\u200b", "", None, 7))
        case _:
            return text_of(put(content, ("witness",), places[:index] + places[index + 1 :]))
    return text_of(put(content, ("witness", index), place))


def words(rng: Random, files: Files, name: str, _others: Files) -> str | None:
    """Change a sentence of the claim, its hypotheses or assumptions, or the hash: a number, a word, all of it."""
    content = json.loads(files[name])
    spoken = [
        path
        for path in paths(content)
        if path
        and path[0] != "proofs"
        and isinstance(value_at(content, path), str)
        and value_at(content, path)
    ]
    path = rng.choice(spoken)
    text = value_at(content, path)
    numbers = list(re.finditer(r"[0-9]+(\.[0-9]+)?", text))
    match rng.randrange(4):
        case 0 if numbers:
            found = rng.choice(numbers)
            digits = str(int(found[0].replace(".", "")) + 1)
            changed = text[: found.start()] + digits + text[found.end() :]
        case 1:
            changed = rng.choice(
                (
                    "Every stop of this locomotive on any rail is asymptotically stable.",
                    "",
                    text.upper() + "!",
                    "0" * 64,
                )
            )
        case 2:
            middle = rng.randrange(len(text))
            changed = (
                text[:middle] + rng.choice(("\x1b[2J", "\u200b", " not ", "\u202e", "\n✓ ")) + text[middle:]
            )
        case _:
            changed = text + rng.choice(("", " ")) + rng.choice(("x", ".", " on every rail", "\u00a0"))
    return text_of(put(content, path, changed))


def unsaid(rng: Random, files: Files, name: str, _others: Files) -> str | None:
    """Leave hypotheses, assumptions or the margin away."""
    content = json.loads(files[name])
    lists = [key for key, value in content.items() if key != "proofs" and isinstance(value, list) and value]
    if lists and rng.random() < 0.7:
        key = rng.choice(sorted(lists))
        kept = [each for each in content[key] if rng.random() < 0.5]
        return None if kept == content[key] else text_of({**content, key: kept})
    key = rng.choice(sorted(key for key in content if key not in ("schema", "check", "status", "proofs")))
    return None if content[key] in (None, []) else text_of({**content, key: None})


def in_proof(change: Callable[[Random, Any, Path], Any]) -> Mutator:
    """Change something inside a proof, also where a proof holds proofs as text."""

    def mutate(rng: Random, files: Files, name: str, _others: Files) -> str | None:
        content = json.loads(files[name])
        proofs = content.get("proofs")
        if not proofs:
            return None
        index = rng.randrange(len(proofs))
        changed = _inner(rng, proofs[index], change)
        return None if changed is None else text_of(put(content, ("proofs", index), changed))

    return mutate


def _inner(rng: Random, proof: Any, change: Callable[[Random, Any, Path], Any]) -> Any:
    held = proof.get("proofs") if isinstance(proof, dict) else None
    if isinstance(held, list) and held and all(isinstance(each, str) for each in held) and rng.random() < 0.5:
        index = rng.randrange(len(held))
        changed = _inner(rng, json.loads(held[index]), change)
        return None if changed is None else put(proof, ("proofs", index), json.dumps(changed))
    return change(rng, proof, ())


def bound(rng: Random, proof: Any, _path: Path) -> Any:
    """Another bound, hash, matrix or other number in a proof."""
    path = pick(rng, proof, number)
    return None if path is None else put(proof, path, nudged(rng, value_at(proof, path)))


def steps(rng: Random, proof: Any, _path: Path) -> Any:
    """Steps of a tree or list left out, doubled, or put in."""
    path = pick(rng, proof, lambda value: isinstance(value, str | list) and len(value) > 0)
    if path is None:
        return None
    value = value_at(proof, path)
    place, choice = rng.randrange(len(value)), rng.randrange(4)
    piece = value[place : place + 1]
    if choice == 0:
        changed = value[:place] + value[place + 1 :]
    elif choice == 1:
        changed = value[:place] + piece + value[place:]
    elif choice == 2:
        changed = value[:place]
    else:
        new = rng.choice("abcdeABCDE.~!") if isinstance(value, str) else rng.choice(HOSTILE[:16])
        changed = value[:place] + (new if isinstance(value, str) else [new]) + value[place:]
    return put(proof, path, changed)


def subdomain(rng: Random, proof: Any, _path: Path) -> Any:
    """A wider, empty, turned or other part of the domain; where a proof has none, one is put in."""
    part = proof.get("part") if isinstance(proof, dict) else None
    if not isinstance(part, dict) or not part:
        made = rng.choice(({"speed": ["3.0", "30.0"]}, {"slip": ["0.1", "0.2"]}, {"mu0": ["0.3", "0.3"]}, {}))
        return {**proof, "part": made} if isinstance(proof, dict) else None
    key = rng.choice(sorted(part))
    low, high = part[key]
    made = rng.choice(
        (
            [repr(0.5 * float(low)), high],
            [low, repr(1.2 * float(high))],
            [high, low],
            [low, low],
            [low, high, high],
            [low, "inf"],
            ["nan", high],
            ["0.0", high],
        )
    )
    return {**proof, "part": rng.choice(({key: made}, {**part, "mass": ["1.0", "2.0"]}))}


def other_claim(rng: Random, files: Files, name: str, _others: Files) -> str | None:
    """Put a proof of another statement in, give one twice, or leave one out."""
    content = json.loads(files[name])
    proofs = list(content.get("proofs") or ())
    pool = [proof for text in files.values() for proof in json.loads(text).get("proofs") or ()]
    if not pool:
        return None
    match rng.randrange(4):
        case 0 if proofs:
            del proofs[rng.randrange(len(proofs))]
        case 1 if proofs:
            proofs[rng.randrange(len(proofs))] = rng.choice(pool)
        case 2:
            proofs.append(rng.choice(pool))
        case _:
            proofs = proofs * 2 or [rng.choice(pool)]
    return None if proofs == content.get("proofs") else text_of({**content, "proofs": proofs})


KINDS: Mapping[str, Mutator] = {
    "layout": layout,
    "around the text": around,
    "key dropped": drop,
    "key doubled": double,
    "key added": extra,
    "hostile value": _changed(lambda _value: True, lambda rng, _value: rng.choice(HOSTILE)),
    "raw JSON": raw_value,
    "number": _changed(number, nudged),
    "field of another file": swap_part,
    "other problem": of_another_problem,
    "status": status,
    "limitation": limitation,
    "witness": witness,
    "words": words,
    "unsaid": unsaid,
    "bound in a proof": in_proof(bound),
    "steps of a proof": in_proof(steps),
    "part of the domain": in_proof(subdomain),
    "proofs of other statements": other_claim,
}
