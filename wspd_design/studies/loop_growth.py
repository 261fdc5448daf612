"""By how much a deviation of the slip grows from sample to sample near the reference."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from wspd_design.certificates.checks.linear.margins import growths_per_sample
from wspd_design.certificates.records import Certificate, Problem, Status
from wspd_design.certificates.setting.linear_loop import linear_law
from wspd_design.design.stop_requirements import LOOPS
from wspd_design.parameters.units import KMH

POLE = "magnitude of a pole"


@dataclass(frozen=True, slots=True, kw_only=True)
class Growth:
    """Largest magnitude of a pole of the nominal sampled loop with its valve: below 1 deviations die out."""

    factor: float  # -, per sample
    speed: float  # m/s, where it is largest
    unstable: int = 0  # speeds at which it is above 1, where that was counted
    speeds: int = 0  # at which it was worked out, evenly spaced in the logarithm; 0 where it was not counted


def speaking(found: Mapping[str, Certificate]) -> Certificate | None:
    """Return the first check of the loop near its reference that speaks about the law."""
    silent = (Status.NOT_APPLICABLE, Status.VACUOUS)
    known = (found[name] for name in LOOPS if name in found)
    return next((each for each in known if each.status not in silent), None)


def growth_of(problem: Problem, certificates: Sequence[Certificate]) -> Growth | None:
    """Return the growth of a loop; None where no check of it speaks about the law."""
    check = speaking({each.name: each for each in certificates})
    if check is None:
        return None
    if check.name == LOOPS[0] and not linear_law(problem):
        found = growths_per_sample(problem)
        factor, speed = max(found)
        unstable = sum(each > 1.0 for each, _ in found)
        return Growth(factor=factor, speed=speed, unstable=unstable, speeds=len(found))
    return _stated(check)


def _stated(check: Certificate) -> Growth | None:
    """Take the growth from the tightest point of a check."""
    at = {each.name: each.value for each in check.worst_point}
    if not {POLE, "speed"} <= set(at):
        return None
    return Growth(factor=at[POLE], speed=at["speed"] / KMH)
