"""``wspd new``: the wizard of designs, and those of vehicles and rails below it."""

from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer

from wspd_design.cli import options
from wspd_design.cli.commands.new_rail import rail
from wspd_design.cli.commands.new_vehicle import vehicle
from wspd_design.cli.console import console, progress
from wspd_design.cli.gains import show_design
from wspd_design.cli.output import check_output
from wspd_design.cli.wizard.asked_design import requirements_of, vehicle_and_rail, wanted
from wspd_design.cli.wizard.design_steps import design_steps
from wspd_design.cli.wizard.draft import ENDING
from wspd_design.cli.wizard.session import again, answered, given_answers, print_answers, target_of
from wspd_design.cli.wizard.steps import Answers
from wspd_design.design.file import seen_from, write_design
from wspd_design.design.stop_requirements import PAPER
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
    answers_file: options.AnswersOption = None,
    pairs: Annotated[
        list[str] | None,
        typer.Option(
            "--set",
            metavar="KEY=VALUE",
            help="One answer by its key, such as slip=10%; repeat it for several.",
            show_default=False,
            rich_help_panel="Answers, in place of questions",
        ),
    ] = None,
    show_answers: options.PrintAnswersOption = False,
    yes: Annotated[
        bool, typer.Option("--yes", help="Ask nothing, and take what is suggested for the rest.")
    ] = False,
    resume: Annotated[
        Path | None,
        typer.Option("--resume", metavar="FILE", help=f"Go on with the answers of a {ENDING} file."),
    ] = None,
    force: options.ForceOption = False,
) -> None:
    """Answer some questions and get a design file, or that of a vehicle or a rail; every default is explained."""
    if context.invoked_subcommand is None:
        design(
            output=output,
            answers_file=answers_file,
            pairs=pairs,
            show_answers=show_answers,
            yes=yes,
            resume=resume,
            force=force,
        )
    elif output or answers_file or pairs or show_answers or yes or resume or force:
        raise UserError(
            f"options of a command stand behind it; write wspd new {context.invoked_subcommand} --help"
        )


def design(
    *,
    output: Path | None = None,
    answers_file: Path | None = None,
    pairs: list[str] | None = None,
    show_answers: bool = False,
    yes: bool = False,
    resume: Path | None = None,
    force: bool = False,
) -> None:
    """Ask for a design and write it."""
    questions = design_steps()
    given = given_answers(questions, answers_file, pairs)
    if show_answers:
        print_answers(questions, given, "wspd new")
        return
    target = target_of(output, resume, options.DESIGN_FILE, remedy="give the name of the design file with -o")
    check_output(target, force=force)
    answers, _ = answered(
        questions,
        given,
        target=target,
        resume=resume,
        yes=yes,
        command="wspd new",
        remedy='take what is suggested with "wspd new --yes", or answer with --set KEY=VALUE or --answers FILE '
        '("wspd new --print-answers" shows one); see "wspd --help" for the commands that ask nothing',
    )
    _design(answers, target)
    if resume is not None:
        resume.unlink()
    if not yes:
        words = ["wspd", "new", *(() if output is None else ("-o", str(output)))]
        console().print(
            f"Again:    {again(questions, answers, words)}", style="dim", markup=False, soft_wrap=True
        )


def _design(answers: Answers, target: Path) -> None:
    from wspd_design.design import selection

    vehicle_name, rail_name = vehicle_and_rail(answers)
    vehicle, rail = load_vehicle(vehicle_name), load_rail(rail_name)
    with progress() as tell:
        tell("choosing the gains")
        made = selection.design_controller(vehicle, rail, wanted(answers), law=answers["law"])
    judged_by = requirements_of(answers)
    made = replace(
        made,
        vehicle_file=seen_from(target, vehicle_name),
        rail_file=seen_from(target, rail_name),
        judged_by="" if judged_by == PAPER else seen_from(target, judged_by) or judged_by,
    )
    write_design(made, target)
    show_design(made, target, vehicle, rail, on_one_screen=True)


COMMANDS = {"vehicle": vehicle, "rail": rail}
"""What ``wspd new`` makes besides designs, with one command each."""
