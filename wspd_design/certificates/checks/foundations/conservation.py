"""The simulated stop conserves momentum and energy, or it is not a stop of this vehicle."""

from collections.abc import Mapping

from wspd_design.certificates.checks.frame import Check
from wspd_design.certificates.kernel.finding import Stated
from wspd_design.certificates.records import Problem
from wspd_design.certificates.theorems.simulated_stop import CONSERVATION, balances, residuals, start_of_stop


def search(problem: Problem) -> Mapping[str, Stated]:
    """Simulate a stop on each plant."""
    numbers = residuals(problem)
    if balances(numbers):
        return {"stops": Stated(numbers=numbers)}
    return {"loss": Stated(place=start_of_stop(problem))}


CHECK = Check(theorem=CONSERVATION, search=search)
