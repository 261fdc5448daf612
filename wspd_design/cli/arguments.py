"""Arguments that several commands read in the same way."""

from wspd_design.cli.options import CONTROLLER, QUARTER
from wspd_design.design.records import Specification
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.units import parse_quantity
from wspd_design.parameters.words import did_you_mean
from wspd_design.plants.names import PLANTS


def parse_speed(text: str) -> float:
    """Read a speed [m/s]."""
    return parse_quantity(text, "speed", what="speed")


def initial_speed(written: str | None, specification: Specification) -> float:
    """Return the speed at which a stop begins [m/s]: the top of the range where nothing was written."""
    return specification.speeds[1] if written is None else parse_speed(written)


def chosen(argument: str | None, option: str | None) -> str:
    """Return the controller, which may stand as an argument or after ``--controller``."""
    if argument is not None and option is not None and argument != option:
        raise UserError(f'two controllers are given, "{argument}" and --controller "{option}"; leave one out')
    return argument or option or CONTROLLER


def check_plant(name: str) -> None:
    """Refuse a plant that does not exist."""
    if name not in PLANTS:
        raise UserError(f'unknown plant "{name}"{did_you_mean(name, PLANTS)}; available: {", ".join(PLANTS)}')


def check_quarter(name: str, command: str) -> None:
    """Refuse a plant other than the quarter model, which the analysis at a point speaks about."""
    check_plant(name)
    if name != QUARTER:
        raise UserError(
            f"{command} speaks about the quarter model, whose wheelsets are alike, not about {name}; "
            f"leave --plant out or write --plant {QUARTER}"
        )
