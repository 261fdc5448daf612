"""Cards of HTML: a title, a verdict, tables and small pictures, legible on light and on dark pages.

A card brings its style with it and asks no other host. Colors follow what the host says about its theme; of an
unknown one the text color is taken over, and all else is legible on both.
"""

import hashlib
from collections.abc import Callable, Sequence
from html import escape
from typing import TYPE_CHECKING

from wspd_design.parameters.table import Table
from wspd_design.reporting.figures.drawing import picture
from wspd_design.reporting.html import COLORS
from wspd_design.reporting.svg import inline
from wspd_design.reporting.text import printable

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MOST_ROWS = 60
"""Rows of a table that a card shows; the rest is told."""

_DARK = (
    '[data-jp-theme-light="false"]',
    '[data-theme="dark"]',
    '[theme="dark"]',
    ".vscode-dark",
)
_LIGHT_COLORS = (
    "--muted:#5c6670;--grid:#d9dee3;--good:#0f6b3a;--bad:#b3261e;--open:#8a5300;--neutral:#5c6670;"
    "--series-1:#0072b2;--series-2:#d55e00;--series-3:#009e73;--series-4:#cc79a7;--series-5:#56b4e9;"
    "--series-6:#e69f00;--series-7:currentColor"
)
_DARK_COLORS = (
    "--muted:#9aa5af;--grid:#3d464e;--good:#6bcf94;--bad:#ff8f85;--open:#f0b45c;--neutral:#9aa5af;"
    "--series-1:#4da6e0;--series-2:#f58a42;--series-3:#2cc79b;--series-4:#dd97bd"
)
_RULES = (
    ".wspd{"
    + _LIGHT_COLORS
    + ";font:.9rem/1.45 system-ui,sans-serif;max-width:56rem;margin:.3rem 0}"
    + "".join(f"{place} .wspd{{{_DARK_COLORS}}}" for place in _DARK)
    + '@media(prefers-color-scheme:dark){[data-theme="auto"] .wspd,.wspd-page .wspd{'
    + _DARK_COLORS
    + "}}"
    ".wspd .title{font-weight:650}.wspd p{margin:.15rem 0}.wspd .note{color:var(--muted);font-size:.85em}"
    ".wspd .scroll{overflow-x:auto}"
    ".wspd table{border-collapse:collapse;margin:.4rem 0;font-variant-numeric:tabular-nums;color:inherit}"
    # Notebooks align and size the cells of all tables by rules that are more specific.
    ".wspd :is(th,td){padding:.18rem .8rem .18rem 0!important;text-align:left!important;vertical-align:baseline;"
    "white-space:normal;max-width:30rem}"
    ".wspd table{font-size:inherit!important}.wspd tr{background:none!important}"
    ".wspd th{font-weight:600;border-bottom:1.5px solid currentColor;vertical-align:bottom}"
    ".wspd th span{display:block;font-weight:400;color:var(--muted)}"
    ".wspd td{border-bottom:1px solid var(--grid)}"
    ".wspd .right{text-align:right!important}.wspd td.right,.wspd td .verdict{white-space:nowrap}"
    ".wspd .good{color:var(--good)}.wspd .bad{color:var(--bad)}.wspd .open{color:var(--open)}"
    ".wspd .neutral{color:var(--neutral)}.wspd .verdict{font-weight:600}"
    ".wspd svg{display:block;max-width:100%;height:auto;font-family:'DejaVu Sans',Verdana,sans-serif}"
)


def card(
    title: str,
    *,
    lines: Sequence[str] = (),
    verdict: tuple[str, str] | None = None,
    tables: Sequence[Table] = (),
    pictures: Sequence[str] = (),
) -> str:
    """Return a card.

    Parameters
    ----------
    title : str
        What is shown.
    lines : sequence of str
        Sentences below it.
    verdict : tuple of str, optional
        Tone, one of good, bad, open and neutral, and the sentence.
    tables : sequence of Table
        Below the pictures.
    pictures : sequence of str
        Elements of :func:`small_picture`.
    """
    said = "" if verdict is None else f'<p class="verdict {verdict[0]}">{_text(verdict[1])}</p>'
    return (
        f'<div class="wspd"><style>{_RULES}</style><p class="title">{_text(title)}</p>{said}'
        + "".join(f"<p>{_text(line)}</p>" for line in lines if line)
        + "".join(pictures)
        + "".join(map(_table, tables))
        + "</div>"
    )


def table_card(table: Table) -> str:
    """Return a table alone as a card."""
    return card(table.caption, tables=[table])


def small_picture(draw: "Callable[[Figure], Figure]", *, height: float, alt: str) -> str:
    """Return what a function draws on an empty figure of this height [in] as an element of a card."""
    svg = picture(draw, height=height)
    prefix = f"w{hashlib.sha256(svg.encode()).hexdigest()[:10]}-"
    return inline(svg, prefix, COLORS, printable(alt))


def _table(table: Table) -> str:
    right = [' class="right"' if table.flush_right(place) else "" for place in range(len(table.columns))]
    heads = "".join(
        f"<th{side}>{_text(column.title)}{f'<span>[{_text(column.unit)}]</span>' if column.unit else ''}</th>"
        for column, side in zip(table.columns, right, strict=True)
    )
    tones = table.tones or ("",) * len(table.rows)
    rows = "".join(
        "<tr>" + "".join(_cells(texts, right, tone)) + "</tr>"
        for texts, tone in list(zip(table.texts, tones, strict=True))[:MOST_ROWS]
    )
    notes = list(table.notes)
    if len(table.rows) > MOST_ROWS:
        notes.append(f"{len(table.rows) - MOST_ROWS} more rows are not shown; to_pandas() has all.")
    below = "".join(f'<p class="note">{_text(note)}</p>' for note in notes)
    return f'<div class="scroll"><table><thead><tr>{heads}</tr></thead><tbody>{rows}</tbody></table></div>{below}'


def _cells(texts: Sequence[str], right: Sequence[str], tone: str) -> list[str]:
    """Cells of a row; its tone colors the first one, which the words of the row tell as well."""
    cells = [f"<td{side}>{_text(text)}</td>" for text, side in zip(texts, right, strict=True)]
    if tone:
        cells[0] = f'<td><span class="verdict {tone}">{_text(texts[0])}</span></td>'
    return cells


def _text(text: str) -> str:
    return escape(printable(text))
