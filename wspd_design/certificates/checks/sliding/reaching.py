"""Reaching condition of the sliding-mode law: the switching gain outweighs all that its model does not know."""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import product
from typing import TYPE_CHECKING

from wspd_design.certificates.checks.frame import Check, Figures, level, series
from wspd_design.certificates.checks.margin_map import margin_map
from wspd_design.certificates.kernel.claim import Claim
from wspd_design.certificates.kernel.finding import Stated
from wspd_design.certificates.records import Certificate, Point, Problem
from wspd_design.certificates.search.prover import extreme
from wspd_design.certificates.search.settle import settle_all
from wspd_design.certificates.setting import domain
from wspd_design.certificates.setting.domain import SLIP, SPEED
from wspd_design.certificates.setting.model_error import Mismatch, mismatch
from wspd_design.certificates.setting.plant import place
from wspd_design.certificates.theorems.sliding import REACHING, gain_claim, reserve
from wspd_design.controllers.sliding_mode import SlidingMode
from wspd_design.parameters.units import KMH

if TYPE_CHECKING:
    from wspd_design.certificates.setting.domain import Array

PLOT_SPEEDS, PLOT_SLIPS = 60, 60
TOLERANCE = 1e-3  # m/s2, of the enclosures


def search(problem: Problem) -> Mapping[str, Stated]:
    """Enclose the gain that is needed, and the deceleration."""
    wanted = {each.key: each for each in REACHING.obligations(problem)}
    return settle_all(wanted, {"gain": TOLERANCE, "deceleration": TOLERANCE})


@dataclass(frozen=True, slots=True, kw_only=True)
class Supremum:
    """Enclosure of a supremum on the domain, by the prover alone; ``value`` is attained at ``point``."""

    value: float  # m/s2
    upper: float  # m/s2
    point: tuple[Point, ...]


def required_gain(problem: Problem) -> Supremum:
    """Enclose the smallest switching gain W0 that meets the condition everywhere, sup (abs(r) + eta) / rho.

    A rule may start from it; the check decides.
    """
    return supremum(gain_claim(problem))


def supremum(claim: Claim) -> Supremum:
    """Enclose the supremum of the expression of a claim; its bound does not matter."""
    found = extreme(claim, tolerance=TOLERANCE)
    at = {v.name: float(found.point.get(v.name, v.low)) for v in claim.variables}
    return Supremum(value=found.low, upper=found.high, point=place(at))


def figures(problem: Problem, certificate: Certificate) -> Figures:
    """Gain that is needed over speed, the worst of a grid over slip and the corners of the parameters."""
    import numpy as np

    law, eta = problem.controller, reserve(problem)
    assert isinstance(law, SlidingMode)
    low, high = domain.box(problem)
    speeds = np.geomspace(low[SPEED], high[SPEED], PLOT_SPEEDS)
    corners = product(problem.span("mass"), problem.span("wheelset inertia"), problem.span("mu0"))
    grid = product(speeds, np.linspace(low[SLIP], high[SLIP], PLOT_SLIPS), corners)
    points = np.array([(slip, speed, *corner) for speed, slip, corner in grid])
    needed = _needed_gain(mismatch(problem, law, points), eta).reshape(PLOT_SPEEDS, -1).max(axis=1)
    axes = ("speed [km/h]", "W0 [m/s2]")
    return Figures(
        series=(
            series("needed", *axes, speeds * KMH, needed),
            level("chosen", *axes, speeds * KMH, law.gains.switching_gain),
        ),
        maps=margin_map(
            "switching gain",
            "W0 that is needed [m/s2]",
            lambda points: _needed_gain(mismatch(problem, law, points), eta),
            domain.box(problem),
            over=SLIP,
            limit=law.gains.switching_gain,
            worst=certificate.findings["gain"].values,
            largest=True,
        ),
    )


def _needed_gain(error: Mismatch, reserve: float) -> "Array":
    """Switching gain that outweighs a model error with a reserve, (abs(r) + eta) / rho."""
    needed: Array = (abs(error.residual) + reserve) / error.inertia_ratio
    return needed


CHECK = Check(theorem=REACHING, search=search, figures=figures)
