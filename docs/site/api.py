"""The page of the public API: the names of ``wspd_design.__all__`` by the room that they live in.

Docstrings are rendered by autodoc. What the fields of a record mean, and their units, stands in the section Attributes
of its docstring, or behind them in the source as a comment; the table of fields is made of either here.
"""

import ast
import dataclasses
import inspect
import io
import re
import textwrap
import tokenize
from importlib import import_module
from typing import Any

import wspd_design

ROOMS = {
    "parameters": "Vehicles and rails",
    "analysis": "Linearization",
    "controllers": "Laws",
    "design": "Designs",
    "certificates": "Statements about stability",
    "simulation": "Stops and campaigns",
    "studies": "Reports",
    "reporting": "Reports",
    "plotting": "Plots",
    "notebook": "Notebooks",
}
"""Headings of the rooms, in the order of the page; a room without one stands under its own name at the end."""

_SHORT = 16  # letters of a default
_BASE = r"(?:kg|m|s|N|Pa|rad|Hz|W|J|K)\d?"
_UNIT = re.compile(
    rf"(?P<unit>-|(?:1/\(?)?{_BASE}(?:[ /]{_BASE})*\)?(?: per (?:wheelset|wheel|axle))?)(?:[,;]? +|$)(?P<rest>.*)"
)
ATTRIBUTES = "\nAttributes\n----------\n"
_STATED = re.compile(r"^(\w+) : (.*)$((?:\n {4}.*$)*)", re.MULTILINE)
_CODE = re.compile(r"``([^`]+)``")


def api_page() -> str:
    """Return the page in Markdown."""
    parts = [
        "# Python API",
        "All public names are those of `wspd_design`, and load when they are first used. Quantities are SI floats "
        "everywhere: m/s, N m, Pa, rad/s; slips are ratios. A name that is not here may change without notice "
        "([compatibility](compatibility.md)).",
        "```python\nimport wspd_design as wd\n```",
    ]
    for heading, names in _by_room().items():
        parts += [f"## {heading}", *map(_entry, names)]
    parts += ["## In tests of your own", _module("wspd_design.testing")]
    return "\n\n".join(parts) + "\n"


def _by_room() -> dict[str, list[str]]:
    found: dict[str, list[str]] = {heading: [] for heading in ROOMS.values()}
    for name in wspd_design.__all__:
        item = getattr(wspd_design, name)
        module = getattr(item, "__module__", "") or ""
        room = module.removeprefix("wspd_design.").partition(".")[0] if "." in module else ""
        found.setdefault(ROOMS.get(room, room or "The package"), []).append(name)
    # Records first, then what takes and makes them.
    for names in found.values():
        names.sort(key=lambda name: (not inspect.isclass(getattr(wspd_design, name)), name.lower()))
    return {heading: names for heading, names in found.items() if names}


def _entry(name: str) -> str:
    item = getattr(wspd_design, name)
    if inspect.isclass(item):
        return _rst(_class(f"wspd_design.{name}", item))
    if callable(item):
        return _rst(f".. autofunction:: wspd_design.{name}")
    return f"`{name}`\n: `{item!r}`" if isinstance(item, str) else f"`{name}`"


def _module(name: str) -> str:
    """Return all public functions of a module that users import by its own name."""
    return "\n\n".join(_rst(f".. autofunction:: {name}.{each}") for each in import_module(name).__all__)


def _class(path: str, item: type) -> str:
    table = field_table(item)
    # The table says what the signature of a record would, and more.
    lines = [f".. autoclass:: {path}{'(**fields)' if table else ''}", "   :members:", ""]
    if table:
        lines += textwrap.indent(table, "   ").splitlines()
    return "\n".join(lines)


