"""Forge certificate files and see whether one is accepted: python -m tests.attack.forge DESIGN CERTIFICATES --count N.

A mutant may be accepted only if it says what a genuine file says, under the same status, and the same is decided.
Nothing but a refusal may answer to any other.
"""

import argparse
import json
import math
import sys
import time
import unicodedata
from collections.abc import Callable, Iterator, Mapping
from contextlib import redirect_stdout
from dataclasses import dataclass, field
from decimal import Decimal, InvalidOperation
from io import StringIO
from pathlib import Path
from random import Random
from typing import Any

from tests.attack.json_mutators import Files
from tests.attack.mutators import KINDS

MOST_SECONDS = 60.0  # of CPU per file
ATTEMPTS = 40  # to find a file that a kind can change
CONTROL = {"Cc", "Cf", "Cs", "Co", "Zl", "Zp"}  # categories that must not reach a terminal
HEARSAY = (
    "findings",
    "made_by",
)  # what a file does not say: one is decided about, nothing rests on the other
FEW_WEIGHT = 400  # bytes of proofs that halve how often a file is taken: those take long to check


# --- the checker, in one place


@dataclass(frozen=True, slots=True, kw_only=True)
class Decision:
    """What the program says about a text."""

    accepted: bool
    status: str
    shown: tuple[str, ...]  # statements that it vouches for
    printed: str  # all that reaches a terminal


def decide(problem: Any, text: str) -> Decision:
    """Ask the program; the only place that knows its interface."""
    from wspd_design.certificates.kernel.file import sentences
    from wspd_design.certificates.replay import replay
    from wspd_design.cli.commands.check import _show

    found = replay(problem, text)
    made = found.certificate
    with redirect_stdout(StringIO()) as out:
        _show("forged.json", "design.toml", found)
    if made is None:
        return Decision(accepted=found.accepted, status="", shown=(), printed=out.getvalue() + found.reason)
    words = json.dumps(sentences(made), sort_keys=True, ensure_ascii=False)
    decided = sorted(f"{key}: {each.status.name} {each.shown}" for key, each in made.findings.items())
    return Decision(
        accepted=found.accepted,
        status=made.status.name,
        shown=(words, *decided),
        printed=out.getvalue() + "\n".join((words, *decided)),
    )


def load_problem(design: Path, *, vehicle: str | None = None, rail: str | None = None) -> Any:
    """Load the closed loop that the files speak about."""
    from wspd_design.design.certification import problem_of

    return problem_of(str(design), vehicle=vehicle, rail=rail)


# --- what a file says


class Ambiguous(ValueError):
    """A text that says two things, or nothing."""


def says(text: str) -> Any:
    """Return what a person reads in a file, what was found left out: one form for one content."""

    def once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        found: dict[str, Any] = {}
        for key, value in pairs:
            if key in found and found[key] != value:
                raise Ambiguous(f"{key!r} is stated twice")
            found[key] = value
        return found

    def exact(digits: str) -> Any:
        return ("number", Decimal(digits))

    try:
        content = json.loads(
            text,
            object_pairs_hook=once,
            parse_int=exact,
            parse_float=exact,
            parse_constant=lambda word: ("constant", word),
        )
    except (ValueError, RecursionError, InvalidOperation) as error:
        raise Ambiguous(str(error)) from None
    if not isinstance(content, dict):
        raise Ambiguous("no object")
    return {key: value for key, value in content.items() if key not in HEARSAY}


# --- mutants and their judge


@dataclass(frozen=True, slots=True, kw_only=True)
class Mutant:
    """A forged text, of which kind and made from which file."""

    kind: str
    name: str
    text: str


def mutants(
    files: Files, others: Files, count: int, *, seed: int = 0, kinds: Mapping[str, Any] = KINDS
) -> Iterator[Mutant]:
    """Yield forged texts, all kinds in turn; the same arguments give the same texts."""
    names = sorted(files)
    weights = [1.0 / (1.0 + _proof_size(files[name]) / FEW_WEIGHT) for name in names]
    listed = list(kinds)
    for index in range(count):
        kind = listed[index % len(listed)]
        rng = Random(f"{seed}:{kind}:{index}")
        for _ in range(ATTEMPTS):
            name = rng.choices(names, weights)[0]
            text = kinds[kind](rng, files, name, others)
            if text is not None and (kind == "layout" or _content(text) != _content(files[name])):
                yield Mutant(kind=kind, name=name, text=text)
                break


def _content(text: str) -> str:
    """Return a text without its layout, if it is JSON at all."""
    try:
        return json.dumps(json.loads(text))
    except (ValueError, RecursionError):
        return text


def _proof_size(text: str) -> int:
    return len(json.dumps(json.loads(text).get("findings") or ""))


@dataclass(slots=True)
class Count:
    """What became of the mutants of one kind."""

    tried: int = 0
    identical: int = 0  # accepted, and saying what the genuine file says
    refused: int = 0
    seconds: float = 0.0  # CPU of the slowest
    faults: list[tuple[str, Mutant]] = field(default_factory=list)


