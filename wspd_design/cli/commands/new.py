"""``wspd new``: the wizard of designs, and those of vehicles and rails below it."""

from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer

from wspd_design.cli import options
from wspd_design.cli.commands.new_rail import rail
from wspd_design.cli.commands.new_vehicle import vehicle
from wspd_design.cli.console import progress
from wspd_design.cli.gains import show_design
from wspd_design.cli.output import check_output
from wspd_design.cli.wizard.draft import ENDING
from wspd_design.cli.wizard.session import answered, target_of
from wspd_design.cli.wizard.steps import Answers, steps, vehicle_and_rail, wanted
from wspd_design.design.file import seen_from, write_design
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import load_rail, load_vehicle


def new(
    context: typer.Context,
    output: Annotated[
        Path | None,
        typer.Option(
            "--output",
            "-o",
            metavar="FILE",
            help=f"Design file to write. Default: {options.DESIGN_FILE}.",
            show_default=False,
        ),
    ] = None,
    yes: Annotated[bool, typer.Option("--yes", help="Ask nothing and take all defaults.")] = False,
    resume: Annotated[
        Path | None,
        typer.Option("--resume", metavar="FILE", help=f"Go on with the answers of a {ENDING} file."),
    ] = None,
    force: options.ForceOption = False,
) -> None:
    """Answer some questions and get a design file, or that of a vehicle or a rail; every default is explained."""
    if context.invoked_subcommand is None:
        design(output=output, yes=yes, resume=resume, force=force)
    elif output or yes or resume or force:
        raise UserError(
            f"options of a command stand behind it; write wspd new {context.invoked_subcommand} --help"
        )


def design(
    *, output: Path | None = None, yes: bool = False, resume: Path | None = None, force: bool = False
) -> None:
    """Ask for a design and write it."""
    target = target_of(output, resume, options.DESIGN_FILE, remedy="give the name of the design file with -o")
    check_output(target, force=force)
    answers, _ = answered(
        steps(),
        {},
        target=target,
        resume=resume,
        yes=yes,
        command="wspd new",
        remedy='take all defaults with "wspd new --yes", or see "wspd --help" for the commands that ask nothing',
    )
    _design(answers, target)
    if resume is not None:
        resume.unlink()


def _design(answers: Answers, target: Path) -> None:
    from wspd_design.design import selection

    vehicle_name, rail_name = vehicle_and_rail(answers)
    vehicle, rail = load_vehicle(vehicle_name), load_rail(rail_name)
    with progress() as tell:
        tell("choosing the gains")
        made = selection.design_controller(vehicle, rail, wanted(answers), law=answers["law"])
    made = replace(made, vehicle_file=seen_from(target, vehicle_name), rail_file=seen_from(target, rail_name))
    write_design(made, target)
    show_design(made, target, vehicle, rail)


COMMANDS = {"vehicle": vehicle, "rail": rail}
"""What ``wspd new`` makes besides designs, with one command each."""
