"""Parameter files: from TOML to checked entries.

Every number is a table with ``value``, ``unit``, ``bounds``, ``source``, ``at``, ``status`` and ``note``, or in short
``mass = "45 t"``. A user's own file has the same format; it may start from a shipped one with ``base = "er24pc"`` and
then states only what differs. Such a number replaces that of the base as a whole, bounds included.
"""

import re
import tomllib
from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from importlib.resources import files
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import Any

from wspd_design.parameters.entry import entry_of, quoted
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.laden import LADEN, laden
from wspd_design.parameters.provenance import Entry, ParameterSet
from wspd_design.parameters.schema import CONSTANTS_SCHEMAS, Kind, Schema, schema_of
from wspd_design.parameters.units import units_of
from wspd_design.parameters.words import did_you_mean, remedy_for

_FOLDERS: dict[Kind, str] = {
    "constants": "",
    "vehicle": "vehicles",
    "rail": "rails",
    "controller": "controllers",
    "track": "track",
}
_DECIMAL_COMMA = re.compile(r"^[^\"\[#]*=\s*([-+]?\d+),(\d+)\s*(?:#.*)?$", re.MULTILINE)
_FILE_KEYS = ("title", "base")
PROFILE_RAILS = "profile.rails"
"""The entry of a rail file that changes along the track."""
MULTIBODY = "multibody"
"""The entry of a vehicle file that names another file."""


def data_file(*parts: str) -> Traversable:
    """Return a file or folder of the data that ships with the program."""
    return files("wspd_design").joinpath("data", *parts)


def available(kind: Kind) -> list[str]:
    """Return the names of the shipped parameter files of one kind, sorted."""
    if kind == "constants":
        return sorted(CONSTANTS_SCHEMAS)
    entries = data_file(_FOLDERS[kind]).iterdir()
    return sorted(entry.name.removesuffix(".toml") for entry in entries if entry.name.endswith(".toml"))


def uniform_rails() -> list[str]:
    """Return the names of the shipped rails of one adhesion, which do not change along the track, sorted."""
    return [name for name in available("rail") if PROFILE_RAILS not in load_entries("rail", name).entries]


def load_entries(kind: Kind, name_or_path: str | Path) -> ParameterSet:
    """Load all entries of a shipped parameter file or of a user's own one.

    Parameters
    ----------
    kind : {"constants", "vehicle", "rail", "controller", "track"}
        What the file describes.
    name_or_path : str or Path
        Name of a shipped file, such as ``er24pc``, or for vehicles and rails the path of a ``.toml`` file; with
        ``:laden`` after it the laden vehicle.

    Returns
    -------
    ParameterSet
        Entries in the order of the schema, values and bounds in SI units.

    Raises
    ------
    UserError
        If the name is unknown or anything in the file is wrong; the sentence names file and key.
    """
    text = str(name_or_path)
    if kind == "vehicle" and text.endswith(LADEN):
        return laden(load_entries(kind, text.removesuffix(LADEN)))
    if kind in ("vehicle", "rail") and text.endswith(".toml"):
        return _load_own(kind, Path(text))
    shipped = _shipped(kind, text)
    return replace(shipped, entries=dict(shipped.entries))  # what a caller does to them stays with the caller


@cache
def _shipped(kind: Kind, text: str) -> ParameterSet:
    """Read a file that ships with the program, which does not change while it runs."""
    if text not in available(kind):
        remedy = f"available: {', '.join(available(kind))}"
        if kind in ("vehicle", "rail"):
            remedy += ", or the path of a .toml file"
        raise UserError(f'unknown {kind} "{text}"{did_you_mean(text, available(kind))}; {remedy}.')
    schema = schema_of(kind, text)
    source = f"{text}.toml"
    document = read_toml(data_file(_FOLDERS[kind], source), source)
    entries = _entries(kind, document, schema, source, {})
    return _parameter_set(kind, text, document, schema, _with_first_rail(entries, Path(), source), source)


def data_text(kind: Kind, name: str) -> str:
    """Return the text of a shipped parameter file."""
    return data_file(_FOLDERS[kind], f"{name}.toml").read_text(encoding="utf-8")


def read_toml(file: Traversable | Path, where: str) -> dict[str, Any]:
    """Read a TOML file; whatever is wrong with it becomes one sentence about ``where``."""
    text = ""
    try:
        text = file.read_bytes().decode("utf-8-sig")  # some editors begin with a byte order mark
        return tomllib.loads(text)
    except RecursionError:
        raise UserError(f"{where} is nested too deeply; a file has tables in tables, no more.") from None
    except tomllib.TOMLDecodeError as error:
        comma = _DECIMAL_COMMA.search(text)
        remedy = f'write "{comma[1]}.{comma[2]}" with a point' if comma else "correct that place"
        raise UserError(f"{where} is not valid TOML: {error}; {remedy}.") from None
    except UnicodeDecodeError:
        raise UserError(f"{where} is not a text file in UTF-8; save it as such.") from None
    except ValueError:  # of the integers alone: Python reads no more than some thousand digits
        raise UserError(f"{where} has a number of thousands of digits; write it with an exponent.") from None
    except FileNotFoundError:
        raise UserError(f"{where} does not exist; check the path.") from None
    except OSError as error:
        raise UserError(
            f"{where} cannot be read ({error.strerror}); check the path and its permissions."
        ) from None


