"""``wspd new vehicle``: some questions about a train, and a vehicle file with everything else worked out."""

from pathlib import Path
from typing import Annotated, TypeAlias

import typer
from rich.text import Text

from wspd_design.analysis.stopping import demanded_adhesion
from wspd_design.cli import options
from wspd_design.cli.console import WIDE, console, print_written, spaced, table
from wspd_design.cli.output import write_text
from wspd_design.cli.wizard.draft import ENDING
from wspd_design.cli.wizard.session import answer_option, answered_for_file, given_answers, print_answers
from wspd_design.cli.wizard.vehicle_answers import NONE, wanted_vehicle
from wspd_design.cli.wizard.vehicle_steps import vehicle_steps
from wspd_design.exchange.parameter_file import parameter_file
from wspd_design.parameters.provenance import Entry
from wspd_design.parameters.units import format_quantity
from wspd_design.studies.new_vehicle import ELECTRIC, PIPE, Wanted, derived_entries, derived_vehicle

VEHICLE_FILE = "vehicle.toml"
_COMMENTS = (
    "Written by wspd new vehicle. Every number may be changed; wspd docs vehicle-files says what each one means.",
    "Bounds are estimates of the uncertainty, which proofs and campaigns go through; a number without bounds is taken",
    'as exactly known. Short forms such as mass = "45 t" are read, too.',
)


FileArgument: TypeAlias = Annotated[
    Path | None,
    typer.Argument(
        metavar="FILE", help=f"Vehicle file to write. Default: {VEHICLE_FILE}.", show_default=False
    ),
]


def vehicle(
    output: FileArgument = None,
    kind: Annotated[
        str | None, answer_option("--kind", "NAME", "Shipped vehicle that it is most like.")
    ] = None,
    mass: Annotated[str | None, answer_option("--mass", "MASS", "Empty mass.")] = None,
    laden_mass: Annotated[
        str | None, answer_option("--laden-mass", "MASS", f"Laden mass, or {NONE}.")
    ] = None,
    weighs: Annotated[
        str | None, answer_option("--weighs", "YES", "Whether the brake weighs the load: yes or no.")
    ] = None,
    axles: Annotated[str | None, answer_option("--axles", "NUMBER", "Axles of the vehicle.")] = None,
    bogie_spacing: Annotated[
        str | None, answer_option("--bogie-spacing", "LENGTH", "Distance of the bogies, or of single axles.")
    ] = None,
    wheelbase: Annotated[str | None, answer_option("--wheelbase", "LENGTH", "Wheelbase of a bogie.")] = None,
    wheel_diameter: Annotated[
        str | None, answer_option("--wheel-diameter", "LENGTH", "Diameter of new wheels.")
    ] = None,
    rotating_mass: Annotated[
        str | None, answer_option("--rotating-mass", "MASS", "Rotating mass, or % of the empty mass.")
    ] = None,
    speed: Annotated[
        str | None, answer_option("--speed", "SPEED", "From which the deceleration holds.")
    ] = None,
    deceleration: Annotated[
        str | None,
        answer_option("--deceleration", "DECEL", "Mean of the fully developed brake, after EN 14531."),
    ] = None,
    build_up: Annotated[
        str | None, answer_option("--build-up", "WORD", f"Build-up of the brake: {PIPE} or {ELECTRIC}.")
    ] = None,
    build_up_delay: Annotated[
        str | None, answer_option("--build-up-delay", "TIME", f"Dead time of an {ELECTRIC} demand.")
    ] = None,
    build_up_time: Annotated[
        str | None,
        answer_option("--build-up-time", "TIME", f"Until 95 % of the pressure; {ELECTRIC}, the ramp."),
    ] = None,
    fill_time: Annotated[str | None, answer_option("--fill-time", "TIME", "T_F of the valve.")] = None,
    vent_time: Annotated[str | None, answer_option("--vent-time", "TIME", "T_V of the valve.")] = None,
    answers_file: options.AnswersOption = None,
    show_answers: options.PrintAnswersOption = False,
    yes: Annotated[bool, typer.Option("--yes", help="Ask nothing; the kind answers what is left.")] = False,
    resume: Annotated[
        Path | None,
        typer.Option("--resume", metavar="FILE", help=f"Go on with the answers of a {ENDING} file."),
    ] = None,
    force: options.ForceOption = False,
) -> None:
    """Answer some questions about a train and get its vehicle file; everything else is worked out and shown."""
    given = {
        "kind": kind,
        "mass": mass,
        "laden_mass": laden_mass,
        "weighs": weighs,
        "axles": axles,
        "bogie_spacing": bogie_spacing,
        "wheelbase": wheelbase,
        "wheel_diameter": wheel_diameter,
        "rotating_mass": rotating_mass,
        "speed": speed,
        "deceleration": deceleration,
        "build_up": build_up,
        "build_up_delay": build_up_delay,
        "build_up_time": build_up_time,
        "fill_time": fill_time,
        "vent_time": vent_time,
    }
    if show_answers:
        said_before = {key: answer for key, answer in given.items() if answer is not None}
        print_answers(
            vehicle_steps(),
            {**given_answers(vehicle_steps(), answers_file, None), **said_before},
            "wspd new vehicle",
        )
        return
    target, answers, said = answered_for_file(
        "vehicle",
        vehicle_steps(),
        given,
        output=output,
        default=VEHICLE_FILE,
        resume=resume,
        file=answers_file,
        yes=yes,
        force=force,
        by_default="the kind answers",
    )
    wanted = wanted_vehicle(answers, said)
    entries = derived_entries(wanted)
    made = derived_vehicle(target.stem, wanted)  # before the file is there: it must be a vehicle
    write_text(target, parameter_file(f"Own vehicle, like {wanted.kind}", _COMMENTS, entries), force=force)
    if resume is not None:
        resume.unlink()
    _show(target, entries, wanted, demanded_adhesion(made))


def _show(target: Path, entries: tuple[Entry, ...], wanted: Wanted, demand: float) -> None:
    """Print what was worked out, by which rule, and what to do with the file."""
    out = console()
    wide = out.width >= WIDE
    shown = table("Number", "Value", "Rule") if wide else table("Number", "Rule")
    for entry in entries:
        if entry.status != "derived" or not isinstance(entry.value, float):
            continue
        value = format_quantity(entry.value, entry.unit)
        if wide:
            shown.add_row(entry.name, value, Text(entry.at))
        else:
            shown.add_row(Text(entry.name).append("\n= ", style="dim").append(value), Text(entry.at))
    out.print(spaced(shown))
    taken = [entry.name for entry in entries if entry.source == f"vehicle {wanted.kind}"]
    out.print(f"As of {wanted.kind}, and to be checked: {', '.join(taken)}.", markup=False)
    out.print(f"Fully applied, the brake asks for an adhesion of {demand:.3f}.", markup=False)
    print_written(
        target,
        ("See it", ("sources", target)),
        ("Check it", ("brake", "--vehicle", target)),
        ("Design", ("design", "--vehicle", target, "--rail", "low-adhesion", "-o", "design.toml")),
    )
