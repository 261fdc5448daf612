"""The loop as it is built, with sampling, valves, lag and lock: does the slip stay at its reference?"""

from collections.abc import Mapping

from wspd_design.certificates.checks.frame import Check, Figures, level, series
from wspd_design.certificates.checks.sliding.sliding_exists import never
from wspd_design.certificates.kernel.finding import Stated
from wspd_design.certificates.records import Certificate, Problem
from wspd_design.certificates.theorems.authority import out_of_reach
from wspd_design.certificates.theorems.simulated_stop import TRACKING, start_of_stop, stays, tracked_stop
from wspd_design.certificates.theorems.whom import surface_of
from wspd_design.parameters.units import KMH


def search(problem: Problem) -> Mapping[str, Stated]:
    """Simulate a stop from the highest speed, and see whether the brake can reach the reference at all."""
    _, numbers = tracked_stop(problem)
    seen = (
        {"stop": Stated(numbers=numbers)}
        if stays(problem, numbers)
        else {"stray": Stated(place=start_of_stop(problem))}
    )
    return {**seen, **never(out_of_reach(problem, axle=False))}


def figures(problem: Problem, certificate: Certificate) -> Figures:  # noqa: ARG001 - the stop is simulated again
    """Slip and speed of the stop."""
    run, _ = tracked_stop(problem)
    return Figures(
        series=(
            series("slip", "time [s]", "slip [-]", run.time, run.slip[:, 0]),
            level("reference", "time [s]", "slip [-]", run.time, surface_of(problem).slip_reference),
            series("speed", "time [s]", "speed [km/h]", run.time, run.speed * KMH),
        )
    )


CHECK = Check(theorem=TRACKING, search=search, figures=figures)
