"""The block model: what a report consists of, free of any way to render it.

Every block is a frozen record of texts. Pictures are SVG, formulas are in Typst's math syntax; both carry the
sentence that a screen reader speaks in their place.
"""

from dataclasses import dataclass
from datetime import datetime
from enum import Enum
from typing import Literal, TypeAlias

from wspd_design.reporting.template import Template
from wspd_design.reporting.text import Text


class Status(Enum):
    """Result of a check, or a plain judgment; shown by a sign and a word, supported by a color."""

    PROVED = ("✓", "proved", "good")
    REFUTED = ("✗", "refuted", "bad")
    LIMITATION = ("!", "limitation", "bad")
    UNDECIDED = ("?", "undecided", "open")
    EVIDENCE = ("≈", "evidence", "open")
    VACUOUS = ("∅", "vacuous", "neutral")
    NOT_APPLICABLE = ("–", "not applicable", "neutral")
    ACCEPTED = ("✓", "accepted", "good")
    REJECTED = ("✗", "rejected", "bad")
    MET = ("✓", "met", "good")
    MISSED = ("✗", "not met", "bad")
    OPEN = ("?", "open", "open")
    HOLDS = ("✓", "holds", "good")
    PARTLY = ("±", "holds in part", "open")
    FAILS = ("✗", "does not hold", "bad")
    GOOD = ("✓", "good", "good")
    BAD = ("✗", "bad", "bad")
    NEUTRAL = ("•", "neutral", "neutral")

    @property
    def sign(self) -> str:
        """One character that tells the statuses apart without color."""
        return self.value[0]

    @property
    def word(self) -> str:
        """The status in words."""
        return self.value[1]

    @property
    def tone(self) -> str:
        """Color family: good, bad, open or neutral."""
        return self.value[2]


@dataclass(frozen=True, slots=True, kw_only=True)
class Heading:
    """A section heading; level 1 is the highest below the title."""

    text: str
    anchor: str
    level: int = 1


@dataclass(frozen=True, slots=True, kw_only=True)
class Paragraph:
    """Running text."""

    text: Text


@dataclass(frozen=True, slots=True, kw_only=True)
class Bullets:
    """An unordered list of short texts."""

    items: tuple[Text, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class Definition:
    """One row of a list of terms."""

    term: Text
    text: Text


@dataclass(frozen=True, slots=True, kw_only=True)
class Definitions:
    """Terms with their explanations or values."""

    rows: tuple[Definition, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class Code:
    """Lines of a program, a file or a terminal."""

    text: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Equation:
    """A displayed formula in Typst's math syntax.

    ``description`` is the sentence for screen readers; ``number`` is that of the paper, such as ``"19"``.
    """

    source: str
    description: str
    number: str = ""
    anchor: str = ""

    def __post_init__(self) -> None:
        if not self.description.strip():
            raise ValueError(f"equation {self.source!r}: description must say in words what the formula says")


@dataclass(frozen=True, slots=True, kw_only=True)
class Figure:
    """A picture as SVG, as :func:`wspd_design.reporting.figure_style.figure_svg` returns it.

    ``alt`` says in words what the picture shows, ``caption`` what to conclude from it; ``data`` is the name of the
    attachment that holds its numbers.
    """

    svg: str
    caption: Text
    alt: str
    anchor: str = ""
    data: str = ""

    def __post_init__(self) -> None:
        if not self.alt.strip():
            raise ValueError(f"figure {self.anchor!r}: alt must say in words what the picture shows")


@dataclass(frozen=True, slots=True, kw_only=True)
class Column:
    """One column of a table; the unit stands under the title."""

    title: Text
    unit: str = ""
    align: Literal["left", "center", "right"] = "left"


@dataclass(frozen=True, slots=True, kw_only=True)
class Cell:
    """A table cell that carries a status; without text, the word of the status is shown."""

    status: Status
    text: Text = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class Table:
    """A table with a header row; columns of numbers are aligned right and set in figures of equal width."""

    columns: tuple[Column, ...]
    rows: tuple[tuple[Text | Cell, ...], ...]
    caption: Text
    anchor: str = ""

    def __post_init__(self) -> None:
        for row in self.rows:
            if len(row) != len(self.columns):
                raise ValueError(
                    f"table {self.anchor!r}: a row has {len(row)} cells, not {len(self.columns)}"
                )


@dataclass(frozen=True, slots=True, kw_only=True)
class Verdict:
    """A judgment in one sentence."""

    status: Status
    sentence: Text


@dataclass(frozen=True, slots=True, kw_only=True)
class KeyNumber:
    """One number that matters, ready to print."""

    label: str
    value: str
    unit: str = ""
    note: Text = ""

    @property
    def unbroken(self) -> str:
        """The value for a narrow column: no line begins behind a ±."""
        return self.value.replace("± ", "±\N{NO-BREAK SPACE}")


@dataclass(frozen=True, slots=True, kw_only=True)
class KeyNumbers:
    """Up to four key numbers side by side."""

    numbers: tuple[KeyNumber, ...]

    def __post_init__(self) -> None:
        if not 1 <= len(self.numbers) <= 4:
            raise ValueError(f"key numbers: {len(self.numbers)} given, 1 to 4 fit side by side")


Block: TypeAlias = (
    Heading | Paragraph | Bullets | Definitions | Code | Equation | Figure | Table | Verdict | KeyNumbers
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Attachment:
    """A text file that travels inside the report, such as the design file."""

    name: str
    media_type: str
    content: str
    description: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Document:
    """A whole report: first page (title, verdict, summary, signatures, contents), blocks, and where it comes from.

    ``timestamp`` is the only date in the output; the same document gives the same bytes. Author and keywords are for
    catalogs. With a template the document is one to sign.
    """

    title: str
    subtitle: str
    status_line: str
    verdict: Verdict
    summary: tuple[Block, ...]
    blocks: tuple[Block, ...]
    provenance: tuple[Definition, ...]
    attachments: tuple[Attachment, ...]
    timestamp: datetime
    author: str
    keywords: tuple[str, ...]
    template: Template | None = None
