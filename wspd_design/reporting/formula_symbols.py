"""Symbols of formulas in plain sentences: letters and Greek names with subscripts, differentials and accents."""

import re
from dataclasses import dataclass
from functools import lru_cache

GREEK = re.compile(
    "alpha|beta|gamma|delta|epsilon|zeta|eta|theta|kappa|lambda|mu|nu|xi|pi|rho|sigma|tau|phi|chi|psi|omega"
    "|Gamma|Delta|Theta|Lambda|Xi|Pi|Sigma|Phi|Psi|Omega"
)
DIFFERENTIAL = re.compile(f"d([tvTuFsV]|{GREEK.pattern})")


@dataclass(frozen=True, slots=True, kw_only=True)
class Symbol:
    """A sign of mathematics as Typst writes it."""

    source: str
    marked: bool  # whether it is a symbol even alone in a sentence


@lru_cache(maxsize=1024)
def symbol_of(name: str) -> Symbol | None:
    """Return a letter, a Greek name or a differential with its subscripts as Typst, or nothing for a word."""
    hat = name.endswith("_hat") or "_hat_" in name
    base, _, below = name.replace("_hat", "", 1).partition("_")
    letters = base.rstrip("0123456789")
    digits = base[len(letters) :]
    if letters == "sbar":
        source = "overline(s)"
    elif name == "int":
        source = "integral"
    elif len(digits) > 2:
        return None
    elif len(letters) == 2 and letters[0] == "Δ":
        source = f"Delta {letters[1]}"
    elif GREEK.fullmatch(letters) or len(letters) == 1:
        source = letters
    elif not digits and (differential := DIFFERENTIAL.fullmatch(letters)):
        source = f"dif {differential[1]}"
    elif letters == "d\u03bb":
        source = "dif lambda"
    else:
        return None
    if hat:
        source = f"hat({source})"
    if digits and below:
        return None
    index = digits or below
    if index:
        source += f"_{index}" if len(index) == 1 or index.isdigit() else f'_"{index.replace("_", ",")}"'
    return Symbol(source=source, marked=bool(hat or index) or len(letters) > 1 or not letters.isascii())


def accented(accent: str, source: str) -> str:
    """Put an accent over the letter of a symbol, not over its subscript."""
    letter, below, index = source.partition("_")
    return f"{accent}({letter}){below}{index}"
