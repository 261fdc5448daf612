"""The way through the questions: forward, back, and again."""

from collections.abc import Callable, Sequence
from enum import Enum, auto
from typing import TypeAlias

from wspd_design.cli.wizard.steps import AGAIN, Answers, Step, accept
from wspd_design.parameters.errors import UserError


class Back(Enum):
    """What asking returns in place of an answer when the user wants the question before."""

    BACK = auto()


Ask: TypeAlias = Callable[[Step, Answers, str], str | Back]
"""Ask one question, given the answers so far and the suggestion; returns an answer that the step accepts."""


def walk(steps: Sequence[Step], answers: dict[str, str], ask: Ask) -> dict[str, str]:
    """Ask all questions that apply, from the first one without a valid answer.

    Parameters
    ----------
    steps : sequence of Step
        All questions; which of them apply is decided again after each answer. The last one is the review.
    answers : dict
        Answers known before. It is filled on the way, so that a caller who is interrupted still has them.
    ask : callable
        How to ask.

    Returns
    -------
    dict
        The same answers, of all questions that apply but the review.
    """
    index = _first_open(steps, answers)
    visited = [i for i in range(index) if steps[i].applies(answers)]
    while index < len(steps):
        step = steps[index]
        if not step.applies(answers):
            answers.pop(step.key, None)
            index += 1
            continue
        answer = ask(step, answers, step.suggestion(answers))
        if isinstance(answer, Back):
            index = visited.pop() if visited else index
        elif step is steps[-1]:
            if answer != AGAIN:
                break
            index, visited = 0, []
        else:
            answers[step.key] = answer
            visited.append(index)
            index += 1
    return answers


def complete(steps: Sequence[Step], answers: Answers) -> dict[str, str]:
    """Return the answers with defaults for all other questions that apply.

    Raises
    ------
    UserError
        If one of the answers is not acceptable.
    """
    made: dict[str, str] = {}
    for step in steps[:-1]:
        if step.applies(made):
            made[step.key] = answers.get(step.key) or step.suggestion(made)
            accept(step, made[step.key], made)
    return made


def _first_open(steps: Sequence[Step], answers: Answers) -> int:
    for index, step in enumerate(steps[:-1]):
        if step.applies(answers) and not _is_valid(step, answers):
            return index
    return len(steps) - 1


def _is_valid(step: Step, answers: Answers) -> bool:
    if step.key not in answers:
        return False
    try:
        accept(step, answers[step.key], answers)
    except UserError:
        return False
    return True
