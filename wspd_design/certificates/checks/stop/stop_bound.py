"""No controller stops shorter than this, and how near to it the simulated stop comes."""

from collections.abc import Mapping
from fractions import Fraction

from wspd_design.certificates.checks.frame import Check, Figures, series
from wspd_design.certificates.kernel.finding import Stated
from wspd_design.certificates.records import Certificate, Problem, Series
from wspd_design.certificates.search import adhesion_peaks
from wspd_design.certificates.theorems.shortest_stop.adhesion_peaks import read
from wspd_design.certificates.theorems.shortest_stop.extremes import exactly, over_bounds
from wspd_design.certificates.theorems.shortest_stop.stop_bound import BOUNDS, NOMINAL, STOP_BOUND
from wspd_design.parameters.units import KMH
from wspd_design.simulation.ideal import ideal_stop
from wspd_design.simulation.peak import peak_adhesion
from wspd_design.simulation.records import Scenario
from wspd_design.simulation.runs import Ending, Run
from wspd_design.simulation.stop import simulate

WIDE = 100  # intervals of the speed, where the parameters are wide
ROUNDING = 1e-3  # m; a simulated stop ends a little above standstill


def search(problem: Problem) -> Mapping[str, Stated]:
    """Sample the peaks of adhesion, and find cuts of the slip with which the checker sees them."""
    start = problem.speeds[1]
    return {
        NOMINAL: Stated(proof=adhesion_peaks.search(exactly(problem.vehicle, problem.rail), start)),
        BOUNDS: Stated(proof=adhesion_peaks.search(over_bounds(problem), start, WIDE)),
    }


def figures(problem: Problem, certificate: Certificate) -> Figures:
    """Set the stop of this controller and the ideal stop against the bound."""
    found = certificate.findings[NOMINAL]
    if not found.proved or found.stated.proof is None:
        return Figures()
    scenario = Scenario(rail=problem.rail, initial_speed=problem.speeds[1])
    run = simulate(problem.vehicle, problem.controller, scenario, plant="quarter")
    ideal = ideal_stop(problem.vehicle, scenario, plant="quarter")
    bound = found.numbers["distance"]
    known = read(found.stated.proof, problem.speeds[1])
    return Figures(
        series=_plots(problem, (known.speeds, known.tops), bound, run),
        remark=_remark(run, ideal.distance, bound),
    )


def _remark(run: Run, ideal: float, bound: float) -> str:
    """Compare stops that are simulated with the bound that is proved."""
    distance, stopped = run.totals.distance, run.ending is Ending.STOPPED
    if ideal < bound - ROUNDING or (stopped and distance < bound - ROUNDING):
        return (
            f"A simulated stop is shorter than the bound: {distance:.4g} m, ideally {ideal:.4g} m. Bound and "
            "simulation speak about different plants; please report this."
        )
    own = (
        f"The simulated stop takes {distance:.4g} m and {run.time[-1]:.4g} s, an efficiency of {bound / distance:.1%}."
        if stopped
        else f"The simulated train does not stop within {run.time[-1]:.4g} s."
    )
    return (
        f"{own} An ideal brake that holds the adhesion peak takes {ideal:.4g} m, {ideal / bound - 1.0:.2%} more than "
        "what is proved."
    )


def _plots(
    problem: Problem, peaks: tuple[tuple[Fraction, ...], tuple[Fraction, ...]], bound: float, run: Run
) -> tuple[Series, ...]:
    """Enclosed peak over speed beside the sampled one, and the stop against the bound."""
    import numpy as np

    speeds, tops = (np.array([float(each) for each in exact]) for exact in peaks)
    above = np.append(speeds[1:], problem.speeds[1])
    sampled = peak_adhesion(problem.vehicle, problem.rail, above)[1]
    axes = ("speed [km/h]", "adhesion [-]")
    path = ("distance [m]", "speed [km/h]")
    return (
        series("bound on the peak", *axes, speeds * KMH, tops),
        series("peak", *axes, above * KMH, sampled),
        series("this stop", *path, run.distance, run.speed * KMH),
        series(
            "no stop ends before this",
            *path,
            np.array([bound] * 2),
            np.array([0.0, run.speed[0] * KMH]),
        ),
    )


CHECK = Check(theorem=STOP_BOUND, search=search, figures=figures)
