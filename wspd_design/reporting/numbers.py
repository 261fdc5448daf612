"""Numbers as people read them: few digits, a real minus sign, powers of ten written out."""

import math
import re
from collections.abc import Sequence

from wspd_design.certificates.records import Point, Range
from wspd_design.parameters.units import format_quantity

MINUS, NONE = "\N{MINUS SIGN}", "\N{EN DASH}"
_SUPERSCRIPTS = str.maketrans("0123456789-", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻")
_LARGEST, _SMALLEST = 1e7, 1e-4


def decimals(value: float, places: int) -> str:
    """Write a number with fixed decimals; a dash where there is none."""
    if not math.isfinite(value):
        return NONE
    return _minus(f"{value:.{places}f}")


def significant(value: float, digits: int = 4) -> str:
    """Write a number with at most so many significant digits; a dash where there is none."""
    if not math.isfinite(value):
        return NONE
    if value == 0.0:
        return "0"
    mantissa, _, exponent = f"{value:.{digits - 1}e}".partition("e")
    if _SMALLEST <= abs(value) < _LARGEST:
        return _minus(_trimmed(f"{value:.{max(digits - 1 - int(exponent), 0)}f}"))
    return scientific(_trimmed(mantissa), int(exponent))


def scientific(mantissa: str, exponent: int) -> str:
    """Write a number that comes as mantissa and power of ten; a mantissa of 1 is left out."""
    power = f"10{str(exponent).translate(_SUPERSCRIPTS)}"
    return power if mantissa == "1" else _minus(f"{mantissa}·") + power


def uncertain(value: float, spread: float, places: int) -> str:
    """Write a number without digits that it does not have: half of a spread that is not zero goes with it."""
    if not spread or not math.isfinite(spread):
        return decimals(value, places)
    half = spread / 2.0
    places = min(max(-math.floor(math.log10(half)), 0), places + 2)
    return f"{decimals(value, places)} ± {decimals(half, places)}"


def settled(value: float, spread: float, places: int) -> str:
    """Write a number with at most so many decimals, and none that half of a spread which is not zero moves."""
    if spread and math.isfinite(spread):
        places = min(max(-math.floor(math.log10(spread / 2.0)) - 1, 0), places)
    return decimals(value, places)


def resolved(value: float, width: float) -> str:
    """Write a number with the digits that matter beside a width over which it spreads: a twentieth of it."""
    if not width > 0.0 or not math.isfinite(width):
        return significant(value, 3)
    return decimals(value, max(-math.floor(math.log10(width / 20.0)), 0))


def unit(spelling: str) -> str:
    """Write a unit with superscripts: ``m/s^2`` and ``m/s2`` become ``m/s²``; a ratio has none.

    A digit after a capital belongs to a name, as in ``of max V2``.
    """
    if spelling == "-":
        return ""
    return re.sub(r"(?<=[a-z])\^?([23])", lambda power: power[1].translate(_SUPERSCRIPTS), spelling)


def quantity(value: float, spelling: str, digits: int = 4) -> str:
    """Write a number with its unit."""
    return f"{significant(value, digits)} {unit(spelling)}".rstrip()


def quantity_in(value_si: float, spelling: str) -> str:
    """Write an SI number in a unit of the parameter files, with its unit."""
    number, _, rest = format_quantity(value_si, spelling).partition(" ")
    return f"{_minus(number)} {unit(rest)}".rstrip()


def margin(enclosure: Range | None) -> str:
    """Write an enclosure: one number where its ends agree, a bound where one end is open."""
    if enclosure is None:
        return NONE
    low, high = enclosure.low, enclosure.high
    if low is None and high is None:
        return NONE
    if low is None or high is None:
        sign, bound = ("≤", high) if low is None else ("≥", low)
        assert bound is not None
        return f"{sign} {quantity(bound, enclosure.unit)}"
    if significant(low) == significant(high):
        return quantity(low, enclosure.unit)
    return f"{significant(low)} to {quantity(high, enclosure.unit)}"


def point(coordinates: Sequence[Point]) -> str:
    """Write a point of a domain: names, values and units."""
    return ", ".join(f"{each.name} {quantity(each.value, each.unit)}" for each in coordinates)


def count(number: int, noun: str) -> str:
    """Write a number of things: ``1 check``, ``2 checks``."""
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"


def listing(words: Sequence[str]) -> str:
    """Join words: ``a``, ``a and b``, ``a, b and c``."""
    return " and ".join((", ".join(words[:-1]), words[-1])) if len(words) > 1 else "".join(words)


def _trimmed(text: str) -> str:
    return text.rstrip("0").rstrip(".") if "." in text else text


def _minus(text: str) -> str:
    return text.replace("-", MINUS)
