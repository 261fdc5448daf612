"""The register of assumptions and the ladder: no theorem states a clause that has no id, and each has a rung."""

import ast
import importlib
import pkgutil
from pathlib import Path

import wspd_design.certificates.theorems as theorems
from wspd_design.certificates.theorems.holds_for import HOLDS_FOR
from wspd_design.certificates.theorems.register import REGISTER, ids_of, stated_in
from wspd_design.certificates.theorems.table import THEOREMS


def _words(node):
    """All words that may stand in an expression: its texts, and those of the names and functions in it."""
    return [
        each.value
        for each in ast.walk(node)
        if isinstance(each, ast.Constant) and isinstance(each.value, str)
    ]


def _clauses():
    found = set()
    for module in pkgutil.walk_packages(theorems.__path__, f"{theorems.__name__}."):
        loaded = importlib.import_module(module.name)
        tree = ast.parse(Path(loaded.__file__).read_text(encoding="utf-8"))
        functions = {each.name: each for each in ast.walk(tree) if isinstance(each, ast.FunctionDef)}
        assigned = {
            target.id: each.value
            for each in ast.walk(tree)
            if isinstance(each, ast.Assign)
            for target in each.targets
            if isinstance(target, ast.Name)
        }
        for call in ast.walk(tree):
            if not isinstance(call, ast.Call):
                continue
            for keyword in call.keywords:
                if keyword.arg != "assumptions" or not isinstance(keyword.value, ast.Tuple):
                    continue
                for element in keyword.value.elts:
                    found |= set(_of(element, loaded, functions, assigned))
    return found


def _of(element, loaded, functions, assigned):
    if isinstance(element, ast.Starred):
        return _of(element.value, loaded, functions, assigned)
    if isinstance(element, ast.Constant):
        return [element.value]
    if isinstance(element, ast.JoinedStr):
        return ["".join(_words(element))]
    if isinstance(element, ast.Call):  # a function of the module that returns clauses
        returned = [each for each in ast.walk(functions[element.func.id]) if isinstance(each, ast.Return)]
        return [word for each in returned for word in _words(each)]
    if isinstance(element, ast.GeneratorExp):
        return _of(element.elt, loaded, functions, assigned)
    if isinstance(element, ast.Subscript):
        return [getattr(loaded, element.value.id)[element.slice.value]]
    value = getattr(loaded, element.id, None)
    if value is None:
        return _words(assigned[element.id])
    return [value] if isinstance(value, str) else list(value)


def test_every_clause_of_a_theorem_has_an_id():
    clauses = _clauses()
    assert len(clauses) > 40
    assert [clause for clause in sorted(clauses) if not ids_of(clause)] == []


def test_a_clause_that_nobody_registered_is_seen():
    assert ids_of("the moon is full") == ()


def test_every_assumption_is_stated_by_a_theorem_or_rests_under_all():
    stated = stated_in(_clauses())
    for each in REGISTER:
        assert (each.id in stated) == bool(each.clauses), each.id
    assert [each.id for each in REGISTER] == [f"A{k}" for k in range(1, len(REGISTER) + 1)]


def test_ids_are_those_of_the_clause():
    assert ids_of("T = u: no valve lag, no sampling") == ("A1", "A2")
    assert ids_of("frozen train speed") == ("A5",)


def test_every_theorem_has_a_rung():
    assert sorted(HOLDS_FOR) == sorted(THEOREMS)
