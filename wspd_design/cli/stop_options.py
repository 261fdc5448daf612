"""From the options of a stop to its scenario."""

import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from wspd_design.cli.disturbances import StopOptions
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.files import available
from wspd_design.parameters.loading import load_rail, load_rail_profile, load_track_spectrum
from wspd_design.parameters.records import Rail, Vehicle
from wspd_design.parameters.units import Dimension, parse_quantity
from wspd_design.parameters.words import did_you_mean
from wspd_design.simulation.records import (
    FAULT_KINDS,
    IRREGULARITIES,
    Fault,
    Irregularities,
    LoadIrregularity,
    Patch,
    Scenario,
    Sensing,
)
from wspd_design.simulation.track import irregular_load, standard_deviation, synthesize

_PATCH = re.compile(r"\s*(?P<start>\S+\s*[a-z]+)\s+(?P<rail>\S.*?)\s*")
_FAULT = re.compile(
    r"\s*axle\s+(?P<axle>\d+)\s*:\s*(?P<kind>\S+)(?:\s+from\s+(?P<since>\S.*?))?\s*", re.IGNORECASE
)
_RISE_IN_RUN = re.compile(r"(?P<rise>\S+)\s*(?:in|:)\s*(?P<run>\S+)", re.IGNORECASE)
MOST_SPREAD = 0.2  # of the wheel loads: five standard deviations are the load
_GRADE = 'write "5 permille", "0.5 %", "1 in 200" or 0.005, negative downhill'


def along_the_track(rail: str | None, disturbances: StopOptions) -> tuple[str | None, StopOptions]:
    """Return the rail below the train at the start; where it changes along the track, the rest become patches.

    Parameters
    ----------
    rail : str or None
        What the user wrote.
    disturbances : StopOptions
        What disturbs the stop.
    """
    if rail is None:
        return rail, disturbances
    profile = load_rail_profile(rail)
    patches = [
        f"{start!r} m {name}" for start, name in zip(profile.starts[1:], profile.rails[1:], strict=True)
    ]
    if patches and (disturbances.patch or disturbances.axle_rails):
        other = "--patch" if disturbances.patch else "--axle-rails"
        raise UserError(
            f"rail {profile.name} changes along the track itself; leave {other} out or take another rail"
        )
    return profile.rails[0], replace(disturbances, patch=patches or disturbances.patch)


