"""Lies about what was found: proofs, places, samples and efforts in the findings of a certificate file."""

import json
from collections.abc import Callable
from copy import deepcopy
from random import Random
from typing import Any

from tests.attack.json_mutators import (
    HOSTILE,
    Files,
    Mutator,
    nudged,
    number,
    pick,
    put,
    text_of,
    value_at,
)

Change = Callable[[Random, Any], Any]

NO_DOUBLES = ("0.1" + "0" * 25 + "1", "1/3", "-7/9", "1e-400", "123456789012345678901234567890.5")
NO_NUMBERS = (
    "０.３６",
    "٣",
    "1_0",
    " 0.3",
    "0.3 ",
    "+0.3",
    "0x1p-2",
    ".5",
    "5.",
    "1e5000",
    "nan",
    None,
    0.3,
    True,
    [],
)
OTHER_NAMES = ("mu0 ", "MU0", "mu0\u200b", "mass", "slip", "", "\x1b[2J", "temperature")


def findings_of(text: str) -> dict[str, Any]:
    """Return the findings of a file, those without any as an empty table."""
    return dict(json.loads(text).get("findings") or {})


def in_findings(entry: str, change: Change) -> Mutator:
    """Change an entry of a finding that has it: its proof, place, numbers or effort."""

    def mutate(rng: Random, files: Files, name: str, _others: Files) -> str | None:
        content = json.loads(files[name])
        keys = [key for key, each in findings_of(files[name]).items() if each.get(entry)]
        if not keys:
            return None
        key = rng.choice(keys)
        changed = change(rng, content["findings"][key][entry])
        return None if changed is None else text_of(put(content, ("findings", key, entry), changed))

    return mutate


def in_statement(change: Change) -> Mutator:
    """Change what the proof of an inequality states."""

    def mutate(rng: Random, proof: Any) -> Any:
        statement = proof.get("statement")
        if not isinstance(statement, dict) or "variables" not in statement:
            return None
        changed = change(rng, deepcopy(statement))
        return None if changed is None else {**proof, "statement": changed}

    return in_findings("proof", mutate)


# --- proofs


def any_number(rng: Random, proof: Any) -> Any:
    """Nudge a bound, matrix, end of a range or other number."""
    path = pick(rng, proof, number)
    return None if path is None else put(proof, path, nudged(rng, value_at(proof, path)))


def bound(rng: Random, statement: Any) -> Any:
    """State another bound or relation."""
    if rng.random() < 0.8:
        return {**statement, "bound": nudged(rng, statement["bound"])}
    return {**statement, "relation": "<=" if statement["relation"] == ">=" else ">="}


def steps(rng: Random, proof: Any) -> Any:
    """Leave steps of a tree or list out, double them, or put some in."""
    tree = isinstance(proof.get("tree"), str) and rng.random() < 0.7
    path = (
        ("tree",)
        if tree
        else pick(rng, proof, lambda value: isinstance(value, str | list) and len(value) > 0)
    )
    if path is None:
        return None
    value = value_at(proof, path)
    place, choice = rng.randrange(len(value) + 1), rng.randrange(5)
    match choice:
        case 0:
            changed = value[:place] + value[place + 1 :]
        case 1:
            changed = value[:place] + value[place : place + 1] + value[place:]
        case 2:
            changed = value[:place]
        case 3 if isinstance(value, str):
            changed = "." * len(value)
        case _:
            new = rng.choice("abcdeABCDE.~!\u0430") if isinstance(value, str) else [rng.choice(HOSTILE[:16])]
            changed = value[:place] + new + value[place:]
    return None if changed == value else put(proof, path, changed)


def ranges(rng: Random, statement: Any) -> Any:
    """Widen, narrow, turn or fix the range of a variable; leave one out, double, rename or exchange them."""
    rows = statement["variables"]
    k = rng.randrange(len(rows))
    name, low, high, unit = rows[k]
    match rng.randrange(10):
        case 0:
            rows[k] = [name, nudged(rng, low), high, unit]
        case 1:
            rows[k] = [name, low, nudged(rng, high), unit]
        case 2:
            rows[k] = [name, high, low, unit]
        case 3:
            rows[k] = [name, low, low, unit]
        case 4:
            del rows[k]
        case 5:
            rows.append([name, low, low, unit])
        case 6:
            rows[k] = [rng.choice(OTHER_NAMES), low, high, unit]
        case 7:
            rows[k] = [name, low, high, rng.choice(("km/h", "%", "", "\x1b[2J", None))]
        case 8:
            rng.shuffle(rows)
        case _:
            rows[k] = [name, low, rng.choice(NO_NUMBERS + NO_DOUBLES), unit]
    return statement


