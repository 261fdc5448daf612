"""A brake between 0 and T_max can hold the slip on the surface: eta/g <= u* <= T_max - eta/g."""

from typing import TYPE_CHECKING

from wspd_design.certificates import domain, laws
from wspd_design.certificates.checking import certified, level, series
from wspd_design.certificates.domain import KMH, SLIP, SPEED
from wspd_design.certificates.reaching import reserve
from wspd_design.certificates.records import Certificate, Point, Problem, Range, Series, Status
from wspd_design.certificates.search import SOBOL_EXPONENT, STARTS, maximize
from wspd_design.controllers.adaptive_fuzzy import AdaptiveFuzzy
from wspd_design.controllers.sliding_mode import SlidingMode
from wspd_design.model.generated import sliding_surface
from wspd_design.model.slip import slip_dynamics

if TYPE_CHECKING:
    from wspd_design.certificates.domain import Array

NAME, TITLE = "brake_authority", "Authority of the brake"
PLOT_SPEEDS = 60


@certified(name=NAME, title=TITLE)
def check(problem: Problem) -> Certificate:
    """Search where the ideal torque leaves the range of the brake."""
    law = problem.controller
    if not isinstance(law, (AdaptiveFuzzy, SlidingMode)):
        return laws.no_surface(problem, NAME, "The brake can hold the slip on its surface.")
    rate, eta, limit = laws.surface_rate(law), reserve(problem), problem.vehicle.brake.max_torque

    def torques(points: "Array") -> tuple["Array", "Array"]:
        """Ideal torque u* and reserve eta/g [N m]."""
        plant = domain.dynamics(problem, points)
        error = sliding_surface.slip_error(law.gains.slip_reference, points[:, SLIP])
        ideal = sliding_surface.equivalent_torque(plant.drift, plant.gain, 0.0, error, rate)
        return ideal, eta / (plant.gain * points[:, SPEED])

    def lack_of_release(points: "Array") -> "Array":
        ideal, needed = torques(points)
        return needed - ideal

    def lack_of_force(points: "Array") -> "Array":
        ideal, needed = torques(points)
        return ideal + needed - limit

    corners = domain.box(problem)
    release = maximize(lack_of_release, *corners, seed=problem.seed)
    force = maximize(lack_of_force, *corners, seed=problem.seed)
    least = maximize(lambda points: -lack_of_force(points), *corners, seed=problem.seed)
    releases, never_enough = release.value <= 0.0, least.value < 0.0
    status = Status.EVIDENCE if releases else Status.REFUTED
    if releases and never_enough:
        status = Status.VACUOUS
    where = domain.readable(release.point)
    most = force.value + limit
    spot, tightest = (
        f"slip {found.point[SLIP]:.3f} and {found.point[SPEED] * KMH:.3g} km/h" for found in (force, release)
    )
    if never_enough:
        upper = (
            "The operation is brake-limited everywhere: the brake never reaches the adhesion of this rail, "
        )
        upper += "so nothing has to slide."
    elif force.value > 0.0:
        upper = (
            f"Brake-limited at points such as {spot}, where {most / 1e3:.3g} kN m would be needed. That is "
        )
        upper += "benign: the slip stays below its reference, and the brake is fully applied."
    else:
        upper = f"The brake is never the limit: at most {most / 1e3:.3g} kN m are needed, at {spot}."
    lower = (
        "A vented brake always lets the wheel recover. "
        if releases
        else f"At {tightest} even a vented brake does not bring the slip back as fast as the surface "
        "demands. "
    )
    return Certificate(
        name=NAME,
        title=TITLE,
        claim="The torque u* that holds the surface leaves room to release, u* >= eta/g with eta = "
        f"{eta:.3g} m/s2 and g = R/(2 I), and room to apply, u* <= {limit / 1e3:g} kN m - eta/g, except "
        f"where the operation is brake-limited; on {domain.described(problem)}.",
        status=status,
        explanation=lower + upper,
        margin=Range(low=None, high=-release.value, unit="N m"),
        worst_point=where,
        witness=() if releases else (*where, Point(name="u* - eta/g", value=-release.value, unit="N m")),
        assumptions=("T = u: no valve lag, no sampling", "slip reference constant"),
        method="even Sobol sampling with all corners, then bounded local optimization from the best points",
        resolution=f"{release.evaluations + force.evaluations + least.evaluations} evaluations: three times "
        f"2^{SOBOL_EXPONENT} Sobol points with the corners and {STARTS} local climbs",
        reference="eqs. (23), (27); findings, section 2, existence of sliding",
        series=_plots(problem, rate),
    )


def _plots(problem: Problem, rate: float) -> tuple[Series, ...]:
    """Ideal torque at the slip reference over speed, with nominal parameters, beside the brake's limit."""
    import numpy as np

    speeds = np.geomspace(*problem.speeds, PLOT_SPEEDS)
    plant = slip_dynamics(problem.vehicle, problem.rail, problem.slip, speeds)
    ideal = sliding_surface.equivalent_torque(plant.drift, plant.gain, 0.0, 0.0, rate)
    axes = ("speed [km/h]", "torque per wheelset [kN m]")
    return (
        series("u* at the slip reference", *axes, speeds * KMH, ideal / 1e3),
        level("T_max", *axes, speeds * KMH, problem.vehicle.brake.max_torque / 1e3),
    )
