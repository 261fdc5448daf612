"""Speeds at which no law of the theorem can be stable with this valve: where the slip pole p reaches 1/tau."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

from wspd_design.certificates.checks.frame import Check, Figures
from wspd_design.certificates.checks.valve import slip_pole
from wspd_design.certificates.kernel.finding import Stated
from wspd_design.certificates.records import Certificate, Problem, Status
from wspd_design.certificates.search.settle import settle
from wspd_design.certificates.theorems.valve import NO_GO, interval_claim, valve_rate
from wspd_design.model.slip import slip_dynamics

if TYPE_CHECKING:
    from wspd_design.certificates.setting.domain import Array

TOLERANCE = 1e-3  # 1/s, of the enclosed pole
GRID_SPEEDS = 401
INSET = 1e-3  # relative; the claimed interval ends this far inside the crossings


def search(problem: Problem) -> Mapping[str, Stated]:
    """Find the widest interval of speeds with p >= 1/tau at the nominal parameters, or show that there is none."""
    below, limit = valve_rate(problem)
    interval = widest_interval(problem, limit)
    if interval is None:
        claim = interval_claim(problem, below, problem.speeds, "<=")
        return {"nowhere": settle(claim, tolerance=TOLERANCE)}
    return {"beyond": settle(interval_claim(problem, limit, interval, ">="), tolerance=TOLERANCE)}


def figures(problem: Problem, certificate: Certificate) -> Figures:
    """Nominal pole over speed, and where it is proved to lie beyond the limit."""
    proved = certificate.findings["beyond"].part if certificate.status is Status.LIMITATION else None
    limit = valve_rate(problem)[1]
    return Figures(
        series=slip_pole.nominal_plots(
            slip_pole.pole_map(problem), "1/tau of the fastest nominal valve", limit, proved
        )
    )


def widest_interval(problem: Problem, limit: float) -> tuple[float, float] | None:
    """Search the widest interval of speeds [m/s] on which the nominal pole exceeds a limit [1/s]."""
    import numpy as np
    from scipy.optimize import brentq

    def excess(speed: "float | Array") -> "Array":
        found: Array = slip_dynamics(problem.vehicle, problem.rail, problem.slip, speed).pole - limit
        return found

    speeds = np.geomspace(*problem.speeds, GRID_SPEEDS)
    above = excess(speeds) > 0.0
    edges = np.flatnonzero(np.diff(np.concatenate([[False], above, [False]]).astype(int)))
    if edges.size == 0:
        return None

    def crossing(outside: int, inside: int, direction: float) -> float:
        if not 0 <= outside < GRID_SPEEDS:
            return float(speeds[inside])
        root = brentq(excess, *sorted((float(speeds[outside]), float(speeds[inside]))))
        return float(root) * (1.0 + direction * INSET)

    intervals = [
        (crossing(int(first) - 1, int(first), 1.0), crossing(int(end), int(end) - 1, -1.0))
        for first, end in zip(edges[::2], edges[1::2], strict=True)
    ]
    return max(
        (each for each in intervals if each[0] < each[1]), key=lambda each: each[1] / each[0], default=None
    )


CHECK = Check(theorem=NO_GO, search=search, figures=figures)
