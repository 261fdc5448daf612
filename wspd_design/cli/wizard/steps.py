"""A question of a wizard as data: what is asked, why its default is so, what is accepted, and what matters about it."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TypeAlias

from wspd_design.parameters.errors import UserError
from wspd_design.parameters.units import Dimension, units_of

Answers: TypeAlias = Mapping[str, str]
"""What the user wrote, by the key of the step."""

SAVE = "save"
"""Answer to the review that ends the questions; the key of a step takes the user back to it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Option:
    """One line of a list."""

    value: str
    text: str
    label: str = ""  # what stands in place of the value

    @property
    def shown(self) -> str:
        """What stands at the start of the line."""
        return self.label or self.value


@dataclass(frozen=True, slots=True, kw_only=True)
class Step:
    """One question.

    With ``options`` it is a list to choose from, otherwise a line to write. ``check`` returns what the
    program understands, and raises :class:`UserError` for what it does not accept. ``suggest`` takes the place of the
    default where that follows from the answers before. ``note`` says what matters about an answer that is accepted;
    nothing where nothing does.
    """

    key: str
    title: str
    explanation: str
    default: str
    help: str = ""  # more words, for those who ask with ?
    check: Callable[[str, Answers], str] = lambda text, _answers: text
    options: tuple[Option, ...] = ()
    applies: Callable[[Answers], bool] = lambda _answers: True
    suggest: Callable[[Answers], str] | None = None
    note: Callable[[str, Answers], str] = lambda _text, _answers: ""
    dimension: Dimension | None = None  # of the quantity that is asked for
    files: str = ""  # ending of the files whose paths Tab completes

    def suggestion(self, answers: Answers) -> str:
        """Return the answer of the user who went through here before, or what the program suggests."""
        if self.key in answers:
            return answers[self.key]
        try:
            return self.default if self.suggest is None else self.suggest(answers)
        except UserError:  # an answer before no longer holds, such as that of a file that was removed
            return self.default

    def more(self) -> str:
        """Return what is said to a user who asks with ``?``."""
        allowed = f"One of {', '.join(option.value for option in self.options)}." if self.options else ""
        units = "" if self.dimension is None else f"Units: {', '.join(units_of(self.dimension))}."
        return " ".join(filter(None, (self.help, allowed, units, f"Key of the answer: {self.key}.")))


def review_step(explanation: str, saves: str) -> Step:
    """Return the last question, which saves or leads back to one of the others.

    Parameters
    ----------
    explanation : str
        What saving does.
    saves : str
        The same in the list.
    """
    return Step(
        key="review",
        title="Review",
        explanation=explanation,
        default=SAVE,
        options=(Option(value=SAVE, text=saves),),
        help="Choose a line to change its answer; what depends on it is asked again where it no longer fits.",
    )


def accept(step: Step, text: str, answers: Answers) -> str:
    """Return what the program understands of an answer; what it does not accept raises :class:`UserError`."""
    values = [option.value for option in step.options]
    if values and text not in values:
        raise UserError(f'{step.key} = "{text}" must be one of {", ".join(values)}')
    return step.check(text, answers)


def noted(step: Step, text: str, answers: Answers) -> str:
    """Return what matters about an answer; nothing about one that is not accepted."""
    try:
        accept(step, text, answers)
        return step.note(text, answers)
    except UserError:
        return ""
