"""Kalker's linear theory of rolling contact: the longitudinal creep coefficient c11 of a contact ellipse."""

import math
from bisect import bisect_right
from functools import cache
from typing import Any

from wspd_design.parameters.errors import UserError
from wspd_design.parameters.files import data_file, read_toml


@cache
def _table() -> dict[str, Any]:
    return read_toml(data_file("kalker.toml"), "kalker.toml")


def longitudinal_coefficient(semi_axis_rolling: float, semi_axis_lateral: float, poisson: float) -> float:
    """Coefficient c11 of eq. (6) [-].

    Between the rows of the table it is linear in the ratio of the axes, between its columns 1/c11 is quadratic in
    Poisson's ratio; ellipses more slender than 1:10 follow the asymptotic formulas.

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
        return _asymptotic(ratio, poisson, along=along)
    rows = _table()["along" if along else "across"]
    k = min(bisect_right(ratios, ratio), len(ratios) - 1)
    share = (ratio - ratios[k - 1]) / (ratios[k] - ratios[k - 1])
    row = [low + share * (high - low) for low, high in zip(rows[k - 1], rows[k], strict=True)]
    return 1.0 / _quadratic(_table()["poisson"], [1.0 / value for value in row], poisson)


def _quadratic(nodes: list[float], values: list[float], x: float) -> float:
    """Lagrange's polynomial through three points."""
    total = 0.0
    for i, value in enumerate(values):
        others = [node for j, node in enumerate(nodes) if j != i]
        total += value * math.prod((x - node) / (nodes[i] - node) for node in others)
    return total


def _asymptotic(ratio: float, poisson: float, *, along: bool) -> float:
    if not along:
        return math.pi**2 / (4.0 * (1.0 - poisson))
    reduced = math.log(16.0 / ratio**2) - 2.0 * poisson
    return 2.0 * math.pi / (reduced * ratio) * (1.0 + (3.0 - math.log(4.0)) / reduced)
