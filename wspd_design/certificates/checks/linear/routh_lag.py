"""Near its reference the valve lag must leave the loop stable: Routh's conditions at every speed."""

from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING

from wspd_design.certificates.checks.frame import Check, Figures, level, series
from wspd_design.certificates.checks.linear.routh_region import region
from wspd_design.certificates.kernel.claim import Claim
from wspd_design.certificates.kernel.finding import Stated
from wspd_design.certificates.records import Certificate, Problem, Series
from wspd_design.certificates.search.prover import prove
from wspd_design.certificates.search.settle import stated_of
from wspd_design.certificates.setting.linear_loop import law_of, nominal, on_brake, quartic, valve
from wspd_design.certificates.theorems.linear import ROUTH_LAG, conditions
from wspd_design.controllers.offers import LinearSurface
from wspd_design.model.slip import slip_dynamics
from wspd_design.parameters.units import KMH

if TYPE_CHECKING:
    from wspd_design.certificates.setting.domain import Array

SHARE_SHOWN = 0.5  # of the smallest value that is found, to be shown
PLOT_SPEEDS = 81


def search(problem: Problem) -> Mapping[str, Stated]:
    """Decide all conditions."""
    return {name: _decided(claim) for name, claim in conditions(problem).items()}


def _decided(claim: Claim) -> Stated:
    """Show that a condition is positive, and if it can be that it is a good part of its smallest value."""
    found = prove(claim)
    if not found.tree:
        return stated_of(claim, found)
    tighter = replace(claim, bound=Fraction(SHARE_SHOWN * found.high))
    shown = prove(tighter)
    return stated_of(tighter, shown) if shown.tree else stated_of(claim, found)


def figures(problem: Problem, certificate: Certificate) -> Figures:  # noqa: ARG001 - samples of the nominal loop
    """Margin over speed, and the region of (c, k) with the law in it."""
    import numpy as np

    law, brake = law_of(problem), problem.vehicle.brake
    speeds = np.geomspace(*problem.speeds, PLOT_SPEEDS)
    plant = nominal(problem.vehicle, problem.rail, problem.slip, speeds)
    gains = on_brake(law, law.linear_form(speeds), brake.max_torque)
    share = -plant_drift(problem, speeds) / plant.gain / brake.max_torque
    rates = valve(brake.fill_time, brake.vent_time, share)
    found = quartic(plant, rates, gains)
    back = rates.decay + rates.rate * gains.torque
    lacking = (
        found.third**2
        * np.where(gains.integral, gains.twice, 0.0)
        / np.where(gains.integral, gains.integral, 1.0)
    )
    margin = np.minimum(
        found.third / back,
        (found.third * found.second - found.first - lacking)
        / (rates.rate * plant.gain * gains.proportional * back),
    )
    unstable = int((margin <= 0.0).sum())
    axes = ("speed [km/h]", "Routh margin [-]")
    curves: list[Series] = [
        series("nominal parameters", *axes, speeds * KMH, margin),
        level("limit", *axes, speeds * KMH, 0.0),
    ]
    if isinstance(law, LinearSurface) and brake.fill_time == brake.vent_time:
        curves += region(law, brake.fill_time, speeds, plant)
    return Figures(
        series=tuple(curves),
        remark=f"With the nominal parameters the loop is unstable at {unstable} of {PLOT_SPEEDS} sampled speeds.",
    )


def plant_drift(problem: Problem, speeds: "Array") -> "Array":
    """Drift of the slip without torque [1/s]."""
    found: Array = slip_dynamics(problem.vehicle, problem.rail, problem.slip, speeds).drift
    return found


CHECK = Check(theorem=ROUTH_LAG, search=search, figures=figures)
