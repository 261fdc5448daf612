"""Units: a closed table of spellings, and numbers with units in text.

Inside the program all numbers are SI floats. Units appear only where people read or write: in parameter
files, on the command line and in reports.
"""

import math
import re
from difflib import get_close_matches
from fractions import Fraction
from typing import Literal, TypeAlias

from wspd_design.parameters.errors import UserError

Dimension: TypeAlias = Literal[
    "ratio",
    "speed",
    "acceleration",
    "time",
    "rate",
    "frequency",
    "length",
    "volume",
    "mass",
    "inertia",
    "force",
    "torque",
    "pressure",
    "linear resistance",
    "quadratic resistance",
    "stiffness",
    "rotational stiffness",
    "rotational damping",
    "1/speed",
    "torque rate",
    "power",
    "temperature",
    "heat capacity",
    "heat flow",
    "1/length",
    "1/length^2",
    "1/length^3",
    "1/length^4",
    "1/length^6",
]

# Spelling -> SI value of one unit, exactly. Radians count as one: spectra over rad/m have powers of 1/m.
_ONE = Fraction(1)
_TABLE: dict[Dimension, dict[str, Fraction]] = {
    "ratio": {"-": _ONE, "%": Fraction(1, 100), "permille": Fraction(1, 1000)},
    "speed": {"m/s": _ONE, "km/h": Fraction(10, 36), "mph": Fraction(44704, 100000)},
    "acceleration": {"m/s^2": _ONE},
    "time": {"s": _ONE, "ms": Fraction(1, 1000), "min": Fraction(60)},
    "rate": {"1/s": _ONE},
    "frequency": {"Hz": _ONE},
    "length": {"m": _ONE, "mm": Fraction(1, 1000), "km": Fraction(1000)},
    "volume": {"m^3": _ONE, "l": Fraction(1, 1000)},
    "mass": {"kg": _ONE, "t": Fraction(1000)},
    "inertia": {"kg m^2": _ONE},
    "force": {"N": _ONE, "kN": Fraction(1000)},
    "torque": {"N m": _ONE, "kN m": Fraction(1000)},
    "pressure": {"Pa": _ONE, "bar": Fraction(100000), "MPa": Fraction(1000000), "GPa": Fraction(1000000000)},
    "linear resistance": {"N s/m": _ONE, "kN s/m": Fraction(1000)},
    "quadratic resistance": {"N s^2/m^2": _ONE},
    "stiffness": {"N/m": _ONE, "kN/m": Fraction(1000), "MN/m": Fraction(1000000)},
    "rotational stiffness": {"N m/rad": _ONE, "kN m/rad": Fraction(1000), "MN m/rad": Fraction(1000000)},
    "rotational damping": {"N m s": _ONE, "kN m s": Fraction(1000)},
    "1/speed": {"s/m": _ONE},
    "torque rate": {"N m/s": _ONE, "kN m/s": Fraction(1000)},
    "power": {"W": _ONE, "kW": Fraction(1000), "MW": Fraction(1000000)},
    "temperature": {"K": _ONE},
    "heat capacity": {"J/K": _ONE, "kJ/K": Fraction(1000)},
    "heat flow": {"W/K": _ONE},
    "1/length": {"1/m": _ONE},
    "1/length^2": {"1/m^2": _ONE},
    "1/length^3": {"1/m^3": _ONE},
    "1/length^4": {"1/m^4": _ONE},
    "1/length^6": {"1/m^6": _ONE},
}

_UNITS: dict[str, Dimension] = {unit: dimension for dimension, row in _TABLE.items() for unit in row}

_EXAMPLES: dict[Dimension, str] = {"speed": "120 km/h", "time": "100 ms", "mass": "76.8 t"}

KMH = 3.6
"""Kilometres per hour in one metre per second."""

_NUMBER = re.compile(
    r"(?P<number>[+-]?(?:\d+(?:[.,]\d*)?|[.,]\d+)(?:[eE][+-]?\d+)?)\s*(?P<unit>.*)", re.DOTALL
)
_THOUSANDS = re.compile(r"[+-]?[1-9]\d{0,2},\d{3}")


def _plain(spelling: str) -> str:
    """Strip what people vary in a unit without changing its meaning: ``kNm``, ``kN*m``; ``m/s2``."""
    return spelling.replace("²", "2").translate(str.maketrans("", "", " *·^"))


_SPELLINGS: dict[str, str] = {_plain(spelling): spelling for spelling in _UNITS} | {
    "‰": "permille",
    "permil": "permille",
}
_MINUS = str.maketrans("\u2212\u2013", "--")  # what word processors make of a hyphen before a number


def units_of(dimension: Dimension) -> tuple[str, ...]:
    """Return the spellings of the units of a dimension, SI unit first."""
    return tuple(_TABLE[dimension])


def dimension_of(unit: str) -> Dimension:
    """Return the dimension of a unit; an unknown spelling raises :class:`UserError`."""
    return _UNITS[_spelling(unit)]


