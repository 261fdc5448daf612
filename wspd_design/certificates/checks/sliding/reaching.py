"""Reaching condition of the sliding-mode law: the switching gain outweighs all that its model does not know.

With Psi = v F and rho = (inertia of the design model) / (true inertia) the law makes
v sbar' = r - rho W0 sat(sbar / layer), r = (1 - rho) v c e - Psi + rho Psi_hat at a constant reference.
"""

import math
from dataclasses import dataclass
from fractions import Fraction
from itertools import product
from typing import TYPE_CHECKING

from wspd_design.certificates.checks.frame import OutsideModel, certified, level, series
from wspd_design.certificates.checks.margin_map import margin_map
from wspd_design.certificates.checks.verdict import hypothesis, proofs, status, undecided
from wspd_design.certificates.kernel.claim import Claim, Relation
from wspd_design.certificates.records import Certificate, Point, Problem, Series, Status
from wspd_design.certificates.search.prover import extreme
from wspd_design.certificates.search.settle import engine, settle
from wspd_design.certificates.setting import domain, laws
from wspd_design.certificates.setting.domain import KMH, SLIP, SPEED
from wspd_design.certificates.setting.model_error import (
    Mismatch,
    inertia_ratio,
    mismatch,
    residual,
    residual_over_ratio,
    variables,
)
from wspd_design.certificates.setting.plant import (
    Values,
    place,
    plant_dynamics,
    plant_forces,
    plant_variables,
)
from wspd_design.controllers.sliding_mode import SlidingMode
from wspd_design.model.number import Number
from wspd_design.model.slip import resistance
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import constants

if TYPE_CHECKING:
    from wspd_design.certificates.setting.domain import Array

NAME, TITLE = "reaching", "Reaching the sliding surface"
PLOT_SPEEDS, PLOT_SLIPS = 60, 60
TOLERANCE = 1e-3  # m/s2, of the enclosures


@dataclass(frozen=True, slots=True, kw_only=True)
class Supremum:
    """Enclosure of a supremum on the domain, by the prover alone; ``value`` is attained at ``point``."""

    value: float  # m/s2
    upper: float  # m/s2
    point: tuple[Point, ...]


def supremum(problem: Problem) -> Supremum:
    """Enclose the largest abs(r) on the domain; the switching gain of the law does not matter.

    Parameters
    ----------
    problem : Problem
        With a :class:`SlidingMode` as controller.

    Returns
    -------
    Supremum
        In m/s2.
    """
    law = _sliding_mode(problem)
    return _supremum(
        Claim(
            name="abs(r)",
            variables=variables(problem, law),
            expression=lambda x: abs(residual(problem, law, x)),
            form=lambda x: abs(residual_over_ratio(problem, law, x) * inertia_ratio(x)),
            relation="<=",
            bound=Fraction(0),
            unit="m/s2",
        )
    )


def required_gain(problem: Problem) -> Supremum:
    """Enclose the smallest switching gain W0 that meets the condition everywhere, sup (abs(r) + eta) / rho.

    Returns
    -------
    Supremum
        In m/s2.
    """
    law = _sliding_mode(problem)
    return _supremum(claims(problem, law)[0])


def reserve(problem: Problem) -> float:
    """Reaching rate eta that brings a wheel from rolling to the surface above the lowest speed [m/s2].

    In sigma = integral of dt / v the distance to the surface shrinks with eta, and the speed falls no faster
    than v0 exp(-a_max sigma), with a_max of :func:`largest_deceleration`.
    """
    domain.box(problem)
    low, high = problem.speeds
    if not low < high:
        raise OutsideModel(f"the speeds {low:g} to {high:g} m/s are one speed, which leaves no time to reach")
    return largest_deceleration(problem) * problem.slip / math.log(high / low)


def largest_deceleration(problem: Problem) -> float:
    """Return a_max: full friction on all wheels and the resistance at the highest speed [m/s2]."""
    rolling = float(resistance(problem.vehicle, problem.speeds[1])) / problem.mass_bounds[0]
    return problem.mu0_bounds[1] * constants().gravity + rolling


def deceleration_claim(
    problem: Problem, relation: Relation, bound: float, **ranges: float | tuple[float, float]
) -> Claim:
    """Return a claim about the deceleration of the train, by default on the whole domain.

    Parameters
    ----------
    problem : Problem
        Plant and domain.
    relation : {"<=", ">="}
        Of deceleration and bound.
    bound : float
        In m/s2.
    **ranges : float or tuple of float
        Other ranges of the quantities, as in :func:`plant_variables`.
    """
    return Claim(
        name="deceleration",
        variables=plant_variables(problem, **ranges),
        expression=lambda x: plant_dynamics(problem, x).deceleration,
        form=lambda x: plant_forces(problem, x).deceleration,
        relation=relation,
        bound=Fraction(bound),
        unit="m/s2",
    )


def claims(problem: Problem, law: SlidingMode) -> tuple[Claim, Claim]:
    """Return what the theorem needs: the gain outweighs the model error; the train slows no faster than a_max."""
    eta = reserve(problem)

    def needed(x: Values) -> Number:
        ratio = inertia_ratio(x)
        return abs(residual(problem, law, x) / ratio) + eta / ratio

    def arranged(x: Values) -> Number:
        inverse = x["wheelset inertia"] / x["model wheelset inertia"]
        return abs(residual_over_ratio(problem, law, x)) + eta * inverse

    gain = Claim(
        name="(abs(r) + eta)/rho",
        variables=variables(problem, law),
        expression=needed,
        form=arranged,
        relation="<=",
        bound=Fraction(law.gains.switching_gain),
        unit="m/s2",
    )
    return gain, deceleration_claim(problem, "<=", largest_deceleration(problem))


