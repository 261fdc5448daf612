"""Line editor and list for one question, drawn below the last line of the terminal."""

import textwrap
from collections.abc import Callable

from prompt_toolkit.application import Application, get_app
from prompt_toolkit.buffer import Buffer
from prompt_toolkit.document import Document
from prompt_toolkit.formatted_text import StyleAndTextTuples
from prompt_toolkit.key_binding import KeyBindings, KeyPressEvent
from prompt_toolkit.layout import BufferControl, FormattedTextControl, HSplit, Layout, VSplit, Window
from prompt_toolkit.styles import Style

from wspd_design.cli.wizard.flow import Back
from wspd_design.cli.wizard.steps import Answers, Step, accept
from wspd_design.parameters.errors import UserError

_STYLE = Style.from_dict(
    {"title": "bold", "chosen": "bold ansicyan", "good": "ansigreen", "bad": "ansired", "keys": "italic"}
)
_ESCAPE_DELAY = 0.1  # s, after which Esc is no longer taken for the start of a key sequence


def ask(step: Step, answers: Answers, suggestion: str) -> str | Back:
    """Ask one question in the terminal.

    Raises
    ------
    KeyboardInterrupt
        On Ctrl-C or Ctrl-D.
    """
    return _choose(step, suggestion) if step.options else _edit(step, answers, suggestion)


def _edit(step: Step, answers: Answers, suggestion: str) -> str | Back:
    """A line with, below it, what the program understands or what is wrong."""
    buffer = Buffer(document=Document(suggestion), multiline=False)

    def verdict() -> tuple[bool, str]:
        try:
            return True, accept(step, buffer.text.strip(), answers)
        except UserError as error:
            return False, str(error)

    def preview() -> StyleAndTextTuples:
        good, text = verdict()
        return [("class:good", _wrapped(f"= {text}"))] if good else [("class:bad", _wrapped(text))]

    keys = _common_keys()

    @keys.add("enter")
    def _(event: KeyPressEvent) -> None:
        if verdict()[0]:
            event.app.exit(result=buffer.text.strip())

    line = VSplit([Window(FormattedTextControl("> "), width=2), Window(BufferControl(buffer), height=1)])
    return _run(step, [line, _text(preview)], keys, "Enter accepts", focus=buffer)


def _choose(step: Step, suggestion: str) -> str | Back:
    """A list whose chosen line is moved by the arrow keys."""
    values = [option.value for option in step.options]
    chosen = values.index(suggestion) if suggestion in values else 0
    width = max(map(len, values))

    def lines() -> StyleAndTextTuples:
        shown: StyleAndTextTuples = []
        for index, option in enumerate(step.options):
            mark, style = ("> ", "class:chosen") if index == chosen else ("  ", "")
            text = _wrapped(f"{option.value:<{width}}  {option.text}", mark, " " * (width + 4))
            shown.append((style, text + ("\n" if index + 1 < len(values) else "")))
        return shown

    keys = _common_keys()

    def move(step_size: int) -> Callable[[KeyPressEvent], None]:
        def handler(_event: KeyPressEvent) -> None:
            nonlocal chosen
            chosen = (chosen + step_size) % len(values)

        return handler

    for key, step_size in (("up", -1), ("down", 1), ("s-tab", -1), ("tab", 1)):
        keys.add(key)(move(step_size))

    @keys.add("enter")
    def _(event: KeyPressEvent) -> None:
        event.app.exit(result=values[chosen])

    return _run(step, [_text(lines)], keys, "Up and down choose, Enter accepts")


def _common_keys() -> KeyBindings:
    keys = KeyBindings()

    @keys.add("c-b")
    @keys.add("escape", eager=True)
    def _(event: KeyPressEvent) -> None:
        event.app.exit(result=Back.BACK)

    @keys.add("c-c")
    @keys.add("c-d")
    @keys.add("<sigint>")
    def _(event: KeyPressEvent) -> None:
        event.app.exit(exception=KeyboardInterrupt)

    return keys


def _run(
    step: Step, content: list[Window | VSplit], keys: KeyBindings, hint: str, focus: Buffer | None = None
) -> str | Back:
    def head() -> StyleAndTextTuples:
        return [("class:title", step.title), ("", f"\n{_wrapped(step.explanation)}")]

    def foot() -> StyleAndTextTuples:
        keys_text = f"{hint}, Ctrl-B or Esc goes back, Ctrl-C leaves and keeps the answers."
        return [("class:keys", _wrapped(keys_text))]

    application: Application[str | Back] = Application(
        layout=Layout(HSplit([_text(head), *content, _text(foot)]), focused_element=focus),
        key_bindings=keys,
        style=_STYLE,
        erase_when_done=True,
    )
    application.ttimeoutlen = _ESCAPE_DELAY
    try:
        return application.run()
    except EOFError:
        raise KeyboardInterrupt from None  # nobody is there any more


def _text(content: Callable[[], StyleAndTextTuples]) -> Window:
    return Window(FormattedTextControl(content), dont_extend_height=True)


def _wrapped(text: str, first: str = "", rest: str = "") -> str:
    """Break lines between words, which the windows of prompt_toolkit do not."""
    columns = get_app().output.get_size().columns
    return textwrap.fill(text, max(columns - 1, 20), initial_indent=first, subsequent_indent=rest)
