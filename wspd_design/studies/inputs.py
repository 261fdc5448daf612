"""The files that a report is made from, as they are attached to it: each under its own name, all in one folder."""

import sys
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import Literal
from urllib.parse import quote

from wspd_design.controllers.protocol import Law
from wspd_design.design.file import design_text
from wspd_design.design.own_controller import is_own_controller
from wspd_design.design.records import Design
from wspd_design.design.requirements import Requirements
from wspd_design.design.stop_requirements import StopRequirements
from wspd_design.exchange.parameter_file import parameter_file
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.files import beside
from wspd_design.parameters.fingerprint import fingerprint
from wspd_design.parameters.given import given_entries, given_in_python
from wspd_design.parameters.laden import LADEN
from wspd_design.parameters.records import Rail, Vehicle
from wspd_design.simulation.records import Scenario
from wspd_design.studies.provenance import InputFile

DESIGN, COMMAND, IN_PYTHON = "design.toml", "command.txt", "made-in-python.txt"


def file_of(written: str) -> Path | None:
    """Return the file of a vehicle, rail or law that does not ship with the program; None for a shipped name."""
    name = written.rpartition(":")[0] if is_own_controller(written) else written.removesuffix(LADEN)
    return Path(name) if name.endswith((".toml", ".py")) else None


def attached_name(written: str) -> str:
    """Return how a vehicle, rail or law is named beside the attachments of a report."""
    path = file_of(written)
    return written if path is None else path.name + written.removeprefix(str(written[: len(str(path))]))


def attached_design(made: Design, *, vehicle_name: str, rail_name: str, rail: Rail) -> Design:
    """Return a design that looks for the files of its vehicle and rails beside itself.

    Parameters
    ----------
    made : Design
        The design.
    vehicle_name, rail_name : str
        Names or paths of the vehicle and of the rail of the stops.
    rail : Rail
        That rail.
    """
    wanted = made.requirements
    if wanted is not None:
        wanted = replace(
            wanted,
            rails=tuple(map(attached_name, wanted.rails)),
            stable_within=tuple((attached_name(name), share) for name, share in wanted.stable_within),
        )
    return replace(
        made,
        vehicle_file="" if file_of(vehicle_name) is None else attached_name(vehicle_name),
        rail_file="" if file_of(rail_name) is None or not made.made_on(rail) else attached_name(rail_name),
        requirements=wanted,
        judged_by=attached_name(made.judged_by),
    )


def required_rails(made: Design, folder: Path) -> tuple[str, ...]:
    """Return the rails of the requirements of a design, as they are seen from here."""
    wanted = made.requirements
    names = () if wanted is None else (*wanted.rails, *(name for name, _ in wanted.stable_within))
    return tuple(beside(name, folder) for name in names)


def command_input(command: str) -> InputFile:
    """Return the command of a report as a file."""
    meaning = "the command that makes this report from its attachments"
    return InputFile(name=COMMAND, text=f"{command}\n", meaning=meaning)


def design_input(design: Design) -> InputFile:
    """Return a design as a file."""
    meaning = "the design with its specification, which every command takes in place of a controller's name"
    return InputFile(name=DESIGN, text=design_text(design), meaning=meaning)


def law_inputs(written: str) -> tuple[InputFile, ...]:
    """Return the file of a law of one's own that was loaded, and what it imported from its folder."""
    path = file_of(written)
    if path is None or not is_own_controller(written):
        return ()
    folder = path.parent.resolve()
    beside_it = {
        Path(file).resolve()
        for module in list(sys.modules.values())
        if (file := getattr(module, "__file__", None)) and file.endswith(".py")
    }
    imported = sorted(
        each for each in beside_it if each.parent == folder and each != path.resolve() and each.is_file()
    )
    return (
        _file(path, "the law, a file of its own"),
        *(_file(each, f"what {path.name} imports") for each in imported),
    )


def parameter_inputs(
    kind: Literal["vehicle", "rail"], given: Vehicle | Rail | Path | str
) -> tuple[InputFile, ...]:
    """Return the file of a vehicle or rail of one's own; one that was made in Python is written as such a file."""
    if isinstance(given, Vehicle | Rail):
        found = given_entries(given)
        if not given_in_python(found):
            return ()
        text = parameter_file(
            found.title, ("Written from a record that was made in Python.",), found.entries.values()
        )
        meaning = f"a {kind}, written from a record that was made in Python"
        return (InputFile(name=f"{quote(found.name, safe=' ')}.toml", text=text, meaning=meaning),)
    path = file_of(str(given))
    return () if path is None else (_file(path, f"a {kind}, a file of its own"),)


def requirement_inputs(
    written: str | None, wanted: StopRequirements | Requirements | None
) -> tuple[InputFile, ...]:
    """Return the file of requirements of one's own, with the rails beside it that it names."""
    path = None if written is None else file_of(written)
    if path is None:
        return ()
    rails = (
        (*wanted.rails, *(rail for rail, _ in wanted.stable_within))
        if isinstance(wanted, Requirements)
        else ()
    )
    return (
        _file(path, "the requirements, a file of its own"),
        *(file for rail in rails for file in parameter_inputs("rail", rail)),
    )


def python_input(law: Law, scenario: Scenario, plant: str) -> InputFile:
    """Return what is known about a report that a program in Python made: fingerprints of what is in no file."""
    lines = (
        f"law {law.name}: {fingerprint(law)}",
        f"scenario: {fingerprint(scenario)}",
        f"plant: {plant}",
    )
    meaning = "fingerprints of the objects that a program in Python made it from"
    return InputFile(name=IN_PYTHON, text="".join(f"{line}\n" for line in lines), meaning=meaning)


def side_by_side(files: Iterable[InputFile]) -> tuple[InputFile, ...]:
    """Return files, each once.

    Raises
    ------
    UserError
        If two different files have the same name.
    """
    found: dict[str, InputFile] = {}
    for each in files:
        same = found.setdefault(each.name.casefold(), each)
        if (same.name, same.text) != (each.name, each.text):
            raise UserError(
                f'two of the files that the report is made from have the name "{each.name}" and different content '
                f"({same.meaning}; {each.meaning}); rename one, because all are attached side by side"
            )
    return tuple(found.values())


def _file(path: Path, meaning: str) -> InputFile:
    """Return a file that could be loaded, so that it is text."""
    return InputFile(name=path.name, text=path.read_text(encoding="utf-8-sig"), meaning=meaning)
