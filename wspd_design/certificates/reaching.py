"""Reaching condition of the sliding-mode law: the switching gain outweighs all that its model does not know.

With Psi = v F and rho = (inertia of the design model) / (true inertia) the law makes
v sbar' = r - rho W0 sat(sbar / layer), r = (1 - rho) v c e - Psi + rho Psi_hat at a constant reference.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from itertools import product
from typing import TYPE_CHECKING, NamedTuple

from wspd_design.certificates import domain, laws
from wspd_design.certificates.checking import OutsideModel, certified, level, series
from wspd_design.certificates.domain import INERTIA, KMH, MASS, MU0, SLIP, SPEED
from wspd_design.certificates.records import Certificate, Point, Problem, Range, Series, Status
from wspd_design.certificates.search import SOBOL_EXPONENT, STARTS, Maximum, maximize
from wspd_design.controllers.sliding_mode import SlidingMode
from wspd_design.model.generated import sliding_surface
from wspd_design.model.slip import resistance, slip_dynamics
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import constants

if TYPE_CHECKING:
    from wspd_design.certificates.domain import Array

NAME, TITLE = "reaching", "Reaching the sliding surface"
PLOT_SPEEDS, PLOT_SLIPS = 60, 60


@dataclass(frozen=True, slots=True, kw_only=True)
class Supremum:
    """The largest value found on the domain, a lower bound of the supremum, and where it lies."""

    value: float  # m/s2
    point: tuple[Point, ...]
    evaluations: int


class Mismatch(NamedTuple):
    """What the design model of a law does not know of the plant."""

    residual: "Array"  # m/s2, r
    inertia_ratio: "Array"  # -, rho


def mismatch(problem: Problem, law: SlidingMode, points: "Array") -> Mismatch:
    """Evaluate r and rho at points of the domain."""
    slip, speed = points[:, SLIP], points[:, SPEED]
    plant = domain.dynamics(problem, points)
    model = slip_dynamics(law.vehicle, law.rail, slip, speed)
    ratio = law.vehicle.wheelset_inertia / points[:, INERTIA]
    error = sliding_surface.slip_error(law.gains.slip_reference, slip)
    closing = (1.0 - ratio) * speed * law.gains.surface_rate * error
    return Mismatch(residual=closing - speed * plant.drift + ratio * speed * model.drift, inertia_ratio=ratio)


def supremum(problem: Problem) -> Supremum:
    """Search the largest abs(r) on the domain; the switching gain of the law does not matter.

    Parameters
    ----------
    problem : Problem
        With a :class:`SlidingMode` as controller.

    Returns
    -------
    Supremum
        In m/s2. A lower bound of the true supremum, since it is found by sampling and climbing.
    """
    law = _sliding_mode(problem)
    found = _search(problem, law, lambda error: abs(error.residual))
    return Supremum(value=found.value, point=domain.readable(found.point), evaluations=found.evaluations)


def required_gain(problem: Problem) -> Supremum:
    """Search the smallest switching gain W0 that meets the condition everywhere, sup (abs(r) + eta) / rho.

    Returns
    -------
    Supremum
        In m/s2. A lower bound of the gain that is needed.
    """
    law = _sliding_mode(problem)
    eta = reserve(problem)
    found = _search(problem, law, lambda error: _needed_gain(error, eta))
    return Supremum(value=found.value, point=domain.readable(found.point), evaluations=found.evaluations)


def reserve(problem: Problem) -> float:
    """Reaching rate eta that brings a wheel from rolling to the surface above the lowest speed [m/s2].

    In sigma = integral of dt / v the distance to the surface shrinks with eta, and the speed falls no faster
    than v0 exp(-a_max sigma), with a_max from full friction on all wheels.
    """
    domain.box(problem)
    low, high = problem.speeds
    if not low < high:
        raise OutsideModel(f"the speeds {low:g} to {high:g} m/s are one speed, which leaves no time to reach")
    rolling = float(resistance(problem.vehicle, high)) / problem.mass_bounds[0]
    deceleration = problem.mu0_bounds[1] * constants().gravity + rolling
    return deceleration * problem.slip / math.log(high / low)


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
    eta = reserve(problem)
    gain = law.gains.switching_gain
    found = _search(problem, law, lambda error: _needed_gain(error, eta))
    at = mismatch(problem, law, found.point[None, :])
    residual, ratio = float(at.residual[0]), float(at.inertia_ratio[0])
    slack = gain - found.value
    holds = slack >= 0.0
    where = domain.readable(found.point)
    spot = f"slip {found.point[SLIP]:.3f}, {found.point[SPEED] * KMH:.3g} km/h, mu0 {found.point[MU0]:.3g}, "
    spot += f"mass {found.point[MASS]:.0f} kg"
    return Certificate(
        name=NAME,
        title=TITLE,
        claim=f"W0 = {gain:.4g} m/s2 outweighs the model error: abs(r) + eta <= rho W0, "
        f"eta = {eta:.3g} m/s2, on {domain.described(problem)}.",
        status=Status.EVIDENCE if holds else Status.REFUTED,
        explanation=(
            f"The tightest point found needs W0 = {found.value:.4g} m/s2 (abs(r) = {abs(residual):.4g} m/s2, "
            f"rho = {ratio:.3g}, at {spot}). "
            + (
                "From everywhere on the domain the slip error is driven into the boundary layer."
                if holds
                else "There the torque can drive the slip away from its surface: a larger W0 or a better "
                "friction model is needed."
            )
        ),
        margin=Range(low=None, high=slack, unit="m/s2"),
        worst_point=where,
        witness=() if holds else (*where, Point(name="abs(r)", value=abs(residual), unit="m/s2")),
        assumptions=(
            "T = u: no valve lag, no sampling, no limit of the brake torque",
            "slip reference constant",
            "eta brings a rolling wheel to the surface above the lowest speed of the domain",
        ),
        method="even Sobol sampling with all corners, then bounded local optimization from the best points",
        resolution=f"{found.evaluations} evaluations: 2^{SOBOL_EXPONENT} Sobol points and the corners, "
        f"{STARTS} local climbs; sampling bounds the margin only from above",
        reference="eqs. (20), (23)-(25) with W = W0/v; findings, section 2",
        series=_plots(problem, law, eta),
    )


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


def _search(problem: Problem, law: SlidingMode, objective: "Callable[[Mismatch], Array]") -> Maximum:
    """Maximize a function of the model error on the domain."""

    def values(points: "Array") -> "Array":
        return objective(mismatch(problem, law, points))

    return maximize(values, *domain.box(problem), seed=problem.seed)


def _sliding_mode(problem: Problem) -> SlidingMode:
    if not isinstance(problem.controller, SlidingMode):
        raise UserError(
            f"controller {problem.controller.name} has no friction model; the reaching condition needs a "
            "sliding-mode law, for example smc"
        )
    return problem.controller
