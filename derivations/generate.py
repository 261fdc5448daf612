"""Write the generated model: plain arithmetic in Python from the SymPy expressions of the derivations.

``python -m derivations.generate`` writes, ``python -m derivations.generate --check`` exits with 1 when a
committed file differs from what would be written.
"""

import argparse
import re
import subprocess
import sys
import textwrap
from functools import cache
from pathlib import Path
from types import ModuleType

import sympy as sp
from sympy.printing.precedence import precedence
from sympy.printing.pycode import PythonCodePrinter

from derivations import (
    adaptive_fuzzy,
    adhesion,
    brake_actuator,
    friction_observer,
    fuzzy_loop,
    fuzzy_surface,
    motion,
    rolling_bounds,
    rolling_sample,
    sliding_surface,
    slip_equation,
    slip_loop,
    slip_tracking,
    track,
    valve_flow,
    valve_inversion,
    wheel_filter,
)
from derivations.equation_map import equations
from derivations.map_files import equations_toml, nomenclature, readme, symbols_toml, theorems_toml, theory
from derivations.notation import NOMENCLATURE, Generated

ROOT = Path(__file__).resolve().parent.parent
PACKAGE = Path("wspd_design/model/generated")
EQUATIONS = Path("wspd_design/data/equations.toml")
SYMBOLS = Path("wspd_design/data/symbols.toml")
THEOREMS = Path("wspd_design/data/theorems.toml")
README = Path("derivations/README.md")
NOMENCLATURE_PAGE = Path("docs/nomenclature.md")
THEORY_PAGE = Path("docs/theory.md")
MODULES: dict[str, ModuleType] = {
    "adaptive_fuzzy": adaptive_fuzzy,
    "adhesion": adhesion,
    "brake": brake_actuator,
    "friction_observer": friction_observer,
    "fuzzy_loop": fuzzy_loop,
    "fuzzy_surface": fuzzy_surface,
    "motion": motion,
    "rolling_bounds": rolling_bounds,
    "rolling_sample": rolling_sample,
    "slip": slip_equation,
    "slip_loop": slip_loop,
    "sliding_surface": sliding_surface,
    "slip_tracking": slip_tracking,
    "track": track,
    "valve_flow": valve_flow,
    "valve_inversion": valve_inversion,
    "wheel_filter": wheel_filter,
}
_ELEMENTARY = ("atan", "exp", "log", "sin", "tan")


class NumberPrinter(PythonCodePrinter):  # type: ignore[misc]
    """Print expressions for any number type, with the functions of ``wspd_design.model.number``."""

    def _print_Integer(self, expression: sp.Integer) -> str:
        return f"{int(expression)}.0"

    def _print_Rational(self, expression: sp.Rational) -> str:
        return f"{expression.p}.0 / {expression.q}.0"

    def _print_Pi(self, _: sp.Expr) -> str:
        return "pi"

    def _print_exp(self, expression: sp.exp) -> str:
        return f"exp({self._print(expression.args[0])})"

    def _print_atan(self, expression: sp.atan) -> str:
        return f"atan({self._print(expression.args[0])})"

    def _print_sin(self, expression: sp.sin) -> str:
        return f"sin({self._print(expression.args[0])})"

    def _print_tan(self, expression: sp.tan) -> str:
        return f"tan({self._print(expression.args[0])})"

    def _print_log(self, expression: sp.log) -> str:
        return f"log({self._print(expression.args[0])})"

    def _print_Pow(self, expression: sp.Pow, **_: object) -> str:
        if not expression.exp.is_Integer:
            raise ValueError(f"only integer powers run on every number type, not {expression}")
        base = self.parenthesize(expression.base, precedence(expression))
        power = int(expression.exp)
        positive = base if abs(power) == 1 else f"{base} ** {abs(power)}"
        return positive if power > 0 else f"1.0 / {positive}"


_PRINTER = NumberPrinter()


def _decimal(expression: sp.Expr) -> sp.Expr:
    """Write the fractions that are exact in binary as decimals: 0.25 instead of 1.0 / 4.0."""
    exact = [r for r in expression.atoms(sp.Rational) if not r.is_Integer and r.q & (r.q - 1) == 0]
    return expression.xreplace({r: sp.Float(r) for r in exact})


def _code(expression: sp.Expr) -> str:
    return str(_PRINTER.doprint(_decimal(expression)))