def field_table(item: type) -> str:
    """Return a table of the fields of a record with type and meaning, empty for what is no record."""
    if not dataclasses.is_dataclass(item):
        return ""
    meanings = {each: text for base in reversed(item.__mro__) for each, text in field_comments(base).items()}
    stated = stated_fields(item)
    rows = [
        (
            f"``{field.name}``",
            f"``{_type(field.type)}``",
            _default(field),
            *(stated.get(field.name) or with_unit(meanings.get(field.name, ""))),
        )
        for field in dataclasses.fields(item)
        if not field.name.startswith("_")
    ]
    lines = [".. list-table::", "   :header-rows: 1", "   :widths: auto", "   :class: fields", ""]
    for row in (("field", "type", "default", "unit", "meaning"), *rows):
        lines += [f"   {'* -' if number == 0 else '  -'} {cell}" for number, cell in enumerate(row)]
    return "\n".join(lines)


def _default(field: "dataclasses.Field[Any]") -> str:
    """Return the default of a field where it is a plain value; ``...`` where it is something longer."""
    if field.default is field.default_factory is dataclasses.MISSING:
        return ""
    text = repr(field.default)
    return f"``{text}``" if len(text) <= _SHORT and "<" not in text else "``...``"


def with_unit(comment: str) -> tuple[str, str]:
    """Split what stands behind a field into unit and meaning, ``kg, of one body`` for example."""
    found = _UNIT.match(comment)
    if not found:
        return "", comment
    return found["unit"].replace("-", "\\-"), found["rest"]  # a hyphen alone would begin a list


def stated_fields(item: type) -> dict[str, tuple[str, str]]:
    """Return unit and meaning of each field that the section Attributes of a docstring states."""
    section = inspect.cleandoc(item.__doc__ or "").partition(ATTRIBUTES)[2].partition("\n\n")[0]
    found = {}
    for name, kind, meaning in _STATED.findall(section):
        unit = kind.rpartition(" [")[2].removesuffix("]") if kind.endswith("]") and " [" in kind else ""
        found[name] = unit.replace("-", "\\-"), " ".join(meaning.split())
    return found


def without_attributes(_app: Any, what: str, _name: str, item: Any, _options: Any, lines: list[str]) -> None:
    """Leave out the section Attributes of a record where Sphinx shows its docstring: the table says it, and more."""
    text = "\n".join(lines)
    if what == "class" and dataclasses.is_dataclass(item) and ATTRIBUTES in text:
        before, _, after = text.partition(ATTRIBUTES)
        lines[:] = (before + after.partition("\n\n")[2]).split("\n")


def field_comments(item: Any) -> dict[str, str]:
    """Return the comment behind each field of a class, or the text below it."""
    try:
        source = textwrap.dedent(inspect.getsource(item))
    except (OSError, TypeError):
        return {}
    body = ast.parse(source).body
    if not body or not isinstance(body[0], ast.ClassDef):
        return {}
    comments = {
        token.start[0]: token.string.lstrip("#: ")
        for token in tokenize.generate_tokens(io.StringIO(source).readline)
        if token.type == tokenize.COMMENT
    }
    found, above = {}, ""
    for node in body[0].body:
        if isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
            above = node.target.id
            lines = range(node.lineno, (node.end_lineno or node.lineno) + 1)
            found[above] = " ".join(comments[line] for line in lines if line in comments)
        elif isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and above:
            found[above] = found[above] or str(node.value.value)
        else:
            above = ""
    return {name: _escaped(" ".join(text.split())) for name, text in found.items() if text}


def _escaped(text: str) -> str:
    """Return plain words as reStructuredText, in which ``code`` stays code."""
    parts = _CODE.split(text)
    plain = (re.sub(r"([*`|_\\])", r"\\\1", part) for part in parts[::2])
    code = (f"``{part}``" for part in parts[1::2])
    return "".join(word for pair in zip(plain, (*code, ""), strict=True) for word in pair)


def _type(annotation: Any) -> str:
    text = annotation if isinstance(annotation, str) else inspect.formatannotation(annotation)
    return re.sub(r"\b(?:[a-z_]+\.)+", "", text.replace('"', "").replace("'", ""))


def _rst(text: str) -> str:
    return f"```{{eval-rst}}\n{text}\n```"
