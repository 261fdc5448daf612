"""Theorem: no controller stops this vehicle within less than a distance and a time, shown from the adhesion peaks.

Twice: over all bounds, whatever the wheelsets do, and for the nominal parameters with static wheel loads and wheelsets
that are alike, which is the quarter model that reports set a simulated stop against.
"""

import math
from collections.abc import Mapping
from functools import partial
from typing import Any

from wspd_design.certificates.kernel.checker import Work
from wspd_design.certificates.kernel.obligation import Obligation, Special
from wspd_design.certificates.outside import OutsideModel
from wspd_design.certificates.records import Certificate, Point, Problem
from wspd_design.certificates.setting import domain
from wspd_design.certificates.setting.assumptions import ALL, Assumption
from wspd_design.certificates.theorems.shortest_stop.adhesion_limit import INSTANTS, NoBound, overspeed
from wspd_design.certificates.theorems.shortest_stop.adhesion_peaks import decide
from wspd_design.certificates.theorems.shortest_stop.extremes import (
    USED,
    Extremes,
    exactly,
    over_bounds,
)
from wspd_design.certificates.theorems.theorem import Findings, Theorem, all_of, hypothesis
from wspd_design.certificates.theorems.whom import every_law
from wspd_design.parameters.units import KMH

DISTANCE, TIME = "bound on the distance", "bound on the time"
"""Names of the two numbers that the certificate states for the nominal parameters."""
NOMINAL, BOUNDS = "nominal peaks", "peaks over the bounds"
"""Keys of the two obligations."""


def rounded_down(bound: float) -> str:
    """Write a lower bound so that what stands there is still one."""
    return f"{math.floor(100.0 * bound) / 100.0:.2f}"


def _shown(plants: Extremes, start: float, proof: Mapping[str, Any], work: Work) -> dict[str, float]:
    limit, parts = decide(plants, start, proof, work)
    return {
        "distance": limit.distance,
        "time": limit.time,
        "adhesion distance": limit.adhesion_distance,
        "handover": limit.handover,
        "intervals": float(len(limit.peaks)),
        "parts": float(parts),
    }


def _obligations(problem: Problem) -> tuple[Obligation, ...]:
    domain.box(problem)
    start = problem.speeds[1]
    plants = {NOMINAL: exactly(problem.vehicle, problem.rail), BOUNDS: over_bounds(problem)}
    try:
        for each in plants.values():
            overspeed(each, start)
    except NoBound as reason:
        raise OutsideModel(str(reason)) from None
    return tuple(
        Special(
            key=key,
            text=f"upper bounds on the adhesion peak at every speed of the stop, {key}",
            check=partial(_shown, each, start),
        )
        for key, each in plants.items()
    )


def _tell(problem: Problem, findings: Findings) -> Certificate:
    known, wide = findings[NOMINAL], findings[BOUNDS]
    where = domain.domain_of(problem, (*USED, "axle load share"))
    stop = f"stops this vehicle from {problem.speeds[1] * KMH:.3g} km/h on {problem.rail.name}"
    return Certificate(
        claim=f"No controller {stop} within less than {_bound(wide.numbers)} on {where.text}; with the nominal "
        f"parameters, static wheel loads and all wheelsets alike, not within less than {_bound(known.numbers)}.",
        status=all_of(known, wide),
        explanation=(
            "With the nominal parameters adhesion alone asks for "
            f"{rounded_down(known.numbers['adhesion distance'])} m; "
            f"until {known.numbers['handover']:.3g} s the filling brake is the limit."
            if known.proved
            else "No peaks of adhesion are stated that the checker accepts."
        ),
        worst_point=(
            Point(name=DISTANCE, value=known.numbers["distance"], unit="m"),
            Point(name=TIME, value=known.numbers["time"], unit="s"),
        )
        if known.proved
        else (),
        hypotheses=(
            hypothesis("the adhesion peaks of the nominal parameters are bounded", known),
            hypothesis("the adhesion peaks are bounded over all bounds, at the least wheel load", wide),
        ),
        assumptions=(
            "level track; the wheel loads add up to the weight",
            "the range of the axle load share is that of a load transfer that follows the deceleration without delay",
            "rolling wheels and empty cylinders at the start; no other brake",
        ),
        domain=where,
        varied=(*USED, "axle load share"),
        method="peaks and cuts of the slip that are searched, then shown in balls by an independent checker; "
        "momentum that the filling brake can take; both bound the speed from below" + _size(known.numbers),
        reference="eqs. (1), (2), (5)-(9); docs/theory.md#bound",
    )


def _bound(numbers: Mapping[str, float]) -> str:
    if not numbers:
        return "a distance that is not proved"
    return f"{rounded_down(numbers['distance'])} m or {rounded_down(numbers['time'])} s"


def _size(numbers: Mapping[str, float]) -> str:
    if not numbers:
        return ""
    return (
        f" (nominal: {numbers['intervals']:.0f} intervals of speed, {numbers['parts']:.0f} parts of the slip; "
        f"{INSTANTS} instants of the change from filling to adhesion)"
    )


CANNOT_HELP = frozenset(
    {
        Assumption.NO_LEAK,
        Assumption.NO_DEAD_TIME,
        Assumption.ANY_PULSE,
        Assumption.NO_WATCHDOG,
        Assumption.SUPPLY,
    }
)
"""No pressure is higher for a leak, a dead time, a lost pulse or a low reservoir than that of filling all along."""

STOP_BOUND = Theorem(
    name="stop_bound",
    title="Shortest stop of any controller",
    claim="No controller stops within less than a distance and a time.",
    speaks_about=every_law,
    obligations=_obligations,
    tell=_tell,
    assumes=ALL - CANNOT_HELP,
)
