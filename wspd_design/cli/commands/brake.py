"""``wspd brake``: what the brake of a vehicle does while no wheel slides."""

from typing import Annotated

import typer

from wspd_design.analysis.brake_sheet import RULES, SPEEDS, brake_sheet
from wspd_design.cli import options
from wspd_design.cli.arguments import parse_speed
from wspd_design.cli.console import console, print_json, spaced
from wspd_design.cli.stop_options import parse_grade
from wspd_design.cli.terminal_tables import terminal_table
from wspd_design.design.adhesion_use import adhesion_sentence
from wspd_design.design.case import RAIL, VEHICLE
from wspd_design.design.records import Specification
from wspd_design.exchange.objects import brake_object
from wspd_design.parameters.loading import load_rail, load_vehicle
from wspd_design.parameters.units import KMH
from wspd_design.reporting.sections.brake import brake_sentence, brake_table
from wspd_design.simulation.records import Scenario


def brake(
    speed: Annotated[
        list[str] | None,
        typer.Option(
            "--speed",
            metavar="SPEED",
            help="One initial speed; repeat it for several. "
            f"Default: {', '.join(f'{each * KMH:g}' for each in SPEEDS)} km/h.",
            show_default=False,
            rich_help_panel=options.CASE,
        ),
    ] = None,
    vehicle: options.VehicleOption = None,
    rail: options.RailOption = None,
    grade: Annotated[
        str | None,
        typer.Option(
            "--grade",
            metavar="GRADE",
            help='Positive uphill: "5 permille" or "-0.5 %".',
            show_default=False,
            rich_help_panel=options.CASE,
        ),
    ] = None,
    as_json: options.JsonOption = False,
) -> None:
    """Show what the brake does while no wheel slides: stops by mean values, braked weight, adhesion asked for.

    Equivalent time, mean deceleration and distance after EN 14531-1, braked weight percentage after EN 16834.
    """
    braked, friction = load_vehicle(vehicle or VEHICLE), load_rail(rail or RAIL)
    speeds = tuple(parse_speed(text) for text in speed) if speed else SPEEDS
    slope = 0.0 if grade is None else parse_grade(grade)
    for each in speeds:
        Scenario(rail=friction, initial_speed=each, grade=slope)  # refuses what is no stop
    sheet = brake_sheet(braked, speeds, grade=slope)
    slowest = Specification().speeds[0]
    used = adhesion_sentence(braked, friction, (min(slowest, *speeds), max(speeds)))
    if as_json:
        print_json(brake_object(sheet))
        return
    out = console()
    out.print(brake_sentence(sheet), style="bold", markup=False)
    out.print(used, markup=False)
    if sheet.grade:
        out.print(f"On a grade of {1e3 * sheet.grade:g} permille.", markup=False)
    out.print(spaced(terminal_table(brake_table(sheet))))
    out.print(RULES, style="dim", markup=False)
