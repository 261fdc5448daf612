"""``wspd tune``: the numbers of any law by the same search as a design."""

from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer

from wspd_design.cli import options
from wspd_design.cli.console import progress
from wspd_design.cli.output import check_output
from wspd_design.cli.searching import SPECIFICATIONS, search_and_write
from wspd_design.controllers.family import tunable_family, with_numbers
from wspd_design.design.selection import shipped_design
from wspd_design.design.specification_file import read_task
from wspd_design.parameters.loading import load_rail, load_vehicle

_SPECIFICATION = "er24pc-20ms"
_LAWS = ", ".join(family.name for family in with_numbers())


def tune(
    law: Annotated[str, typer.Argument(metavar="LAW", help=f"{_LAWS}.")],
    wanted: Annotated[
        str, typer.Argument(metavar="SPEC", help=f"Stops and effort: {SPECIFICATIONS}.")
    ] = _SPECIFICATION,
    output: Annotated[
        Path | None,
        typer.Option(
            "--output",
            "-o",
            metavar="FILE",
            help="Design file to write. Default: LAW-SPEC-tuned.toml.",
            show_default=False,
        ),
    ] = None,
    force: options.ForceOption = False,
) -> None:
    """Tune the numbers of any law with the stops and the effort of a specification, for fair comparisons.

    The distance alone counts: the limits of the specification are told, not kept. Tables are tuned by factors on their
    limits and pulses. The file that comes out is a controller for every other command, and its name says the effort.
    """
    task = read_task(wanted)
    family = tunable_family(law)
    task = replace(task, law=family.name)
    path = output or Path(f"{family.name}-{task.name}-tuned.toml")
    check_output(path, force=force)
    vehicle, rail = load_vehicle(task.vehicle), load_rail(task.design_rail)
    with progress() as tell:
        tell("choosing the numbers to start from")
        start = shipped_design(family.name, vehicle, rail, task.specification)
    name = f"{family.name} (tuned, {task.effort.evaluations} evaluations)"
    search_and_write(task, start, name, path, limits=(), force=force)
