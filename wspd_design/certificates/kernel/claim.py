"""What is claimed: an inequality between an expression of the model and a number, on a box of exact rationals.

A number means the double that the program computes with, exactly: 0.55 is the double beside 55/100. A claim thus
speaks about the model as it stands in memory, evaluated without rounding. The expression is a function that runs
the model's kernels on whatever numbers it is given: on CasADi symbols for the prover, on terms for the statement that
the checker reads.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import Any, Literal, TypeAlias

from wspd_design.certificates.kernel.term import Step, Terms, steps, text
from wspd_design.certificates.records import Interval
from wspd_design.model.number import Number

Expression: TypeAlias = Callable[[Mapping[str, Number]], Number]
"""Takes the value of every variable by name, returns the value that is bounded."""

Relation: TypeAlias = Literal["<=", ">="]

OPERATIONS = ("add", "mul", "abs", "exp", "atan")
"""Of a formula, beside powers; in the words of the checker."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Variable:
    """A quantity of the model with its exact range; a number that is known has two equal ends."""

    name: str
    low: Fraction
    high: Fraction
    unit: str

    def __post_init__(self) -> None:
        """Refuse a range that is reversed."""
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

    @property
    def free(self) -> tuple[Variable, ...]:
        """Variables that span the box, in the order of the letters of a split tree."""
        return tuple(v for v in self.variables if v.free)

    def in_words(self) -> str:
        """Return the inequality in words; a name that is an inequality has a margin in place of a bound."""
        margin = "<" in self.name or ">" in self.name
        said = f"{self.name}, with a margin of at least" if margin else f"{self.name} {self.relation}"
        return f"{said} {float(self.bound):.6g} {self.unit}".removesuffix(" -")

    def ranges(self) -> tuple[Interval, ...]:
        """Return the ranges of the variables that the expression depends on, rounded to doubles."""
        used = {step[1] for step in formula(self.expression, self.variables) if step[0] == "x"}
        return tuple(
            Interval(name=each.name, low=float(each.low), high=float(each.high), unit=each.unit)
            for each in self.variables
            if each.name in used
        )

    def statement(self) -> dict[str, Any]:
        """Return everything that is claimed as the JSON object that the stand-alone checker decides about."""
        model = formula(self.expression, self.variables)
        arranged = model if self.form is None else formula(self.form, self.variables)
        stated = {
            "kind": "inequality",
            "name": self.name,
            "relation": self.relation,
            "bound": text(self.bound),
            "unit": self.unit,
            "variables": [[v.name, text(v.low), text(v.high), v.unit] for v in self.variables],
            "model": [list(step) for step in model],
        }
        return stated if arranged == model else stated | {"form": [list(step) for step in arranged]}

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


@lru_cache(maxsize=256)
def formula(expression: Expression, variables: tuple[Variable, ...]) -> tuple[Step, ...]:
    """Run an expression on terms and write it as steps; nothing is simplified on the way."""
    terms = Terms()
    return steps(terms.number(expression({v.name: terms.variable(v.name) for v in variables})))


def steps_of(symbolic: Any) -> tuple[Step, ...]:
    """Write a SymPy expression as the steps of the checker, each shared part once.

    Raises
    ------
    ValueError
        If it contains a function or a number that a claim may not contain.
    """
    places: dict[Any, int] = {}
    found: list[Step] = []

    def visit(node: Any) -> int:
        if node not in places:
            step = _step(node, visit)
            places[node] = len(found)
            found.append(step)
        return places[node]

    visit(symbolic)
    return tuple(found)


def _step(node: Any, visit: Callable[[Any], int]) -> Step:
    if node.is_Symbol:
        return ("x", node.name)
    if node.is_number and not node.args:
        return ("n", text(constant(node)))
    if node.is_Pow:
        return ("pow", visit(node.args[0]), text(constant(node.args[1])))
    name = type(node).__name__.lower()
    if name not in OPERATIONS:
        raise ValueError(f"{type(node).__name__} is not a function that a claim may contain")
    return (name, *(visit(argument) for argument in node.args))


def constant(symbolic: Any) -> Fraction:
    """Return the exact value of a SymPy number."""
    if symbolic.is_Rational:
        return Fraction(int(symbolic.p), int(symbolic.q))
    if symbolic.is_Float:
        return Fraction(float(symbolic))
    raise ValueError(f"{symbolic} is not a number that a claim may contain")
