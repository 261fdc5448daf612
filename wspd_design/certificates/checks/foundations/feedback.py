"""What the commands of a law depend on: paths of the graph of its step, and pairs of histories that show it."""

from collections.abc import Mapping

from wspd_design.certificates.checks.frame import Check
from wspd_design.certificates.kernel.finding import Stated
from wspd_design.certificates.records import Problem
from wspd_design.certificates.theorems.feedback import (
    FEEDBACK,
    found_pair,
    pair_of_histories,
    traced,
    wheelsets_of,
)


def search(problem: Problem) -> Mapping[str, Stated]:
    """Look for two histories that differ in the speed of a wheel and in its command."""
    law = traced(problem)
    found = {each: found_pair(law, each) for each in wheelsets_of(problem, law)}
    return {
        f"histories, {each}": Stated(proof=pair_of_histories(number))
        for each, number in found.items()
        if number is not None
    }


CHECK = Check(theorem=FEEDBACK, search=search)