@certified(name=NAME, title=TITLE)
def check(problem: Problem) -> Certificate:
    """Check abs(r) + eta <= rho W0 on the domain."""
    law = problem.controller
    if not isinstance(law, SlidingMode):
        return laws.not_applicable(
            problem,
            NAME,
            "abs(r) + eta <= rho W0 for a law with a friction model and a switching gain W0.",
            "has no switching gain W0 that stands against a model error",
        )
    eta, gain = reserve(problem), law.gains.switching_gain
    needed, slowing = (settle(claim, tolerance=TOLERANCE) for claim in claims(problem, law))
    least, most = needed.ends
    at = needed.place
    spot = (
        f"slip {at['slip']:.3f}, {at['speed'] * KMH:.3g} km/h, mu0 {at['mu0']:.3g}, mass {at['mass']:.0f} kg"
    )
    verdict = status(needed, slowing)
    where = place(at)
    left = problem.speeds[1] * math.exp(-slowing.ends[1] * problem.slip / eta)
    meaning = {
        Status.PROVED: "From everywhere on the domain the slip error is driven into the boundary layer. From slip "
        f"{problem.slips[0]:g} at {problem.speeds[1] * KMH:.3g} km/h the surface is reached above "
        f"{left * KMH:.3g} km/h.",
        Status.REFUTED: "There the torque can drive the slip away from its surface: a larger W0 or a better "
        "friction model is needed.",
        Status.UNDECIDED: f"Open: {needed.reason or slowing.reason}.",
    }[verdict]
    refuted = needed.status is Status.REFUTED
    return Certificate(
        name=NAME,
        title=TITLE,
        claim=f"W0 = {gain:.4g} m/s2 outweighs the model error: abs(r) + eta <= rho W0, "
        f"eta = {eta:.3g} m/s2, on {domain.described(problem)}.",
        status=verdict,
        explanation=f"The smallest W0 that does lies between {least:.7g} and {most:.7g} m/s2; the "
        f"tightest point is at {spot}. {meaning}",
        margin=needed.margin,
        worst_point=where,
        witness=(*where, Point(name="(abs(r) + eta)/rho", value=least, unit="m/s2")) if refuted else (),
        hypotheses=(
            hypothesis(f"(abs(r) + eta)/rho <= W0 = {gain:.4g} m/s2", needed),
            hypothesis(f"deceleration <= a_max = {largest_deceleration(problem):.4g} m/s2", slowing),
        ),
        assumptions=(
            "T = u: no valve lag, no sampling, no limit of the brake torque",
            "slip reference constant",
            "vehicle and rail numbers without a range in the domain are known",
        ),
        method="interval branch and bound, replayed by the independent checker",
        resolution=f"{needed.boxes + slowing.boxes} boxes; the smallest W0 within {TOLERANCE:g} m/s2",
        reference="eqs. (20), (23)-(25) with W = W0/v; docs/theory.md#reaching",
        undecided=undecided(needed, slowing),
        engine=engine(),
        proofs=proofs(needed, slowing),
        series=_plots(problem, law, eta),
        maps=margin_map(
            "switching gain",
            "W0 that is needed [m/s2]",
            lambda points: _needed_gain(mismatch(problem, law, points), eta),
            domain.box(problem),
            over=SLIP,
            limit=gain,
            worst=at,
            largest=True,
        ),
    )


def _supremum(claim: Claim) -> Supremum:
    found = extreme(claim, tolerance=TOLERANCE)
    at = {v.name: float(found.point.get(v.name, v.low)) for v in claim.variables}
    return Supremum(value=found.low, upper=found.high, point=place(at))


def _plots(problem: Problem, law: SlidingMode, reserve: float) -> tuple[Series, ...]:
    """Gain that is needed over speed, the worst of a grid over slip and the corners of the parameters."""
    import numpy as np

    low, high = domain.box(problem)
    speeds = np.geomspace(low[SPEED], high[SPEED], PLOT_SPEEDS)
    corners = product(problem.mass_bounds, problem.inertia_bounds, problem.mu0_bounds)
    grid = product(speeds, np.linspace(low[SLIP], high[SLIP], PLOT_SLIPS), corners)
    points = np.array([(slip, speed, *corner) for speed, slip, corner in grid])
    needed = _needed_gain(mismatch(problem, law, points), reserve).reshape(PLOT_SPEEDS, -1).max(axis=1)
    axes = ("speed [km/h]", "W0 [m/s2]")
    return (
        series("needed", *axes, speeds * KMH, needed),
        level("chosen", *axes, speeds * KMH, law.gains.switching_gain),
    )


def _needed_gain(error: Mismatch, reserve: float) -> "Array":
    """Switching gain that outweighs a model error with a reserve, (abs(r) + eta) / rho."""
    needed: Array = (abs(error.residual) + reserve) / error.inertia_ratio
    return needed


def _sliding_mode(problem: Problem) -> SlidingMode:
    if not isinstance(problem.controller, SlidingMode):
        raise UserError(
            f"controller {problem.controller.name} has no friction model; the reaching condition needs a "
            "sliding-mode law, for example smc"
        )
    return problem.controller