def assignments(function: Generated) -> tuple[list[tuple[sp.Symbol, sp.Expr]], list[sp.Expr]]:
    """Return the intermediate results of a function, common subexpressions included, and its results."""
    values = list(function.value) if isinstance(function.value, tuple) else [function.value]
    names = [name for name, _ in function.steps]
    shared, reduced = sp.cse([expression for _, expression in function.steps] + values)
    pending = shared + list(zip(names, reduced[: len(names)], strict=True))
    known, ordered = set(function.arguments), []
    while pending:  # each intermediate result after those that it uses
        ready = next(item for item in pending if item[1].free_symbols <= known)
        pending.remove(ready)
        ordered.append(ready)
        known.add(ready[0])
    return ordered, reduced[len(names) :]


def function_source(function: Generated) -> str:
    """Return the Python source of one generated function."""
    described = [(s.name, function.meanings.get(s.name) or _describe(s.name)) for s in function.arguments]
    reference = f"eq. ({function.equation})" if function.equation[0].isdigit() else function.equation
    signature = ", ".join(f"{name}: Number" for name, _ in described)
    is_tuple = isinstance(function.value, tuple)
    kind = f"tuple[{', '.join(['Number'] * len(function.expressions))}]" if is_tuple else "Number"
    doc = [f"{function.summary}, {reference}.", "", "Parameters", "----------"]
    for name, meaning in described:
        doc += [f"{name} : Number", f"    {meaning}."]
    doc += ["", "Returns", "-------", kind, f"    {function.returns}."]
    if function.notes:
        doc += ["", "Notes", "-----", *function.notes.split("\n")]
    steps, results = assignments(function)
    body = [f"{name} = {_code(expression)}" for name, expression in steps]
    body.append("return " + ", ".join(_code(result) for result in results))
    text = "\n".join(['"""' + doc[0], *doc[1:], '"""', *body])
    return f"def {function.name}({signature}) -> {kind}:\n" + textwrap.indent(text, "    ") + "\n"


def _describe(name: str) -> str:
    quantity = NOMENCLATURE[name]
    meaning = quantity.meaning[0].upper() + quantity.meaning[1:]
    return f"{meaning} [{quantity.unit}]" if quantity.unit else meaning


def module_source(derivation: ModuleType) -> str:
    """Return the Python source of one generated module."""
    functions = "\n\n".join(function_source(function) for function in derivation.FUNCTIONS)
    file = f"derivations/{derivation.__name__.rpartition('.')[2]}.py"
    title = (derivation.__doc__ or "").partition(":")[0]
    imports = ", ".join(["Number", *(name for name in _ELEMENTARY if re.search(rf"\b{name}\(", functions))])
    header = f'"""{title}: generated by `make derive` from {file}; never edit."""\n\n'
    if any(e.has(sp.pi) for function in derivation.FUNCTIONS for e in function.expressions):
        header += "from math import pi\n\n"
    return _formatted(f"{header}from wspd_design.model.number import {imports}\n\n\n{functions}")


@cache
def _formatted(source: str) -> str:
    command = [sys.executable, "-m", "ruff", "format", "--line-length", "110", "-"]
    return subprocess.run(command, input=source, capture_output=True, text=True, check=True).stdout


def sources() -> dict[Path, str]:
    """Return the text of every generated file by its path inside the repository."""
    files = {PACKAGE / f"{name}.py": module_source(module) for name, module in MODULES.items()}
    files[PACKAGE / "__init__.py"] = (
        '"""The paper\'s equations as plain arithmetic: generated by `make derive`, never edit."""\n'
    )
    found = equations()
    files[EQUATIONS] = equations_toml(found)
    files[README] = readme(found)
    files[NOMENCLATURE_PAGE] = nomenclature()
    files[THEORY_PAGE] = theory()
    files[SYMBOLS] = symbols_toml()
    files[THEOREMS] = theorems_toml()
    return files


def outdated(root: Path) -> list[Path]:
    """Return the generated files under ``root`` that differ from what would be written."""
    return [
        path
        for path, text in sources().items()
        if not (root / path).is_file() or (root / path).read_text() != text
    ]


def main() -> int:
    """Write the generated files, or compare them with ``--check``."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument(
        "--check", action="store_true", help="exit with 1 when a committed file is not current"
    )
    if parser.parse_args().check:
        for path in (stale := outdated(ROOT)):
            print(f"{path} differs from its derivation: run `make derive`.", file=sys.stderr)
        return 1 if stale else 0
    for path, text in sources().items():
        (ROOT / path).parent.mkdir(parents=True, exist_ok=True)
        (ROOT / path).write_text(text, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
