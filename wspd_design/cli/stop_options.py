"""From the options of a stop to its scenario, and back to words."""

import re
from dataclasses import dataclass

from wspd_design.cli.case import parse_speed
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import load_rail
from wspd_design.parameters.records import Rail
from wspd_design.parameters.units import Dimension, parse_quantity
from wspd_design.simulation.records import Patch, Scenario, Sensing

_PATCH = re.compile(r"\s*(?P<start>\S+\s*[a-z]+)\s+(?P<rail>\S.*?)\s*")
_PERMILLE = re.compile(r"(?P<number>.*\d)\s*(?:‰|per ?mil(?:le)?)", re.IGNORECASE)
_GRADE = 'write "5 permille", "0.5 %" or 0.005, negative downhill'


@dataclass(frozen=True, slots=True, kw_only=True)
class StopWords:
    """What the user wrote about the stop; None where nothing was written."""

    speed: str
    seed: int
    axle_rails: str | None = None
    patches: list[str] | None = None
    grade: str | None = None
    pad_vibration: bool = False
    speed_noise: str | None = None
    pulses: int | None = None
    reference_error: str | None = None
    dead_time: str | None = None


def scenario(rail: Rail, words: StopWords) -> Scenario:
    """Return the stop that the user asks for.

    Parameters
    ----------
    rail : Rail
        Rail below all axles from the start, unless the words say otherwise.
    words : StopWords
        The options.
    """
    return Scenario(
        rail=rail,
        initial_speed=parse_speed(words.speed),
        seed=words.seed,
        axle_rails=None if words.axle_rails is None else _axle_rails(words.axle_rails),
        patches=tuple(map(_patch, words.patches or ())),
        grade=0.0 if words.grade is None else _grade(words.grade),
        pad_vibration=words.pad_vibration,
        sensing=Sensing(
            speed_noise=_amount(words.speed_noise, "speed", "speed noise"),
            pulses_per_turn=words.pulses or 0,
            reference_error=0.0 if words.reference_error is None else _reference_error(words.reference_error),
            dead_time=_amount(words.dead_time, "time", "dead time"),
        ),
    )


def rails_of(stop: Scenario) -> str:
    """Say on which rails a stop runs."""
    names = "/".join(rail.name for rail in stop.axle_rails) if stop.axle_rails else stop.rail.name
    return ", ".join((names, *(f"{patch.rail.name} from {patch.start:g} m" for patch in stop.patches)))


def disturbances_of(stop: Scenario) -> str:
    """Say what disturbs a stop besides its rails; empty for nothing."""
    sensing = stop.sensing
    said = (
        (stop.grade, f"grade {1e3 * stop.grade:g} permille"),
        (stop.pad_vibration, "pad vibration"),
        (sensing.speed_noise, f"speed noise {sensing.speed_noise:g} m/s rms"),
        (sensing.pulses_per_turn, f"{sensing.pulses_per_turn} pulses per turn"),
        (sensing.reference_error, f"reference error {100.0 * sensing.reference_error:g} %"),
        (sensing.dead_time, f"dead time {1e3 * sensing.dead_time:g} ms"),
    )
    return ", ".join(words for present, words in said if present)


def _axle_rails(text: str) -> tuple[Rail, ...]:
    return tuple(load_rail(name.strip()) for name in text.split(","))


def _patch(text: str) -> Patch:
    found = _PATCH.fullmatch(text)
    if found is None:
        raise UserError(
            f'--patch "{text}" must be a distance with its unit and a rail, such as "50 m polach-wet"'
        )
    start = parse_quantity(found["start"], "length", what="start of the patch")
    return Patch(start=start, rail=load_rail(found["rail"]))


def _grade(text: str) -> float:
    permille = _PERMILLE.fullmatch(text.strip())
    try:
        value = parse_quantity(permille["number"] if permille else text, "ratio", what="grade")
    except UserError:
        raise UserError(f'grade "{text}" is no number with permille or %; {_GRADE}') from None
    return value / 1000.0 if permille else value


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
