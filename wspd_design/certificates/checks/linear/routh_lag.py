"""Near its reference the valve lag must leave the loop stable: Routh's conditions at every speed."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

from wspd_design.certificates.checks.frame import Check, Figures, level, series
from wspd_design.certificates.checks.linear.routh_region import region
from wspd_design.certificates.kernel.finding import Stated
from wspd_design.certificates.records import Certificate, Problem, Series
from wspd_design.certificates.search.settle import settle_all
from wspd_design.certificates.setting.linear_loop import law_of, nominal, on_brake, one_time, quartic, valve
from wspd_design.certificates.theorems.linear import ROUTH_LAG
from wspd_design.controllers.offers import Surface
from wspd_design.model.slip import slip_dynamics
from wspd_design.parameters.units import KMH

if TYPE_CHECKING:
    from wspd_design.certificates.setting.domain import Array

TOLERANCE = 0.1  # of the enclosed margins
PLOT_SPEEDS = 81


def search(problem: Problem) -> Mapping[str, Stated]:
    """Settle all conditions."""
    wanted = {each.key: each for each in ROUTH_LAG.obligations(problem)}
    return settle_all(wanted, dict.fromkeys(wanted, TOLERANCE))


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
    lacking = found.third**2 * np.where(gains.integral, gains.twice, 0.0) / np.where(gains.integral, gains.integral, 1.0)
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
    if isinstance(law, Surface) and one_time(problem):
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
