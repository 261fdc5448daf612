"""What a theorem of the theory page is made of."""

from dataclasses import dataclass

import sympy as sp


@dataclass(frozen=True, slots=True)
class Identity:
    """An equation that a proof rests on, as text, and its residual."""

    text: str
    residual: sp.Expr


@dataclass(frozen=True, slots=True)
class Theorem:
    """A statement with what it needs, why it holds and what it does not say."""

    anchor: str
    title: str
    statement: str
    hypotheses: tuple[str, ...]
    sketch: str
    not_said: str
    identities: tuple[Identity, ...]
    certificates: tuple[str, ...]
