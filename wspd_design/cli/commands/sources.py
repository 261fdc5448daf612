"""``wspd sources``: every number of a parameter file with where it comes from."""

from collections.abc import Iterable
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.text import Text

from wspd_design.cli.completion import names_or_files
from wspd_design.cli.console import WIDE, console, spaced, table
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.files import read_toml
from wspd_design.parameters.laden import LADEN
from wspd_design.parameters.loading import available, load_entries
from wspd_design.parameters.loading import sources as known_sources
from wspd_design.parameters.provenance import Entry, ParameterSet
from wspd_design.parameters.schema import Kind, schema_of
from wspd_design.parameters.units import format_quantity
from wspd_design.parameters.words import did_you_mean
from wspd_design.plants.multibody.loading import available_multibodies, load_multibody

_KINDS: tuple[Kind, ...] = ("vehicle", "rail", "controller", "track", "constants")


def sources(
    name: Annotated[
        str | None,
        typer.Argument(
            metavar="NAME",
            help="Vehicle, rail, controller, track or multibody vehicle, or a .toml file.",
            autocompletion=names_or_files((name for kind in _KINDS for name in available(kind)), ".toml"),
        ),
    ] = None,
) -> None:
    """Show every number of a parameter set with unit, bounds, status, source and place."""
    if name is None:
        _show_names()
        return
    for parameters in _of_name(name):
        _show(parameters)


def _of_name(name: str) -> list[ParameterSet]:
    """Return what a name stands for: of one kind, and a multibody vehicle may have the name of a vehicle."""
    if name.endswith(LADEN):
        return [load_entries("vehicle", name)]
    if name.endswith(".toml"):
        document = read_toml(Path(name), name)
        if "bodies" in document:
            return [_of_multibody(name)]
        keys = {key.partition(".")[0] for key in schema_of("rail", "")}
        own_rail = document.get("base") in available("rail") or bool(document.keys() & keys)
        return [load_entries("rail" if own_rail else "vehicle", name)]
    found = [load_entries(kind, name) for kind in _KINDS if name in available(kind)][:1]
    found += [_of_multibody(name)] if name in available_multibodies() else []
    if found:
        return found
    everything = [known for kind in _KINDS for known in available(kind)] + available_multibodies()
    raise UserError(
        f'no parameter set is called "{name}"{did_you_mean(name, everything)}; "wspd sources" lists all of them'
    )


def _of_multibody(name: str) -> ParameterSet:
    model = load_multibody(name)
    return ParameterSet(kind="multibody", name=model.name, title=model.title, entries=dict(model.entries))


def _show_names() -> None:
    out = console()
    shown = table("Kind", "Name", "Title")
    for kind in _KINDS:
        for name in available(kind):
            shown.add_row(kind, name, load_entries(kind, name).title)
    for name in available_multibodies():
        shown.add_row("multibody", name, load_multibody(name).title)
    out.print(spaced(shown))


def _show(parameters: ParameterSet) -> None:
    out = console()
    out.print(f"{parameters.name}: {parameters.title}", style="bold", markup=False)
    entries = parameters.entries.values()
    if out.width >= WIDE:
        shown = table("Number", "Value", "Bounds", "Status", "Source", "Place")
        for column in (0, 3, 4):
            shown.columns[column].no_wrap = True
        for entry in entries:
            shown.add_row(
                entry.name, _value(entry), _bounds(entry), entry.status, entry.source, _place(entry)
            )
    else:
        shown = table("Number", "Status", "Source")
        first = min(max(len(entry.name) for entry in entries), out.width // 2)
        second = max(len("Status"), *(len(entry.status) for entry in entries))
        # Stated for all, less 5 between them: a least width of one would push the last out of the terminal.
        for each, width in zip(shown.columns, (first, second, out.width - first - second - 5), strict=True):
            each.width = width
        for entry in entries:
            number = Text(entry.name, style="bold").append("\n").append(_value(entry))
            if entry.bounds is not None:
                number.append("\n").append(_bounds(entry))
            shown.add_row(number, entry.status, Text(f"{entry.source}\n").append_text(_place(entry)))
    out.print(spaced(shown))
    _show_inherited(parameters)
    notes = [(entry.name, entry.note) for entry in entries if entry.note]
    _list(notes, "Notes")
    titles = known_sources()
    keys = dict.fromkeys(entry.source for entry in entries)
    _list([(key, _citation(key)) for key in keys if key in titles], "Sources")


def _show_inherited(parameters: ParameterSet) -> None:
    """Say which numbers the file does not state itself."""
    for base in dict.fromkeys(entry.inherited for entry in parameters.entries.values() if entry.inherited):
        taken = [entry.name for entry in parameters.entries.values() if entry.inherited == base]
        console().print(
            f"{len(taken)} of {len(parameters.entries)} are not of this file but taken over from {base}: "
            f"{', '.join(taken)}.",
            markup=False,
        )


def _place(entry: Entry) -> Text:
    return (
        Text(f"from {entry.inherited}: ", style="bold").append(entry.at, style="not bold")
        if entry.inherited
        else Text(entry.at)
    )


def _list(rows: Iterable[tuple[str, str]], heading: str) -> None:
    shown = table(heading, "")
    for name, text in rows:
        shown.add_row(name, Text(text))
    if shown.row_count:
        console().print(spaced(shown))


def _citation(key: str) -> str:
    source = known_sources()[key]
    note = f" {source.note}" if source.note else ""
    return f"{source.authors} ({source.year}): {source.title} [{source.access}].{note}"


def _value(entry: Entry) -> Text:
    return Text(_quantity(entry.value, entry.unit))


def _bounds(entry: Entry) -> Text:
    if entry.bounds is None:
        return Text("exact", style="dim")
    return Text(" to ".join(_number(bound, entry.unit) for bound in entry.bounds))


def _quantity(value: Any, unit: str) -> str:
    if isinstance(value, float):
        return format_quantity(value, unit)
    return f"{_number(value, unit)} {'' if unit == '-' else unit}".rstrip()


def _number(value: Any, unit: str) -> str:
    """Write numbers without their unit; words stay as they are."""
    match value:
        case str():
            return value
        case tuple():
            return f"[{', '.join(_number(item, unit) for item in value)}]"
    return format_quantity(value, unit).partition(" ")[0]
