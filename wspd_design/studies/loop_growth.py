"""By how much a deviation of the slip grows from sample to sample near the reference."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from wspd_design.certificates.checks.linear.margins import growths_per_sample
from wspd_design.certificates.records import Certificate, Problem, Status
from wspd_design.certificates.setting.linear_loop import linear_law
from wspd_design.certificates.setting.traced_loop import Rest
from wspd_design.certificates.theorems.traced_loop import rests
from wspd_design.design.stop_requirements import LOOP, TRACED_LOOP

_SILENT = (Status.NOT_APPLICABLE, Status.VACUOUS)


@dataclass(frozen=True, slots=True, kw_only=True)
class Growth:
    """Largest magnitude of a pole of the nominal sampled loop with its valve: below 1 deviations die out."""

    factor: float  # -, per sample
    speed: float  # m/s, where it is largest
    unstable: int  # speeds at which it is above 1
    speeds: int  # at which it was worked out


def check_of_loop(found: Mapping[str, Certificate]) -> Certificate | None:
    """Return the check that tells the growth: by the form of the law if that is known, else by its traced step."""
    checks = (found.get(name) for name in (LOOP, TRACED_LOOP))
    return next((each for each in checks if each is not None and each.status not in _SILENT), None)


def growth_of(problem: Problem, certificates: Sequence[Certificate]) -> Growth | None:
    """Return the growth of a loop; None where no check of it speaks about the law."""
    check = check_of_loop({each.name: each for each in certificates})
    if check is None:
        return None
    if check.name == TRACED_LOOP:
        found = [(each.radius, each.speed) for each in rests(problem) if isinstance(each, Rest)]
    elif linear_law(problem):
        return None
    else:
        found = growths_per_sample(problem)
    factor, speed = max(found)
    return Growth(
        factor=factor, speed=speed, unstable=sum(each > 1.0 for each, _ in found), speeds=len(found)
    )
