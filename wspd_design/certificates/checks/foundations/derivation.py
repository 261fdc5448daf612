"""The equations that the program runs on follow from the laws of motion: identities of the functions themselves."""

from collections.abc import Mapping

from wspd_design.certificates.checks.frame import Check
from wspd_design.certificates.kernel.finding import Stated
from wspd_design.certificates.records import Problem
from wspd_design.certificates.search.settle import settle_all
from wspd_design.certificates.theorems.equations import DERIVATION


def search(problem: Problem) -> Mapping[str, Stated]:
    """State the identities, which exact arithmetic decides."""
    return settle_all({each.key: each for each in DERIVATION.obligations(problem)}, {})


CHECK = Check(theorem=DERIVATION, search=search)
