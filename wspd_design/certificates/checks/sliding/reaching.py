"""Reaching condition of the sliding-mode law: the switching gain outweighs all that its model does not know."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import product
from typing import TYPE_CHECKING

from wspd_design.certificates.checks.frame import Check, Figures, level, series
from wspd_design.certificates.checks.margin_map import margin_map
from wspd_design.certificates.kernel.finding import Stated
from wspd_design.certificates.kernel.obligation import Inequality
from wspd_design.certificates.quantities import STATE
from wspd_design.certificates.records import Certificate, Point, Problem
from wspd_design.certificates.search.prover import extreme, prove
from wspd_design.certificates.search.together import settle_together
from wspd_design.certificates.setting import domain
from wspd_design.certificates.setting.domain import BASIC, PARAMETERS, SLIP, SPEED
from wspd_design.certificates.setting.model_error import mismatch
from wspd_design.certificates.setting.plant import place
from wspd_design.certificates.theorems.edges import of_key, together
from wspd_design.certificates.theorems.sliding import REACHING, gain_claims, reserve
from wspd_design.certificates.theorems.whom import sliding_law
from wspd_design.parameters.units import KMH

if TYPE_CHECKING:
    from wspd_design.certificates.setting.domain import Array

PLOT_SPEEDS, PLOT_SLIPS = 60, 60
TOLERANCE = 0.1  # m/s2, of the enclosures


def search(problem: Problem) -> Mapping[str, Stated]:
    """Enclose the gain that is needed."""
    return settle_together(gain_claims(problem), tolerance=TOLERANCE)


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
    return supremum(gain_claims(problem))


def supremum(claims: Sequence[Inequality], tolerance: float = TOLERANCE) -> Supremum:
    """Enclose the largest value of the expressions of claims; their bounds do not matter.

    The claim that comes last is enclosed first; where no other one exceeds its enclosure, that is enough.
    """
    *others, last = (each.claim for each in claims)
    claim, tightest = last, extreme(last, tolerance=tolerance)
    upper = tightest.high
    if not all(prove(replace(each, bound=Fraction(upper))).tree for each in others):
        found = [(each, extreme(each, tolerance=tolerance)) for each in others]
        claim, tightest = max(((last, tightest), *found), key=lambda pair: pair[1].low)
        upper = max(upper, *(each.high for _, each in found))
    at = {v.name: float(tightest.point.get(v.name, v.low)) for v in claim.variables}
    wide = {v.name for each in (*others, last) for v in each.variables if v.low < v.high}
    names = [name for name in at if name in (*BASIC, *wide)]
    return Supremum(value=tightest.low, upper=upper, point=place(at, tuple(names)))


def figures(problem: Problem, certificate: Certificate) -> Figures:
    """Gain that is needed over speed, the worst of a grid over slip and the corners of mass, inertia and mu0.

    The other numbers stand where the condition is tightest, for r and for -r.
    """
    import numpy as np

    law, eta = sliding_law(problem), reserve(problem)
    tightest = [
        together(of_key(certificate.findings.items(), key)).values or _nominal(problem) for key in ("r", "-r")
    ]
    others = [{name: at[name] for name in _further(problem, at)} for at in tightest]

    def needed(points: "Array") -> "Array":
        found = [mismatch(problem, law, points, each) for each in others]
        most: Array = np.max([(abs(each.residual) + eta) / each.inertia_ratio for each in found], axis=0)
        return most

    low, high = domain.box(problem)
    speeds = np.geomspace(low[SPEED], high[SPEED], PLOT_SPEEDS)
    corners = product(*(problem.span(name) for name in PARAMETERS))
    grid = product(speeds, np.linspace(low[SLIP], high[SLIP], PLOT_SLIPS), corners)
    points = np.array([(slip, speed, *corner) for speed, slip, corner in grid])
    axes = ("speed [km/h]", "W0 [m/s2]")
    return Figures(
        series=(
            series("needed", *axes, speeds * KMH, needed(points).reshape(PLOT_SPEEDS, -1).max(axis=1)),
            level("chosen", *axes, speeds * KMH, law.gains.switching_gain),
        ),
        maps=margin_map(
            "switching gain",
            "W0 that is needed [m/s2]",
            needed,
            domain.box(problem),
            over=SLIP,
            limit=law.gains.switching_gain,
            worst=together(
                [each for key in ("r", "-r") for each in of_key(certificate.findings.items(), key)]
            ).values
            or _nominal(problem),
            largest=True,
        ),
    )


def _nominal(problem: Problem) -> Mapping[str, float]:
    """Where a search found nothing, the middle of the domain stands for its tightest point."""
    return {name: sum(domain.span(problem, name)) / 2.0 for name in BASIC}


def _further(problem: Problem, at: Mapping[str, float]) -> list[str]:
    return [name for name in domain.uncertain(problem) if name in at and name not in (*STATE, *PARAMETERS)]


CHECK = Check(theorem=REACHING, search=search, figures=figures)
