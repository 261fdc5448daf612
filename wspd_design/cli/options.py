"""The options that several commands share, each defined once; the defaults are the paper's case."""

from typing import Annotated, TypeAlias

import typer

from wspd_design.design.catalog import CONTROLLERS
from wspd_design.design.records import Specification
from wspd_design.parameters.loading import available
from wspd_design.parameters.units import format_quantity

_PAPER = Specification()

VEHICLE = "er24pc"
RAIL = "polach-wet"
CONTROLLER = "afsmc"
PLANT = "quarter"
LAW = "afsmc"
SPEED = format_quantity(_PAPER.speeds[1], "km/h")
SPEEDS = f"{format_quantity(_PAPER.speeds[0], 'km/h')} to {SPEED}"
SLIP = format_quantity(_PAPER.slip, "-")
SAMPLE_TIME = format_quantity(_PAPER.sample_time, "ms")
TOLERANCE = format_quantity(_PAPER.slip_tolerance, "-")
DESIGN_FILE = "design.toml"

_CASE = "Case"
_CONTROLLERS = f"{', '.join(CONTROLLERS)} or a design file."


def _names(names: list[str]) -> str:
    return f"{', '.join(names)} or a .toml file."


ControllerArgument: TypeAlias = Annotated[
    str | None,
    typer.Argument(metavar="[CONTROLLER]", help=_CONTROLLERS, show_default=CONTROLLER),
]
ControllersArgument: TypeAlias = Annotated[
    list[str] | None,
    typer.Argument(metavar="[CONTROLLER]...", help=_CONTROLLERS, show_default=", ".join(CONTROLLERS)),
]
ControllerOption: TypeAlias = Annotated[
    str | None,
    typer.Option("--controller", metavar="NAME", help="The same as the argument.", show_default=False),
]
VehicleOption: TypeAlias = Annotated[
    str | None,
    typer.Option(
        "--vehicle",
        metavar="NAME",
        help=_names(available("vehicle")),
        show_default=VEHICLE,
        rich_help_panel=_CASE,
    ),
]
RailOption: TypeAlias = Annotated[
    str | None,
    typer.Option(
        "--rail", metavar="NAME", help=_names(available("rail")), show_default=RAIL, rich_help_panel=_CASE
    ),
]
PlantOption: TypeAlias = Annotated[
    str, typer.Option("--plant", metavar="NAME", help="Model of the vehicle: quarter.", rich_help_panel=_CASE)
]
SpeedOption: TypeAlias = Annotated[
    str,
    typer.Option("--speed", metavar="SPEED", help="Initial speed with its unit.", rich_help_panel=_CASE),
]
SpeedsOption: TypeAlias = Annotated[
    tuple[str, str] | None,
    typer.Option(
        "--speeds",
        metavar="LOW HIGH",
        help="Range of speeds of the specification.",
        show_default=SPEEDS,
        rich_help_panel=_CASE,
    ),
]
SlipOption: TypeAlias = Annotated[
    str | None,
    typer.Option(
        "--slip", metavar="SLIP", help="Slip reference in (0, 1).", show_default=SLIP, rich_help_panel=_CASE
    ),
]
SampleTimeOption: TypeAlias = Annotated[
    str | None,
    typer.Option(
        "--sample-time",
        metavar="TIME",
        help="Of the controller.",
        show_default=SAMPLE_TIME,
        rich_help_panel=_CASE,
    ),
]
SeedOption: TypeAlias = Annotated[
    int, typer.Option("--seed", min=0, help="Seed of all random numbers.", rich_help_panel=_CASE)
]
JsonOption: TypeAlias = Annotated[
    bool, typer.Option("--json", help="Print one JSON object and nothing else (docs/json.md).")
]
ForceOption: TypeAlias = Annotated[bool, typer.Option("--force", help="Replace an existing file.")]