def _load_own(kind: Kind, path: Path) -> ParameterSet:
    where = str(path)
    document = read_toml(path, where)
    schema = schema_of(kind, path.stem)
    # A user may leave out the history of a number, but then it says so itself.
    entries = _entries(
        kind, document, schema, where, {"source": "own file", "at": path.name, "status": "assumed"}
    )
    if MULTIBODY in entries:
        entry = entries[MULTIBODY]
        entries[MULTIBODY] = replace(entry, value=beside(str(entry.value), path.parent))
    if "base" in document:
        base, shipped = document["base"], available(kind)
        if base not in shipped:
            raise UserError(
                f"base = {quoted(base)} in {where} is not a shipped {kind}"
                f"{did_you_mean(str(base), shipped)}; available: {', '.join(shipped)}."
            )
        entries = inherited(kind, base) | entries
    entries = _with_first_rail(entries, path.parent, where)
    return _parameter_set(kind, path.stem, document, schema, entries, where)


def _with_first_rail(entries: dict[str, Entry], folder: Path, where: str) -> dict[str, Entry]:
    """Give a rail that changes along the track the numbers of the first of its rails."""
    if PROFILE_RAILS not in entries:
        return entries
    own = [key for key, entry in entries.items() if not key.startswith("profile.") and not entry.inherited]
    if own:
        raise UserError(
            f"{own[0]} in {where} stands beside a profile, whose rails have their own; leave it out."
        )
    rails = entries[PROFILE_RAILS].value
    assert isinstance(rails, tuple)
    for name in dict.fromkeys(beside(str(rail), folder) for rail in rails):
        if name == where or PROFILE_RAILS in load_entries("rail", name).entries:
            raise UserError(
                f"{where} names {name}, which changes along the track itself; name rails that do not."
            )
    return inherited("rail", beside(str(rails[0]), folder)) | entries


def beside(name: str, folder: Path) -> str:
    """Return a name of a file as seen from here, which another file in a folder states; other names stay."""
    return str(folder / name) if name.endswith(".toml") else name


def _parameter_set(
    kind: Kind, name: str, document: dict[str, Any], schema: Schema, entries: dict[str, Entry], where: str
) -> ParameterSet:
    missing = [key for key, quantity in schema.items() if key not in entries and not quantity.optional]
    if missing:
        remedy = "add it" if len(missing) == 1 else "add them"
        if kind in ("vehicle", "rail"):
            remedy += f' or start with base = "...", one of {", ".join(available(kind))}'
        raise UserError(f"{where} lacks {', '.join(f'[{key}]' for key in missing)}; {remedy}.")
    title = document.get("title", name)
    if not isinstance(title, str):
        raise UserError(f"title = {title} in {where} must be text; put it in quotes.")
    return ParameterSet(
        kind=kind, name=name, title=title, entries={key: entries[key] for key in schema if key in entries}
    )


def inherited(kind: Kind, name: str) -> dict[str, Entry]:
    """Return the numbers of a parameter file as another one takes them over."""
    entries = load_entries(kind, name).entries
    return {key: replace(entry, inherited=entry.inherited or name) for key, entry in entries.items()}


def _entries(
    kind: Kind, document: dict[str, Any], schema: Schema, where: str, defaults: dict[str, str]
) -> dict[str, Entry]:
    stated = {key: value for key, value in document.items() if key not in _FILE_KEYS}
    return {
        name: entry_of(name, raw, schema[name], where, defaults)
        for name, raw in _named(kind, stated, schema, where, "")
    }


def _named(
    kind: Kind, stated: dict[str, Any], schema: Schema, where: str, prefix: str
) -> Iterator[tuple[str, Any]]:
    """Walk through the groups and yield what the schema knows, by its dotted name."""
    for key, raw in stated.items():
        name = prefix + key
        members = [known for known in schema if known.startswith(f"{name}.")]
        if name in schema:
            yield name, raw
        elif not members:
            raise UserError(
                f"{where} has an unknown key {name}{remedy_for(kind, name, raw, _known_names(schema))}"
            )
        elif isinstance(raw, dict):
            yield from _named(kind, raw, schema, where, f"{name}.")
        else:
            raise UserError(
                f"{name} in {where} must be a table: write [{members[0]}] and below it "
                f'value = ... and unit = "{units_of(schema[members[0]].dimension)[0]}".'
            )


def _known_names(schema: Schema) -> list[str]:
    return [*schema, *{known.rpartition(".")[0]: None for known in schema if "." in known}, *_FILE_KEYS]
