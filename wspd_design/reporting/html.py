"""A document as one HTML file that needs no network and no file beside it, and no script to be read."""

import base64
import hashlib
from collections.abc import Mapping
from importlib.resources import files
from typing import TYPE_CHECKING

from wspd_design.reporting.blocks import Attachment, Cell, Document, Equation, Figure
from wspd_design.reporting.equations import FormulaSet, typeset
from wspd_design.reporting.figure_style import GRID, INK, MUTED, SERIES
from wspd_design.reporting.numbering import CONTENTS, PROVENANCE, Numbering, formulas, number
from wspd_design.reporting.svg import inline
from wspd_design.reporting.template import ROLES
from wspd_design.reporting.text import CodeSpan, Emphasis, Link, Math, Text, plain, printable, spans, unbroken

if TYPE_CHECKING:
    from markupsafe import Markup

COLORS = {color: f"var(--series-{index})" for index, color in enumerate(SERIES, start=1)} | {
    INK: "currentColor",
    MUTED: "var(--muted)",
    GRID: "var(--grid)",
    "#000000": "currentColor",
}
"""Of the style sheet, in place of those of a figure."""


def render_html(document: Document) -> str:
    """Return a document as HTML text.

    The page allows itself nothing but its own style sheet and script, known by their hashes, and embedded images.
    Colors follow the light or dark scheme of the reader; on paper the style sheet for print applies.
    """
    import jinja2

    numbering = number(document)
    formula_set = typeset(formulas(document))
    style, script = _style_sheet(formula_set), _script()
    environment = jinja2.Environment(
        loader=jinja2.PackageLoader("wspd_design.reporting"),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        finalize=lambda value: printable(value) if type(value) is str else value,
    )
    writer = _Writer(numbering, formula_set)
    environment.filters |= {
        "rich": writer.rich,
        "figure": writer.figure,
        "equation": writer.equation,
        "data_uri": _data_uri,
        "file_anchor": lambda name: f"File-{[each.name for each in document.attachments].index(name) + 1}",
    }
    environment.tests |= {"with_status": lambda cell: isinstance(cell, Cell)}
    return environment.get_template("report.html").render(
        document=document,
        numbering=numbering,
        contents=CONTENTS,
        provenance=PROVENANCE,
        roles=ROLES,
        keywords=", ".join(document.keywords),
        description=plain(document.verdict.sentence),
        style=style,
        script=script,
        script_hash=_hash(script),
        style_hash=_hash(style),
        glyphs=_trusted(formula_set.glyphs),
    )


def _trusted(markup: str) -> "Markup":
    """Mark markup of our own making as safe."""
    from markupsafe import Markup

    return Markup(markup)


def _style_sheet(formula_set: FormulaSet) -> "Markup":
    """Return the style sheet; the policy forbids style attributes, so each baseline becomes a class."""
    depths = sorted({image.depth for image in formula_set.images.values()})
    baselines = "".join(f".{_depth_class(depth)} {{ vertical-align: {-depth:.2f}em }}\n" for depth in depths)
    sheet = files("wspd_design.reporting").joinpath("templates/report.css").read_text(encoding="utf-8")
    return _trusted(sheet + baselines)


def _script() -> "Markup":
    """Return the script of the page without indentation and comments that fill a line."""
    source = files("wspd_design.reporting").joinpath("templates/report.js").read_text(encoding="utf-8")
    lines = map(str.strip, source.splitlines())
    return _trusted("".join(f"{line}\n" for line in lines if not line.startswith("//")))


def _hash(text: str) -> str:
    return base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()


def _depth_class(depth: float) -> str:
    return f"depth-{round(depth * 100)}"


def _data_uri(attachment: Attachment) -> str:
    content = base64.b64encode(attachment.content.encode()).decode()
    return f"data:{attachment.media_type};base64,{content}"


class _Writer:
    """The Jinja filters that need to know the numbers and the formulas of the document."""

    def __init__(self, numbering: Numbering, formula_set: FormulaSet) -> None:
        self._labels: Mapping[str, str] = numbering.labels
        self._formulas = formula_set
        self._figures = 0

    def rich(self, text: Text) -> "Markup":
        """Return inline text as HTML."""
        return _trusted("").join(map(self._span, spans(text)))

    def _span(self, span: object) -> "Markup":
        markup = _trusted
        match span:
            case Emphasis(text=text):
                return markup("<em>{}</em>").format(printable(text))
            case CodeSpan(text=text):
                return markup("<code>{}</code>").format(printable(text))
            case Link(anchor=anchor, text=text):
                return markup('<a href="#{}">{}</a>').format(anchor, printable(text) or self._labels[anchor])
            case Math(spoken=spoken):
                image = self._formulas.image(span)
                return markup('<span class="math {}">{}<span class="spoken">{}</span></span>').format(
                    _depth_class(image.depth), markup(image.svg), printable(spoken)
                )
            case _:
                return markup("{}").format(unbroken(printable(str(span))))

    def equation(self, equation: Equation) -> "Markup":
        """Return the image of a displayed formula."""
        return _trusted(self._formulas.image(equation).svg)

    def figure(self, figure: Figure) -> "Markup":
        """Return the picture of a figure, its ids made unique in the page."""
        self._figures += 1
        return _trusted(inline(figure.svg, f"F{self._figures}-", COLORS, printable(figure.alt)))
