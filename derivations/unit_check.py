"""Units of equations: what both sides are in, where they differ, and what the unit of an unknown has to be.

A unit is a vector of exponents of m, kg, s and rad; an unknown unit has unknown exponents, for which the linear
equations that an equation of the paper imposes are solved. Angles are pure numbers unless they are kept apart.
"""

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

import sympy as sp

from derivations.notation import quantity
from derivations.printing import plain

_BASE = ("m", "kg", "s", "rad")
_ZERO = sp.zeros(1, len(_BASE))
_METRE, _KILOGRAM, _SECOND, _RADIAN = (sp.Matrix([[int(a == b) for b in _BASE]]) for a in _BASE)
_NAMED = {
    "m": _METRE,
    "kg": _KILOGRAM,
    "s": _SECOND,
    "rad": _RADIAN,
    "N": _KILOGRAM + _METRE - 2 * _SECOND,
    "Pa": _KILOGRAM - _METRE - 2 * _SECOND,
    "1": _ZERO,
    "-": _ZERO,
}
_PURE = (sp.exp, sp.log, sp.atan, sp.tan, sp.tanh, sp.sin)  # take and give pure numbers


def parse(unit: str) -> sp.Matrix:
    """Read a unit such as ``N m/s`` or ``m/(N m s2)``; what follows the first stroke divides."""
    above, _, below = unit.partition("/")
    return _product(above) - (parse(below.strip("()")) if below else _ZERO)


def _product(text: str) -> sp.Matrix:
    total = _ZERO
    for token in text.replace("(", " ").replace(")", " ").split():
        name, power = re.fullmatch(r"(\D+|1)(\d*)", token).groups()  # type: ignore[union-attr]
        total = total + _NAMED[name] * int(power or 1)
    return total


def unit_name(dimension: sp.Matrix) -> str:
    """Write a unit with N for kg m/s2, and Pa for N/m2; ``-`` is a pure number."""
    metre, kilogram, second, radian = dimension
    newton, metre, second = kilogram, metre - kilogram, second + 2 * kilogram
    powers = {"N": newton, "m": metre, "s": second, "rad": radian}
    if newton == 1 and metre == -2:
        powers = {"Pa": newton, "m": 0, "s": second, "rad": radian}
    above = [_power(name, power) for name, power in powers.items() if power > 0]
    below = [_power(name, -power) for name, power in powers.items() if power < 0]
    top = " ".join(above) or ("1" if below else "-")
    bottom = " ".join(below)
    return f"{top}/({bottom})" if len(below) > 1 else f"{top}/{bottom}" if below else top


def _power(name: str, power: sp.Expr) -> str:
    return name if power == 1 else f"{name}{power}"


@dataclass(frozen=True, slots=True)
class Units:
    """Outcome of a check: the common unit, or what differs; and the units of the unknowns."""

    unit: str
    fault: str
    solved: dict[str, str]


@dataclass(slots=True)
class _Walk:
    """One walk through expressions: the equations between exponents that it meets."""

    unknown: tuple[str, ...]
    keep_angles: bool
    own: Mapping[str, str]  # units of symbols that mean something else than in the nomenclature
    equations: list[tuple[sp.Matrix, str]] = field(default_factory=list)

    def of(self, expression: sp.Expr) -> sp.Matrix:
        """Return the unit of an expression and note what its parts have to share."""
        match expression:
            case sp.Symbol() | sp.core.function.AppliedUndef():
                return self._symbol(str(getattr(expression, "name", expression.func)))
            case sp.Add() | sp.Max():
                return self.same(*sorted(expression.args, key=sp.default_sort_key))
            case sp.Mul():
                return sum((self.of(factor) for factor in expression.args), _ZERO)
            case sp.exp():
                return self._pure(expression.args[0])
            case sp.Pow():
                self._pure(expression.exp)
                if expression.exp.is_number:
                    return expression.exp * self.of(expression.base)
                return self._pure(expression.base)
            case sp.Abs():
                return self.of(expression.args[0])
            case sp.sign():
                self.of(expression.args[0])
                return _ZERO
            case sp.Integral():
                return self.of(expression.function) + self.of(expression.variables[0])
            case sp.Derivative():
                return self.of(expression.expr) - self.of(expression.variables[0])
            case _ if expression.is_number:
                return _ZERO
            case _ if isinstance(expression, _PURE):
                return self._pure(expression.args[0])
        raise TypeError(f"no rule for the unit of {type(expression).__name__}")

    def same(self, *expressions: sp.Expr) -> sp.Matrix:
        """Ask that all expressions have the unit of the first; zero has any unit."""
        told = [(each, self.of(each)) for each in expressions if each != 0]
        (first, unit), rest = told[0], told[1:]
        for other, found in rest:
            self.equations.append((found - unit, self._differ(other, found, first, unit)))
        return unit

    def _pure(self, expression: sp.Expr) -> sp.Matrix:
        found = self.of(expression)
        if found != _ZERO:
            self.equations.append((found, f"{plain(expression)} has to be a pure number"))
        return _ZERO

    def _symbol(self, name: str) -> sp.Matrix:
        if name in self.unknown:
            return sp.Matrix([[_exponent(name, base) for base in _BASE]])
        if name == "t":
            return _SECOND
        known = quantity(name)
        unit = self.own.get(name) or (known.unit if known else "")
        if not unit:
            raise ValueError(f"{name} has no unit in the nomenclature")
        found = parse(unit)
        return found if self.keep_angles else sp.Matrix([[*found[:3], 0]])

    def _differ(self, one: sp.Expr, of_one: sp.Matrix, other: sp.Expr, of_other: sp.Matrix) -> str:
        if of_one.free_symbols | of_other.free_symbols:
            return f"{plain(one)} does not have the unit of {plain(other)}"
        return f"{plain(one)} is in {unit_name(of_one)}, {plain(other)} in {unit_name(of_other)}"


def _exponent(name: str, base: str) -> sp.Symbol:
    return sp.Symbol(f"{name}:{base}")


def check(
    sides: tuple[sp.Expr, ...],
    unknown: tuple[str, ...] = (),
    *,
    keep_angles: bool = False,
    own: Mapping[str, str] = MappingProxyType({}),
) -> Units:
    """Check that all sides have one unit.

    Parameters
    ----------
    sides : tuple of Expr
        Both sides of an equation, or all lines of it.
    unknown : tuple of str
        Names of the symbols whose units are solved for.
    keep_angles : bool
        Whether rad is a unit of its own.
    own : mapping of str to str
        Units of symbols that mean something else than in the nomenclature.

    Returns
    -------
    Units
        The unit and no fault; or no unit and the first fault.
    """
    walk = _Walk(unknown, keep_angles, own)
    unit = walk.same(*sides)
    exponents = [_exponent(name, base) for name in unknown for base in _BASE]
    solution: dict[sp.Symbol, sp.Expr] = {}
    for difference, fault in walk.equations:
        left = [each for each in difference.subs(solution) if each != 0]
        found = sp.solve(left, exponents, dict=True) if left else [{}]
        if not found:
            return Units("", fault, {})
        solution = {name: value.subs(found[0]) for name, value in solution.items()} | found[0]
    return Units(unit_name(unit.subs(solution)), "", dict(_solved(unknown, solution)))


def _solved(unknown: tuple[str, ...], solution: dict[sp.Symbol, sp.Expr]) -> Iterator[tuple[str, str]]:
    for name in unknown:
        exponents = sp.Matrix([[_exponent(name, base) for base in _BASE]]).subs(solution)
        if not exponents.free_symbols:
            yield name, unit_name(exponents)
