"""``wspd equations``: what became of every numbered equation of the paper."""

from collections import Counter
from difflib import get_close_matches
from typing import Annotated

import typer
from rich.text import Text

from wspd_design.cli.console import console, spaced, table
from wspd_design.parameters.equations import VERDICTS, Equation, load_equations
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.words import did_you_mean

_STYLES = dict(zip(VERDICTS, ("green", "red", "yellow", "cyan", "dim"), strict=True))
_CERTAINTY = {
    "proved": "proved from the paper's other equations or from units",
    "inferred": "inferred: our reading, others are possible",
    "scan": "one glyph, which the scan at hand may have lost",
}


def equations(
    number: Annotated[
        str | None, typer.Argument(metavar="NUMBER", help='For example 19, B_W or "Table 5".')
    ] = None,
    verdict: Annotated[
        str | None, typer.Option("--verdict", metavar="WORD", help=f"Only {', '.join(VERDICTS)}.")
    ] = None,
) -> None:
    """Show every equation of the paper with its verdict, or all about one of them."""
    known = load_equations()
    if number is not None:
        _show_one(_find(number, known))
        return
    if verdict is not None and verdict not in VERDICTS:
        raise UserError(
            f'--verdict "{verdict}" is unknown{did_you_mean(verdict, VERDICTS)}; choose {", ".join(VERDICTS)}'
        )
    _show_all([equation for equation in known if verdict is None or verdict in equation.verdicts])


def _find(number: str, known: tuple[Equation, ...]) -> Equation:
    wanted = number.strip("() ").lower()
    for equation in known:
        if equation.number.lower() == wanted:
            return equation
    numbers = {equation.number.lower(): equation.number for equation in known}
    near = get_close_matches(wanted, numbers, n=1, cutoff=0.7)
    offer = f' (did you mean "{numbers[near[0]]}"?)' if near else ""
    raise UserError(f'the map has no entry "{number}"{offer}; "wspd equations" lists all of them')


def _label(number: str) -> str:
    return f"({number})" if number[0].isdigit() else number


def _show_all(chosen: list[Equation]) -> None:
    out = console()
    shown = table("No.", "Verdict", "Title and corrected form")
    for equation in chosen:
        content = Text(equation.title)
        if equation.corrected:
            content.append(f"\n{equation.corrected}", style="dim")
        shown.add_row(_label(equation.number), _verdicts(equation), content)
    out.print(spaced(shown))
    counts = Counter(verdict for equation in chosen for verdict in equation.verdicts)
    told = ", ".join(f"{counts[word]} {word}" for word in VERDICTS if counts[word])
    out.print(f"{len(chosen)} entries: {told}", style="bold", highlight=False)
    out.print("A misprint of one glyph may be the scan's: see its certainty.", style="dim", markup=False)
    out.print('Details: "wspd equations 19".', style="dim", markup=False)


def _verdicts(equation: Equation, weight: str = "") -> Text:
    parts = (Text(word, style=f"{weight}{_STYLES[word]}") for word in equation.verdicts)
    return Text(", ").join(parts)


def _show_one(equation: Equation) -> None:
    out = console()
    heading = Text(f"{_label(equation.number)} {equation.title}: ", style="bold")
    out.print(heading.append_text(_verdicts(equation, "bold ")))
    shown = table("", "")
    shown.show_header = False
    for name, content in (
        ("printed", equation.printed),
        ("corrected", equation.corrected),
        ("certainty", "; ".join(_CERTAINTY[word] for word in equation.certainty)),
        ("domain", equation.domain),
        ("unit", equation.unit),
        ("units differ", equation.unit_fault),
        ("residual", equation.residual),
        ("assumption", equation.assumption),
        ("left over without it", equation.gap),
        ("remark", equation.remark),
        ("file", equation.file),
        ("functions", ", ".join(equation.functions)),
        ("test", equation.test),
    ):
        if content:
            shown.add_row(Text(name, style="dim"), Text(content))
    out.print(spaced(shown))
    if equation.file or equation.test:
        out.print("File and test are in the repository; a wheel has neither.", style="dim", markup=False)
