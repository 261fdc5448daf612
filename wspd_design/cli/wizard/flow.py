"""The way through the questions: forward, back, and from the review to any of them."""

from collections.abc import Callable, Sequence
from enum import Enum, auto
from typing import NamedTuple, TypeAlias

from wspd_design.cli.wizard.steps import SAVE, Answers, Step, accept
from wspd_design.parameters.errors import UserError


class Back(Enum):
    """What asking returns in place of an answer when the user wants the question before."""

    BACK = auto()


class Place(NamedTuple):
    """Where a question stands among those that apply so far."""

    number: int  # from 1 on
    of: int


Ask: TypeAlias = Callable[[Step, Answers, str, Place], str | Back]
"""Ask one question, given the answers so far, the suggestion and its place; returns an answer that the step accepts."""


def walk(steps: Sequence[Step], answers: dict[str, str], ask: Ask) -> dict[str, str]:
    """Ask all questions that apply, from the first one without a valid answer.

    Parameters
    ----------
    steps : sequence of Step
        All questions; which of them apply is decided again after each answer. The last one is the review, whose answer
        may be the key of another one: that is asked once more, and after it what no longer fits.
    answers : dict
        Answers known before, which are not asked for where they are valid. It is filled on the way, so that a caller
        who is interrupted still has them.
    ask : callable
        How to ask.

    Returns
    -------
    dict
        The same answers, of all questions that apply but the review.
    """
    keys, last = [step.key for step in steps], len(steps) - 1
    index = first_open(steps, answers)
    visited = [i for i in range(index) if steps[i].applies(answers)]
    given, reviewed = set(answers), False
    while True:
        step = steps[index]
        answer = ask(step, answers, step.suggestion(answers), place(steps, answers, index))
        if isinstance(answer, Back):
            index = visited.pop() if visited else index
            given.discard(keys[index])
            continue
        if index == last:
            if answer == SAVE:
                return answers
            visited.append(index)
            index, reviewed = keys.index(answer), True
            continue
        answers[step.key] = answer
        visited.append(index)
        _forget(steps, answers)
        rest = range(0 if reviewed else index + 1, last)
        index = next(
            (i for i in rest if _is_open(steps[i], answers, known=reviewed or keys[i] in given)), last
        )


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


def place(steps: Sequence[Step], answers: Answers, index: int) -> Place:
    """Return the place of a question among those that apply, if the suggestions answer what is open."""
    made: dict[str, str] = {}
    numbers = []
    for number, step in enumerate(steps):
        if step.applies(made):
            numbers.append(number)
            made[step.key] = answers.get(step.key, step.default)
    return Place(number=sum(number <= index for number in numbers), of=len(numbers))


def first_open(steps: Sequence[Step], answers: Answers) -> int:
    """Return the index of the first question without a valid answer, or that of the review."""
    return next(
        (index for index, step in enumerate(steps[:-1]) if _is_open(step, answers, known=True)),
        len(steps) - 1,
    )


def _is_open(step: Step, answers: Answers, *, known: bool) -> bool:
    """Whether a question is to be asked; of a ``known`` answer only if it is not valid."""
    return step.applies(answers) and not (known and _is_valid(step, answers))


def _forget(steps: Sequence[Step], answers: dict[str, str]) -> None:
    """Leave out answers to questions that no longer apply."""
    made: dict[str, str] = {}
    for step in steps[:-1]:
        if step.key in answers:
            if step.applies(made):
                made[step.key] = answers[step.key]
            else:
                del answers[step.key]


def _is_valid(step: Step, answers: Answers) -> bool:
    if step.key not in answers:
        return False
    try:
        accept(step, answers[step.key], answers)
    except UserError:
        return False
    return True
