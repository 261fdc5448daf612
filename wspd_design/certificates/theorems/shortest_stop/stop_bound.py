"""Theorem: no controller stops this vehicle within less than a distance and a time, shown from the adhesion peaks."""

import math
from collections.abc import Mapping
from functools import partial
from typing import Any

from wspd_design.certificates.kernel.checker import Work
from wspd_design.certificates.kernel.obligation import Obligation, Special
from wspd_design.certificates.outside import OutsideModel
from wspd_design.certificates.quantities import AXLE, QUANTITIES, STATE
from wspd_design.certificates.records import Certificate, Point, Problem
from wspd_design.certificates.setting import domain
from wspd_design.certificates.theorems.shortest_stop.adhesion_limit import INSTANTS, NoBound, require
from wspd_design.certificates.theorems.shortest_stop.adhesion_peaks import decide
from wspd_design.certificates.theorems.theorem import Findings, Theorem
from wspd_design.certificates.theorems.whom import every_law
from wspd_design.parameters.units import KMH

DISTANCE, TIME = "bound on the distance", "bound on the time"
"""Names of the two places that the certificate states."""
USED = tuple(name for name in QUANTITIES if name not in (*STATE, *AXLE, "max pressure", "vent time"))
"""Numbers that the bound depends on; of the brake only its torque and how fast it fills count."""


def rounded_down(bound: float) -> str:
    """Write a lower bound so that what stands there is still one."""
    return f"{math.floor(100.0 * bound) / 100.0:.2f}"


def _shown(problem: Problem, proof: Mapping[str, Any], work: Work) -> dict[str, float]:
    limit, parts = decide(problem.vehicle, problem.rail, problem.speeds[1], proof, work)
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
    try:
        require(problem.vehicle, problem.rail, problem.speeds[1])
    except NoBound as reason:
        raise OutsideModel(str(reason)) from None
    return (
        Special(
            key="peaks",
            text="upper bounds on the adhesion peak at every speed of the stop",
            check=partial(_shown, problem),
        ),
    )


def _tell(problem: Problem, findings: Findings) -> Certificate:
    found = findings["peaks"].numbers
    held = tuple(name for name in domain.uncertain(problem) if name in USED)
    values = domain.described(problem, (), held).removeprefix("; held: ")
    stop = f"from {problem.speeds[1] * KMH:.3g} km/h on {problem.rail.name}"
    plant = f"with its nominal parameters ({values}) and static wheel loads"
    return Certificate(
        name="stop_bound",
        title="Shortest stop of any controller",
        claim=f"No controller of this vehicle, {plant}, stops {stop} within less than "
        f"{rounded_down(found['distance'])} m or {rounded_down(found['time'])} s."
        if found
        else f"No controller of this vehicle, {plant}, stops {stop} within less than a distance that can be proved.",
        status=findings["peaks"].status,
        explanation=f"Adhesion alone asks for {rounded_down(found['adhesion distance'])} m; until "
        f"{found['handover']:.3g} s the filling brake is the limit."
        if found
        else "No peaks of adhesion are stated that the checker accepts.",
        worst_point=(
            Point(name=DISTANCE, value=found["distance"], unit="m"),
            Point(name=TIME, value=found["time"], unit="s"),
        )
        if found
        else (),
        assumptions=(
            "static wheel loads, level track",
            "rolling wheels and empty cylinders at the start; no other brake",
        ),
        held=held,
        method="peaks and cuts of the slip that are searched, then shown in balls by an independent checker; "
        "momentum that the filling brake can take; both bound the speed from below"
        + (
            f" ({found['intervals']:.0f} intervals of speed, {found['parts']:.0f} parts of the slip, {INSTANTS} "
            "instants of the change from filling to adhesion)"
            if found
            else ""
        ),
        reference="eqs. (1), (2), (5)-(9); docs/theory.md#bound",
    )


STOP_BOUND = Theorem(
    name="stop_bound",
    title="Shortest stop of any controller",
    claim="No controller stops within less than a distance and a time.",
    speaks_about=every_law,
    obligations=_obligations,
    tell=_tell,
)