class Judge:
    """Compares what the program says about mutants with what it says about the genuine files."""

    def __init__(self, ask: Callable[[str], Decision], files: Files) -> None:
        self.ask = ask
        self.genuine = {}
        for name, text in files.items():
            content, decision = json.loads(text), ask(text)
            if not decision.accepted:
                raise ValueError(f"the genuine {name} is not accepted: {decision.printed}")
            self.genuine[content["check"]] = (says(text), decision)

    def fault(self, mutant: Mutant) -> tuple[str, bool, float]:
        """Return what is wrong about the answer to a mutant, empty if nothing; whether accepted; seconds of CPU."""
        started = time.process_time()
        try:
            decision = self.ask(mutant.text)
        except Exception as error:
            return f"{type(error).__name__}: {error}"[:200], False, time.process_time() - started
        took = time.process_time() - started
        return self._wrong(mutant.text, decision, took), decision.accepted, took

    def _wrong(self, text: str, decision: Decision, took: float) -> str:
        if took > MOST_SECONDS:
            return f"took {took:.0f} s"
        escaping = sorted(
            {each for each in decision.printed if each != "\n" and unicodedata.category(each) in CONTROL}
        )
        if escaping:
            return f"prints {escaping!a}"
        if not decision.accepted:
            return ""
        try:
            said = says(text)
        except Ambiguous as error:
            return f"accepted although {error}"
        check = said.get("check")
        if not isinstance(check, str) or check not in self.genuine:
            return f"accepted a check that has no genuine file: {check!a}"
        words, genuine = self.genuine[check]
        if (decision.status, decision.shown) != (genuine.status, genuine.shown):
            new = [each for each in decision.shown if each not in genuine.shown]
            gone = [each for each in genuine.shown if each not in decision.shown]
            return f"accepted as {decision.status}, with {'; '.join(new)[:200]!a}, without {'; '.join(gone)[:200]!a}"
        if said != words:
            changed = sorted(key for key in said.keys() | words.keys() if said.get(key) != words.get(key))
            return f"accepted with another {', '.join(map(ascii, changed))}"
        return ""

    def count(self, stream: Iterator[Mutant], *, cpu_seconds: float = math.inf) -> dict[str, Count]:
        """Judge a stream of mutants, by kind; the time is an upper limit alone."""
        found: dict[str, Count] = {}
        deadline = time.process_time() + cpu_seconds
        for mutant in stream:
            if time.process_time() > deadline:
                break
            one = found.setdefault(mutant.kind, Count())
            wrong, accepted, took = self.fault(mutant)
            one.tried += 1
            one.seconds = max(one.seconds, took)
            if wrong:
                one.faults.append((wrong, mutant))
            elif accepted:
                one.identical += 1
            else:
                one.refused += 1
        return found


def read_files(folder: Path) -> Files:
    """Read the genuine files of a folder."""
    return {path.name: path.read_text(encoding="utf-8") for path in sorted(folder.glob("*.json"))}


def main(arguments: list[str]) -> int:
    """Print what became of the mutants; 1 if one was answered wrongly."""
    parser = argparse.ArgumentParser(prog="python -m tests.attack.forge", description=__doc__)
    parser.add_argument("design", type=Path)
    parser.add_argument("certificates", type=Path)
    parser.add_argument("--other", type=Path, help="folder of certificates of another design")
    parser.add_argument("--vehicle")
    parser.add_argument("--rail")
    parser.add_argument("--count", type=int, default=1000)
    parser.add_argument("--cpu-seconds", type=float, default=math.inf, help="at most")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--kind", action="append", choices=list(KINDS))
    parser.add_argument("--keep", type=Path, help="folder for the texts that were answered wrongly")
    given = parser.parse_args(arguments)
    problem = load_problem(given.design, vehicle=given.vehicle, rail=given.rail)
    files = read_files(given.certificates)
    judge = Judge(lambda text: decide(problem, text), files)
    others = read_files(given.other) if given.other else {}
    chosen = {kind: KINDS[kind] for kind in given.kind or KINDS}
    found = judge.count(
        mutants(files, others, given.count, seed=given.seed, kinds=chosen), cpu_seconds=given.cpu_seconds
    )
    print(f"{'kind':28}{'tried':>7}{'identical':>11}{'refused':>9}{'wrong':>7}{'worst CPU':>12}")
    for kind, one in found.items():
        print(
            f"{kind:28}{one.tried:7}{one.identical:11}{one.refused:9}{len(one.faults):7}{one.seconds:10.2f} s"
        )
    for kind, one in found.items():
        for index, (wrong, mutant) in enumerate(one.faults[:5]):
            print(f"WRONG  {kind}, {mutant.name}: {wrong}")
            if given.keep:
                given.keep.mkdir(parents=True, exist_ok=True)
                name = f"{kind.replace(' ', '-')}-{index}-{mutant.name}"
                (given.keep / name).write_text(mutant.text, encoding="utf-8", errors="surrogatepass")
    wrong = sum(len(one.faults) for one in found.values())
    print(f"{sum(one.tried for one in found.values())} forged files, {wrong} answered wrongly")
    return int(wrong > 0)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
