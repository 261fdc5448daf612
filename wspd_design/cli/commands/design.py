"""``wspd design``: gains by rules, or by a search that a specification asks for, with their reasons."""

from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer

from wspd_design.cli import options
from wspd_design.cli.completion import names
from wspd_design.cli.console import progress
from wspd_design.cli.exit_codes import REFUTED
from wspd_design.cli.gains import show_design
from wspd_design.cli.option_records import takes_records
from wspd_design.cli.output import check_output
from wspd_design.cli.searching import SPECIFICATIONS, search_design, to_the_files
from wspd_design.cli.sensor_options import SensorOptions
from wspd_design.controllers.family import designed, designed_family
from wspd_design.design import selection
from wspd_design.design.case import RAIL, VEHICLE, CaseOptions, specification
from wspd_design.design.file import seen_from, write_design
from wspd_design.design.specification_file import read_task
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import load_rail, load_vehicle


@takes_records
def design(
    *,
    wanted: Annotated[
        str | None,
        typer.Argument(metavar="SPEC", help=f"What must be reached: {SPECIFICATIONS}.", show_default=False),
    ] = None,
    law: Annotated[
        str | None,
        typer.Option(
            "--law",
            metavar="LAW",
            help=f"{options.LAWS}. Default: {options.LAW}.",
            show_default=False,
            autocompletion=names(*(family.name for family in designed())),
        ),
    ] = None,
    vehicle: options.VehicleOption = None,
    rail: options.RailOption = None,
    slip: options.SlipOption = None,
    tolerance: Annotated[
        str | None,
        options.case_option("--tolerance", "SLIP", "Band about the slip reference.", options.TOLERANCE),
    ] = None,
    speeds: options.SpeedsOption = None,
    sample_time: options.SampleTimeOption = None,
    sensors: SensorOptions,
    rules_only: Annotated[
        bool,
        typer.Option("--rules-only", help="Take the gains of the rules for SPEC, too, and search nothing."),
    ] = False,
    output: Annotated[
        Path, typer.Option("--output", "-o", metavar="FILE", help="Design file to write.")
    ] = Path(options.DESIGN_FILE),
    force: options.ForceOption = False,
) -> None:
    """Choose the gains of a slip controller by rules, or by search for a specification, and write a design file.

    A search tries many gains on the same drawn vehicles, rails and disturbances, and looks once at sets that it has not
    seen; the exit code is 1 if a requirement is missed there. What is finished stays in a journal beside the output,
    and the same command goes on from there.
    """
    check_output(output, force=force)
    given = {
        "--law": law,
        "--vehicle": vehicle,
        "--rail": rail,
        "--slip": slip,
        "--tolerance": tolerance,
        "--speeds": speeds,
        "--sample-time": sample_time,
        **sensors.written,
    }
    if wanted is not None:
        extra = next((flag for flag, value in given.items() if value is not None), None)
        if extra is not None:
            raise UserError(
                f"{extra} is stated by the specification {wanted}; leave it out, or change the file"
            )
        _made_to(wanted, output, rules_only=rules_only, force=force)
        return
    if rules_only:
        raise UserError(
            "--rules-only goes with a specification; without one the rules choose all gains anyway"
        )
    asked = specification(
        CaseOptions(
            slip=slip, speeds=speeds, tolerance=tolerance, sample_time=sample_time, sensors=sensors.words
        )
    )
    chosen = designed_family(law or options.LAW).name
    braked, friction = load_vehicle(vehicle or VEHICLE), load_rail(rail or RAIL)
    with progress() as tell:
        tell("choosing the gains")
        made = selection.design_controller(braked, friction, asked, law=chosen)
    made = replace(made, vehicle_file=seen_from(output, vehicle), rail_file=seen_from(output, rail))
    write_design(made, output)
    show_design(made, output, braked, friction)


def _made_to(wanted: str, output: Path, *, rules_only: bool, force: bool) -> None:
    task = read_task(wanted)
    braked, friction = load_vehicle(task.vehicle), load_rail(task.design_rail)
    with progress() as tell:
        tell("choosing the gains to start from")
        start = selection.design_controller(braked, friction, task.specification, law=task.law)
    name = f"{task.law}-{task.name}"
    if rules_only:
        made = to_the_files(replace(start, name=name), task, output)
        write_design(made, output)
        show_design(made, output, braked, friction)
        return
    if not search_design(task, start, name, output, keep=True, force=force):
        raise typer.Exit(REFUTED)
