"""What each stop draws, as files state it: tables of numbers with units, by the dotted names of the drawing."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from wspd_design.parameters.errors import UserError
from wspd_design.parameters.schema import schema_of
from wspd_design.parameters.units import Dimension, parse_quantity, units_of
from wspd_design.simulation.draws import FILE_KINDS, About, Choice, Distribution, Draw, Normal, Uniform

STOP_DIMENSIONS: Mapping[str, Dimension] = {
    "stop.initial_speed": "speed",
    "stop.grade": "ratio",
    "stop.pad_vibration": "ratio",
    "stop.start.slip": "ratio",
    "stop.start.torque": "torque",
    "stop.start.braking_time": "time",
    "stop.sensing.speed_noise": "speed",
    "stop.sensing.pulses_per_turn": "ratio",
    "stop.sensing.period_timing": "ratio",
    "stop.sensing.reference_error": "ratio",
    "stop.sensing.reference_drift": "acceleration",
    "stop.sensing.reference_noise": "speed",
    "stop.sensing.torque_error": "ratio",
    "stop.sensing.accelerometer_bias": "acceleration",
    "stop.sensing.accelerometer_noise": "acceleration",
    "stop.sensing.dead_time": "time",
    "stop.sensing.shortest_pulse": "time",
}
"""What the numbers of a stop are measured in; a test holds that every one of them stands here."""

_FORMS = (
    '{ uniform = ["LOW", "HIGH"] }, { normal = ["MEAN", "DEVIATION"], within = ["LOW", "HIGH"] }, '
    '{ choice = ["ONE", "OTHER"] } or { about = "SHARE" }, evenly about the nominal number'
)


def read_draws(table: dict[str, Any], where: str) -> tuple[Draw, ...]:
    """Read the table [draw] of a file; the dots of its names stand in quotes or not.

    Parameters
    ----------
    table : dict
        As TOML gives it.
    where : str
        The file, in sentences.

    Raises
    ------
    UserError
        If a spread has no such form or a number no unit; that there is such a number is for the drawing to say.
    """
    return tuple(_draw(name, spread, f"{name} of [draw] in {where}") for name, spread in flat(table))


def draws_text(draws: Sequence[Draw]) -> str:
    """Return the lines of the table [draw]; reading them gives the same draws back."""
    lines = []
    for draw in draws:
        dimension = dimension_of(draw.name)
        assert dimension is not None, "a draw that was read has a dimension"
        spread = ", ".join(f"{key} = {listed}" for key, listed in _spread(draw.distribution, dimension))
        lines.append(f'"{draw.name}" = {{ {spread} }}')
    return "\n".join(lines)


def quantity_text(value: float, dimension: Dimension) -> str:
    """Return a number with its SI unit, as a TOML text that is read back to the last bit."""
    unit = units_of(dimension)[0]
    return f'"{value!r}"' if unit == "-" else f'"{value!r} {unit}"'


def _spread(distribution: Distribution | About, dimension: Dimension) -> list[tuple[str, str]]:
    def listed(*values: float) -> str:
        return f"[{', '.join(quantity_text(value, dimension) for value in values)}]"

    match distribution:
        case Normal(mean=mean, deviation=deviation, low=low, high=high):
            return [("normal", listed(mean, deviation)), ("within", listed(low, high))]
        case Choice(values=values):
            return [("choice", listed(*values))]
        case About(share=share):
            return [("about", quantity_text(share, "ratio"))]
        case _:
            return [("uniform", listed(*distribution.ends))]


def flat(table: dict[str, Any], above: str = "") -> list[tuple[str, Any]]:
    """Return names and values of a table, whether their dots stand in quotes or not."""
    found = []
    for key, value in table.items():
        name = f"{above}{key}"
        if isinstance(value, dict) and not set(value) & {*_SPREADS, "about"}:
            found += flat(value, f"{name}.")
        else:
            found.append((name, value))
    return found


def _draw(name: str, spread: Any, place: str) -> Draw:
    dimension = dimension_of(name)
    kinds = [kind for kind in (*_SPREADS, "about") if isinstance(spread, dict) and kind in spread]
    if len(kinds) != 1:
        raise UserError(f"{place} must be one of {_FORMS}")
    unknown = set(spread) - {kinds[0], *(("within",) if kinds[0] == "normal" else ())}
    if unknown:
        raise UserError(f'{place} has an unknown key "{min(unknown)}" beside {kinds[0]}; leave it out')

    if kinds == ["about"]:
        return Draw(name=name, distribution=About(share=number_of(spread["about"], "ratio", place)))

    def numbers(key: str, count: int | None) -> list[float]:
        listed = spread.get(key)
        if not isinstance(listed, list) or not listed or (count is not None and len(listed) != count):
            wanted = "one or more" if count is None else str(count)
            raise UserError(f"{key} of {place} must be a list of {wanted} quantities with their units")
        return [number_of(each, dimension, place) for each in listed]

    return Draw(name=name, distribution=_SPREADS[kinds[0]](numbers))


_SPREADS: dict[str, Callable[[Callable[[str, int | None], list[float]]], Distribution]] = {
    "uniform": lambda numbers: Uniform(**dict(zip(("low", "high"), numbers("uniform", 2), strict=True))),
    "normal": lambda numbers: Normal(
        **dict(
            zip(
                ("mean", "deviation", "low", "high"), numbers("normal", 2) + numbers("within", 2), strict=True
            )
        )
    ),
    "choice": lambda numbers: Choice(values=tuple(numbers("choice", None))),
}


def number_of(given: Any, dimension: Dimension | None, place: str) -> float:
    """Read a number with its unit; a ratio may stand alone."""
    if isinstance(given, int | float) and not isinstance(given, bool) and dimension in ("ratio", None):
        return float(given)
    if not isinstance(given, str):
        raise UserError(f'{given!r} of {place} must be text with its unit, such as "1 m/s"')
    return parse_quantity(given, dimension or "ratio", what=place)


def dimension_of(name: str) -> Dimension | None:
    """Return what a number is measured in; None where there is no such number, which the drawing says."""
    root, _, rest = name.partition(".")
    if root in FILE_KINDS:
        quantity = schema_of(FILE_KINDS[root], "").get(rest)
        return None if quantity is None else quantity.dimension
    return STOP_DIMENSIONS.get(name)
