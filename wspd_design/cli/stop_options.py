"""From the options of a stop to its scenario."""

import re
from pathlib import Path

from wspd_design.cli.disturbances import StopOptions
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.files import available
from wspd_design.parameters.loading import load_rail
from wspd_design.parameters.records import Rail
from wspd_design.parameters.units import Dimension, parse_quantity
from wspd_design.simulation.records import Patch, Scenario, Sensing

_PATCH = re.compile(r"\s*(?P<start>\S+\s*[a-z]+)\s+(?P<rail>\S.*?)\s*")
_RISE_IN_RUN = re.compile(r"(?P<rise>\S+)\s*(?:in|:)\s*(?P<run>\S+)", re.IGNORECASE)
_GRADE = 'write "5 permille", "0.5 %", "1 in 200" or 0.005, negative downhill'


def scenario(rail: Rail, disturbances: StopOptions, *, initial_speed: float, seed: int) -> Scenario:
    """Return the stop that the user asks for.

    Parameters
    ----------
    rail : Rail
        Rail below all axles from the start, unless the options say otherwise.
    disturbances : StopOptions
        What disturbs the stop.
    initial_speed : float
        Of the train [m/s].
    seed : int
        Of all random numbers.
    """
    return Scenario(
        rail=rail,
        initial_speed=initial_speed,
        seed=seed,
        axle_rails=None if disturbances.axle_rails is None else _axle_rails(disturbances.axle_rails),
        patches=tuple(map(_patch, disturbances.patch or ())),
        grade=0.0 if disturbances.grade is None else _grade(disturbances.grade),
        pad_vibration=disturbances.pad_vibration,
        sensing=Sensing(
            speed_noise=_amount(disturbances.speed_noise, "speed", "speed noise"),
            pulses_per_turn=disturbances.pulses or 0,
            reference_error=0.0
            if disturbances.reference_error is None
            else _reference_error(disturbances.reference_error),
            dead_time=_amount(disturbances.dead_time, "time", "dead time"),
        ),
    )


def _axle_rails(text: str) -> tuple[Rail, ...]:
    """Read rails between commas; where a part is no rail, the comma belongs to the name of a file."""
    found: list[Rail] = []
    name = ""
    for part in text.split(","):
        name += part
        if name.strip() in available("rail") or Path(name.strip()).is_file():
            found.append(load_rail(name.strip()))
            name = ""
        else:
            name += ","
    if name:
        load_rail(name.partition(",")[0].strip())  # which says what is wrong with it
    return tuple(found)


def _patch(text: str) -> Patch:
    found = _PATCH.fullmatch(text)
    if found is None:
        raise UserError(
            f'--patch "{text}" must be a distance with its unit and a rail, such as "50 m polach-wet"'
        )
    start = parse_quantity(found["start"], "length", what="start of the patch")
    return Patch(start=start, rail=load_rail(found["rail"]))


def _grade(text: str) -> float:
    parts = _RISE_IN_RUN.fullmatch(text.strip())
    try:
        if parts is None:
            return parse_quantity(text, "ratio", what="grade")
        rise, run = (parse_quantity(part, "ratio", what="grade") for part in parts.groups())
        return rise / run
    except (UserError, ZeroDivisionError):
        raise UserError(f'grade "{text}" is not a number with permille or %; {_GRADE}') from None


def _amount(text: str | None, dimension: Dimension, what: str) -> float:
    """Read a quantity that must not be negative; nothing written is zero."""
    if text is None:
        return 0.0
    value = parse_quantity(text, dimension, what=what)
    if value < 0.0:
        raise UserError(f'{what} "{text}" must not be negative; leave the option out for none')
    return value


def _reference_error(text: str) -> float:
    value = parse_quantity(text, "ratio", what="reference error")
    if not -1.0 < value < 1.0:
        raise UserError(
            f'reference error "{text}" must lie between -100 % and 100 %; positive is a speed read too high'
        )
    return value
