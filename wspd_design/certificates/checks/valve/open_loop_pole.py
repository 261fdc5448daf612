"""The slip pole against the rate of the valve: p tau < 1."""

from collections.abc import Mapping

from wspd_design.certificates.checks.frame import Check, Figures
from wspd_design.certificates.checks.margin_map import margin_map
from wspd_design.certificates.checks.valve import slip_pole
from wspd_design.certificates.kernel.finding import Stated
from wspd_design.certificates.records import Certificate, Problem
from wspd_design.certificates.search.settle import settle_all
from wspd_design.certificates.setting import domain
from wspd_design.certificates.setting.plant import dynamics_at
from wspd_design.certificates.theorems.valve import OPEN_LOOP_POLE, slow_valve, slowest_valve

TOLERANCE = 1e-3  # -, of p tau


def search(problem: Problem) -> Mapping[str, Stated]:
    """Enclose p tau for the slowest valve; for a faster one only if that leaves the verdict open."""
    wanted = {each.key: each for each in OPEN_LOOP_POLE.obligations(problem)}
    if slow_valve(problem) == slowest_valve(problem):
        found = settle_all(wanted, {"every valve": TOLERANCE})
        return {**found, "some valve": found["every valve"]}
    return settle_all(wanted, {"every valve": TOLERANCE, "some valve": TOLERANCE})


def figures(problem: Problem, certificate: Certificate) -> Figures:
    """Pole over speed beside the rate of the slowest valve."""
    poles = slip_pole.pole_map(problem)
    limit = 1.0 / slowest_valve(problem)
    worst = certificate.findings["every valve"].values
    return Figures(
        series=slip_pole.plots(poles, "1/tau of the slowest valve", limit),
        maps=margin_map(
            "slip pole",
            "slip pole p [1/s]",
            lambda points: dynamics_at(problem, points, held=worst).pole,
            domain.slip_held(problem),
            over=domain.MU0,
            limit=limit,
            worst=worst,
            largest=True,
        ),
        remark=f"{slip_pole.unstable_speeds(poles, limit)}.",
    )


CHECK = Check(theorem=OPEN_LOOP_POLE, search=search, figures=figures)
