"""Answers in files and on the command line: kept when the wizard is left, given in place of questions, or shown."""

import json
import textwrap
from collections.abc import Sequence
from pathlib import Path

from wspd_design.cli.output import write_text
from wspd_design.cli.wizard.steps import Answers, Step
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.files import read_toml
from wspd_design.parameters.words import near_or_allowed

SCHEMA = "wspd-draft/1"
ENDING = ".part"


def draft_path(output: Path) -> Path:
    """Return where the answers for a design file are kept."""
    return output.with_name(output.name + ENDING)


def write_draft(answers: Answers, path: Path) -> None:
    """Keep the answers."""
    lines = [f'schema = "{SCHEMA}"', "", "[answers]"]
    lines += [f"{key} = {json.dumps(value, ensure_ascii=False)}" for key, value in answers.items()]
    write_text(path, "\n".join(lines) + "\n", force=True)


def read_draft(path: Path, steps: tuple[Step, ...]) -> dict[str, str]:
    """Read kept answers.

    Raises
    ------
    UserError
        If the file is missing or no draft, or a key in it is unknown.
    """
    document = read_toml(path, str(path))
    if document.get("schema") != SCHEMA or not isinstance(document.get("answers"), dict):
        raise UserError(f'{path} is not a draft of the wizard; start again with "wspd new"')
    for key, value in document["answers"].items():
        _check_key(key, steps, f" in {path}")
        if not isinstance(value, str):
            raise UserError(f"{key} = {value} in {path} must be text; put it in quotes")
    return dict(document["answers"])


def read_pairs(pairs: Sequence[str], steps: tuple[Step, ...]) -> dict[str, str]:
    """Read answers of the form ``key=value``.

    Raises
    ------
    UserError
        If one has another form, or its key is unknown or stands there twice.
    """
    found: dict[str, str] = {}
    for pair in pairs:
        key, equals, value = (part.strip() for part in pair.partition("="))
        if not equals or not value:
            example = f"{steps[0].key}={steps[0].default}"
            raise UserError(f'--set "{pair}" must be an answer with its key, such as --set {example}')
        _check_key(key, steps, "")
        if key in found:
            raise UserError(f"--set {key} stands there twice; leave one out")
        found[key] = value
    return found


def answers_text(steps: tuple[Step, ...], answers: Answers, command: str) -> str:
    """Return a file of answers with what each one means, to be changed and given back."""
    lines = [
        f"# Answers for {command} --answers FILE. What is left out is asked, or taken as suggested with --yes.",
        f'schema = "{SCHEMA}"',
        "",
        "[answers]",
    ]
    for step in steps[:-1]:
        if step.key in answers:
            said = " ".join((f"{step.title}.", step.explanation, *_allowed(step)))
            lines += textwrap.wrap(said, 100, initial_indent="# ", subsequent_indent="# ")
            lines += [f"{step.key} = {json.dumps(answers[step.key], ensure_ascii=False)}"]
    return "\n".join(lines) + "\n"


def _allowed(step: Step) -> tuple[str, ...]:
    return (f"One of {', '.join(option.value for option in step.options)}.",) if step.options else ()


def _check_key(key: str, steps: tuple[Step, ...], where: str) -> None:
    known = [step.key for step in steps[:-1]]
    if key not in known:
        raise UserError(f"unknown answer {key}{where}; {near_or_allowed(key, known)}")
