"""Derivations that are imported when a test first asks one for something.

SymPy works on all of them for half a minute, which every worker would pay for while it gathers its tests.
"""

import ast
from importlib import import_module
from pathlib import Path

import wspd_design.model.generated as generated


class Lazily:
    """A module of ``derivations`` that is not imported yet."""

    def __init__(self, name):
        self.__name = name

    def __getattr__(self, name):
        if name.startswith("_"):  # what pytest asks every object in a file for
            raise AttributeError(name)
        return getattr(import_module(f"derivations.{self.__name}"), name)


def generated_functions():
    """Module and name of every committed function of the generated model; ``make derive`` writes no others."""
    return [
        (path.stem, node.name)
        for path in sorted(Path(generated.__file__).parent.glob("*.py"))
        for node in ast.parse(path.read_text(encoding="utf-8")).body
        if isinstance(node, ast.FunctionDef)
    ]


def definition(module, name):
    """Return what the derivations say of a generated function."""
    from derivations import generate

    (found,) = (each for each in generate.MODULES[module].FUNCTIONS if each.name == name)
    return found


def residuals(module):
    """Return the identities of a derivation by their names."""
    found = vars(import_module(f"derivations.{module}"))
    return {name: value for name, value in found.items() if name.endswith("_residual")}
