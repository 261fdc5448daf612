"""What the commands of a law depend on: decided from the graph of its step, with nothing to search for."""

from collections.abc import Mapping

from wspd_design.certificates.checks.frame import Check
from wspd_design.certificates.kernel.finding import Stated
from wspd_design.certificates.records import Problem
from wspd_design.certificates.theorems.feedback import FEEDBACK


def search(problem: Problem) -> Mapping[str, Stated]:  # noqa: ARG001 - the design alone decides
    """State nothing."""
    return {}


CHECK = Check(theorem=FEEDBACK, search=search)
