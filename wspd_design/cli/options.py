"""The options that several commands share, each defined once; the defaults are the paper's case."""

from pathlib import Path
from typing import Annotated, Any, TypeAlias

import typer

from wspd_design.design.catalog import BASELINES, CONTROLLERS
from wspd_design.design.records import Specification
from wspd_design.parameters.loading import available
from wspd_design.parameters.units import format_quantity
from wspd_design.plants.names import DEFAULT_PLANT, PLANTS
from wspd_design.plants.quarter import Quarter

_PAPER = Specification()

VEHICLE = "er24pc"
RAIL = "polach-wet"
CONTROLLER = "afsmc"
PLANT = DEFAULT_PLANT
QUARTER = Quarter.name
LAW = "afsmc"
SPEED = format_quantity(_PAPER.speeds[1], "km/h")
SPEEDS = f"{format_quantity(_PAPER.speeds[0], 'km/h')} to {SPEED}"
SLIP = format_quantity(_PAPER.slip, "-")
SAMPLE_TIME = format_quantity(_PAPER.sample_time, "ms")
TOLERANCE = format_quantity(_PAPER.slip_tolerance, "-")
DESIGN_FILE = "design.toml"

CASE = "Case"
DISTURBANCES = "Disturbances, all off by default"
_CONTROLLERS = (
    f"{', '.join(CONTROLLERS)}, a design file, which brings its own case, or FILE.py:NAME "
    f"(docs/own-controller.md). {', '.join(BASELINES)} also with :textbook for the textbook tables."
)


def _names(names: list[str]) -> str:
    return f"{', '.join(names)} or a .toml file."


def _disturbance(flag: str, metavar: str, meaning: str) -> Any:
    return typer.Option(flag, metavar=metavar, help=meaning, show_default=False, rich_help_panel=DISTURBANCES)


def case_option(flag: str, metavar: str, meaning: str, default: str) -> Any:
    """Describe an option of the case that is None when it is not given, so that its default shows here."""
    return typer.Option(
        flag,
        metavar=metavar,
        help=f"{meaning} Default: {default}.",
        show_default=False,
        rich_help_panel=CASE,
    )


ControllerArgument: TypeAlias = Annotated[
    str | None,
    typer.Argument(metavar="CONTROLLER", help=f"{_CONTROLLERS} Default: {CONTROLLER}.", show_default=False),
]
ControllersArgument: TypeAlias = Annotated[
    list[str] | None,
    typer.Argument(metavar="CONTROLLER", help=f"{_CONTROLLERS} Default: all names.", show_default=False),
]
ControllerOption: TypeAlias = Annotated[
    str | None,
    typer.Option("--controller", metavar="NAME", help="The same as the argument.", show_default=False),
]
VehicleOption: TypeAlias = Annotated[
    str | None, case_option("--vehicle", "NAME", _names(available("vehicle")), VEHICLE)
]
RailOption: TypeAlias = Annotated[str | None, case_option("--rail", "NAME", _names(available("rail")), RAIL)]
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
    str, typer.Option("--speed", metavar="SPEED", help="Initial speed with its unit.", rich_help_panel=CASE)
]
StopSpeedOption: TypeAlias = Annotated[
    str | None,
    case_option("--speed", "SPEED", "Initial speed with its unit.", f"{SPEED}, or that of the witness"),
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
        "supply, and the torque that holds the slip (docs/json.md).",
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
AxleRailsOption: TypeAlias = Annotated[
    str | None,
    _disturbance(
        "--axle-rails",
        "R1,R2,R3,R4",
        "Rail below each axle, front first; --rail stays the one that controllers are designed for.",
    ),
]
PatchOption: TypeAlias = Annotated[
    list[str] | None,
    _disturbance(
        "--patch", '"START RAIL"', 'From START on another rail: "50 m polach-wet". Repeat it for several.'
    ),
]
GradeOption: TypeAlias = Annotated[
    str | None, _disturbance("--grade", "GRADE", 'Positive uphill: "5 permille" or "-0.5 %".')
]
PadVibrationOption: TypeAlias = Annotated[
    bool,
    typer.Option(
        "--pad-vibration",
        help="Vibration of the brake pads, T_d in Section 7 of the paper.",
        show_default=False,
        rich_help_panel=DISTURBANCES,
    ),
]
SpeedNoiseOption: TypeAlias = Annotated[
    str | None, _disturbance("--speed-noise", "SPEED", 'Of the measured rim speed, rms: "0.05 m/s".')
]
PulsesOption: TypeAlias = Annotated[
    int | None,
    typer.Option(
        "--pulses",
        min=1,
        metavar="NUMBER",
        help="Pulses per turn of the wheel that measures the speed, such as 80.",
        show_default=False,
        rich_help_panel=DISTURBANCES,
    ),
]
ReferenceErrorOption: TypeAlias = Annotated[
    str | None,
    _disturbance("--reference-error", "SHARE", 'Of the train speed that the controller knows: "2 %".'),
]
DeadTimeOption: TypeAlias = Annotated[
    str | None,
    _disturbance("--dead-time", "TIME", 'From command to valve, at most one sample time: "40 ms".'),
]
OnlyOption: TypeAlias = Annotated[
    list[str] | None, typer.Option("--only", metavar="CHECK", help="One check; repeat it for several.")
]
SearchTimeOption: TypeAlias = Annotated[
    str | None,
    typer.Option(
        "--search-time",
        metavar="TIME",
        help='How long to search for the proof of one claim before it stays undecided: "2 min". Default: 20 s.',
        show_default=False,
    ),
]
JsonOption: TypeAlias = Annotated[
    bool, typer.Option("--json", help="Print one JSON object and nothing else (docs/json.md).")
]
ForceOption: TypeAlias = Annotated[bool, typer.Option("--force", help="Replace an existing file.")]
