"""What ``verify`` and ``certify`` share: run the checks of a case and show what they found."""

from collections import Counter
from collections.abc import Collection, Sequence
from typing import NamedTuple

from rich.console import Group
from rich.padding import Padding
from rich.text import Text

from wspd_design.certificates.records import Certificate, Point, Problem, Range, Status
from wspd_design.cli.case import Case
from wspd_design.cli.console import console, progress, spaced, table
from wspd_design.cli.exit_codes import GOOD, REFUTED, UNDECIDED
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.units import parse_quantity


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
        (Status.EVIDENCE, "~", "cyan"),
        (Status.VACUOUS, "○", "yellow"),
        (Status.NOT_APPLICABLE, "-", "dim"),
        (Status.UNDECIDED, "?", "bold yellow"),
        (Status.REFUTED, "✗", "bold red"),
    )
}
_LIMIT = _Shown(
    "!", "bold red", "LIMIT PROVED", f"{Status.PROVED.value}, and says what the closed loop cannot do"
)


def problem_of(case: Case, *, seed: int = 0) -> Problem:
    """Return the closed loop and domain that the checks of a case speak about."""
    from wspd_design.design.problem import stability_problem

    return stability_problem(case.vehicle, case.rail, case.controller, case.specification, seed=seed)


def run_checks(
    problem: Problem, only: Collection[str] | None, search_time: str | None
) -> tuple[Certificate, ...]:
    """Run the checks with their progress on standard error; ``search_time`` is what the user wrote."""
    from wspd_design.certificates import suite
    from wspd_design.certificates.search.prover import DEFAULT_BUDGET, Budget

    budget = DEFAULT_BUDGET
    if search_time is not None:
        seconds = parse_quantity(search_time, "time", what="search time")
        if seconds <= 0.0:
            raise UserError(f'search time "{search_time}" must be above 0; write for example "2 min"')
        budget = Budget(seconds=seconds)
    with progress() as tell:
        return suite.verify(problem, only=only or None, progress=tell, budget=budget)


def exit_code(certificates: Sequence[Certificate]) -> int:
    """Return the exit code of a verification; a refuted claim counts more than an undecided one."""
    statuses = {certificate.status for certificate in certificates}
    if Status.REFUTED in statuses:
        return REFUTED
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
        out.print(_claim(certificate))


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
    counts = Counter(map(_shown, certificates))
    present = [shown for shown in (*_SHOWN.values(), _LIMIT) if counts[shown]]
    out.print(Text(", ").join(Text(f"{counts[each]} {each.word}", style=each.style) for each in present))
    for each in present:
        out.print(f"{each.word}: {each.meaning}.", style="dim")


def status_text(certificate: Certificate) -> Text:
    """Return sign and word of a finding, in its color; a limitation that is proved is no good news."""
    shown = _shown(certificate)
    return Text(f"{shown.sign} {shown.word}", style=shown.style)


def _shown(certificate: Certificate) -> _Shown:
    limit = certificate.limitation and certificate.status is Status.PROVED
    return _LIMIT if limit else _SHOWN[certificate.status]


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


def _claim(certificate: Certificate) -> Group:
    """What is claimed and, unless it holds, why not; indented below the name of the check."""
    lines = [Text(certificate.claim)]
    if certificate.status in (Status.REFUTED, Status.UNDECIDED, Status.VACUOUS) or certificate.limitation:
        lines.append(Text(certificate.explanation, style="italic"))
    if certificate.witness:
        lines.append(Text(f"Witness: {_place(certificate.witness)}", style="red"))
    heading = Text(f"\n{certificate.name}: ", style="bold").append(status_text(certificate))
    return Group(heading, Padding(Group(*lines), (0, 0, 0, 2)))


def _place(points: Sequence[Point]) -> str:
    return ", ".join(f"{point.name} {point.value:.4g} {point.unit}".removesuffix(" -") for point in points)
