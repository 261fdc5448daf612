"""The slip pole against what sampled feedback can stabilize through the valve."""

from collections.abc import Mapping

from wspd_design.certificates.checks.frame import Check, Figures
from wspd_design.certificates.checks.valve import slip_pole
from wspd_design.certificates.kernel.finding import Stated
from wspd_design.certificates.records import Certificate, Problem
from wspd_design.certificates.search.settle import settle_all
from wspd_design.certificates.theorems.valve import SAMPLING

TOLERANCE = 1e-3  # 1/s, of the enclosed pole


def search(problem: Problem) -> Mapping[str, Stated]:
    """Enclose the slip pole."""
    return settle_all({each.key: each for each in SAMPLING.obligations(problem)}, {"pole": TOLERANCE})


def figures(problem: Problem, certificate: Certificate) -> Figures:
    """Pole over speed beside the largest that a gain stabilizes."""
    poles, limit = slip_pole.pole_map(problem), float(certificate.findings["pole"].limit)
    return Figures(
        series=slip_pole.plots(poles, "p_max", limit),
        remark=f"{slip_pole.unstable_speeds(poles, limit)}.",
    )


CHECK = Check(theorem=SAMPLING, search=search, figures=figures)