def to_si(value: float, unit: str) -> float:
    """Convert a number from a unit of the table to SI units.

    Parameters
    ----------
    value : float
        Number in ``unit``.
    unit : str
        A unit of the table; ``kNm`` and ``kN*m`` are accepted for ``kN m``, ``m/s2`` for ``m/s^2``.

    Returns
    -------
    float
        The same quantity in SI units.

    Raises
    ------
    UserError
        If the unit is unknown; the sentence offers the nearest one.
    """
    factor = _factor(unit)
    if not math.isfinite(value):
        return value
    try:
        return float(
            Fraction(repr(value)) * factor
        )  # through decimals: 7.73 mm becomes 0.00773, to the last bit
    except OverflowError:
        return math.copysign(math.inf, value)


def factor(unit: str) -> float:
    """SI value of one unit; an unknown spelling raises :class:`UserError`."""
    return float(_factor(unit))


def format_quantity(value_si: float, unit: str) -> str:
    """Write an SI number in a unit, with six significant digits: ``120 km/h``.

    Parameters
    ----------
    value_si : float
        Quantity in SI units.
    unit : str
        A unit of the table; ``-`` is left out of the text.

    Returns
    -------
    str
        Number and unit.
    """
    spelling = _spelling(unit)
    number = f"{value_si / float(_factor(unit)):.6g}"
    return number if spelling == "-" else f"{number} {spelling}"


def parse_quantity(text: str, dimension: Dimension, *, what: str) -> float:
    """Read a number with its unit, such as ``120 km/h``, ``100 ms``, ``14 %`` or ``33,3 m/s``.

    Parameters
    ----------
    text : str
        What the user wrote.
    dimension : str
        Dimension that is expected; only a ratio may stand without a unit.
    what : str
        Name of the quantity for the error sentence.

    Returns
    -------
    float
        The quantity in SI units.

    Raises
    ------
    UserError
        If the text is not a finite number, or its unit is missing, unknown or of another dimension.
    """
    number, unit = split_quantity(text, dimension, what=what)
    value = to_si(number, unit)
    if not math.isfinite(value):
        raise UserError(f'{what} = "{text}" is not a finite number; {_instruction(dimension)}.')
    return value


def split_quantity(text: str, dimension: Dimension, *, what: str) -> tuple[float, str]:
    """Read a number and its unit, which stay apart.

    Parameters
    ----------
    text : str
        What the user wrote.
    dimension : str
        Dimension that is expected; only a ratio may stand without a unit.
    what : str
        Name of the quantity for the error sentence.

    Returns
    -------
    (float, str)
        The number, and the unit as this program spells it.

    Raises
    ------
    UserError
        If the text is not a number, or its unit is missing, unknown or of another dimension.
    """
    match = _NUMBER.fullmatch(text.strip().translate(_MINUS))
    allowed = _instruction(dimension)
    if match is None:
        raise UserError(f'{what} = "{text}" is not a finite number with a unit; {allowed}.')
    number, unit = match["number"], match["unit"]
    if _THOUSANDS.fullmatch(number):
        raise UserError(
            f'{what} = "{text}" is ambiguous, since the comma may separate decimals or thousands; '
            f'write "{number.replace(",", ".")} {unit}" or "{number.replace(",", "")} {unit}".'
        )
    if not unit and dimension != "ratio":
        raise UserError(f'{what} = "{text}" has no unit; {allowed}.')
    try:
        found = dimension_of(unit or "-")
    except UserError:
        raise UserError(
            f'{what} = "{text}" has an unknown unit; {_offer(number, unit, dimension)}.'
        ) from None
    if found != dimension:
        raise UserError(f'{what} = "{text}" has a unit of {found}, not of {dimension}; {allowed}.')
    return float(number.replace(",", ".")), _spelling(unit or "-")


def nearest_unit(unit: str, dimension: Dimension | None = None) -> str | None:
    """Return the known spelling that looks most like ``unit``, of a dimension if one is given."""
    candidates = {_plain(s).lower(): s for s in (_UNITS if dimension is None else _TABLE[dimension])}
    close = get_close_matches(_plain(unit).lower(), candidates, n=1, cutoff=0.5)
    return candidates[close[0]] if close else None


def _factor(unit: str) -> Fraction:
    spelling = _spelling(unit)
    return _TABLE[_UNITS[spelling]][spelling]


def _spelling(unit: str) -> str:
    plain = _plain(unit)
    if plain not in _SPELLINGS:
        near = nearest_unit(unit)
        remedy = f'did you mean "{near}"?' if near else f"known units: {', '.join(_UNITS)}."
        raise UserError(f'"{unit}" is not a known unit; {remedy}')
    return _SPELLINGS[plain]


def _offer(number: str, unit: str, dimension: Dimension) -> str:
    near = nearest_unit(unit, dimension)
    if near is not None:
        return f'did you mean "{number} {near}"? Units of {dimension}: {", ".join(units_of(dimension))}'
    return _instruction(dimension)


def _instruction(dimension: Dimension) -> str:
    if dimension == "ratio":
        return 'write a plain number or %, for example "0.14" or "14 %"'
    example = _EXAMPLES.get(dimension, f"1 {units_of(dimension)[0]}")
    return f'write it in {" or ".join(units_of(dimension))}, for example "{example}"'
