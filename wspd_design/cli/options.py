"""The options that several commands share, each defined once; the defaults are the paper's case."""

from pathlib import Path
from typing import Annotated, Any, TypeAlias

import typer

from wspd_design.cli.completion import Offers, checks, names_or_files
from wspd_design.controllers.family import FAMILIES, designed, with_presets
from wspd_design.design.case import RAIL, VEHICLE
from wspd_design.design.records import Specification
from wspd_design.parameters.loading import available
from wspd_design.parameters.schema import PRESETS
from wspd_design.parameters.units import format_quantity
from wspd_design.plants.names import DEFAULT_PLANT, PLANTS
from wspd_design.plants.quarter import Quarter

_PAPER = Specification()

CONTROLLER = "afsmc"
PLANT = DEFAULT_PLANT
QUARTER = Quarter.name
LAW = "afsmc"
LAWS = " or ".join(family.name for family in designed())
SPEED = format_quantity(_PAPER.speeds[1], "km/h")
SPEEDS = f"{format_quantity(_PAPER.speeds[0], 'km/h')} to {SPEED}"
SLIP = format_quantity(_PAPER.slip, "-")
SAMPLE_TIME = format_quantity(_PAPER.sample_time, "ms")
TOLERANCE = format_quantity(_PAPER.slip_tolerance, "-")
DESIGN_FILE = "design.toml"

CASE = "Case"
_CONTROLLERS = (
    f"{', '.join(FAMILIES)}, a design file, which brings its own case, or FILE.py:NAME "
    f"(wspd docs own-controller). {', '.join(family.name for family in with_presets())} also with "
    f":{' or :'.join(PRESETS)} for their tables; without, those that belong to the vehicle."
)


def _names(names: list[str]) -> str:
    return f"{', '.join(names)} or a .toml file."


def case_option(flag: str, metavar: str, meaning: str, default: str, offers: Offers | None = None) -> Any:
    """Describe an option of the case that is None when it is not given, so that its default shows here."""
    return typer.Option(
        flag,
        metavar=metavar,
        help=f"{meaning} Default: {default}.",
        show_default=False,
        rich_help_panel=CASE,
        autocompletion=offers,
    )


_OFFERED = names_or_files(FAMILIES, ".toml", ".py")
ControllerArgument: TypeAlias = Annotated[
    str | None,
    typer.Argument(
        metavar="CONTROLLER",
        help=f"{_CONTROLLERS} Default: {CONTROLLER}.",
        show_default=False,
        autocompletion=_OFFERED,
    ),
]
ControllersArgument: TypeAlias = Annotated[
    list[str] | None,
    typer.Argument(
        metavar="CONTROLLER",
        help=f"{_CONTROLLERS} Default: all names.",
        show_default=False,
        autocompletion=_OFFERED,
    ),
]
ControllerOption: TypeAlias = Annotated[
    str | None,
    typer.Option("--controller", metavar="NAME", help="The same as the argument.", show_default=False),
]
VehicleOption: TypeAlias = Annotated[
    str | None,
    case_option(
        "--vehicle",
        "NAME",
        _names(available("vehicle")),
        VEHICLE,
        names_or_files(available("vehicle"), ".toml"),
    ),
]
RailOption: TypeAlias = Annotated[
    str | None,
    case_option(
        "--rail", "NAME", _names(available("rail")), RAIL, names_or_files(available("rail"), ".toml")
    ),
]
PlantOption: TypeAlias = Annotated[
    str,
    typer.Option(
        "--plant", metavar="NAME", help=f"Model of the vehicle: {' or '.join(PLANTS)}.", rich_help_panel=CASE
    ),
]
QuarterOption: TypeAlias = Annotated[
    str,
    typer.Option("--plant", metavar="NAME", help="Model of the vehicle: quarter only.", rich_help_panel=CASE),
]
SpeedOption: TypeAlias = Annotated[
    str | None,
    case_option("--speed", "SPEED", "Initial speed with its unit.", f"top of the design's range, {SPEED}"),
]
StopSpeedOption: TypeAlias = Annotated[
    str | None,
    case_option(
        "--speed",
        "SPEED",
        "Initial speed with its unit.",
        f"top of the design's range, {SPEED}, or that of the witness",
    ),
]
StopPlantOption: TypeAlias = Annotated[
    str | None,
    case_option(
        "--plant",
        "NAME",
        f"Model of the vehicle: {' or '.join(PLANTS)}.",
        f"{PLANT}, but {QUARTER} with --from-witness",
    ),
]
FromWitnessOption: TypeAlias = Annotated[
    Path | None,
    typer.Option(
        "--from-witness",
        metavar="FILE",
        help="Start at the witness of a certificate that is REFUTED: its slip, speed, mass, inertia and mu0, full "
        "supply, and the torque that holds the slip (wspd docs json).",
        show_default=False,
        rich_help_panel=CASE,
    ),
]
SpeedsOption: TypeAlias = Annotated[
    tuple[str, str] | None, case_option("--speeds", "LOW HIGH", "Range of operation.", SPEEDS)
]
SlipOption: TypeAlias = Annotated[
    str | None, case_option("--slip", "SLIP", "Slip reference in (0, 1).", SLIP)
]
SampleTimeOption: TypeAlias = Annotated[
    str | None,
    case_option("--sample-time", "TIME", "Of the controller.", SAMPLE_TIME),
]
SeedOption: TypeAlias = Annotated[
    int,
    typer.Option("--seed", min=0, metavar="NUMBER", help="Seed of all random numbers.", rich_help_panel=CASE),
]
OnlyOption: TypeAlias = Annotated[
    list[str] | None,
    typer.Option("--only", metavar="CHECK", help="One check; repeat it for several.", autocompletion=checks),
]
EffortOption: TypeAlias = Annotated[
    float,
    typer.Option(
        "--effort",
        metavar="FACTOR",
        min=0.01,
        max=1000.0,
        help="How hard to search before a claim stays undecided, as a multiple of the usual work. Work is counted, so "
        "that a busy machine comes to the same verdict.",
    ),
]
JsonOption: TypeAlias = Annotated[
    bool, typer.Option("--json", help="Print one JSON object and nothing else (wspd docs json).")
]
ForceOption: TypeAlias = Annotated[bool, typer.Option("--force", help="Replace an existing file.")]
AnswersOption: TypeAlias = Annotated[
    Path | None,
    typer.Option(
        "--answers",
        metavar="FILE",
        help="Take answers from a file, as --print-answers shows it and the wizard keeps it.",
        show_default=False,
        rich_help_panel="Answers, in place of questions",
    ),
]
PrintAnswersOption: TypeAlias = Annotated[
    bool,
    typer.Option(
        "--print-answers",
        help="Print a file of answers with what each means, and ask nothing.",
        rich_help_panel="Answers, in place of questions",
    ),
]
