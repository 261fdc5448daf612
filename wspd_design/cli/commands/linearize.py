"""``wspd linearize``: poles and input gain of the slip over speed."""

from typing import TYPE_CHECKING, Annotated

import typer

from wspd_design.cli import options
from wspd_design.cli.arguments import check_quarter, parse_speed
from wspd_design.cli.console import console, print_json, spaced
from wspd_design.cli.json_objects import linearization_object
from wspd_design.cli.terminal_tables import terminal_table
from wspd_design.design.case import RAIL, VEHICLE, CaseOptions, specification
from wspd_design.parameters.loading import load_entries, load_rail, load_vehicle
from wspd_design.reporting.running_gear import alike_note
from wspd_design.reporting.tables import ColumnOf, build

if TYPE_CHECKING:
    from wspd_design.analysis.linearization import Linearization

SPEEDS_KMH = (120, 100, 80, 60, 40, 30, 20, 10, 5, 3.6)


def linearize(
    speed: Annotated[
        list[str] | None,
        typer.Option(
            "--speed",
            metavar="SPEED",
            help=f"One speed; repeat it for several. Default: {SPEEDS_KMH[0]} to {SPEEDS_KMH[-1]} km/h.",
            show_default=False,
            rich_help_panel=options.CASE,
        ),
    ] = None,
    vehicle: options.VehicleOption = None,
    plant: options.QuarterOption = options.QUARTER,
    rail: options.RailOption = None,
    slip: options.SlipOption = None,
    as_json: options.JsonOption = False,
) -> None:
    """Show open-loop poles, input gain and equilibrium torque of the slip over speed.

    Where the slip pole exceeds 1/tau of the valve, no law can stabilize the equilibrium that does not read the torque
    and has a memory of integrals alone. A law with dynamics of its own, such as a lead filter, is not bound by this.
    """
    from wspd_design.analysis import linearization

    check_quarter(plant, "linearize")
    reference = specification(CaseOptions(slip=slip)).slip
    braked, friction = load_vehicle(vehicle or VEHICLE), load_rail(rail or RAIL)
    speeds = [parse_speed(text) for text in speed] if speed else [kmh / 3.6 for kmh in SPEEDS_KMH]
    points = [linearization.linearized(braked, friction, slip=reference, speed=v) for v in speeds]
    beyond = [point.slip_pole > 1.0 / point.time_constant for point in points]
    if as_json:
        print_json(linearization_object(points, plant=plant))
    else:
        _show(points, beyond)
        note = alike_note(load_entries("vehicle", vehicle or VEHICLE))
        if note:
            console().print(note, markup=False)


def _show(points: "list[Linearization]", beyond: list[bool]) -> None:
    out, first = console(), points[0]
    out.print(f"{first.vehicle} on {first.rail} at slip {first.slip:g}", style="bold", markup=False)
    shown = build(
        list(zip(points, beyond, strict=True)),
        (
            ColumnOf(
                title="speed", unit="km/h", flush_right=True, read=lambda row: f"{row[0].speed * 3.6:g}"
            ),
            ColumnOf(title="slip pole", unit="1/s", decimals=3, read=lambda row: row[0].slip_pole),
            ColumnOf(title="gain G", unit="1/(MN m s)", decimals=1, read=lambda row: row[0].gain * 1e6),
            ColumnOf(
                title="with valve",
                unit="1/s",
                flush_right=True,
                read=lambda row: ", ".join(f"{pole:.2f}" for pole in row[0].poles()),
            ),
            ColumnOf(
                title="torque", unit="kN m", decimals=1, read=lambda row: row[0].equilibrium_torque / 1e3
            ),
            ColumnOf(title="", read=lambda row: "!" if row[1] else ""),
        ),
        caption="",
    )
    out.print(spaced(terminal_table(shown)))
    limits = sorted({round(1.0 / point.time_constant, 6) for point in points})
    limit = f"{limits[0]:.3g}" if len(limits) == 1 else f"{limits[0]:.3g} to {limits[-1]:.3g}"
    verdict = (
        f"!: at {sum(beyond)} of {len(points)} speeds the slip pole exceeds 1/tau = {limit} 1/s of the "
        "valve, nominal parameters: no law can stabilize the equilibrium there that does not read the torque and has "
        "a memory of integrals alone. A law with dynamics of its own, such as a lead filter, is not bound by this."
        if any(beyond)
        else f"The slip pole does not exceed 1/tau = {limit} 1/s of the valve at any of these speeds."
    )
    out.print(verdict, style="yellow" if any(beyond) else "")
