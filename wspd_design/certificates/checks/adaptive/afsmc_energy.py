"""The energy of the adaptive fuzzy law: bounds from the repaired V, or that of the paper refuted."""

from collections.abc import Mapping

from wspd_design.certificates.checks.frame import Check, Figures, level, series
from wspd_design.certificates.checks.sliding.sliding_exists import torques
from wspd_design.certificates.kernel.arb import below
from wspd_design.certificates.kernel.finding import Stated
from wspd_design.certificates.records import Certificate, Problem
from wspd_design.certificates.search.together import settle_together
from wspd_design.certificates.theorems.afsmc_energy import AFSMC_ENERGY, braking_obligations
from wspd_design.certificates.theorems.authority import torque_obligations
from wspd_design.certificates.theorems.printed_energy import printed_rate
from wspd_design.certificates.theorems.whom import adaptive_law
from wspd_design.parameters.units import KMH

DECELERATION_TOLERANCE = 1e-2  # m/s2
SPEEDS = 41


def search(problem: Problem) -> Mapping[str, Stated]:
    """Enclose what the repaired law needs, or find the speed at which (44) fails most clearly."""
    if not adaptive_law(problem).gains.dead_zone:
        return _printed(problem)
    return {
        **torques(torque_obligations(problem)),
        **settle_together(braking_obligations(problem), tolerance=DECELERATION_TOLERANCE),
    }


def _printed(problem: Problem) -> Mapping[str, Stated]:
    speed, rate = max(_rates(problem), key=lambda pair: pair[1])
    return {"at s = 0": Stated(place={"speed": speed})} if rate > 0.0 else {}


def _rates(problem: Problem) -> list[tuple[float, float]]:
    """Return speeds with the least dV2/dt at s = 0 there [m/s, 1/s]."""
    import numpy as np

    speeds = np.geomspace(*problem.speeds, SPEEDS)
    speeds[[0, -1]] = problem.speeds  # without the rounding of the powers
    return [(float(speed), below(printed_rate(problem, float(speed)))) for speed in speeds]


def figures(problem: Problem, certificate: Certificate) -> Figures:  # noqa: ARG001 - the rates say more
    """Least rate of V2 at s = 0 over speed, for the printed law."""
    import numpy as np

    if adaptive_law(problem).gains.dead_zone:
        return Figures()
    speeds, rates = (np.array(column) for column in zip(*_rates(problem), strict=True))
    axes = ("speed [km/h]", "dV2/dt at s = 0 [1/s]")
    return Figures(
        series=(
            series("at least, as printed", *axes, speeds * KMH, rates),
            level("at most, as (44) says", *axes, speeds * KMH, 0.0),
        ),
        remark=f"The same happens at {np.count_nonzero(rates > 0.0)} of {SPEEDS} speeds.",
    )


CHECK = Check(theorem=AFSMC_ENERGY, search=search, figures=figures)