def scenario(
    rail: Rail, disturbances: StopOptions, *, initial_speed: float, seed: int, vehicle: Vehicle
) -> Scenario:
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
    vehicle : Vehicle
        Whose axles meet the irregular track one after the other.
    """
    return Scenario(
        rail=rail,
        initial_speed=initial_speed,
        seed=seed,
        axle_rails=None if disturbances.axle_rails is None else _axle_rails(disturbances.axle_rails),
        patches=tuple(map(_patch, disturbances.patch or ())),
        grade=0.0 if disturbances.grade is None else parse_grade(disturbances.grade),
        pad_vibration=disturbances.pad_vibration,
        sensing=_sensing(disturbances, vehicle),
        faults=tuple(_fault(text, vehicle) for text in disturbances.fault or ()),
        load_irregularity=None
        if disturbances.load_spread is None
        else _loads(disturbances.load_spread, vehicle, seed),
        irregularities=_irregularities(disturbances.irregularities),
    )


def _irregularities(text: str | None) -> Irregularities:
    """Read the level of the irregularities of the track."""
    level = "none" if text is None else text.strip().lower()
    if level not in IRREGULARITIES:
        offer = did_you_mean(level, IRREGULARITIES)
        raise UserError(
            f'--irregularities "{text}" names no level{offer}; it may be {", ".join(IRREGULARITIES)}'
        )
    return level


def _loads(text: str, vehicle: Vehicle, seed: int) -> LoadIrregularity:
    """Wheel loads with the shape of a drawn track."""
    spread = parse_quantity(text, "ratio", what="load spread")
    if not 0.0 <= spread <= MOST_SPREAD:
        raise UserError(
            f'load spread "{text}" must lie between 0 and {100.0 * MOST_SPREAD:g} %: a wheel would leave the rail'
        )
    track, channel = load_track_spectrum("erri-b176"), "vertical-high"
    return irregular_load(
        vehicle,
        synthesize(track, (channel,), seed=seed),
        sigma=standard_deviation(track, channel),
        spread=spread,
    )


def _sensing(disturbances: StopOptions, vehicle: Vehicle) -> Sensing:
    if disturbances.period_timing and disturbances.pulses is None:
        raise UserError("--period-timing needs a pulse wheel; add --pulses, for example --pulses 100")
    drift = disturbances.reference_drift
    return Sensing(
        speed_noise=_amount(disturbances.speed_noise, "speed", "speed noise"),
        pulses_per_turn=disturbances.pulses or 0,
        period_timing=disturbances.period_timing,
        reference_error=_error(disturbances.reference_error, "reference error", "a speed read"),
        reference_drift=0.0
        if drift is None
        else parse_quantity(drift, "acceleration", what="reference drift"),
        reference_noise=_amount(disturbances.reference_noise, "speed", "reference noise"),
        torque_error=_error(disturbances.torque_error, "torque error", "a torque computed"),
        accelerometer_bias=0.0
        if disturbances.accelerometer_bias is None
        else parse_quantity(disturbances.accelerometer_bias, "acceleration", what="accelerometer bias"),
        accelerometer_noise=_amount(disturbances.accelerometer_noise, "acceleration", "accelerometer noise"),
        radius_errors=()
        if disturbances.radius_errors is None
        else _radius_errors(disturbances.radius_errors, vehicle),
        dead_time=_of_valves(disturbances.dead_time, "dead time"),
        shortest_pulse=_of_valves(disturbances.shortest_pulse, "shortest pulse"),
    )


def _radius_errors(text: str, vehicle: Vehicle) -> tuple[float, ...]:
    """Read a relative error for each wheelset."""
    parts = text.split(",")
    if len(parts) != vehicle.wheelsets:
        raise UserError(
            f'radius errors "{text}" are {len(parts)}; give {vehicle.wheelsets} between commas, one for each wheelset '
            f"of vehicle {vehicle.name}, front axle first"
        )
    return tuple(_error(part, "radius error", "a radius taken") for part in parts)


def _fault(text: str, vehicle: Vehicle) -> Fault:
    """Read what fails where and when."""
    found = _FAULT.fullmatch(text)
    if found is None:
        raise UserError(
            f'--fault "{text}" must be an axle and what fails, such as "axle 2: valve-holds from 3 s"'
        )
    kind, axle = found["kind"].lower(), int(found["axle"])
    if kind not in FAULT_KINDS:
        offer = did_you_mean(kind, FAULT_KINDS)
        raise UserError(f'--fault "{text}" names no known fault{offer}; it may be {", ".join(FAULT_KINDS)}')
    if not 1 <= axle <= vehicle.wheelsets:
        raise UserError(
            f'--fault "{text}" must name an axle from 1 to {vehicle.wheelsets}, as vehicle {vehicle.name} has'
        )
    return Fault(axle=axle, kind=kind, since=_amount(found["since"], "time", "start of the fault"))


def rail_names(disturbances: StopOptions) -> tuple[str, ...]:
    """Return the rails that the options name."""
    below = () if disturbances.axle_rails is None else _axle_rail_names(disturbances.axle_rails)
    return (*below, *(_patch_parts(text)[1] for text in disturbances.patch or ()))


def with_rail_names(disturbances: StopOptions, named: Callable[[str], str]) -> StopOptions:
    """Return the options with other names of the same rails."""
    patches = [f"{start} {named(rail)}" for start, rail in map(_patch_parts, disturbances.patch or ())]
    below = disturbances.axle_rails
    return replace(
        disturbances,
        axle_rails=None if below is None else ",".join(map(named, _axle_rail_names(below))),
        patch=patches or None,
    )


def _axle_rails(text: str) -> tuple[Rail, ...]:
    return tuple(map(load_rail, _axle_rail_names(text)))


def _axle_rail_names(text: str) -> tuple[str, ...]:
    """Read rails between commas; where a part is no rail, the comma belongs to the name of a file."""
    found: list[str] = []
    name = ""
    for part in text.split(","):
        name += part
        if name.strip() in available("rail") or Path(name.strip()).is_file():
            found.append(name.strip())
            name = ""
        else:
            name += ","
    if name:
        load_rail(name.partition(",")[0].strip())  # which says what is wrong with it
    return tuple(found)


def _patch(text: str) -> Patch:
    start, rail = _patch_parts(text)
    return Patch(start=parse_quantity(start, "length", what="start of the patch"), rail=load_rail(rail))


def _patch_parts(text: str) -> tuple[str, str]:
    found = _PATCH.fullmatch(text)
    if found is None:
        raise UserError(
            f'--patch "{text}" must be a distance with its unit and a rail, such as "50 m polach-wet"'
        )
    return found["start"], found["rail"]


def parse_grade(text: str) -> float:
    """Read a grade, rise over run [-]."""
    parts = _RISE_IN_RUN.fullmatch(text.strip())
    try:
        if parts is None:
            return parse_quantity(text, "ratio", what="grade")
        rise, run = (parse_quantity(part, "ratio", what="grade") for part in parts.groups())
        return rise / run
    except (UserError, ZeroDivisionError):
        raise UserError(f'grade "{text}" is not a number with permille or %; {_GRADE}') from None


def _of_valves(text: str | None, what: str) -> float | None:
    """Read a time of the valves; nothing written is that of the vehicle."""
    return None if text is None else _amount(text, "time", what)


def _amount(text: str | None, dimension: Dimension, what: str) -> float:
    """Read a quantity that must not be negative; nothing written is zero."""
    if text is None:
        return 0.0
    value = parse_quantity(text, dimension, what=what)
    if value < 0.0:
        raise UserError(f'{what} "{text}" must not be negative; leave the option out for none')
    return value


def _error(text: str | None, what: str, positive: str) -> float:
    """Read a relative error; nothing written is none."""
    if text is None:
        return 0.0
    value = parse_quantity(text, "ratio", what=what)
    if not -1.0 < value < 1.0:
        raise UserError(f'{what} "{text}" must lie between -100 % and 100 %; positive is {positive} too high')
    return value
