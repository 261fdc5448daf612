"""The public API, walked: every name is there and documented, attributes have units, misspelt keywords are refused."""

import ast
import inspect
import re
import subprocess
import sys
from dataclasses import fields, is_dataclass
from enum import Enum
from importlib import import_module
from pathlib import Path

import pytest

import wspd_design as wd

PACKAGE = Path(wd.__file__).parent
NAMES = sorted(set(wd.__all__) - {"__version__"})
RECORDS = [name for name in NAMES if is_dataclass(getattr(wd, name))]
FUNCTIONS = [name for name in NAMES if inspect.isfunction(getattr(wd, name))]
METHODS = [
    (name, method)
    for name in NAMES
    if inspect.isclass(getattr(wd, name)) and not issubclass(getattr(wd, name), (Enum, Exception))
    for method in vars(getattr(wd, name))
    if not method.startswith("_") and inspect.isfunction(vars(getattr(wd, name))[method])
]
MEASURED = re.compile(r"float|ndarray|Trace|NDArray")


def attributes(record):
    """What the docstring of a record says about each attribute: the line of its type."""
    section = record.__doc__.partition("Attributes\n    ----------\n")[2]
    return dict(re.findall(r"^    (\w+) : (.*)$", section, re.MULTILINE))


def without_unit(record):
    """Attributes that are numbers and whose line states no unit."""
    said = attributes(record)
    return [
        field.name
        for field in fields(record)
        if MEASURED.search(str(field.type)) and not re.search(r" \[.+\]$", said.get(field.name, ""))
    ]


def test_names_that_people_ask_for_are_there():
    wanted = {"Vehicle", "Rail", "Run", "Trial", "Metrics", "Certificate", "Design", "Scenario", "Campaign"}
    wanted |= {"certify", "check", "compare", "linearize", "load_controller", "simulate", "write_report"}
    assert wanted <= set(wd.__all__)
    assert re.fullmatch(r"\d+\.\d+\.\d+.*", wd.__version__)
    with pytest.raises(AttributeError, match="no attribute 'simulat'"):
        _ = wd.simulat


def test_names_load_lazily():
    code = (
        "import wspd_design, sys; wspd_design.__all__; print(sorted(m for m in sys.modules if 'wspd' in m))"
    )
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert found.stdout.strip() == "['wspd_design']"


@pytest.mark.parametrize("name", NAMES)
def test_every_name_is_documented(name):
    found = getattr(wd, name)
    if callable(found):
        assert (inspect.getdoc(found) or "").strip(), name
        assert not (found.__doc__ or "").startswith(f"{name}("), "what a dataclass writes by itself"


@pytest.mark.parametrize("name", FUNCTIONS)
def test_parameters_are_documented(name):
    function = getattr(wd, name)
    said = inspect.getdoc(function)
    for parameter in inspect.signature(function).parameters:
        assert re.search(rf"^[\w, *]*\b{parameter}\b[\w, ]* : ", said, re.MULTILINE) or (
            "parameters as" in said.lower() or "as in" in said.lower()
        ), f"{name}: {parameter}"


@pytest.mark.parametrize(("name", "method"), METHODS)
def test_methods_are_documented(name, method):
    assert inspect.getdoc(vars(getattr(wd, name))[method])


@pytest.mark.parametrize("name", RECORDS)
def test_numbers_of_records_have_units(name):
    record = getattr(wd, name)
    assert [field.name for field in fields(record) if field.name not in attributes(record)] == []
    assert without_unit(record) == []


def test_a_number_without_unit_would_be_seen():
    class Planted:
        """A record.

        Attributes
        ----------
        mass : float [kg]
        speed : float
        """

    planted = Planted
    planted.__doc__ = inspect.cleandoc(Planted.__doc__).replace("\n", "\n    ")
    assert attributes(planted) == {"mass": "float [kg]", "speed": "float"}


@pytest.mark.parametrize("name", FUNCTIONS)
def test_misspelt_keywords_are_refused(name):
    function = getattr(wd, name)
    parameters = inspect.signature(function).parameters.values()
    assert not any(each.kind is each.VAR_KEYWORD for each in parameters), "a typo would be swallowed"
    with pytest.raises(TypeError, match=r"unexpected keyword|missing"):
        function(sead=1)


@pytest.mark.parametrize("name", RECORDS)
def test_records_are_frozen_and_refuse_misspelt_fields(name):
    record = getattr(wd, name)
    assert record.__dataclass_params__.frozen
    with pytest.raises(TypeError):
        record(spead=1)


def later_calls():
    """Module and function of every call of ``later`` in the package, which no import checks."""
    for path in sorted(PACKAGE.rglob("*.py")):
        text = path.read_text(encoding="utf-8")
        if "later(" not in text or path.name == "later.py":
            continue
        for node in ast.walk(ast.parse(text)):
            if isinstance(node, ast.Call) and getattr(node.func, "id", "") == "later":
                yield tuple(argument.value for argument in node.args)


def test_what_is_loaded_later_exists():
    calls = set(later_calls())
    assert len(calls) > 20
    missing = [call for call in calls if not hasattr(import_module(f"wspd_design.{call[0]}"), call[1])]
    assert missing == []
