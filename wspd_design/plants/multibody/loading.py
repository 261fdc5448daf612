"""From a file of a multibody vehicle to its record."""

from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import Any, Final

from wspd_design.parameters.entry import entry_of, quoted
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.files import data_file, read_toml
from wspd_design.parameters.provenance import Entry
from wspd_design.parameters.units import units_of
from wspd_design.parameters.words import did_you_mean
from wspd_design.plants.multibody import schema
from wspd_design.plants.multibody.checks import check_numbers, check_topology
from wspd_design.plants.multibody.expansion import (
    Instance,
    chosen,
    filled,
    instances_of,
    known,
    length,
    place,
)
from wspd_design.plants.multibody.records import (
    Body,
    BumpStop,
    CaliperBrake,
    Gear,
    Multibody,
    Rod,
    Spring,
)

_OWN: Final = {"source": "own file", "status": "assumed"}


def available_multibodies() -> list[str]:
    """Return the names of the shipped multibody vehicles, sorted."""
    names = (entry.name for entry in data_file("multibody").iterdir())
    return sorted(name.removesuffix(".toml") for name in names if name.endswith(".toml"))


def load_multibody(name_or_path: str | Path) -> Multibody:
    """Load a multibody vehicle by its name, such as ``er24pc-82``, or from a ``.toml`` file.

    Parameters
    ----------
    name_or_path : str or Path
        Name of a shipped vehicle or path of a user's own file; docs/multibody.md tells the format.

    Returns
    -------
    Multibody
        Topology, and numbers in SI units.

    Raises
    ------
    UserError
        If there is no such vehicle or anything in its file is wrong; the sentence names file and key.
    """
    text = str(name_or_path)
    if text.endswith(".toml"):
        path = Path(text)
        return _multibody(path.stem, read_toml(path, text), text, _OWN | {"at": path.name})
    if text not in available_multibodies():
        raise UserError(
            f'unknown multibody vehicle "{text}"{did_you_mean(text, available_multibodies())}; available: '
            f"{', '.join(available_multibodies())}, or the path of a .toml file."
        )
    return _shipped(text)


@cache
def _shipped(name: str) -> Multibody:
    file = f"{name}.toml"
    return _multibody(name, read_toml(data_file("multibody", file), file), file, {})


def _multibody(name: str, document: dict[str, Any], where: str, defaults: dict[str, str]) -> Multibody:
    known(document, schema.FILE_KEYS, where)
    title, remainder = document.get("title", name), document.get("remainder", "")
    if not isinstance(title, str):
        raise UserError(f"title = {title} in {where} must be text; put it in quotes.")
    tables = instances_of(_group(document, "instances", where), where)
    items = {part: list(_items(document, part, tables, where)) for part in schema.ITEM_KEYS}
    parts: dict[str, Any] = {
        "bodies": tuple(_body(*item) for item in items["bodies"]),
        "springs": tuple(_spring(*item) for item in items["springs"]),
        "rods": tuple(_rod(*item) for item in items["rods"]),
        "gears": tuple(_gear(*item) for item in items["gears"]),
        "brakes": tuple(_brake(*item) for item in items["brakes"]),
    }
    stops = tuple(_bump_stop(*item) for item in items["bump_stops"])
    topology = Multibody(
        name=name, title=title, **parts, stops=stops, remainder=remainder, numbers={}, entries={}
    )
    check_topology(topology, where)
    entries = _entries(_group(document, "numbers", where), schema.quantities_of(topology), where, defaults)
    numbers = {key: value for name, entry in entries.items() for key, value in _flat(name, entry.value)}
    model = replace(
        topology,
        stops=tuple(replace(stop, points=_points(stop.kind, numbers, where)) for stop in stops),
        numbers=numbers,
        entries=entries,
    )
    check_numbers(model, where)
    return model


def _group(document: dict[str, Any], part: str, where: str) -> dict[str, Any]:
    table = document.get(part, {})
    if not isinstance(table, dict):
        raise UserError(f"{part} in {where} must be tables; write [{part}.NAME] and its keys below.")
    return table


def _items(
    document: dict[str, Any], part: str, tables: dict[str, tuple[Instance, ...]], where: str
) -> Iterator[tuple[str, dict[str, Any], Instance, str]]:
    """Yield kind, table, instance and place in the file of every body or element of one part."""
    for kind, item in _group(document, part, where).items():
        what = f"[{part}.{kind}] in {where}"
        if not isinstance(item, dict):
            raise UserError(f"{kind} of {part} in {where} must be a table; write [{part}.{kind}].")
        needed, optional = schema.ITEM_KEYS[part]
        known(item, (*needed, *optional), what)
        for key in needed:
            if key not in item:
                raise UserError(f"{what} lacks {key}; add {key} = {schema.EXAMPLES[key]} below it.")
        for instance in chosen(tables, item, what):
            yield kind, item, instance, what


def _name(kind: str, instance: Instance) -> str:
    return "_".join(filter(None, (kind, instance.name)))


