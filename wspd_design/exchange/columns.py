"""Names of the columns of tables: each ends in its unit, those of drawn numbers as well."""

import re

from wspd_design.design.draw_table import dimension_of
from wspd_design.exchange.forms import unit
from wspd_design.parameters.units import units_of

_SPELLED = {
    "1/s": "per_s",
    "m/s": "m_s",
    "m/s^2": "m_s2",
    "kg m^2": "kg_m2",
    "N m": "Nm",
    "N m s": "Nms",
    "N s/m": "Ns_m",
    "N s^2/m^2": "Ns2_m2",
    "s/m": "s_m",
    "m^3": "m3",
    "J/K": "J_K",
    "W/K": "W_K",
}
"""Ends of names for units that are more than letters."""
_OTHERS = {"_Pa": "Pa", "_J": "J", "_K": "K", "_Nl": "normal litres"}


def unit_of(column: str) -> str:
    """Return the unit of a column of a table of stops or traces; empty for a ratio, a count or a word.

    Parameters
    ----------
    column : str
        Name with the unit at its end, or the dotted name of a number that is drawn, with the wheelset behind it or
        not.
    """
    dimension = dimension_of(column)
    if dimension is not None:
        return units_of(dimension)[0].removeprefix("-")
    name = re.sub(r"_\d+$", "", column)
    return next((spelled for end, spelled in _OTHERS.items() if name.endswith(end)), unit(name))


def with_unit(column: str) -> str:
    """Return the name of a column in a file: that of a drawn number gets the end that tells its unit."""
    dimension = dimension_of(column)
    if dimension is None:
        return column
    measured = units_of(dimension)[0]
    return column if measured == "-" else f"{column}_{_SPELLED.get(measured, measured)}"
