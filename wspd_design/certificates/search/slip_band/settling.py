"""Search for how wheels of a cell are followed until they are in the band."""

from collections.abc import Sequence

from wspd_design.certificates.kernel.checker import Refused
from wspd_design.certificates.records import Problem
from wspd_design.certificates.theorems.from_rolling.sample import law_numbers
from wspd_design.certificates.theorems.from_rolling.settling import Numbers, Plan, Settled, Start, settles
from wspd_design.certificates.theorems.slip_band.arrival import Asked
from wspd_design.certificates.theorems.slip_band.statement import law_of

FIRST, LAST = 3, 120  # samples in time before the rows, and after them
UNTIL = (21.0, 12.0)  # of what the pull falls by in a sample on the braking curve, where the rows end
HALVED = ("", "v", "ium", "vti")  # at the end, the first that does


def plan_for(
    problem: Problem,
    numbers: Numbers,
    start: Start,
    asked: Sequence[Asked],
) -> tuple[Plan, Settled] | str:
    """Return how the wheels of a cell are followed and what that shows, or why they cannot be."""
    sigma, why = law_numbers(law_of(problem.controller)).sigma, ""
    for until in UNTIL:
        for halved in HALVED:
            plan = Plan(FIRST, until * sigma, LAST, halved)
            try:
                return plan, settles(problem, numbers, start, asked, plan)
            except Refused as refused:
                why = str(refused)
                if "row" in why or "fall" in why:
                    break  # what comes after the rows makes no difference
    return why
