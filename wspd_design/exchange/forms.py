"""What a form is: the keys of one JSON object, what stands behind each, and the JSON Schema that says so."""

from dataclasses import dataclass
from typing import Any, Literal, TypeAlias

Kind: TypeAlias = "Literal['text', 'number', 'integer', 'flag', 'value'] | Form"

UNITS = {
    "_per_Nms": "1/(N m s)",
    "_per_s": "1/s",
    "_kg_m2": "kg m²",
    "_m_s2": "m/s²",
    "_rad_s": "rad/s",
    "_m_s": "m/s",
    "_Nms": "N m s",
    "_Nm": "N m",
    "_kg": "kg",
    "_Hz": "Hz",
    "_N": "N",
    "_m": "m",
    "_s": "s",
}
"""Unit of a number by the end of its key, longest end first; without one it is a ratio or a count."""

_TYPES = {"text": "string", "number": "number", "integer": "integer", "flag": "boolean"}
_DIALECT = "https://json-schema.org/draft/2020-12/schema"


@dataclass(frozen=True, slots=True, kw_only=True)
class Key:
    """One key of an object.

    ``many`` is the least and the largest length of a list of such values, ``by_name`` an object with one such value
    for each name; a key that is not ``always`` there is written by some commands only, which the meaning names.
    """

    name: str
    kind: Kind
    meaning: str
    nullable: bool = False
    many: tuple[int, int | None] | None = None
    by_name: bool = False
    words: tuple[str, ...] = ()
    always: bool = True


@dataclass(frozen=True, slots=True, kw_only=True)
class Form:
    """The keys of one object, in their order; an object that stands alone has a schema name such as ``wspd-stop/2``."""

    name: str
    keys: tuple[Key, ...]
    schema: str = ""


def unit(key: str) -> str:
    """Return the unit that ends a key; empty for a ratio, a count or a word."""
    return next((spelled for end, spelled in UNITS.items() if key.endswith(end)), "")


def json_schema(form: Form) -> dict[str, Any]:
    """Return the JSON Schema of a form that stands alone.

    Keys that the form does not know are allowed, because keys may be added under the same name of a schema.
    """
    inner = {each.name: _object(each) for each in inner_forms(form)}
    return {
        "$schema": _DIALECT,
        "$id": f"urn:wspd-design:{form.schema}",
        "title": form.schema,
        **_object(form),
        **({"$defs": inner} if inner else {}),
    }


def inner_forms(form: Form) -> tuple[Form, ...]:
    """Return the forms inside a form, each once, in the order in which they are met."""
    found: dict[str, Form] = {}
    for key in form.keys:
        if isinstance(key.kind, Form):
            for each in (key.kind, *inner_forms(key.kind)):
                found.setdefault(each.name, each)
    return tuple(found.values())


def _object(form: Form) -> dict[str, Any]:
    return {
        "type": "object",
        "properties": {key.name: _property(form, key) for key in form.keys},
        "required": [key.name for key in form.keys if key.always],
    }


def _property(form: Form, key: Key) -> dict[str, Any]:
    if key.name == "schema":
        return {"const": form.schema}
    unit_of = unit(key.name) if key.kind == "number" else ""
    meaning = ", ".join(filter(None, (key.meaning, unit_of)))
    return {**_nullable(key, _listed(key, _value(key))), **({"description": meaning} if meaning else {})}


def _value(key: Key) -> dict[str, Any]:
    if isinstance(key.kind, Form):
        return {"$ref": f"#/$defs/{key.kind.name}"}
    if key.kind == "value":
        return {}
    return {"type": _TYPES[key.kind], **({"enum": list(key.words)} if key.words else {})}


def _listed(key: Key, value: dict[str, Any]) -> dict[str, Any]:
    if key.by_name:
        return {"type": "object", "additionalProperties": value}
    if key.many is None:
        return value
    least, most = key.many
    return {
        "type": "array",
        "items": value,
        **({"minItems": least} if least else {}),
        **({} if most is None else {"maxItems": most}),
    }


def _nullable(key: Key, value: dict[str, Any]) -> dict[str, Any]:
    return {"anyOf": [value, {"type": "null"}]} if key.nullable else value
