"""Inline text of a report: plain strings are literal, light markup is parsed once for both renderings.

A ``str`` in a block is always shown as it stands, whatever it contains: names of files, vehicles and users
need no escaping. Emphasis, code, mathematics and links come from :func:`rich`.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias


@dataclass(frozen=True, slots=True, kw_only=True)
class Emphasis:
    """Stressed words, set in italics."""

    text: str


@dataclass(frozen=True, slots=True, kw_only=True)
class CodeSpan:
    """A command, a file name or a key, set in a fixed-width face."""

    text: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Math:
    """A formula inside a line, in Typst's math syntax, and how to read it aloud."""

    source: str
    spoken: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Link:
    """A reference to an anchor of the same document; without text, the label of its target is shown."""

    anchor: str
    text: str = ""


Inline: TypeAlias = str | Emphasis | CodeSpan | Math | Link
Text: TypeAlias = str | tuple[Inline, ...]

_MARKUP = re.compile(
    r"\\(?P<literal>[\\*`$\[\]])"
    r"|\*(?P<emphasis>[^*\s](?:[^*]*[^*\s])?)\*"
    r"|`(?P<code>[^`]+)`"
    r"|\$(?P<math>[^$]+)\$"
    r"|\[(?P<label>[^\[\]]*)\]\(#(?P<anchor>[a-z][a-z0-9-]*)\)"
)


def rich(markup: str) -> tuple[Inline, ...]:
    r"""Parse light markup: ``*emphasis*``, ```code```, ``$math$``, ``[text](#anchor)``, ``[](#anchor)``.

    A backslash makes the next special character literal. Text from outside goes through :func:`escape` first.
    """
    spans: list[Inline] = []
    position = 0
    for match in _MARKUP.finditer(markup):
        _append(spans, markup[position : match.start()])
        position = match.end()
        match match.lastgroup:
            case "literal":
                _append(spans, match["literal"])
            case "emphasis":
                spans.append(Emphasis(text=match["emphasis"]))
            case "code":
                spans.append(CodeSpan(text=match["code"]))
            case "math":
                spans.append(Math(source=match["math"], spoken=spoken(match["math"])))
            case _:
                spans.append(Link(anchor=match["anchor"], text=match["label"]))
    _append(spans, markup[position:])
    return tuple(spans)


def _append(spans: list[Inline], text: str) -> None:
    """Add literal text, joined with literal text before it."""
    if spans and isinstance(spans[-1], str):
        spans[-1] += text
    elif text:
        spans.append(text)


def references(anchors: Sequence[str]) -> tuple[Inline, ...]:
    """Refer to several anchors by their labels: ``Table 1, Table 2 and Figure 1``."""
    found: list[Inline] = []
    for place, anchor in enumerate(anchors):
        found += [] if place == 0 else [" and " if place == len(anchors) - 1 else ", "]
        found.append(Link(anchor=anchor))
    return tuple(found)


def escape(text: str) -> str:
    """Return markup that :func:`rich` shows as exactly this text."""
    return re.sub(r"([\\*`$\[\]])", r"\\\1", text)


def spans(text: Text) -> tuple[Inline, ...]:
    """Return the parts of a text, whichever of its two forms it has."""
    if isinstance(text, str):
        return (text,) if text else ()
    return text


def plain(text: Text) -> str:
    """Return the words of a text without markup, formulas as they are read aloud."""
    return "".join(_words(span) for span in spans(text))


def _words(span: Inline) -> str:
    match span:
        case str():
            return span
        case Math():
            return span.spoken
        case _:
            return span.text


_UNPRINTABLE = re.compile(r"[\x00-\x08\x0b-\x1f\x7f-\x9f\ud800-\udfff\ufffe\uffff]")
_TURNING = re.compile(r"[\u061c\u200e\u200f\u202a-\u202e\u2066-\u2069]")
_RIGHT_TO_LEFT = r"\u0590-\u08ff\ufb1d-\ufdff\ufe70-\ufefc"
_WORDS_FROM_THE_RIGHT = re.compile(rf"[{_RIGHT_TO_LEFT}]+(?: +[{_RIGHT_TO_LEFT}]+)*")


def printable(text: str) -> str:
    """Return the text as every reader shows it, whoever wrote it.

    Control characters, which neither HTML nor PDF can hold, are replaced. Characters that turn the direction of
    what follows are spelled by their code points: with them "evil" would be shown as "live". Words that are written
    from right to left are isolated, so that no number beside them changes its place.
    """
    text = _UNPRINTABLE.sub("\N{REPLACEMENT CHARACTER}", text)
    text = _TURNING.sub(lambda turning: f"[U+{ord(turning[0]):04X}]", text)
    return _WORDS_FROM_THE_RIGHT.sub("\N{FIRST STRONG ISOLATE}\\g<0>\N{POP DIRECTIONAL ISOLATE}", text)


_UNIT_BEHIND = re.compile(
    r"(?<=[\d∞]) (?=(?:km/h|m/s²|m/s|1/s|kN|MN|N|kg|bar|MPa|Pa|GPa|mm|ms|m|s|t|dB|Hz|rad/s|%)(?![\w]))"
    r"|(?<=[kM]N) (?=m\b)|(?<=\bN) (?=[ms]\b)|(?<=N m) (?=s\b)|(?<=kg) (?=m²)|(?<=\d) (?=±)|(?<=[±≤≥<]) (?=\d)"
)


def unbroken(text: str) -> str:
    """Keep numbers, their units and the signs of limits on one line."""
    return _UNIT_BEHIND.sub("\N{NO-BREAK SPACE}", text)


_SPOKEN = (
    (r'"', ""),
    (r"\b(dot|hat|tilde|overline)\(([^()]*)\)", r"\2 \1"),
    (r"\\/", " over "),
    (r"<=", " at most "),
    (r">=", " at least "),
    (r"\^\*", " star"),
    (r"\^2\b", " squared"),
    (r"\^", " to the power "),
    (r"/", " over "),
    (r"=", " equals "),
    (r"_", " "),
    (r"\s+", " "),
)


def spoken(source: str) -> str:
    """Return a plain reading of a short formula in Typst's math syntax, such as ``W_0/v``: "W 0 over v"."""
    for pattern, replacement in _SPOKEN:
        source = re.sub(pattern, replacement, source)
    return source.strip()
