"""What is claimed: an inequality between an expression of the model and a number, on a box of exact rationals.

A number means the double that the program computes with, exactly: 0.55 is the double beside 55/100. A claim thus
speaks about the model as it stands in memory, evaluated without rounding. The expression is a function that runs
the model's kernels on whatever numbers it is given: on CasADi symbols for the prover, on SymPy symbols for the
checker.
"""

import hashlib
import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Literal, TypeAlias

from wspd_design.model.number import Number

Expression: TypeAlias = Callable[[Mapping[str, Number]], Number]
"""Takes the value of every variable by name, returns the value that is bounded."""

Relation: TypeAlias = Literal["<=", ">="]


def text(rational: Fraction) -> str:
    """Write a rational without loss: a decimal stands for the double that Python reads from it, else p/q."""
    near = float(rational)
    return repr(near) if Fraction(near) == rational else f"{rational.numerator}/{rational.denominator}"


def number(written: str) -> Fraction:
    """Read what :func:`text` wrote."""
    return Fraction(written) if "/" in written else Fraction(float(written))


@dataclass(frozen=True, slots=True, kw_only=True)
class Variable:
    """A quantity of the model with its exact range; a number that is known has two equal ends."""

    name: str
    low: Fraction
    high: Fraction
    unit: str

    def __post_init__(self) -> None:
        """Refuse a range that is none."""
        if self.low > self.high:
            raise ValueError(f"{self.name}: {self.low} lies above {self.high}")

    @property
    def free(self) -> bool:
        """Whether it varies."""
        return self.low < self.high


def variable(name: str, ends: float | tuple[float, float], unit: str) -> Variable:
    """Return a variable between two doubles, or a known number."""
    low, high = ends if isinstance(ends, tuple) else (ends, ends)
    return Variable(name=name, low=Fraction(low), high=Fraction(high), unit=unit)


@dataclass(frozen=True, slots=True, kw_only=True)
class Claim:
    """``expression <= bound`` (or ``>=``) for all values of the variables.

    ``form`` is the same function, arranged so that variables stand in it as few times as possible: intervals are
    much tighter on it. The checker makes sure that it is the same.
    """

    name: str
    variables: tuple[Variable, ...]
    expression: Expression
    relation: Relation
    bound: Fraction
    unit: str  # of the bound
    form: Expression | None = None

    def __post_init__(self) -> None:
        """Refuse two variables of one name."""
        if len({v.name for v in self.variables}) < len(self.variables):
            raise ValueError(f"{self.name}: two variables have the same name")

    def statement(self) -> str:
        """Return the inequality in words."""
        return self.with_bound(text(self.bound))

    def with_bound(self, bound: str) -> str:
        """Return the inequality with a bound as it is written; a name that is an inequality has a margin instead."""
        margin = "<" in self.name or ">" in self.name
        said = f"{self.name}, with a margin of at least" if margin else f"{self.name} {self.relation}"
        return f"{said} {bound} {self.unit}".removesuffix(" -")

    @property
    def free(self) -> tuple[Variable, ...]:
        """Variables that span the box, in the order of the letters of a split tree."""
        return tuple(v for v in self.variables if v.free)

    def definition(self) -> Any:
        """Run the expression on SymPy symbols; nothing is simplified, so that the model stays as it is written.

        Returns
        -------
        sympy.Expr
            In the symbols of all variables.
        """
        return self._symbolic(self.expression)

    def formula(self) -> Any:
        """Run the arranged form, or the expression if there is none, on SymPy symbols."""
        return self._symbolic(self.form or self.expression)

    def function(self) -> Any:
        """Run the arranged form, or the expression if there is none, on CasADi symbols.

        Returns
        -------
        casadi.Function
            From the vector of all variables, in their order, to the value.
        """
        import casadi as ca

        symbols = ca.SX.sym("x", len(self.variables))
        values = {v.name: symbols[i] for i, v in enumerate(self.variables)}
        return ca.Function("claim", [symbols], [ca.SX((self.form or self.expression)(values))])

    def _symbolic(self, expression: Expression) -> Any:
        import sympy

        with sympy.evaluate(False):
            return sympy.sympify(expression({v.name: sympy.Symbol(v.name) for v in self.variables}))

    def digest(self) -> str:
        """SHA-256 of everything that is claimed: names, ranges, units, the whole model text, relation, bound."""
        content = {
            "name": self.name,
            "variables": [[v.name, text(v.low), text(v.high), v.unit] for v in self.variables],
            "model": model_text(self.definition()),
            "form": model_text(self.formula()),
            "relation": self.relation,
            "bound": text(self.bound),
            "unit": self.unit,
        }
        return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()


def constant(symbolic: Any) -> Fraction:
    """Return the exact value of a SymPy number."""
    if symbolic.is_Rational:
        return Fraction(int(symbolic.p), int(symbolic.q))
    if symbolic.is_Float:
        return Fraction(float(symbolic))
    raise ValueError(f"{symbolic} is no number that a claim may contain")


def model_text(formula: Any) -> str:
    """Write a SymPy expression as numbered steps, each shared part once."""
    steps: dict[Any, int] = {}
    lines: list[str] = []

    def visit(node: Any) -> int:
        if node not in steps:
            arguments = [visit(argument) for argument in node.args]
            if node.is_Symbol:
                line = node.name
            elif node.is_number and not node.args:
                line = text(constant(node))
            else:
                line = f"{type(node).__name__}({', '.join(f'#{i}' for i in arguments)})"
            steps[node] = len(lines)
            lines.append(line)
        return steps[node]

    visit(formula)
    return "\n".join(lines)
