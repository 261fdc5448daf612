"""``wspd verify``: what can be said about the stability of a closed loop."""

from collections import Counter
from collections.abc import Sequence
from typing import Annotated

import typer
from rich.text import Text

from wspd_design.certificates.records import Certificate, Point, Problem, Range, Status
from wspd_design.cli import options
from wspd_design.cli.case import Wishes, check_plant, chosen, resolve
from wspd_design.cli.console import console, print_json, progress, table
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
    plant: options.PlantOption = options.PLANT,
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

    check_plant(plant)
    case = resolve(
        chosen(name, controller),
        Wishes(vehicle=vehicle, rail=rail, slip=slip, speeds=speeds, sample_time=sample_time),
    )
    problem = stability_problem(case.vehicle, case.rail, case.controller, case.specification, seed=seed)
    with progress() as tell:
        certificates = suite.verify(problem, only=only, progress=tell)
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
        f"slip {problem.slips[0]:g} to {problem.slips[1]:g}, {low * 3.6:g} to {high * 3.6:g} km/h, sample time "
        f"{problem.sample_time * 1e3:g} ms",
        style="bold",
        markup=False,
    )
    shown = table("Status", "Check and claim", "Margin")
    for certificate in certificates:
        sign, style = _SIGNS[certificate.status]
        mark = Text(f"{sign} {_word(certificate.status)}", style=style)
        shown.add_row(mark, _claim(certificate), Text(_margin(certificate.margin)))
    out.print(shown)
    counts = Counter(certificate.status for certificate in certificates)
    tally = Text(", ").join(
        Text(f"{counts[status]} {_word(status)}", style=_SIGNS[status][1])
        for status in _SIGNS
        if counts[status]
    )
    out.print(tally)
    for status in _SIGNS:
        if counts[status]:
            out.print(f"{_word(status)}: {status.value}.", style="dim")


def _claim(certificate: Certificate) -> Text:
    text = Text(certificate.name, style="bold").append(f"\n{certificate.claim}", style="not bold")
    if certificate.status in (Status.REFUTED, Status.UNDECIDED):
        text.append(f"\n{certificate.explanation}", style="not bold italic")
    if certificate.witness:
        text.append(f"\nwitness: {_place(certificate.witness)}", style="not bold red")
    return text


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
            return f"{low:.3g}{unit}" if low == high else f"{low:.3g} to {high:.3g}{unit}"


def _place(points: Sequence[Point]) -> str:
    return ", ".join(f"{point.name} {point.value:.4g} {point.unit}".removesuffix(" -") for point in points)
