"""The input gain G = R/(2 I v) of (19) is positive: more torque always means more slip."""

from collections.abc import Mapping

from wspd_design.certificates.checks.frame import Check
from wspd_design.certificates.kernel.finding import Stated
from wspd_design.certificates.records import Problem
from wspd_design.certificates.search.settle import settle_all
from wspd_design.certificates.theorems.foundations import GAIN_POSITIVE


def search(problem: Problem) -> Mapping[str, Stated]:
    """State the signs of the factors, which exact arithmetic decides."""
    return settle_all({each.key: each for each in GAIN_POSITIVE.obligations(problem)}, {})


CHECK = Check(theorem=GAIN_POSITIVE, search=search)
