"""From rolling the slip comes to its reference: the loop enclosed sample by sample, over friction and supply rate."""

from collections.abc import Mapping
from typing import cast

from wspd_design.certificates.checks.frame import Check
from wspd_design.certificates.kernel.finding import Effort, Stated
from wspd_design.certificates.records import Problem
from wspd_design.certificates.search.budget import budget
from wspd_design.certificates.search.slip_band.way_in import plan
from wspd_design.certificates.theorems.slip_band.way_in import write
from wspd_design.certificates.theorems.way_in import SLIP_WAY_IN, STRIPS
from wspd_design.controllers.protection import Protection


def search(problem: Problem) -> Mapping[str, Stated]:
    """Choose strips that hold at the corners of both ranges; the checker follows all of them."""
    found = plan(problem, cast(Protection, problem.controller), budget().effort)
    if found is None:
        return {STRIPS: Stated(effort=Effort(undecided=1.0, cut=True))}
    return {STRIPS: Stated(proof=write(found.pieces))}


CHECK = Check(theorem=SLIP_WAY_IN, search=search)
