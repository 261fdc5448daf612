"""``wspd design``: gains that meet a specification, with their reasons."""

from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer

from wspd_design.cli import options
from wspd_design.cli.console import progress
from wspd_design.cli.gains import show_design
from wspd_design.cli.output import check_output
from wspd_design.controllers.family import designed_family
from wspd_design.design import selection
from wspd_design.design.case import RAIL, VEHICLE, CaseOptions, specification
from wspd_design.design.file import seen_from, write_design
from wspd_design.parameters.loading import load_rail, load_vehicle


def design(
    law: Annotated[str, typer.Option("--law", metavar="LAW", help=f"{options.LAWS}.")] = options.LAW,
    vehicle: options.VehicleOption = None,
    rail: options.RailOption = None,
    slip: options.SlipOption = None,
    tolerance: Annotated[
        str | None,
        options.case_option("--tolerance", "SLIP", "Band about the slip reference.", options.TOLERANCE),
    ] = None,
    speeds: options.SpeedsOption = None,
    sample_time: options.SampleTimeOption = None,
    output: Annotated[
        Path, typer.Option("--output", "-o", metavar="FILE", help="Design file to write.")
    ] = Path(options.DESIGN_FILE),
    force: options.ForceOption = False,
) -> None:
    """Choose the gains of a slip controller by rules, say why, and write a design file."""
    check_output(output, force=force)
    wanted = specification(
        CaseOptions(slip=slip, speeds=speeds, tolerance=tolerance, sample_time=sample_time)
    )
    chosen = designed_family(law).name
    braked, friction = load_vehicle(vehicle or VEHICLE), load_rail(rail or RAIL)
    with progress() as tell:
        tell("choosing the gains")
        made = selection.design_controller(braked, friction, wanted, law=chosen)
    made = replace(made, vehicle_file=seen_from(output, vehicle), rail_file=seen_from(output, rail))
    write_design(made, output)
    show_design(made, output, braked, friction)
