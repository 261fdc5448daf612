"""``wspd new``: the wizard."""

import os
import shlex
from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer
from rich.text import Text

from wspd_design.cli import options
from wspd_design.cli.console import console, is_interactive, progress, spaced, table
from wspd_design.cli.exit_codes import INTERRUPTED
from wspd_design.cli.gains import show_design
from wspd_design.cli.output import check_output
from wspd_design.cli.wizard.draft import ENDING, draft_path, read_draft, write_draft
from wspd_design.cli.wizard.flow import Ask, Back, complete, walk
from wspd_design.cli.wizard.steps import SAVE, Answers, Step, steps, vehicle_and_rail, wanted
from wspd_design.design.file import seen_from, write_design
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import load_rail, load_vehicle


def new(
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
    """Answer some questions and get a design file; every default is explained."""
    questions = steps()
    target = output or _target_of(resume)
    check_output(target, force=force)
    answers = {} if resume is None else read_draft(resume, questions)
    if yes:
        answers = complete(questions, answers)
    else:
        _interview(questions, answers, target)
    _design(answers, target)
    if resume is not None:
        resume.unlink()


def _target_of(resume: Path | None) -> Path:
    if resume is None:
        return Path(options.DESIGN_FILE)
    if resume.suffix != ENDING:
        raise UserError(f"{resume} does not end in {ENDING}; give the name of the design file with -o")
    return resume.with_suffix("")


def _interview(questions: tuple[Step, ...], answers: dict[str, str], target: Path) -> None:
    """Ask, and keep the answers when the user leaves."""
    if not is_interactive():
        raise UserError(
            'the wizard needs a terminal; start it in one, take all defaults with "wspd new --yes", '
            'or see "wspd --help" for the commands that ask nothing'
        )
    try:
        walk(questions, answers, _asking())
    except KeyboardInterrupt:
        kept = draft_path(target)
        write_draft(answers, kept)
        console().print(
            f"The answers are kept. Go on with:\nwspd new --resume {shlex.quote(str(kept))}",
            markup=False,
            soft_wrap=True,
        )
        raise typer.Exit(INTERRUPTED) from None


def _asking() -> Ask:
    """Return the way to ask that suits the terminal, with a line for each answer."""
    if os.environ.get("TERM", "") in ("dumb", "unknown"):
        from wspd_design.cli.wizard import plain

        asker: Ask = plain.ask
    else:
        from wspd_design.cli.wizard import widgets

        asker = widgets.ask

    def ask(step: Step, answers: Answers, suggestion: str) -> str | Back:
        out = console()
        if any(option.value == SAVE for option in step.options):
            _review(answers)
        answer = asker(step, answers, suggestion)
        if isinstance(answer, Back):
            out.print(f"< back from {step.title}", style="dim", markup=False)
        else:
            out.print(Text(f"{step.title}: ").append(answer, style="bold"))
        return answer

    return ask


def _review(answers: Answers) -> None:
    shown = table("Question", "Answer")
    for step in steps():
        if step.key in answers:
            shown.add_row(step.title, Text(answers[step.key]))
    console().print(spaced(shown))


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
