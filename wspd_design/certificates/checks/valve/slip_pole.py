"""The open-loop slip pole dF/dslip at the reference, over speed and the bounds of the parameters."""

from dataclasses import dataclass
from itertools import product
from typing import TYPE_CHECKING

from wspd_design.certificates.checks.frame import level, series
from wspd_design.certificates.records import Problem, Series
from wspd_design.certificates.setting import domain
from wspd_design.certificates.setting.domain import INERTIA, MASS, MU0, SLIP, SPEED
from wspd_design.certificates.setting.plant import dynamics_at
from wspd_design.parameters.units import KMH

if TYPE_CHECKING:
    from wspd_design.certificates.setting.domain import Array

GRID_SPEEDS = 81
FRICTIONS = 33  # values of mu0 between its bounds: the pole is not monotone in it
AXES = ("speed [km/h]", "slip pole [1/s]")


@dataclass(frozen=True, slots=True, kw_only=True)
class PoleMap:
    """The slip pole over speed [1/s]."""

    speeds: "Array"  # m/s
    nominal: "Array"
    worst: "Array"  # largest over the corners of mass and inertia and some values of mu0


def pole_map(problem: Problem) -> PoleMap:
    """Evaluate the pole over speed."""
    import numpy as np

    low, high = domain.slip_held(problem)
    speeds = np.geomspace(low[SPEED], high[SPEED], GRID_SPEEDS)
    vehicle, rail = problem.vehicle, problem.rail

    def poles(mass: float, inertia: float, mu0: float) -> "Array":
        points = np.empty((len(speeds), 5))
        points[:, SLIP], points[:, SPEED] = problem.slip, speeds
        points[:, MASS], points[:, INERTIA], points[:, MU0] = mass, inertia, mu0
        found: Array = dynamics_at(problem, points).pole
        return found

    frictions = np.linspace(low[MU0], high[MU0], FRICTIONS)
    varied = product(problem.span("mass"), problem.span("wheelset inertia"), frictions)
    return PoleMap(
        speeds=speeds,
        nominal=poles(vehicle.mass, vehicle.wheelset_inertia, rail.mu0),
        worst=np.max([poles(*parameters) for parameters in varied], axis=0),
    )


def plots(poles: PoleMap, limit_name: str, limit: float) -> tuple[Series, ...]:
    """Pole over speed beside the limit that it must respect."""
    speeds = poles.speeds * KMH
    return (
        series("nominal", *AXES, speeds, poles.nominal),
        series("worst of the bounds", *AXES, speeds, poles.worst),
        level(limit_name, *AXES, speeds, limit),
    )


def nominal_plots(
    poles: PoleMap, limit_name: str, limit: float, proved: tuple[float, float] | None
) -> tuple[Series, ...]:
    """Nominal pole over speed beside its limit, and the speeds [m/s] where it is proved to lie beyond."""
    import numpy as np

    found = [series("nominal", *AXES, poles.speeds * KMH, poles.nominal)]
    if proved:
        inside = poles.speeds[(poles.speeds > proved[0]) & (poles.speeds < proved[1])]
        speeds = np.array([proved[0], *inside, proved[1]])
        beyond = np.interp(speeds, poles.speeds, poles.nominal)
        found.append(series("nominal, proved to be beyond the limit", *AXES, speeds * KMH, beyond))
    return (*found, level(limit_name, *AXES, poles.speeds * KMH, limit))


def unstable_speeds(poles: PoleMap, limit: float) -> str:
    """Say where the nominal pole exceeds a limit, which need not be that of the nominal valve."""
    import numpy as np

    beyond = np.flatnonzero(poles.nominal >= limit)
    if beyond.size == 0:
        return f"With nominal vehicle and rail the pole stays below {limit:.4g} 1/s at all speeds"
    low, high = poles.speeds[beyond[0]] * KMH, poles.speeds[beyond[-1]] * KMH
    share = f"{beyond.size} of {len(poles.speeds)} speeds between {low:.3g} and {high:.3g} km/h"
    return f"With nominal vehicle and rail the pole exceeds {limit:.4g} 1/s, the limit of the slowest valve, at {share}"
