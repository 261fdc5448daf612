"""From rolling the slip comes to its reference: the loop enclosed sample by sample, over friction and supply rate."""

from collections.abc import Mapping
from fractions import Fraction
from typing import Any, cast

from wspd_design.certificates.checks.frame import Check
from wspd_design.certificates.checks.region.slip_band import bounded_friction
from wspd_design.certificates.kernel.finding import Effort, Stated
from wspd_design.certificates.records import Problem
from wspd_design.certificates.search.budget import budget
from wspd_design.certificates.search.slip_band.chain import Sought
from wspd_design.certificates.search.slip_band.search import alone, exactly
from wspd_design.certificates.search.slip_band.way_in import plan
from wspd_design.certificates.theorems.slip_band.friction import Halves
from wspd_design.certificates.theorems.slip_band.proof import write as write_band
from wspd_design.certificates.theorems.slip_band.statement import law_of
from wspd_design.certificates.theorems.slip_band.way_in import around, write
from wspd_design.certificates.theorems.way_in import SLIP_WAY_IN, STRIPS
from wspd_design.controllers.protection import Protection


def search(problem: Problem) -> Mapping[str, Stated]:
    """Choose strips whose outer ones hold and get into a band; the checker follows all of them."""
    law, near = cast(Protection, problem.controller), around(problem)
    stated, friction = bounded_friction(near, SLIP_WAY_IN.obligations(problem))
    band = None if friction is None else _band(near, law, friction)
    pieces = plan(problem, law, budget().effort, settled=band is not None)
    if pieces is None:
        return stated | {STRIPS: Stated(effort=Effort(undecided=1.0, cut=True))}
    return stated | {STRIPS: Stated(proof=write(pieces, band))}


def _band(problem: Problem, law: Protection, friction: tuple[Halves, ...]) -> dict[str, Any] | None:
    """Find a band in one cell, which is the whole box of friction and supply rate."""
    numbers = law_of(law)
    sought = Sought(problem=problem, law=numbers, friction=friction, conditions=exactly(problem, numbers))
    found = alone(sought, Fraction(1))
    return write_band(found) if found else None


CHECK = Check(theorem=SLIP_WAY_IN, search=search)
