"""The files that a report is made from, as they are attached to it: each under its own name, all in one folder."""

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

from wspd_design.design.file import design_text
from wspd_design.design.records import Design
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.files import beside
from wspd_design.parameters.laden import LADEN
from wspd_design.parameters.records import Rail
from wspd_design.studies.provenance import InputFile

DESIGN, COMMAND = "design.toml", "command.txt"


def file_of(written: str) -> Path | None:
    """Return the file of a vehicle or rail that does not ship with the program; None for a shipped name."""
    name = written.removesuffix(LADEN)
    return Path(name) if name.endswith(".toml") else None


def attached_name(written: str) -> str:
    """Return how a vehicle or rail is named beside the attachments of a report."""
    path = file_of(written)
    return written if path is None else path.name + (LADEN if written.endswith(LADEN) else "")


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
    )


def required_rails(made: Design, folder: Path) -> tuple[str, ...]:
    """Return the rails of the requirements of a design, as they are seen from here."""
    wanted = made.requirements
    names = () if wanted is None else (*wanted.rails, *(name for name, _ in wanted.stable_within))
    return tuple(beside(name, folder) for name in names)


def input_files(
    attached: Design, *, vehicle_name: str, rail_names: Iterable[str], command: str = ""
) -> tuple[InputFile, ...]:
    """Collect what a report is made from: its command, the design, and each vehicle or rail of one's own.

    Parameters
    ----------
    attached : Design
        As :func:`attached_design` returns it.
    vehicle_name : str
        Name or path of the vehicle.
    rail_names : iterable of str
        Names or paths of all rails.
    command : str
        That makes the report from these files; empty where there is none.

    Raises
    ------
    UserError
        If two different files have the same name.
    """
    found = [_command(command)] if command else []
    meaning = "the design with its specification, which every command takes in place of a controller's name"
    found.append(InputFile(name=DESIGN, text=design_text(attached), meaning=meaning))
    for kind, written in (("vehicle", vehicle_name), *(("rail", name) for name in rail_names)):
        if (path := file_of(written)) is not None:
            _add(found, path, f"a {kind}, a file of its own")
    return tuple(found)


def _command(command: str) -> InputFile:
    meaning = "the command that makes this report from its attachments"
    return InputFile(name=COMMAND, text=f"{command}\n", meaning=meaning)


def _add(found: list[InputFile], path: Path, meaning: str) -> None:
    """Add a file that was loaded before, once."""
    made = InputFile(name=path.name, text=path.read_text(encoding="utf-8-sig"), meaning=meaning)
    same = next((each for each in found if each.name.casefold() == made.name.casefold()), None)
    if same is None:
        found.append(made)
    elif (same.name, same.text) != (made.name, made.text):
        raise UserError(
            f"{path} has the name of another file that the report is made from, and other content; rename it, "
            "because all are attached side by side"
        )
