"""The page of the public API: the names of ``wspd_design.__all__`` by the room that they live in.

Docstrings are rendered by autodoc, but for the section "Attributes" of a record, which becomes a table with defaults.
"""

import dataclasses
import inspect
import re
import textwrap
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
_ATTRIBUTE = re.compile(r"(?P<name>\w+) : (?P<type>.+?)(?: \[(?P<unit>[^\]]+)\])?")
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
    return "\n".join((*lines, textwrap.indent(table, "   ")))


def field_table(item: type) -> str:
    """Return a table of the attributes that the docstring of a record states, empty for what is no record."""
    if not dataclasses.is_dataclass(item):
        return ""
    defaults = {field.name: _default(field) for field in dataclasses.fields(item)}
    rows = [
        (
            f"``{each['name']}``",
            f"``{each['type']}``",
            defaults.get(each["name"], ""),
            each["unit"],
            each["meaning"],
        )
        for each in attributes(inspect.getdoc(item) or "")
    ]
    lines = [".. list-table::", "   :header-rows: 1", "   :widths: auto", "   :class: fields", ""]
    for row in (("attribute", "type", "default", "unit", "meaning"), *rows):
        lines += [f"   {'* -' if number == 0 else '  -'} {cell}" for number, cell in enumerate(row)]
    return "\n".join(lines) if rows else ""


def attributes(docstring: str) -> list[dict[str, str]]:
    """Return name, type, unit and meaning of each attribute in a docstring."""
    found: list[dict[str, str]] = []
    for line in docstring.splitlines()[_section(docstring.splitlines())]:
        stated = _ATTRIBUTE.fullmatch(line)
        if stated:
            unit = (stated["unit"] or "").replace("-", "\\-")  # a hyphen alone would begin a list
            found.append({"name": stated["name"], "type": stated["type"], "unit": unit, "meaning": ""})
        elif found and line.strip():
            found[-1]["meaning"] = f"{found[-1]['meaning']} {_escaped(line.strip())}".strip()
    return found


def without_attributes(lines: list[str]) -> list[str]:
    """Return a docstring without the section that the table shows."""
    section = _section(lines)
    return [*lines[: max(section.start - 2, 0)], *lines[section.stop :]] if section.start else lines


def _section(lines: list[str]) -> slice:
    """Return where the section "Attributes" lies, without its heading; nowhere if there is none."""
    heads = [place for place, line in enumerate(lines) if line and not line.strip("-") and len(line) > 3]
    for head, following in zip(heads, (*heads[1:], len(lines) + 1), strict=False):
        if lines[head - 1] == "Attributes":
            return slice(head + 1, following - 1)
    return slice(0, 0)


def _default(field: "dataclasses.Field[Any]") -> str:
    """Return the default of a field where it is a plain value; ``...`` where it is something longer."""
    if field.default is field.default_factory is dataclasses.MISSING:
        return ""
    text = repr(field.default)
    return f"``{text}``" if len(text) <= _SHORT and "<" not in text else "``...``"


def _escaped(text: str) -> str:
    """Return plain words as reStructuredText, in which ``code`` stays code."""
    parts = _CODE.split(text)
    plain = (re.sub(r"([*`|_\\])", r"\\\1", part) for part in parts[::2])
    code = (f"``{part}``" for part in parts[1::2])
    return "".join(word for pair in zip(plain, (*code, ""), strict=True) for word in pair)


def _rst(text: str) -> str:
    return f"```{{eval-rst}}\n{text}\n```"