def formula(rng: Random, statement: Any) -> Any:
    """Change a step of the model or of its arranged form, drop the form, or put one in the place of the other."""
    which = rng.choice([each for each in ("model", "form") if each in statement])
    written = statement[which]
    k = rng.randrange(len(written))
    match rng.randrange(8):
        case 0:
            statement.pop("form", None)
        case 1:
            statement["form"] = deepcopy(statement["model"])
        case 2:
            statement["model"] = deepcopy(statement.get("form", []))
        case 3:
            written[k] = ["n", rng.choice(("0", "1", "1000000.0"))]
        case 4:
            written[k] = [rng.choice(("add", "mul", "abs", "exp", "atan", "pow", "log")), *written[k][1:]]
        case 5:
            numbers = [place for place, step in enumerate(written) if step[0] == "n"]
            if not numbers:
                return None
            place = rng.choice(numbers)
            written[place] = ["n", nudged(rng, written[place][1])]
        case 6:
            written[k] = [
                written[k][0],
                *(rng.choice((0, 0.0, False, -1, k, k + 1, "0")) for _ in written[k][1:]),
            ]
        case _:
            del written[k]
    return statement


# --- places, samples, efforts


def place(rng: Random, table: Any) -> Any:
    """Move a place within and out of the box; leave coordinates out, put some in, write them in other ways."""
    name = rng.choice(sorted(table))
    others = {key: each for key, each in table.items() if key != name}
    match rng.randrange(8):
        case 0 | 1:
            return {
                **table,
                name: repr(float(table[name]) * rng.choice((0.9, 0.999, 1.0 - 1e-9, 1.0 + 1e-9, 1.001, 1.1))),
            }
        case 2:
            return {**table, name: repr(float(table[name]) * rng.choice((1e-6, -1.0, 10.0, 1e6)))}
        case 3:
            return others
        case 4:
            return {**table, rng.choice(OTHER_NAMES): table[name]}
        case 5:
            return {**others, rng.choice(OTHER_NAMES): table[name]}
        case 6:
            return {**table, name: rng.choice(NO_NUMBERS + NO_DOUBLES)}
        case _:
            return rng.choice(({}, None, [], list(table), {**table, name: {}}))


def effort(rng: Random, table: Any) -> Any:
    """Say that the search was harder, easier, cut, or nonsense."""
    name = rng.choice(sorted(table))
    other = rng.choice((0, 1, 10**9, 10**10, -1, 0.5, 1.0, 1.5, True, False, None, "many", [], {}))
    return rng.choice(({**table, name: other}, {**table, "seconds": 1.0}, {name: table[name]}, None, {}))


# --- findings as a whole


def findings(rng: Random, files: Files, name: str, others: Files) -> str | None:
    """Exchange, drop, rename and double findings, and take some from other files and other designs."""
    content, table = json.loads(files[name]), findings_of(files[name])
    keys = sorted(table)
    texts = [*files.values(), *others.values()]
    foreign = [pair for text in texts for pair in findings_of(text).items()]
    if not keys:
        taken = dict(rng.choices(foreign, k=1))
        return text_of({**content, "findings": taken})
    key, other = rng.choice(keys), rng.choice(keys)
    match rng.randrange(9):
        case 0:
            del table[key]
        case 1:
            table[key], table[other] = table[other], table[key]
        case 2:
            table[key] = table[other]
        case 3:
            table[rng.choice((key.upper(), key + " ", "\x1b[2J", "", key + "\u200b", "radius"))] = table.pop(
                key
            )
        case 4:
            foreign_key, each = rng.choice(foreign)
            table[rng.choice((key, foreign_key))] = each
        case 5:
            table = {key: table[key]}
        case 6:
            table[key] = rng.choice(
                ({}, None, [], {"proof": None}, {"proof": {}}, {"place": {}, "numbers": {}})
            )
        case 7:
            entry = rng.choice(sorted(table[key]))
            table[key] = {each: value for each, value in table[key].items() if each != entry}
        case _:
            table = {}
    return text_of({**content, "findings": table})


def foreign_entry(rng: Random, files: Files, name: str, others: Files) -> str | None:
    """Put the proof, place or numbers of another finding into one."""
    content = json.loads(files[name])
    pool = [
        each
        for text in (files[name], *files.values(), *others.values())
        for each in findings_of(text).values()
    ]
    entry = rng.choice(("proof", "proof", "place", "numbers"))
    found = [each[entry] for each in pool if each.get(entry)]
    keys = sorted(content.get("findings") or {})
    if not (found and keys):
        return None
    return text_of(put(content, ("findings", rng.choice(keys), entry), rng.choice(found)))


PROOF_KINDS: dict[str, Mutator] = {
    "number in a proof": in_findings("proof", any_number),
    "bound of a proof": in_statement(bound),
    "steps of a proof": in_findings("proof", steps),
    "ranges of a proof": in_statement(ranges),
    "formula of a proof": in_statement(formula),
    "place": in_findings("place", place),
    "numbers of samples": in_findings("numbers", place),
    "effort": in_findings("effort", effort),
    "findings": findings,
    "entry of another finding": foreign_entry,
}
