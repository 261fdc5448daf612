"""A stop as it is simulated, for every law: does the slip get to its reference, and how far beyond it?"""

from collections.abc import Mapping

from wspd_design.certificates.checks.frame import Check
from wspd_design.certificates.checks.sliding.sliding_exists import never
from wspd_design.certificates.kernel.finding import Stated
from wspd_design.certificates.records import Problem
from wspd_design.certificates.theorems.authority import out_of_reach
from wspd_design.certificates.theorems.overshoot import OVERSHOOT, judged_stop, keeps, numbers_of
from wspd_design.certificates.theorems.simulated_stop import start_of_stop


def search(problem: Problem) -> Mapping[str, Stated]:
    """Simulate a stop from the highest speed, and see whether the brake can reach the reference at all."""
    numbers = numbers_of(*judged_stop(problem))
    seen = (
        {"stop": Stated(numbers=numbers)}
        if keeps(problem, numbers)
        else {"beyond": Stated(place=start_of_stop(problem))}
    )
    return {**seen, **never(out_of_reach(problem, axle=False))}


CHECK = Check(theorem=OVERSHOOT, search=search)
