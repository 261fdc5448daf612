"""What ``verify`` and ``certify`` share: run the checks of a case and show what they found."""

from collections import Counter
from collections.abc import Collection, Sequence
from pathlib import Path
from typing import NamedTuple

import typer
from rich.console import Group
from rich.padding import Padding
from rich.text import Text

from wspd_design.certificates.records import Certificate, Point, Problem, Range, Status
from wspd_design.cli.console import console, interrupted, progress, spaced, table
from wspd_design.cli.exit_codes import GOOD, REFUTED, UNDECIDED


class _Shown(NamedTuple):
    """How a finding looks."""

    sign: str
    style: str
    word: str
    meaning: str


_SHOWN = {
    status: _Shown(sign, style, status.name.replace("_", " "), status.value)
    for status, sign, style in (
        (Status.PROVED, "✓", "green"),
        (Status.LIMITATION, "!", "bold red"),
        (Status.EVIDENCE, "~", "cyan"),
        (Status.VACUOUS, "○", "yellow"),
        (Status.NOT_APPLICABLE, "-", "dim"),
        (Status.UNDECIDED, "?", "bold yellow"),
        (Status.REFUTED, "✗", "bold red"),
    )
}


class Ran(NamedTuple):
    """What a run of the checks came to."""

    certificates: tuple[Certificate, ...]
    complete: bool  # False after an interrupt, with what was finished before


def run_checks(
    problem: Problem,
    only: Collection[str] | None,
    effort: float,
    stored: Path | None,
    folder: Path | None = None,
) -> Ran:
    """Run the checks with their progress on standard error; write each into the folder, if there is one."""
    from wspd_design.design.certification import certify

    finished: list[Certificate] = []
    try:
        with progress() as tell:
            certify(
                problem,
                only=only,
                effort=effort,
                stored=stored,
                folder=folder,
                progress=tell,
                found=finished.append,
            )
    except KeyboardInterrupt:
        return Ran(tuple(finished), complete=False)
    return Ran(tuple(finished), complete=True)


def interrupted_checks(ran: Ran, only: Collection[str] | None, kept: str) -> typer.Exit:
    """Say what an interrupt left of the checks, and return the exit that ends the command."""
    from wspd_design.certificates.suite import NAMES

    wanted = len(NAMES) if only is None else len(set(only))
    return interrupted(f"{len(ran.certificates)} of {wanted} checks{kept}")


def exit_code(certificates: Sequence[Certificate], *, asked: bool) -> int:
    """Return the exit code of a verification: bad news first, then what is open.

    A check that was ``asked`` for by its name is open unless it is proved.
    """
    statuses = {certificate.status for certificate in certificates}
    if statuses & {Status.REFUTED, Status.LIMITATION}:
        return REFUTED
    if asked:
        return GOOD if statuses == {Status.PROVED} else UNDECIDED
    return UNDECIDED if Status.UNDECIDED in statuses else GOOD


def show_claims(problem: Problem, certificates: Sequence[Certificate]) -> None:
    """Print what is claimed and found, check by check."""
    out = console()
    low, high = problem.speeds
    out.print(
        f"{problem.controller.name} on {problem.rail.name}, {problem.vehicle.name}: "
        f"slip {problem.slips[0]:g} to {problem.slips[1]:g}, {low * 3.6:g} to {high * 3.6:g} km/h, "
        f"sample time {problem.sample_time * 1e3:g} ms",
        style="bold",
        markup=False,
    )
    for certificate in certificates:
        out.print(claim_text(certificate))


def show_not_varied(problem: Problem, certificates: Sequence[Certificate]) -> None:
    """Print which numbers with bounds no claim varies, or held by some."""
    from wspd_design.certificates.setting.domain import not_varied

    never = not_varied(problem, {name for each in certificates for name in each.varied})
    held = sorted({name for each in certificates for name in each.held} - set(never))
    console().print(f"not varied: {', '.join(never) or 'none'}", style="dim", markup=False)
    if held:
        console().print(f"held by some claims, as they say: {', '.join(held)}", style="dim", markup=False)


def show_verdicts(certificates: Sequence[Certificate]) -> None:
    """Print status and margin of each check as a table, and what the statuses mean."""
    shown = table("Status", "Check", "Margin")
    for certificate in certificates:
        shown.add_row(status_text(certificate), certificate.name, Text(margin_text(certificate.margin)))
    console().print(spaced(shown))
    show_counts(certificates)


def show_counts(certificates: Sequence[Certificate]) -> None:
    """Print how often each status was found, and what it means."""
    out = console()
    counts = Counter(_SHOWN[certificate.status] for certificate in certificates)
    present = [shown for shown in _SHOWN.values() if counts[shown]]
    out.print(Text(", ").join(Text(f"{counts[each]} {each.word}", style=each.style) for each in present))
    for each in present:
        out.print(f"{each.word}: {each.meaning}.", style="dim")


def status_text(certificate: Certificate) -> Text:
    """Return sign and word of a finding, in its color; only good news is green."""
    shown = _SHOWN[certificate.status]
    return Text(f"{shown.sign} {shown.word}", style=shown.style)


def margin_text(margin: Range | None) -> str:
    """Write an enclosure of a margin."""
    if margin is None:
        return ""
    unit = "" if margin.unit == "-" else f" {margin.unit}"
    match margin.low, margin.high:
        case None, None:
            return ""
        case low, None:
            return f">= {low:.3g}{unit}"
        case None, high:
            return f"<= {high:.3g}{unit}"
        case low, high:
            same = f"{low:.3g}" == f"{high:.3g}"
            return f"{low:.3g}{unit}" if same else f"{low:.3g} to {high:.3g}{unit}"


def claim_text(certificate: Certificate) -> Group:
    """What is claimed and, unless it holds, why not; indented below the name of the check."""
    lines = [Text(certificate.claim)]
    if certificate.status not in (Status.PROVED, Status.EVIDENCE):
        lines.append(Text(certificate.explanation, style="italic"))
    if certificate.witness:
        lines.append(Text(f"Witness: {_place(certificate.witness)}", style="red"))
    heading = Text(f"\n{certificate.name}: ", style="bold").append(status_text(certificate))
    return Group(heading, Padding(Group(*lines), (0, 0, 0, 2)))


def _place(points: Sequence[Point]) -> str:
    return ", ".join(f"{point.name} {point.value:.4g} {point.unit}".removesuffix(" -") for point in points)