def _body(kind: str, item: dict[str, Any], instance: Instance, what: str) -> Body:
    joint = item["joint"]
    if joint not in schema.JOINTS:
        raise UserError(
            f"joint = {quoted(joint)} of {what} is unknown{did_you_mean(str(joint), schema.JOINTS)}; "
            f"allowed: {', '.join(schema.JOINTS)}."
        )
    turns = joint in ("revolute", "rotor")
    if turns != ("on" in item):
        raise UserError(
            f'{what} lacks on; a body with the joint "{joint}" turns on another one, whose name stands there.'
            if turns
            else f'on of {what} means nothing with the joint "{joint}", which leaves the body free; leave it out.'
        )
    return Body(
        name=_name(kind, instance),
        kind=kind,
        joint=joint,
        at=place(item["at"], instance, f"at of {what}"),
        on=filled(item["on"], instance, f"on of {what}") if turns else "",
        axis=place(item["axis"], instance, f"axis of {what}") if "axis" in item else None,
    )


def _between(item: dict[str, Any], instance: Instance, what: str) -> tuple[str, str]:
    pair = item["between"]
    if not isinstance(pair, list) or len(pair) != 2:
        raise UserError(f'between of {what} is {quoted(pair)} but must be two bodies; write ["A", "B"].')
    first, second = (filled(each, instance, f"between of {what}") for each in pair)
    if first == second:
        raise UserError(f"between of {what} names {first} twice; name two bodies.")
    return first, second


def _spring(kind: str, item: dict[str, Any], instance: Instance, what: str) -> Spring:
    carries = item.get("carries", False)
    if not isinstance(carries, bool):
        raise UserError(f"carries = {quoted(carries)} of {what} must be true or false.")
    return Spring(
        name=_name(kind, instance),
        kind=kind,
        between=_between(item, instance, what),
        at=place(item["at"], instance, f"at of {what}"),
        carries=carries,
    )


def _rod(kind: str, item: dict[str, Any], instance: Instance, what: str) -> Rod:
    first, second = (place(item[key], instance, f"{key} of {what}") for key in ("from", "to"))
    return Rod(
        name=_name(kind, instance), kind=kind, between=_between(item, instance, what), ends=(first, second)
    )


def _bump_stop(kind: str, item: dict[str, Any], instance: Instance, what: str) -> BumpStop:
    axis = item["axis"]
    if axis not in ("x", "y", "z"):
        raise UserError(f"axis = {quoted(axis)} of {what} must be one of x, y, z.")
    return BumpStop(
        name=_name(kind, instance),
        kind=kind,
        between=_between(item, instance, what),
        at=place(item["at"], instance, f"at of {what}"),
        axis=axis,
        points=0,
    )


def _gear(kind: str, item: dict[str, Any], instance: Instance, what: str) -> Gear:
    housing, rotor = (filled(item[key], instance, f"{key} of {what}") for key in ("housing", "rotor"))
    return Gear(name=_name(kind, instance), kind=kind, housing=housing, rotor=rotor)


def _brake(kind: str, item: dict[str, Any], instance: Instance, what: str) -> CaliperBrake:
    levers = item["levers"]
    if not isinstance(levers, list) or not levers:
        raise UserError(f'levers of {what} is {quoted(levers)} but must be lengths; write ["brake.lever"].')
    return CaliperBrake(
        name=_name(kind, instance),
        kind=kind,
        frame=filled(item["frame"], instance, f"frame of {what}"),
        wheelset=filled(item["wheelset"], instance, f"wheelset of {what}"),
        levers=tuple(length(lever, instance, f"levers of {what}") for lever in levers),
    )


def _entries(
    stated: dict[str, Any], wanted: schema.Wanted, where: str, defaults: dict[str, str]
) -> dict[str, Entry]:
    found = {
        name: entry_of(name, raw, wanted[name], where, defaults)
        for name, raw in _named(stated, wanted, where, "")
    }
    missing = [name for name, quantity in wanted.items() if name not in found and not quantity.optional]
    if missing:
        unit = units_of(wanted[missing[0]].dimension)[0]
        raise UserError(
            f"{where} lacks {', '.join(f'[numbers.{name}]' for name in missing)}; add "
            f'{"it" if len(missing) == 1 else "them"} with value, unit (such as "{unit}"), source, at and status.'
        )
    return {name: found[name] for name in wanted if name in found}


def _named(
    stated: dict[str, Any], wanted: schema.Wanted, where: str, prefix: str
) -> Iterator[tuple[str, Any]]:
    for key, raw in stated.items():
        name = prefix + key
        if name in wanted:
            yield name, raw
        elif isinstance(raw, dict) and any(each.startswith(f"{name}.") for each in wanted):
            yield from _named(raw, wanted, where, f"{name}.")
        else:
            raise UserError(
                f"[numbers.{name}] in {where} is not a number of this vehicle{did_you_mean(name, wanted)}; correct its "
                "name, or leave it out where no body, element or place uses it."
            )


def _flat(name: str, value: Any) -> Iterator[tuple[str, float]]:
    """Yield the numbers of an entry: those of a table are numbered from 1."""
    if isinstance(value, tuple):
        yield from ((f"{name}.{k}", each) for k, each in enumerate(value, 1))
    else:
        yield name, value


def _points(kind: str, numbers: dict[str, float], where: str) -> int:
    """Count the points of the table of a bump stop, which rises from zero force."""
    travel, force = (
        [value for name, value in numbers.items() if name.startswith(f"{kind}.{column}.")]
        for column in ("travel", "force")
    )
    rising = all(a < b for a, b in pairwise(travel)) and all(a <= b for a, b in pairwise(force))
    if len(travel) != len(force) or len(travel) < 2 or force[0] != 0.0 or not rising:
        raise UserError(
            f"{kind}.travel and {kind}.force in {where} must be tables of equal length that rise, from force 0 on; "
            "correct them."
        )
    return len(travel)
