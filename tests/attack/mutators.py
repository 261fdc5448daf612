"""Ways to forge a certificate file: what breaks any JSON, and lies about what was proved."""

import json
import re
from collections.abc import Mapping
from random import Random

from tests.attack.json_mutators import (
    HOSTILE,
    STATUSES,
    Files,
    Mutator,
    around,
    changed_value,
    double,
    drop,
    extra,
    layout,
    nudged,
    number,
    paths,
    pick,
    put,
    raw_value,
    swap_part,
    text_of,
    value_at,
    with_raw,
)
from tests.attack.proof_mutators import PROOF_KINDS

UNITS = ("mph", "%", "km/h", "m/s", "", "-", "N m", "kg m²", "\x1b[31mm/s", None, 3)


def of_another_problem(rng: Random, files: Files, name: str, others: Files) -> str | None:
    """Hand in the file of another design, as a whole, or its proofs under this one's words."""
    if name not in others:
        return None
    content, other = json.loads(files[name]), json.loads(others[name])
    if content == other:
        return None
    keys = rng.choice(
        (sorted(other), ["findings"], ["findings", "margin"], ["findings", "model_sha256"], ["claim"])
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
        forged["findings"] = {}
    elif choice == 4:
        forged["witness"] = content.get("worst_point", [])
    return text_of(forged)


def news(rng: Random, files: Files, name: str, _others: Files) -> str | None:
    """Turn what a loop cannot do into good news, or the other way around, in the status and in the words."""
    content = json.loads(files[name])
    forged = dict(content)
    if content.get("status") in ("PROVED", "LIMITATION", "VACUOUS"):
        forged["status"] = "PROVED" if content["status"] != "PROVED" else "LIMITATION"
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
        and path[0] not in ("findings", "made_by")
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
    lists = [key for key, value in content.items() if key != "findings" and isinstance(value, list) and value]
    if lists and rng.random() < 0.7:
        key = rng.choice(sorted(lists))
        kept = [each for each in content[key] if rng.random() < 0.5]
        return None if kept == content[key] else text_of({**content, key: kept})
    key = rng.choice(
        sorted(key for key in content if key not in ("schema", "check", "status", "findings", "made_by"))
    )
    return None if content[key] in (None, []) else text_of({**content, key: None})


def scope(rng: Random, files: Files, name: str, _others: Files) -> str | None:
    """Say of a number that is held that it is varied, or the other way around; drop or invent one."""
    content = json.loads(files[name])
    lists = {key: list(content.get(key) or ()) for key in ("varied", "held")}
    one, other = rng.sample(sorted(lists), 2)
    if lists[one] and rng.random() < 0.8:
        moved = lists[one].pop(rng.randrange(len(lists[one])))
        lists[other] += rng.choice(([moved], []))
    else:
        lists[one].append(rng.choice(("wheel radius", "fill time", "temperature", "mass", "")))
    return text_of({**content, **lists})


def depth(rng: Random, files: Files, name: str, _others: Files) -> str | None:
    """Nest a value about as deep as the reader and the writer of JSON can go."""
    content = json.loads(files[name])
    path = pick(rng, content, lambda _value: True)
    levels = rng.choice((100, 300, 450, 900, 980, 1000, 2000, 9000, 30_000))
    opened, closed = rng.choice((("[", "]"), ('{"a": ', "}")))
    return None if path is None else with_raw(content, path, opened * levels + "1" + closed * levels)


KINDS: Mapping[str, Mutator] = {
    "layout": layout,
    "around the text": around,
    "key dropped": drop,
    "key doubled": double,
    "key added": extra,
    "hostile value": changed_value(lambda _value: True, lambda rng, _value: rng.choice(HOSTILE)),
    "raw JSON": raw_value,
    "nested deeply": depth,
    "number": changed_value(number, nudged),
    "field of another file": swap_part,
    "other problem": of_another_problem,
    "status": status,
    "good and bad news": news,
    "witness": witness,
    "words": words,
    "unsaid": unsaid,
    "varied and held": scope,
    **PROOF_KINDS,
}
