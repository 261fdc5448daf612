"""Instances of bodies and elements: tables of places, names with braces, and lengths as sums of numbers."""

import re
from typing import Any, NamedTuple

from wspd_design.parameters.entry import quoted
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.words import did_you_mean
from wspd_design.plants.multibody.records import Length, Place, Term

_PLACEHOLDER = re.compile(r"\{(\w*)\}")
_FLOAT = re.compile(r"\d+(?:\.\d*)?|\.\d+")


class Instance(NamedTuple):
    """One row of a table of instances."""

    name: str  # empty for what there is once
    words: dict[str, str]  # what stands for a name in braces
    factors: dict[str, float]  # what stands for a name in a length


ONCE = (Instance("", {}, {}),)
"""The instances of what there is once."""


def instances_of(tables: dict[str, Any], where: str) -> dict[str, tuple[Instance, ...]]:
    """Expand the tables of instances; a table ``of`` another one has its rows once for each row of that one.

    Parameters
    ----------
    tables : dict
        By name: ``of``, the name of an earlier table, if any; ``rows``, tables of factors with a ``name``. Rows
        without names are numbered through.
    where : str
        Name of the file in sentences.
    """
    expanded: dict[str, tuple[Instance, ...]] = {}
    for name, table in tables.items():
        what = f"[instances.{name}] in {where}"
        if not isinstance(table, dict) or not isinstance(table.get("rows"), list) or not table["rows"]:
            raise UserError(f"{what} lacks rows; write rows = [{{a = 1}}, {{a = -1}}].")
        known(table, ("of", "rows"), what)
        outer: tuple[Instance, ...] = ONCE
        if "of" in table:
            outer = _named(expanded, table["of"], f"of = {quoted(table['of'])} of {what}")
        rows = list[Instance]()
        for parent in outer:
            for row in table["rows"]:
                rows.append(_instance(name, parent, row, len(rows) + 1, what))
        if len({row.name for row in rows}) < len(rows):
            raise UserError(f"{what} has two rows of one name; give each row a name of its own.")
        expanded[name] = tuple(rows)
    return expanded


def _instance(table: str, parent: Instance, row: object, number: int, what: str) -> Instance:
    if not isinstance(row, dict):
        raise UserError(f"{what} has the row {row}; write each row as {{a = 1}}.")
    factors = dict(parent.factors)
    for key, value in row.items():
        if key == "name":
            if not isinstance(value, str) or not value:
                raise UserError(f"name = {value} of a row of {what} must be text; put it in quotes.")
        elif isinstance(value, bool) or not isinstance(value, (int, float)):
            raise UserError(f"{key} = {quoted(value)} of a row of {what} must be a number.")
        else:
            factors[key] = float(value)
    name = "_".join(filter(None, (parent.name, row["name"]))) if "name" in row else str(number)
    return Instance(name, parent.words | {table: name}, factors)


def chosen(tables: dict[str, tuple[Instance, ...]], item: dict[str, Any], what: str) -> tuple[Instance, ...]:
    """Return the instances of a body or an element: those of the table that ``each`` names, or one."""
    if "each" not in item:
        return ONCE
    return _named(tables, item["each"], f"each = {quoted(item['each'])} of {what}")


def _named(tables: dict[str, tuple[Instance, ...]], name: Any, what: str) -> tuple[Instance, ...]:
    if name not in tables:
        raise UserError(
            f"{what} is no table of instances above it{did_you_mean(str(name), tables)}; "
            f"known: {', '.join(tables) or 'none'}."
        )
    return tables[name]


def known(table: dict[str, Any], keys: tuple[str, ...], what: str) -> None:
    """Refuse a table with a key that nothing reads."""
    for key in table:
        if key not in keys:
            raise UserError(
                f"{what} has an unknown key {key}{did_you_mean(key, keys)}; allowed: {', '.join(keys)}."
            )


def filled(text: object, instance: Instance, what: str) -> str:
    """Put the names of an instance into the braces of a text."""
    if not isinstance(text, str):
        raise UserError(f"{what} is {text} but must be text; put it in quotes.")

    def word(match: re.Match[str]) -> str:
        if match[1] not in instance.words:
            raise UserError(
                f'"{text}" of {what} has {{{match[1]}}}{did_you_mean(match[1], instance.words)}; '
                f"known here: {', '.join(instance.words) or 'none'}."
            )
        return instance.words[match[1]]

    return _PLACEHOLDER.sub(word, text)


def place(raw: object, instance: Instance, what: str) -> Place:
    """Read a point: three lengths."""
    if not isinstance(raw, list) or len(raw) != 3:
        raise UserError(f"{what} is {quoted(raw)} but must be three lengths; write [x, y, z].")
    x, y, z = (length(item, instance, what) for item in raw)
    return x, y, z


def length(raw: object, instance: Instance, what: str) -> Length:
    """Read a length such as ``0.5 b bogie_spacing - a guide.arm``, or 0.

    A term is a product of numbers without unit, of columns of the table of instances, and of the name of one length.
    """
    if raw == 0:
        return ()
    if not isinstance(raw, str):
        raise UserError(
            f'{what} has {quoted(raw)} where a length belongs; write 0, or text such as "0.5 wheelbase" with the name '
            "of a number that has a unit."
        )
    terms: list[Term] = []
    for sign, product in re.findall(r"([+-]?)\s*([^+-]+)", raw.strip()):
        factor, numbers = -1.0 if sign == "-" else 1.0, []
        for word in product.split():
            if word in instance.factors:
                factor *= instance.factors[word]
            elif _FLOAT.fullmatch(word):
                factor *= float(word)
            else:
                numbers.append(word)
        if len(numbers) != 1:
            raise UserError(
                f'"{raw}" of {what} must have the name of one length in each term; "{product.strip()}" has '
                f"{', '.join(numbers) or 'none'} (columns here: {', '.join(instance.factors) or 'none'})."
            )
        terms.append(Term(factor=factor, number=numbers[0]))
    return tuple(term for term in terms if term.factor != 0.0)
