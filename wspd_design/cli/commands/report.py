"""``wspd report``: everything about a design in one document."""

from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Annotated

import typer

from wspd_design.cli import options
from wspd_design.cli.arguments import check_plant, chosen
from wspd_design.cli.console import console, progress
from wspd_design.cli.disturbances import StopOptions
from wspd_design.cli.option_records import takes_records
from wspd_design.cli.output import check_output
from wspd_design.cli.report_call import ReportCall, compute, reported
from wspd_design.cli.sensor_options import SensorOptions
from wspd_design.cli.stop_options import along_the_track
from wspd_design.design.case import Case, load_case
from wspd_design.design.catalog import is_design_file
from wspd_design.design.certification import stored_beside
from wspd_design.design.records import Design
from wspd_design.design.stop_requirements import TEMPLATES, named_requirements
from wspd_design.parameters.errors import UserError
from wspd_design.studies.inputs import (
    DESIGN,
    attached_design,
    attached_name,
    command_input,
    design_input,
    law_inputs,
    parameter_inputs,
    required_rails,
    requirement_inputs,
    side_by_side,
)
from wspd_design.studies.provenance import InputFile


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
    requirements: Annotated[
        str | None,
        typer.Option(
            "--requirements",
            metavar="TEMPLATE|FILE.toml",
            help=f"Judge by these in place of those of the design: {', '.join(TEMPLATES)}, or a table of your own "
            "(docs/requirements.md).",
        ),
    ] = None,
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
    from wspd_design.reporting.attachments import TEMPLATE
    from wspd_design.reporting.report import write_report
    from wspd_design.reporting.sections.summary import verdict
    from wspd_design.reporting.template import BLANK, read_template
    from wspd_design.reporting.text import plain

    check_plant(plant)
    paths = list(dict.fromkeys([output, output.with_suffix(".pdf")] if pdf else [output]))
    for path in paths:
        if path.suffix.lower() not in (".html", ".pdf"):
            raise UserError(f"report {path} must end in .html or .pdf, which chooses the format")
        check_output(path, force=force)
    letterhead = BLANK if template is None else read_template(template)
    chosen_name = chosen(name, controller)
    rail, disturbances = along_the_track(rail, disturbances)
    call = ReportCall(
        law=chosen_name,
        vehicle="",
        rail="",
        plant=plant,
        speed=speed,
        slip=slip,
        sample_time=sample_time,
        seed=seed,
        template=None if letterhead == BLANK else TEMPLATE,
        requirements=requirements,
        sensors=sensors,
        disturbances=disturbances,
    )
    case = load_case(chosen_name, replace(call.case_options, vehicle=vehicle, rail=rail))
    call, inputs = _asked(chosen_name, case, call)
    with progress() as tell, TemporaryDirectory(prefix="wspd-") as folder:
        computed = compute(
            call,
            inputs,
            Path(folder),
            case=None if call.law == DESIGN else case,
            stored=stored_beside(chosen_name),
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


def _asked(name: str, case: Case, call: ReportCall) -> tuple[ReportCall, tuple[InputFile, ...]]:
    """Return the call over the files that it needs, and these files, the command among them."""
    made = reported(name, case)
    call = replace(call, vehicle=case.vehicle_name, rail=case.rail_name)
    rails, law_files = call.rails, law_inputs(name)
    if isinstance(made, Design):
        folder = Path(name).parent if is_design_file(name) else Path()
        rails = (*rails, *required_rails(made, folder))
        attached = attached_design(
            made, vehicle_name=case.vehicle_name, rail_name=case.rail_name, rail=case.rail
        )
        call = replace(call, law=DESIGN, slip=None, sample_time=None, sensors=SensorOptions())
        law_files = (design_input(attached),)
    wanted = None if call.requirements is None else named_requirements(call.requirements, case.specification)
    files = (
        *law_files,
        *requirement_inputs(call.requirements, wanted),
        *parameter_inputs("vehicle", case.vehicle_name),
        *(file for rail in rails for file in parameter_inputs("rail", rail)),
    )
    call = call.named(attached_name)
    return call, side_by_side((command_input(call.text), *files))
