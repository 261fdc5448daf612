"""``wspd report``: everything about a design in one document."""

from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Annotated

import typer

from wspd_design.cli import options
from wspd_design.cli.arguments import check_plant, chosen
from wspd_design.cli.completion import names_or_files
from wspd_design.cli.console import console, progress
from wspd_design.cli.disturbances import StopOptions
from wspd_design.cli.exit_codes import GOOD, REFUTED
from wspd_design.cli.option_records import takes_records
from wspd_design.cli.output import check_output
from wspd_design.cli.report_call import ReportCall, compute, over_attachments
from wspd_design.cli.sensor_options import SensorOptions
from wspd_design.cli.stop_options import along_the_track
from wspd_design.design.case import load_case
from wspd_design.design.certification import stored_beside
from wspd_design.design.stop_requirements import TEMPLATES
from wspd_design.parameters.errors import UserError
from wspd_design.studies.inputs import DESIGN

if TYPE_CHECKING:
    from wspd_design.reporting.differences import Difference
    from wspd_design.studies.previous import Previous

_MOST_CHANGES = 20  # that the terminal shows


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
            "(wspd docs requirements).",
            autocompletion=names_or_files(TEMPLATES, ".toml"),
        ),
    ] = None,
    ladder: Annotated[
        bool,
        typer.Option("--ladder", help="Show the stop on every model of the vehicle, too (docs/models.md)."),
    ] = False,
    template: Annotated[
        Path | None,
        typer.Option(
            "--template",
            metavar="FILE.toml",
            help="Logo, names, document number and issue of your company.",
        ),
    ] = None,
    diff: Annotated[
        Path | None,
        typer.Option(
            "--diff",
            metavar="OLD",
            help="Older report, or its report.json, to tell the changes since then: here and in the report.",
            show_default=False,
        ),
    ] = None,
    replay: Annotated[
        Path | None,
        typer.Option(
            "--replay",
            metavar="FILE",
            help="Make this report again from its attachments and compare; nothing is written. A law of one's own is "
            "run only where CONTROLLER names the same file.",
            show_default=False,
        ),
    ] = None,
    force: options.ForceOption = False,
) -> None:
    """Write a report on a design or any other law: gains, poles, certificates, stops and sources."""
    from wspd_design.cli.received import older_report
    from wspd_design.reporting.attachments import TEMPLATE
    from wspd_design.reporting.report import write_report
    from wspd_design.reporting.sections.changes import since_previous
    from wspd_design.reporting.sections.summary import verdict
    from wspd_design.reporting.template import BLANK, read_template
    from wspd_design.reporting.text import plain

    if replay is not None:
        others = (controller, vehicle, rail, speed, slip, sample_time, template, diff, requirements)
        set_otherwise = (plant, seed, sensors, disturbances) != (
            options.PLANT,
            0,
            SensorOptions(),
            StopOptions(),
        )
        if any(others) or set_otherwise or pdf or force or ladder:
            raise UserError(f"--replay takes everything from {replay}; leave the other options out")
        _show_replay(replay, law=name)
        return
    check_plant(plant)
    paths = list(dict.fromkeys([output, output.with_suffix(".pdf")] if pdf else [output]))
    for path in paths:
        if path.suffix.lower() not in (".html", ".pdf"):
            raise UserError(f"report {path} must end in .html or .pdf, which chooses the format")
        check_output(path, force=force)
    older = None if diff is None else older_report(diff)
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
        ladder=ladder,
        sensors=sensors,
        disturbances=disturbances,
    )
    case = load_case(chosen_name, replace(call.case_options, vehicle=vehicle, rail=rail))
    call, inputs = over_attachments(case, call, older)
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
    if computed.idle:
        console().print(computed.adhesion_use, markup=False)
    for path in paths:
        console().print(f"Written: {path}", style="bold", markup=False, soft_wrap=True)
    if older is not None:
        _show_changes(older, since_previous(computed))


def _show_replay(path: Path, *, law: str | None) -> None:
    """Make a report again, say what is not the same, and end with the exit code."""
    from wspd_design.cli.replaying import replay
    from wspd_design.reporting.text import printable

    with progress() as tell:
        found = replay(path, law=law, progress=tell)
    out = console()
    if found.difference:
        out.print(f"✗ different: {printable(found.difference)}.", style="bold red", markup=False)
    else:
        size = f"{found.entries} numbers, verdicts and words, {found.files} attachments and every byte"
        out.print(f"✓ the same: {size} of {path}.", style="bold green", markup=False)
    if found.made_by:
        out.print("The report was made by something else than what is here:", markup=False)
    for each in found.made_by:
        out.print(f"  {printable(each)}", markup=False)
    raise typer.Exit(REFUTED if found.difference else GOOD)


def _show_changes(older: "Previous", found: "tuple[Difference, ...]") -> None:
    """Tell what is not as in the older report."""
    from wspd_design.reporting.sections.changes import shown, summary_of
    from wspd_design.reporting.text import printable

    out = console()
    since = f" of {older.made_at}" if older.made_at else ""
    out.print(f"Against the report{since}: {printable(summary_of(found))}.", style="bold", markup=False)
    for each in found[:_MOST_CHANGES]:
        before, after = shown(each)
        out.print(f"  {printable(each.place)}: {printable(before)}, now {printable(after)}", markup=False)
    if found[_MOST_CHANGES:]:
        out.print("  All others stand in the change record and in the two records.", markup=False)
