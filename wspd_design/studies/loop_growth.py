"""By how much a deviation of the slip grows from sample to sample near the reference."""

from collections.abc import Sequence
from dataclasses import dataclass

from wspd_design.certificates.checks.linear.margins import growths_per_sample
from wspd_design.certificates.records import Certificate, Problem, Status
from wspd_design.certificates.setting.linear_loop import linear_law
from wspd_design.design.stop_requirements import LOOP


@dataclass(frozen=True, slots=True, kw_only=True)
class Growth:
    """Largest magnitude of a pole of the nominal sampled loop with its valve: below 1 deviations die out."""

    factor: float  # -, per sample
    speed: float  # m/s, where it is largest
    unstable: int  # speeds at which it is above 1
    speeds: int  # at which it was worked out, evenly spaced in the logarithm


def growth_of(problem: Problem, certificates: Sequence[Certificate]) -> Growth | None:
    """Return the growth of a loop; None where the check of its margins does not speak about it."""
    silent = (Status.NOT_APPLICABLE, Status.VACUOUS)
    check = next((each for each in certificates if each.name == LOOP), None)
    if check is None or check.status in silent or linear_law(problem):
        return None
    found = growths_per_sample(problem)
    factor, speed = max(found)
    return Growth(
        factor=factor, speed=speed, unstable=sum(each > 1.0 for each, _ in found), speeds=len(found)
    )
