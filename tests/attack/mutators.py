"""Ways to forge a certificate file: what breaks any JSON, and lies about what was proved."""

import json
import re
from collections.abc import Callable, Mapping
from random import Random
from typing import Any

from tests.attack.json_mutators import (
    HOSTILE,
    STATUSES,
    Files,
    Mutator,
    Path,
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
)

UNITS = ("mph", "%", "km/h", "m/s", "", "-", "N m", "kg m²", "\x1b[31mm/s", None, 3)


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
    "hostile value": changed_value(lambda _value: True, lambda rng, _value: rng.choice(HOSTILE)),
    "raw JSON": raw_value,
    "number": changed_value(number, nudged),
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
