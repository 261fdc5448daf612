"""The words of the theory: what theorems say and do not say, the symbols of statements, and the terms of the field."""

import tomllib
from dataclasses import dataclass
from functools import lru_cache
from importlib.resources import files
from typing import Any


@dataclass(frozen=True, slots=True, kw_only=True)
class TheoremText:
    """A theorem in words, as the derivations state it; formulas are in plain text."""

    anchor: str
    title: str
    statement: str
    needs: tuple[str, ...]
    why: str
    not_said: str


@dataclass(frozen=True, slots=True, kw_only=True)
class SymbolText:
    """A symbol of a statement."""

    symbol: str  # in Typst's math syntax
    meaning: str
    unit: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Term:
    """A word of the field that a report may have to explain."""

    term: str
    forms: tuple[str, ...]  # of the word in a sentence, in lower case
    meaning: str


@lru_cache(maxsize=1)
def load_theorems() -> tuple[TheoremText, ...]:
    """Return the theorems behind the checks, as the derivations state them."""
    return tuple(
        TheoremText(**{**entry, "needs": tuple(entry["needs"])}) for entry in _data("theorems")["theorem"]
    )


@lru_cache(maxsize=1)
def load_symbols() -> tuple[SymbolText, ...]:
    """Return the symbols of the statements of checks, in the order of a list."""
    return tuple(SymbolText(**entry) for entry in _data("symbols")["symbol"])


@lru_cache(maxsize=1)
def load_glossary() -> tuple[Term, ...]:
    """Return the terms in the order of the alphabet."""
    found = (Term(**{**entry, "forms": tuple(entry["forms"])}) for entry in _data("glossary")["term"])
    return tuple(sorted(found, key=lambda each: each.term.lower()))


def _data(name: str) -> dict[str, Any]:
    return tomllib.loads(files("wspd_design").joinpath("data", f"{name}.toml").read_text(encoding="utf-8"))
