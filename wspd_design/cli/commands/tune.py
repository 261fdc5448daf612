"""``wspd tune``: the numbers of any law by the same search as a design."""

from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer

from wspd_design.cli import options
from wspd_design.cli.console import progress
from wspd_design.cli.output import check_output, write_text
from wspd_design.cli.searching import SPECIFICATIONS, search_and_write, search_design
from wspd_design.controllers.family import tunable_family, with_numbers
from wspd_design.design.industry import TUNED, named_with
from wspd_design.design.own_controller import is_own_controller
from wspd_design.design.selection import shipped_design
from wspd_design.design.specification_file import Task, read_task
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import load_rail, load_vehicle

_SPECIFICATION = "er24pc-20ms"
_LAWS = ", ".join(family.name for family in with_numbers())


def tune(
    law: Annotated[str, typer.Argument(metavar="LAW", help=f"{_LAWS} or FILE.py:NAME.")],
    wanted: Annotated[
        str, typer.Argument(metavar="SPEC", help=f"Stops and effort: {SPECIFICATIONS}.")
    ] = _SPECIFICATION,
    output: Annotated[
        Path | None,
        typer.Option(
            "--output",
            "-o",
            metavar="FILE",
            help="Design file to write, or Python file for a law of one's own. Default: LAW-SPEC-tuned.toml.",
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
    if is_own_controller(law):
        _tune_own(law, task, output, force=force)
        return
    family = tunable_family(law)
    task = replace(task, law=family.name)
    path = output or Path(f"{family.name}-{task.name}-tuned.toml")
    check_output(path, force=force)
    vehicle, rail = load_vehicle(task.vehicle), load_rail(task.design_rail)
    with progress() as tell:
        tell("choosing the numbers to start from")
        start = shipped_design(family.name, vehicle, rail, task.specification)
    search_design(task, start, _tuned(family.name, task), path, keep=False, force=force)


def _tune_own(law: str, task: Task, output: Path | None, *, force: bool) -> None:
    """Tune a law from a Python file; what comes out is a Python file beside it."""
    from wspd_design.design.own_tuning import own_space, tuned_source

    file = Path(law.rpartition(":")[0])
    path = output or file.with_name(f"{file.stem}_tuned.py")
    check_output(path, force=force)
    if path.resolve().parent != file.resolve().parent or path.suffix != ".py":
        raise UserError(
            f"{path} must be a .py file beside {file}, from which it imports; choose another name with -o"
        )
    vehicle, rail = load_vehicle(task.vehicle), load_rail(task.design_rail)
    space, own = own_space(law, task, vehicle, rail)
    name = _tuned(space.law, task)
    search_and_write(
        task,
        space,
        name,
        path,
        lambda found: write_text(path, tuned_source(law, name, own, found), force=True),
        keep=False,
        force=force,
        controller=f"{path}:tuned",
    )


def _tuned(law: str, task: Task) -> str:
    return named_with(law, f"{TUNED}, {task.effort.evaluations} evaluations")
