"""A slip that takes more than full pressure is not exceeded again: where that is so, and that it stays so."""

from collections.abc import Mapping
from dataclasses import replace

from wspd_design.certificates.checks.frame import Check, Figures, level, series
from wspd_design.certificates.kernel.finding import Place, Stated
from wspd_design.certificates.kernel.obligation import Inequality
from wspd_design.certificates.records import Certificate, Problem
from wspd_design.certificates.search.settle import settle
from wspd_design.certificates.search.together import settle_together
from wspd_design.certificates.setting.plant import complete
from wspd_design.certificates.theorems.limit import (
    FADES,
    SLIP_LIMIT,
    fading,
    limited,
    sides,
    torque_claim,
)
from wspd_design.parameters.units import KMH

FADING_TOLERANCE, TOLERANCE = 1e-4, 50.0  # s/m, N m
HALVINGS = 40  # of the range of speed
PLOT_SPEEDS = 60


def search(problem: Problem) -> Mapping[str, Stated]:
    """Bound the change of the force with the speed; look for the highest speed at which the brake is the limit."""
    asked = sides(problem)
    stated = settle_together(asked, tolerance=TOLERANCE)
    return {
        FADES: settle(fading(problem).claim, tolerance=FADING_TOLERANCE),
        **{each.key: _fastest(problem, each, stated[each.key]) for each in asked},
    }


def _fastest(problem: Problem, asked: Inequality, stated: Stated) -> Stated:
    """Move a place where full pressure does not suffice to the highest speed at which it does not."""

    def denied(speed: float) -> bool:
        at = {v.name: stated.place.get(v.name, float(v.low)) for v in asked.claim.variables}
        return bool(asked.claim.expression({**at, "speed": speed}) > float(asked.claim.bound) * (1.0 + 1e-9))

    if not stated.place or not denied(stated.place["speed"]):
        return stated
    low, high = stated.place["speed"], problem.speeds[1]
    for _ in range(HALVINGS):
        middle = (low + high) / 2.0
        low, high = (middle, high) if denied(middle) else (low, middle)
    place: Place = {**stated.place, "speed": low}
    return replace(
        stated, proof=None, place=place
    )  # how much more than full pressure it takes counts no more


def figures(problem: Problem, certificate: Certificate) -> Figures:
    """Torque that holds a slip over speed: the reference, nominal, and the slip where the brake is first the limit."""
    import numpy as np

    speeds = np.geomspace(*problem.speeds, PLOT_SPEEDS)
    axes = ("speed [km/h]", "torque per wheelset [kN m]")

    holds = torque_claim(problem, 0.0, {}).expression
    where = limited(certificate.findings)
    places: dict[str, Mapping[str, float]] = {"nominal": {"slip": problem.slip}}
    if where is not None:
        places["corner of the box"] = where.values
    shown = [
        series(
            f"holds slip {values['slip']:.3g}, {name}",
            *axes,
            speeds * KMH,
            np.array(holds(complete(problem, {**values, "speed": speeds}))) / 1e3,
        )
        for name, values in places.items()
    ]
    least, most = (torque / 1e3 for torque in problem.span("max torque"))
    return Figures(
        series=(
            *shown,
            level("least T_max", *axes, speeds * KMH, least),
            level("largest T_max", *axes, speeds * KMH, most),
        )
    )


CHECK = Check(theorem=SLIP_LIMIT, search=search, figures=figures)
