"""The tables of ``docs/json.md``: what stands behind each key, from the same forms as the schemas."""

import re
from collections.abc import Mapping

from wspd_design.exchange.forms import UNITS, Form, Key, inner_forms, unit
from wspd_design.exchange.vocabulary import STANDING_ALONE

_TYPES = {
    "text": "text",
    "number": "number",
    "integer": "integer",
    "flag": "true or false",
    "value": "any",
}
_BLOCK = re.compile(r"<!-- (?P<name>[a-z_]+) -->\n.*?<!-- end -->", re.DOTALL)


def with_tables(page: str) -> str:
    """Return a page with the table of each form between its markers, ``<!-- stop -->`` and ``<!-- end -->``."""
    tables = documented_tables()
    return _BLOCK.sub(lambda found: f"<!-- {found['name']} -->\n{tables[found['name']]}\n<!-- end -->", page)


def documented_tables() -> Mapping[str, str]:
    """Return the table of every form, and that of the units, by the name of its marker."""
    forms = {each.name: each for form in STANDING_ALONE for each in (form, *inner_forms(form))}
    return {name: _table(form) for name, form in forms.items()} | {"units": _units()}


def _table(form: Form) -> str:
    rows = (f"| `{key.name}` | {_type(key)} | {_meaning(form, key)} |" for key in form.keys)
    return "\n".join(("| key | type | meaning |", "|---|---|---|", *rows))


def _type(key: Key) -> str:
    one = f"object `{key.kind.name}`" if isinstance(key.kind, Form) else _TYPES[key.kind]
    many = one if key.many is None else f"list of {'two ' * (key.many == (2, 2))}{_plural(one)}"
    if key.by_name:
        many = f"{_plural(one)} by name"
    return f"{many} or null" if key.nullable else many


def _plural(noun: str) -> str:
    return {"text": "texts", "number": "numbers"}.get(noun, noun.replace("object", "objects"))


def _meaning(form: Form, key: Key) -> str:
    if key.name == "schema":
        return f"`{form.schema}`"
    measured = f"[{unit(key.name)}]" if key.kind == "number" and unit(key.name) else ""
    words = f"({', '.join(f'`{word}`' for word in key.words)})" if key.words else ""
    return " ".join(filter(None, (key.meaning, measured, words)))


def _units() -> str:
    rows = (f"| `{end}` | {spelled} |" for end, spelled in UNITS.items())
    return "\n".join(("| end of the key | unit |", "|---|---|", *rows))
