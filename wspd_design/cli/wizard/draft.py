"""Answers that were kept when the wizard was left before its end."""

import json
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
    known = [step.key for step in steps]
    for key, value in document["answers"].items():
        if key not in known:
            raise UserError(f"unknown answer {key} in {path}; {near_or_allowed(key, known)}")
        if not isinstance(value, str):
            raise UserError(f"{key} = {value} in {path} must be text; put it in quotes")
    return dict(document["answers"])
