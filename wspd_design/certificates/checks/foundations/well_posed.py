"""What every proof takes for granted: the train slows down, adhesion brakes it, and torque raises the slip."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

from wspd_design.certificates.checks.frame import Check, Figures
from wspd_design.certificates.checks.margin_map import margin_map
from wspd_design.certificates.kernel.finding import Stated
from wspd_design.certificates.kernel.obligation import Inequality
from wspd_design.certificates.records import Certificate, Problem
from wspd_design.certificates.search.together import settle_together
from wspd_design.certificates.setting import domain
from wspd_design.certificates.setting.plant import dynamics_at
from wspd_design.certificates.theorems.edges import of_key, together
from wspd_design.certificates.theorems.signs import WELL_POSED, sign_obligations

if TYPE_CHECKING:
    pass

TOLERANCES = {"m/s2": 1e-2, "N": 5.0, "1/s per MN m": 0.01, "1/s2 per MN m": 0.01}


def search(problem: Problem) -> Mapping[str, Stated]:
    """Enclose the four quantities."""
    parts: dict[str, list[Inequality]] = {}
    for each in sign_obligations(problem):
        parts.setdefault(each.claim.name, []).append(each)
    found: dict[str, Stated] = {}
    for of_one in parts.values():
        found |= settle_together(of_one, tolerance=TOLERANCES[of_one[0].claim.unit])
    return found


def figures(problem: Problem, certificate: Certificate) -> Figures:
    """Deceleration over slip and speed, the other numbers as where it is least."""
    at = together(of_key(certificate.findings.items(), "deceleration")).values
    if not at:
        return Figures()
    return Figures(
        maps=margin_map(
            "deceleration",
            "deceleration a [m/s2]",
            lambda points: dynamics_at(problem, points, held=at).deceleration,
            domain.box(problem),
            over=domain.SLIP,
            limit=0.0,
            worst=at,
            largest=False,
        )
    )


CHECK = Check(theorem=WELL_POSED, search=search, figures=figures)
