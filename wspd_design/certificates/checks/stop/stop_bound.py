"""No controller stops shorter than this, and how near to it the simulated stop comes."""

from wspd_design.certificates.checks.frame import OutsideModel, certified, model_hash, series
from wspd_design.certificates.records import (
    Certificate,
    Hypothesis,
    Point,
    Problem,
    Proof,
    Range,
    Series,
    Status,
)
from wspd_design.certificates.search import adhesion_peaks as peak_search
from wspd_design.certificates.search.settle import versions
from wspd_design.certificates.setting import domain
from wspd_design.certificates.setting.domain import KMH
from wspd_design.certificates.theorems.shortest_stop import adhesion_peaks
from wspd_design.certificates.theorems.shortest_stop.adhesion_limit import INSTANTS, Limit, NoBound, require
from wspd_design.certificates.theorems.shortest_stop.adhesion_peaks import CLAIM, rounded_down
from wspd_design.simulation.ideal import ideal_stop, peak_adhesion
from wspd_design.simulation.records import Ending, Run, Scenario
from wspd_design.simulation.stop import simulate

NAME, TITLE = "stop_bound", "Shortest stop of any controller"
ROUNDING = 1e-3  # m and s; a simulated stop ends a little above standstill


@certified(name=NAME, title=TITLE)
def check(problem: Problem) -> Certificate:
    """Bound every stop from below, simulate that of the controller, and compare."""
    domain.box(problem)
    start = problem.speeds[1]
    try:
        require(problem.vehicle, problem.rail, start)
    except NoBound as reason:
        raise OutsideModel(str(reason)) from None
    text = peak_search.search(problem)
    verdict = adhesion_peaks.check(problem, text)
    if verdict.limit is None:
        raise OutsideModel(f"the checker refuses what the search found: {verdict.reason}")
    limit = verdict.limit
    scenario = Scenario(rail=problem.rail, initial_speed=start)
    run = simulate(problem.vehicle, problem.controller, scenario, plant="quarter")
    ideal = ideal_stop(problem.vehicle, scenario, plant="quarter")
    distance, time = run.totals.distance, float(run.time[-1])
    stopped = run.ending is Ending.STOPPED
    room = distance - limit.distance
    kept = not stopped or (room >= -ROUNDING and time >= limit.time - ROUNDING)
    consistent = ideal.distance >= limit.distance - ROUNDING
    holds = kept and consistent
    where = (
        Point(name="bound of the distance", value=limit.distance, unit="m"),
        Point(name="bound of the time", value=limit.time, unit="s"),
        Point(name="distance of the simulated stop", value=distance, unit="m"),
        Point(name="time of the simulated stop", value=time, unit="s"),
        Point(name="distance of the ideal stop", value=ideal.distance, unit="m"),
    )
    efficiency = f"; this stop has an efficiency of {limit.distance / distance:.1%}" if stopped else ""
    return Certificate(
        name=NAME,
        title=TITLE,
        claim=f"No controller of this vehicle stops from {start * KMH:.3g} km/h on {problem.rail.name} within less "
        f"than {rounded_down(limit.distance)} m or {rounded_down(limit.time)} s.",
        status=Status.PROVED if holds else Status.REFUTED,
        explanation=(
            f"Adhesion alone asks for {limit.adhesion_distance:.4g} m; until {limit.handover:.3g} s the filling "
            f"brake is the limit. The simulated stop takes {distance:.4g} m and {time:.4g} s{efficiency}. An ideal "
            f"brake that holds the adhesion peak takes {ideal.distance:.4g} m, "
            f"{ideal.distance / limit.distance - 1.0:.2%} more than what is proved."
            if holds
            else f"A simulated stop is shorter than the bound: {distance:.4g} m and {time:.4g} s, ideally "
            f"{ideal.distance:.4g} m. Bound and simulation speak about different plants."
        ),
        margin=Range(low=room, high=room, unit="m"),
        worst_point=where,
        witness=() if holds else where,
        hypotheses=(
            Hypothesis(text="the simulated stop keeps the bound", status=_seen(kept)),
            Hypothesis(text="the ideal stop keeps the bound", status=_seen(consistent)),
        ),
        assumptions=(
            "quarter locomotive with static wheel load, nominal parameters, level track",
            "rolling wheels and empty cylinders at the start; no other brake",
        ),
        method="peaks and cuts of the slip that are searched, then shown in balls by an independent checker; "
        "momentum that the filling brake can take; both bound the speed from below",
        resolution=f"{len(limit.peaks)} intervals of speed, {verdict.leaves} parts of the slip, {INSTANTS} instants of "
        "the change from filling to adhesion",
        reference="eqs. (1), (2), (5)-(9); docs/theory.md#bound",
        engine=f"python-flint {versions()['python-flint']}",
        proofs=(
            Proof(
                claim=CLAIM,
                statement=verdict.statement,
                claim_hash=model_hash(problem),
                certificate=text,
                leaves=verdict.leaves,
                seconds=verdict.seconds,
            ),
        ),
        series=_plots(problem, limit, run),
    )


def _seen(holds: bool) -> Status:
    return Status.EVIDENCE if holds else Status.REFUTED


def _plots(problem: Problem, limit: Limit, run: Run) -> tuple[Series, ...]:
    """Enclosed peak over speed beside the sampled one, and the stop against the bound."""
    import numpy as np

    speeds = np.array([float(speed) for speed in limit.speeds])
    sampled = peak_adhesion(problem.vehicle, problem.rail, speeds[1:])[1]
    axes = ("speed [km/h]", "adhesion [-]")
    path = ("distance [m]", "speed [km/h]")
    return (
        series(
            "bound of the peak", *axes, speeds[:-1] * KMH, np.array([float(peak) for peak in limit.peaks])
        ),
        series("peak", *axes, speeds[1:] * KMH, sampled),
        series("this stop", *path, run.distance, run.speed * KMH),
        series(
            "no stop ends before this",
            *path,
            np.array([limit.distance] * 2),
            np.array([0.0, run.speed[0] * KMH]),
        ),
    )
