"""Questions line by line, for terminals that cannot move the cursor (``TERM=dumb``)."""

from wspd_design.cli.console import console
from wspd_design.cli.wizard.flow import Back, Place
from wspd_design.cli.wizard.steps import Answers, Step, accept, noted
from wspd_design.parameters.errors import UserError

BACK, HELP = "<", "?"


def ask(step: Step, answers: Answers, suggestion: str, place: Place) -> str | Back:
    """Ask one question by printing it and reading a line; an empty one takes the suggestion.

    Raises
    ------
    KeyboardInterrupt
        On Ctrl-C, or when the input ends.
    """
    out = console()
    out.print(f"\n{step.title} ({place.number} of {place.of})\n{step.explanation}", markup=False)
    for number, option in enumerate(step.options, start=1):
        out.print(f"  {number}  {option.shown}: {option.text}", markup=False)
    while True:
        try:
            text = input(f"[{suggestion}] ({BACK} goes back, {HELP} helps) > ").strip() or suggestion
        except (EOFError, KeyboardInterrupt):
            out.print()  # leave the line of the prompt
            raise KeyboardInterrupt from None
        if text == BACK:
            return Back.BACK
        if text == HELP:
            out.print(step.more(), markup=False)
            continue
        if text.isdigit() and 1 <= int(text) <= len(step.options):
            text = step.options[int(text) - 1].value
        try:
            understood = accept(step, text, answers)
        except UserError as error:
            out.print(str(error), markup=False)
            continue
        if understood != text:
            out.print(f"= {understood}", markup=False)
        note = noted(step, text, answers)
        if note:
            out.print(f"! {note}", markup=False)
        return text
