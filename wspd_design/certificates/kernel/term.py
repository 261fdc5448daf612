"""Expressions as they are computed: every operation becomes a step of the checker, and nothing is simplified.

A term is made by running a function of the model on it. Equal terms of one table are one object, so that each shared
part becomes one step. The steps are those that SymPy's symbols give without evaluation: a difference adds the opposite,
a quotient multiplies by a power, and a whole number is another term than the same double.
"""

from fractions import Fraction
from typing import Any, TypeAlias

Plain: TypeAlias = "float | int | Fraction"

Step: TypeAlias = tuple[Any, ...]
"""One step of a formula, as the checker reads it."""


def text(rational: Fraction) -> str:
    """Write a rational without loss: a decimal stands for the double that Python reads from it, else p/q."""
    near = float(rational)
    return repr(near) if Fraction(near) == rational else f"{rational.numerator}/{rational.denominator}"


class Terms:
    """A table of terms."""

    def __init__(self) -> None:
        self._known: dict[tuple[Any, ...], Term] = {}

    def variable(self, name: str) -> "Term":
        """Return the term of a quantity."""
        return self.of("x", name)

    def number(self, value: "Plain | Term") -> "Term":
        """Return the term of a number; a term stands for itself."""
        if isinstance(value, Term):
            return value
        return self.of("n", Fraction(value), isinstance(value, float))

    def of(self, kind: str, *content: Any) -> "Term":
        """Return the term of an operation on terms, or of a name or a number."""
        key = (kind, *(id(each) if isinstance(each, Term) else each for each in content))
        if key not in self._known:
            self._known[key] = Term(self, kind, content)
        return self._known[key]


class Term:
    """A number that is not known, and how it is computed."""

    __slots__ = ("content", "kind", "table")

    def __init__(self, table: Terms, kind: str, content: tuple[Any, ...]) -> None:
        self.table, self.kind, self.content = table, kind, content

    def __add__(self, other: "Plain | Term") -> "Term":
        return self.table.of("add", self, self.table.number(other))

    def __radd__(self, other: Plain) -> "Term":
        return self.table.of("add", self.table.number(other), self)

    def __sub__(self, other: "Plain | Term") -> "Term":
        return self + -other

    def __rsub__(self, other: Plain) -> "Term":
        return other + -self

    def __neg__(self) -> "Term":
        if self.kind == "n":
            value, is_float = self.content
            return self.table.of("n", -value, is_float)
        first, *others = self.content if self.kind == "mul" else (self,)
        if first.kind != "n":
            return self.table.of("mul", self.table.number(-1), first, *others)
        if first is not self.table.number(-1):
            return self.table.of("mul", -first, *others)
        return others[0] if len(others) == 1 else self.table.of("mul", *others)

    def __mul__(self, other: "Plain | Term") -> "Term":
        return self.table.of("mul", self, self.table.number(other))

    def __rmul__(self, other: Plain) -> "Term":
        return self.table.of("mul", self.table.number(other), self)

    def __truediv__(self, other: "Plain | Term") -> "Term":
        return self.table.of("mul", self, self.table.number(other) ** -1)

    def __rtruediv__(self, other: Plain) -> "Term":
        inverse = self**-1
        return inverse if isinstance(other, int) and other == 1 else other * inverse

    def __pow__(self, exponent: Plain) -> "Term":
        return self.table.of("pow", self, Fraction(exponent), isinstance(exponent, float))

    def __abs__(self) -> "Term":
        return self.table.of("abs", self)

    def exp(self) -> "Term":
        """Exponential function."""
        return self.table.of("exp", self)

    def atan(self) -> "Term":
        """Inverse tangent."""
        return self.table.of("atan", self)


def steps(result: Term) -> tuple[Step, ...]:
    """Write a term as the steps of the checker, each shared part once."""
    places: dict[int, int] = {}
    found: list[Step] = []

    def visit(term: Term) -> int:
        if id(term) not in places:
            if term.kind == "x":
                step: Step = ("x", term.content[0])
            elif term.kind == "n":
                step = ("n", text(term.content[0]))
            elif term.kind == "pow":
                step = ("pow", visit(term.content[0]), text(term.content[1]))
            else:
                step = (term.kind, *map(visit, term.content))
            places[id(term)] = len(found)
            found.append(step)
        return places[id(term)]

    visit(result)
    return tuple(found)
