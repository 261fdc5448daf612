"""``wspd verify``: what can be said about the stability of a closed loop."""

from collections import Counter
from collections.abc import Sequence
from typing import Annotated

import typer
from rich.console import Group
from rich.padding import Padding
from rich.text import Text

from wspd_design.certificates.records import Certificate, Point, Problem, Range, Status
from wspd_design.cli import options
from wspd_design.cli.case import Wishes, check_quarter, chosen, resolve
from wspd_design.cli.console import console, print_json, progress, spaced, table
from wspd_design.cli.exit_codes import GOOD, REFUTED, UNDECIDED
from wspd_design.cli.json_objects import verification_object

_SIGNS = {
    Status.PROVED: ("✓", "green"),
    Status.EVIDENCE: ("~", "cyan"),
    Status.VACUOUS: ("○", "yellow"),
    Status.NOT_APPLICABLE: ("-", "dim"),
    Status.UNDECIDED: ("?", "bold yellow"),
    Status.REFUTED: ("✗", "bold red"),
}
_VERDICTS = {GOOD: "good", REFUTED: "refuted", UNDECIDED: "undecided"}


def verify(
    name: options.ControllerArgument = None,
    controller: options.ControllerOption = None,
    vehicle: options.VehicleOption = None,
    plant: options.QuarterOption = options.QUARTER,
    rail: options.RailOption = None,
    slip: options.SlipOption = None,
    speeds: options.SpeedsOption = None,
    sample_time: options.SampleTimeOption = None,
    seed: options.SeedOption = 0,
    only: Annotated[
        list[str] | None, typer.Option("--only", metavar="CHECK", help="One check; repeat it for several.")
    ] = None,
    as_json: options.JsonOption = False,
) -> None:
    """Check the stability of a closed loop, claim by claim.

    Exit code 1 when a claim is refuted, else 3 when one is undecided, else 0.
    """
    from wspd_design.certificates import suite
    from wspd_design.design.problem import stability_problem

    check_quarter(plant, "verify")
    case = resolve(
        chosen(name, controller),
        Wishes(vehicle=vehicle, rail=rail, slip=slip, speeds=speeds, sample_time=sample_time),
    )
    problem = stability_problem(case.vehicle, case.rail, case.controller, case.specification, seed=seed)
    with progress() as tell:
        certificates = suite.verify(problem, only=only or None, progress=tell)
    code = exit_code(certificates)
    if as_json:
        print_json(verification_object(problem, certificates, plant=plant, verdict=_VERDICTS[code]))
    else:
        _show(problem, certificates)
    raise typer.Exit(code)


def exit_code(certificates: Sequence[Certificate]) -> int:
    """Return the exit code of a verification; a refuted claim counts more than an undecided one."""
    statuses = {certificate.status for certificate in certificates}
    if Status.REFUTED in statuses:
        return REFUTED
    return UNDECIDED if Status.UNDECIDED in statuses else GOOD


def _show(problem: Problem, certificates: Sequence[Certificate]) -> None:
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
    shown = table("Status", "Check", "Margin")
    for certificate in certificates:
        shown.add_row(_status(certificate.status), certificate.name, Text(_margin(certificate.margin)))
    out.print(spaced(shown))
    counts = Counter(certificate.status for certificate in certificates)
    present = [status for status in _SIGNS if counts[status]]
    out.print(Text(", ").join(Text(f"{counts[s]} {_word(s)}", style=_SIGNS[s][1]) for s in present))
    for status in present:
        out.print(f"{_word(status)}: {status.value}.", style="dim")


def _claim(certificate: Certificate) -> Group:
    """What is claimed and, unless it holds, why not; indented below the name of the check."""
    lines = [Text(certificate.claim)]
    if certificate.status in (Status.REFUTED, Status.UNDECIDED, Status.VACUOUS):
        lines.append(Text(certificate.explanation, style="italic"))
    if certificate.witness:
        lines.append(Text(f"Witness: {_place(certificate.witness)}", style="red"))
    heading = Text(f"\n{certificate.name}: ", style="bold").append(_status(certificate.status))
    return Group(heading, Padding(Group(*lines), (0, 0, 0, 2)))


def _status(status: Status) -> Text:
    sign, style = _SIGNS[status]
    return Text(f"{sign} {_word(status)}", style=style)


def _word(status: Status) -> str:
    return status.name.replace("_", " ")


def _margin(margin: Range | None) -> str:
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


def _place(points: Sequence[Point]) -> str:
    return ", ".join(f"{point.name} {point.value:.4g} {point.unit}".removesuffix(" -") for point in points)
