"""On the surface the slip error decays: e' + c e = 0 with c = K_I / K_P > 0."""

from collections.abc import Mapping

from wspd_design.certificates.checks.frame import Check
from wspd_design.certificates.kernel.finding import Stated
from wspd_design.certificates.records import Problem
from wspd_design.certificates.search.settle import settle_all
from wspd_design.certificates.theorems.surface import SURFACE_HURWITZ


def search(problem: Problem) -> Mapping[str, Stated]:
    """State the sign of c, which exact arithmetic decides."""
    return settle_all({each.key: each for each in SURFACE_HURWITZ.obligations(problem)}, {})


CHECK = Check(theorem=SURFACE_HURWITZ, search=search)
