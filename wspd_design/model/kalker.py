"""Kalker's linear theory of rolling contact: the creep coefficients of a contact ellipse."""

import math
from bisect import bisect_right
from functools import cache
from typing import Any, NamedTuple

from wspd_design.parameters.errors import UserError
from wspd_design.parameters.files import data_file, read_toml


class CreepCoefficients(NamedTuple):
    """Kalker's coefficients of one ellipse: forces -G a b c11, -G a b c22 and -G (a b)^1.5 c23 [-]."""

    c11: float  # along the rail, by longitudinal creep
    c22: float  # across the rail, by lateral creep
    c23: float  # across the rail, by spin


@cache
def _table() -> dict[str, Any]:
    return read_toml(data_file("kalker.toml"), "kalker.toml")


def creep_coefficients(
    semi_axis_rolling: float, semi_axis_lateral: float, poisson: float
) -> CreepCoefficients:
    """Coefficients c11 of eq. (6), c22 and c23.

    Between the rows of the table they are linear in the ratio of the axes, between its columns their inverses are
    quadratic in Poisson's ratio; ellipses more slender than 1:10 follow the asymptotic formulas.

    Parameters
    ----------
    semi_axis_rolling, semi_axis_lateral : float
        Semi-axes a and b of the contact ellipse [m].
    poisson : float
        Poisson's ratio, 0 to 0.5.

    Raises
    ------
    UserError
        If an axis is not positive or Poisson's ratio is outside its range.

    References
    ----------
    Kalker (1967); table and rules as in the program CONTACT.
    """
    if not (semi_axis_rolling > 0.0 and semi_axis_lateral > 0.0 and 0.0 <= poisson <= 0.5):
        raise UserError(
            f"contact ellipse a = {semi_axis_rolling:g} m, b = {semi_axis_lateral:g} m with Poisson's ratio "
            f"{poisson:g}: the axes must be positive and the ratio must lie in [0, 0.5]"
        )
    slender = semi_axis_rolling / semi_axis_lateral
    along = slender > 1.0
    ratio = 1.0 / slender if along else slender
    ratios = _table()["ratio"]
    if ratio < ratios[0]:
        return _asymptotic_along(ratio, poisson) if along else _asymptotic_across(ratio, poisson)
    rows = _table()["along" if along else "across"]
    k = min(bisect_right(ratios, ratio), len(ratios) - 1)
    share = (ratio - ratios[k - 1]) / (ratios[k] - ratios[k - 1])

    def between(table: list[list[float]]) -> float:
        row = [low + share * (high - low) for low, high in zip(table[k - 1], table[k], strict=True)]
        return 1.0 / _quadratic(_table()["poisson"], [1.0 / value for value in row], poisson)

    return CreepCoefficients(c11=between(rows["c11"]), c22=between(rows["c22"]), c23=between(rows["c23"]))


def _quadratic(nodes: list[float], values: list[float], x: float) -> float:
    """Lagrange's polynomial through three points."""
    total = 0.0
    for i, value in enumerate(values):
        others = [node for j, node in enumerate(nodes) if j != i]
        total += value * math.prod((x - node) / (nodes[i] - node) for node in others)
    return total


def _asymptotic_across(ratio: float, poisson: float) -> CreepCoefficients:
    """Ellipses far longer across the rail than along it."""
    soft = 1.0 - poisson
    spin = math.pi * math.sqrt(ratio) / (3.0 * soft) * (1.0 + poisson * (math.log(16.0 / ratio) - 5.0))
    return CreepCoefficients(c11=math.pi**2 / (4.0 * soft), c22=math.pi**2 / 4.0, c23=spin)


def _asymptotic_along(ratio: float, poisson: float) -> CreepCoefficients:
    """Ellipses far longer along the rail than across it."""
    length, soft = math.log(16.0 / ratio**2), 1.0 - poisson
    step = 3.0 - math.log(4.0)
    reduced = length - 2.0 * poisson
    sideways = soft * length + 2.0 * poisson
    return CreepCoefficients(
        c11=2.0 * math.pi / (reduced * ratio) * (1.0 + step / reduced),
        c22=2.0 * math.pi / (sideways * ratio) * (1.0 + soft * step / sideways),
        c23=2.0 * math.pi / (3.0 * ratio**1.5 * (soft * length - 2.0 + 4.0 * poisson)),
    )
