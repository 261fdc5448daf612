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

from wspd_design.cli.path_completion import common_start, last_part, paths
from wspd_design.cli.wizard.flow import Back, Place
from wspd_design.cli.wizard.steps import Answers, Option, Step, accept, noted
from wspd_design.parameters.errors import UserError

_STYLE = Style.from_dict(
    {
        "title": "bold",
        "chosen": "bold ansicyan",
        "good": "ansigreen",
        "bad": "ansired",
        "note": "ansiyellow",
        "keys": "italic",
    }
)
_ESCAPE_DELAY = 0.1  # s, after which Esc is no longer taken for the start of a key sequence


def ask(step: Step, answers: Answers, suggestion: str, place: Place) -> str | Back:
    """Ask one question in the terminal.

    Raises
    ------
    KeyboardInterrupt
        On Ctrl-C or Ctrl-D.
    """
    return (
        _choose(step, answers, suggestion, place) if step.options else _edit(step, answers, suggestion, place)
    )


class _Frame:
    """What stands around a question: its head, what matters about the answer, and the keys."""

    def __init__(self, step: Step, answers: Answers, place: Place, hint: str) -> None:
        self._step, self._answers, self._place, self._hint = step, answers, place, hint
        self.helping = False

    def head(self) -> StyleAndTextTuples:
        """Title, place, and explanation or help."""
        style, said = ("class:keys", self._step.more()) if self.helping else ("", self._step.explanation)
        title = ("class:title", self._step.title)
        return [title, ("", f"  {self._place.number} of {self._place.of}"), (style, f"\n{_wrapped(said)}")]

    def note(self, text: str) -> StyleAndTextTuples:
        """What matters about an answer, on lines of its own; help takes its room."""
        said = "" if self.helping else noted(self._step, text, self._answers)
        return [("class:note", "\n" + _wrapped(f"! {said}", rest="  "))] if said else []

    def foot(self) -> StyleAndTextTuples:
        """The keys."""
        keys = f"{self._hint}, Ctrl-B or Esc goes back, ? helps, Ctrl-C leaves and keeps the answers."
        return [("class:keys", _wrapped(keys))]

    def room(self, text: str) -> int:
        """Lines of the terminal that are left between head, note and keys."""
        around = [*self.head(), *self.note(text), ("", "\n"), *self.foot()]
        return get_app().output.get_size().rows - sum(part[1].count("\n") for part in around) - 1


def _edit(step: Step, answers: Answers, suggestion: str, place: Place) -> str | Back:
    """A line with, below it, what the program understands or what is wrong."""
    frame = _Frame(
        step, answers, place, "Tab completes a path, Enter accepts" if step.files else "Enter accepts"
    )
    buffer = Buffer(document=Document(suggestion, cursor_position=len(suggestion)), multiline=False)
    offered: list[str] = []  # paths that Tab has found

    def verdict() -> tuple[bool, str]:
        try:
            return True, accept(step, buffer.text.strip(), answers)
        except UserError as error:
            return False, str(error)

    def preview() -> StyleAndTextTuples:
        if offered:
            return [("class:keys", _wrapped("  ".join(map(last_part, offered))))]
        good, text = verdict()
        if not good:
            return [("class:bad", _wrapped(text))]
        return [("class:good", _wrapped(f"= {text}")), *frame.note(buffer.text.strip())]

    keys = _common_keys(frame)

    @keys.add("enter")
    def _(event: KeyPressEvent) -> None:
        if verdict()[0]:
            event.app.exit(result=buffer.text.strip())

    if step.files:

        @keys.add("tab")
        def _(_event: KeyPressEvent) -> None:
            found = paths(buffer.text, step.files)
            if found:
                completed = common_start(found)
                buffer.document = Document(completed, cursor_position=len(completed))
                offered[:] = found if len(found) > 1 else []

    buffer.on_text_changed += lambda _: offered.clear()
    line = VSplit([Window(FormattedTextControl("> "), width=2), Window(BufferControl(buffer), height=1)])
    return _run(frame, [line, _text(preview)], keys, focus=buffer)


def _choose(step: Step, answers: Answers, suggestion: str, place: Place) -> str | Back:
    """A list whose chosen line is moved by the arrow keys."""
    frame = _Frame(step, answers, place, "Up and down choose, Enter accepts")
    values = [option.value for option in step.options]
    chosen = values.index(suggestion) if suggestion in values else 0
    width = max(len(option.shown) for option in step.options)

    def lines() -> StyleAndTextTuples:
        texts = [_item(option, width, index == chosen) for index, option in enumerate(step.options)]
        if sum(text.count("\n") + 1 for text in texts) > frame.room(values[chosen]):
            texts = [_cut(text) for text in texts]
        styles = ["class:chosen" if index == chosen else "" for index in range(len(texts))]
        shown = [(style, text + "\n") for style, text in zip(styles, texts, strict=True)]
        shown[-1] = (styles[-1], texts[-1])
        return [*shown, *frame.note(values[chosen])]

    keys = _common_keys(frame)

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

    return _run(frame, [_text(lines)], keys)


def _item(option: Option, width: int, chosen: bool) -> str:
    mark = "> " if chosen else "  "
    return _wrapped(f"{option.shown:<{width}}  {option.text}", mark, " " * (width + 4))


def _cut(text: str) -> str:
    """Leave one line of a text, for a terminal that is too low for all of it."""
    first, more, _ = text.partition("\n")
    columns = get_app().output.get_size().columns
    return f"{first[: columns - 5].rstrip()} ..." if more else first


def _common_keys(frame: _Frame) -> KeyBindings:
    keys = KeyBindings()

    @keys.add("?")
    def _(_event: KeyPressEvent) -> None:
        frame.helping = not frame.helping

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
    frame: _Frame, content: list[Window | VSplit], keys: KeyBindings, focus: Buffer | None = None
) -> str | Back:
    application: Application[str | Back] = Application(
        layout=Layout(HSplit([_text(frame.head), *content, _text(frame.foot)]), focused_element=focus),
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
