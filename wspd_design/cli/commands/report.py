"""``wspd report``: everything about a design in one document."""

import shlex
import sys
from pathlib import Path
from typing import Annotated

import typer

from wspd_design.cli import options
from wspd_design.cli.arguments import check_plant, chosen, initial_speed
from wspd_design.cli.console import console, progress
from wspd_design.cli.disturbances import StopOptions
from wspd_design.cli.option_records import takes_records
from wspd_design.cli.output import check_output
from wspd_design.cli.sensor_options import SensorOptions
from wspd_design.cli.stop_command import stop_command
from wspd_design.cli.stop_options import along_the_track, scenario
from wspd_design.controllers.family import FAMILIES
from wspd_design.controllers.protocol import Law
from wspd_design.design.case import Case, CaseOptions, load_case
from wspd_design.design.catalog import is_design_file
from wspd_design.design.certification import stored_beside
from wspd_design.design.records import Design
from wspd_design.design.selection import named_design
from wspd_design.parameters.errors import UserError


@takes_records
def report(
    *,
    name: options.ControllerArgument = None,
    controller: options.ControllerOption = None,
    vehicle: options.VehicleOption = None,
    plant: options.PlantOption = options.PLANT,
    rail: options.RailOption = None,
    speed: options.SpeedOption = None,
    slip: options.SlipOption = None,
    sample_time: options.SampleTimeOption = None,
    sensors: SensorOptions,
    seed: options.SeedOption = 0,
    disturbances: StopOptions,
    output: Annotated[
        Path, typer.Option("--output", "-o", metavar="FILE", help="Report to write, .html or .pdf.")
    ] = Path("report.html"),
    pdf: Annotated[bool, typer.Option("--pdf", help="Write the same content as PDF beside it, too.")] = False,
    template: Annotated[
        Path | None,
        typer.Option(
            "--template",
            metavar="FILE.toml",
            help="Logo, names, document number and issue of your company.",
        ),
    ] = None,
    force: options.ForceOption = False,
) -> None:
    """Write a report on a design or any other law: gains, poles, certificates, stops and sources."""
    from wspd_design.reporting.report import write_report
    from wspd_design.reporting.sections.summary import verdict
    from wspd_design.reporting.template import BLANK, read_template
    from wspd_design.reporting.text import plain
    from wspd_design.studies.dossier import dossier

    check_plant(plant)
    paths = list(dict.fromkeys([output, output.with_suffix(".pdf")] if pdf else [output]))
    for path in paths:
        if path.suffix.lower() not in (".html", ".pdf"):
            raise UserError(f"report {path} must end in .html or .pdf, which chooses the format")
        check_output(path, force=force)
    letterhead = BLANK if template is None else read_template(template)
    chosen_name = chosen(name, controller)
    rail, disturbances = along_the_track(rail, disturbances)
    case = load_case(
        chosen_name,
        CaseOptions(vehicle=vehicle, rail=rail, slip=slip, sample_time=sample_time, sensors=sensors.words),
    )
    made = _reported(chosen_name, case)
    braked_from = initial_speed(speed, case.specification)
    stop = scenario(case.rail, disturbances, initial_speed=braked_from, seed=seed, vehicle=case.vehicle)
    with progress() as tell:
        computed = dossier(
            made,
            vehicle=case.vehicle_name,
            rail=case.rail_name,
            scenario=stop,
            specification=None if isinstance(made, Design) else case.specification,
            baselines=[other for other in FAMILIES if other not in (made.name, chosen_name)],
            command=shlex.join(["wspd", *sys.argv[1:]]),
            stop_command=stop_command(sys.argv[2:]),
            written="" if isinstance(made, Design) else chosen_name,
            plant=plant,
            stored=stored_beside(chosen_name),
            folder=Path(chosen_name).parent if is_design_file(chosen_name) else Path(),
            progress=tell,
        )
        tell("typesetting")
        write_report(computed, *paths, template=letterhead)
    judged = verdict(computed)
    style = (
        "bold green"
        if judged.status.tone == "good"
        else "bold red"
        if judged.status.tone == "bad"
        else "bold"
    )
    first, period, _ = plain(judged.sentence).partition(". ")
    console().print(f"{judged.status.sign} {first}{period}".rstrip(), style=style, markup=False)
    for path in paths:
        console().print(f"Written: {path}", style="bold", markup=False, soft_wrap=True)


def _reported(name: str, case: Case) -> Design | Law:
    """Return the design that the report is about, or the law where no rule chose its gains."""
    if case.design is not None:
        return case.design
    if name in FAMILIES and FAMILIES[name].gains is not None:
        return named_design(name, case.vehicle, case.rail, case.specification)
    return case.controller
