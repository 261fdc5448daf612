"""One run of a wizard: its questions on a terminal, the answers that are kept, and the review."""

import os
import shlex
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import typer
from rich.text import Text

from wspd_design.cli.console import console, is_interactive
from wspd_design.cli.exit_codes import INTERRUPTED
from wspd_design.cli.output import check_output
from wspd_design.cli.wizard.draft import (
    ENDING,
    answers_text,
    draft_path,
    read_draft,
    read_pairs,
    write_draft,
)
from wspd_design.cli.wizard.flow import Ask, Back, Place, complete, walk
from wspd_design.cli.wizard.steps import Answers, Option, Step, accept, noted
from wspd_design.parameters.errors import UserError


def answer_option(flag: str, metavar: str, meaning: str) -> Any:
    """Describe an option that answers a question."""
    return typer.Option(
        flag,
        metavar=metavar,
        help=meaning,
        show_default=False,
        rich_help_panel="Answers, in place of questions",
    )


def given_answers(
    questions: tuple[Step, ...], file: Path | None, pairs: Sequence[str] | None
) -> dict[str, str]:
    """Return the answers of a file and those of ``--set``, which count more."""
    return {**({} if file is None else read_draft(file, questions)), **read_pairs(pairs or (), questions)}


def print_answers(questions: tuple[Step, ...], given: Answers, command: str) -> None:
    """Print a file of answers, with suggestions for all that are not given."""
    print(answers_text(questions, complete(questions, given), command), end="")


def again(questions: Sequence[Step], answers: Answers, command: Sequence[str]) -> str:
    """Return the command that gives the same answers without questions: what differs from the suggestions."""
    made: dict[str, str] = {}
    words = [*command, "--yes"]
    for step in questions[:-1]:
        if step.key in answers:
            if answers[step.key] != step.suggestion(made):
                words += ["--set", f"{step.key}={answers[step.key]}"]
            made[step.key] = answers[step.key]
    return shlex.join(words)


def answered(
    questions: tuple[Step, ...],
    given: Answers,
    *,
    target: Path,
    resume: Path | None,
    yes: bool,
    command: str,
    remedy: str,
) -> tuple[dict[str, str], frozenset[str]]:
    """Return an answer to each question that applies, and the questions that the user answered.

    Parameters
    ----------
    questions : sequence of Step
        All questions, the review last.
    given : mapping
        Answers that the command line brought; where they answer all, nothing is asked.
    target : Path
        File that the answers lead to; when the user leaves, they are kept beside it.
    resume : Path or None
        File of answers that were kept.
    yes : bool
        Whether the suggestions answer what is left, which the user then did not.
    command : str
        The command line that goes on, such as ``wspd new vehicle``.
    remedy : str
        What to do without a terminal.
    """
    kept = {} if resume is None else read_draft(resume, questions)
    _check_given(questions, given)
    answers = {**kept, **given}
    left = _open_questions(questions, answers)
    if yes or (given and not left):
        return complete(questions, answers), frozenset(answers)
    if not is_interactive():
        raise UserError(
            f"the wizard needs a terminal to ask for {', '.join(left) or 'its review'}; start it in one, {remedy}"
        )
    try:
        walk(questions, answers, _asking(questions))
    except KeyboardInterrupt:
        draft = draft_path(target)
        write_draft(answers, draft)
        console().print(
            f"The answers are kept. Go on with:\n{command} --resume {shlex.quote(str(draft))}",
            markup=False,
            soft_wrap=True,
        )
        raise typer.Exit(INTERRUPTED) from None
    return answers, frozenset(answers)


def answered_for_file(
    kind: str,
    questions: tuple[Step, ...],
    given: Mapping[str, str | None],
    *,
    output: Path | None,
    default: str,
    resume: Path | None,
    file: Path | None,
    yes: bool,
    force: bool,
    by_default: str,
) -> tuple[Path, dict[str, str], frozenset[str]]:
    """Return a parameter file to write, the answers for it, and the questions that the user answered.

    The file is that of a vehicle or a rail, and may be written. Of what the command line may give, None is no answer,
    and the rest counts more than a ``file`` of answers; ``by_default`` says what ``--yes`` does with what is left, such
    as "the kind answers".
    """
    target = target_of(output, resume, default, remedy=f"give the name of the {kind} file, too")
    if target.suffix != ".toml":
        raise UserError(f"{kind} file {target} must end in .toml")
    check_output(target, force=force)
    answers, said = answered(
        questions,
        {
            **given_answers(questions, file, None),
            **{key: answer for key, answer in given.items() if answer is not None},
        },
        target=target,
        resume=resume,
        yes=yes,
        command=f"wspd new {kind}",
        remedy=f"give all answers as options, or add --yes and {by_default} what is left",
    )
    return target, answers, said


def target_of(output: Path | None, resume: Path | None, default: str, *, remedy: str) -> Path:
    """Return the file that the answers lead to; ``remedy`` says how to name it."""
    if output is not None or resume is None:
        return output or Path(default)
    if resume.suffix != ENDING:
        raise UserError(f"{resume} does not end in {ENDING}; {remedy}")
    return resume.with_suffix("")


def _open_questions(questions: Sequence[Step], answers: Answers) -> list[str]:
    return [step.key for step in questions[:-1] if step.applies(answers) and step.key not in answers]


def _check_given(questions: Sequence[Step], given: Answers) -> None:
    """Refuse a wrong answer of the command line before the first question."""
    made: dict[str, str] = {}
    for step in questions[:-1]:
        if step.key in given:
            accept(step, given[step.key], made)
            made[step.key] = given[step.key]


def _asking(questions: Sequence[Step]) -> Ask:
    """Return the way to ask that suits the terminal, with a line for each answer."""
    if os.environ.get("TERM", "") in ("dumb", "unknown"):
        from wspd_design.cli.wizard import plain

        asker: Ask = plain.ask
    else:
        from wspd_design.cli.wizard import widgets

        asker = widgets.ask

    def ask(step: Step, answers: Answers, suggestion: str, place: Place) -> str | Back:
        out = console()
        review = step is questions[-1]
        if review:
            step = reviewing(questions, answers)
        answer = asker(step, answers, suggestion, place)
        if isinstance(answer, Back):
            out.print(f"< back from {step.title}", style="dim", markup=False)
        elif not review:
            out.print(Text(f"{step.title}: ").append(answer, style="bold"))
        return answer

    return ask


def reviewing(questions: Sequence[Step], answers: Answers) -> Step:
    """Return the review with a line for each answer, which leads back to its question."""
    asked = {step.key: step for step in questions[:-1] if step.key in answers}
    lines = (Option(value=key, text=answers[key], label=step.title) for key, step in asked.items())
    return replace(
        questions[-1],
        options=(*questions[-1].options, *lines),
        note=lambda key, answers: noted(asked[key], answers[key], answers) if key in asked else "",
    )
