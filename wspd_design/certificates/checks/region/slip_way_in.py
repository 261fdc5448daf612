"""From rolling the slip comes to its reference: cells of all numbers, or strips of friction and supply rate."""

from collections.abc import Mapping
from fractions import Fraction
from functools import cache, partial
from typing import Any, cast

from wspd_design.certificates.checks.frame import Check
from wspd_design.certificates.checks.region.slip_band import bounded_friction
from wspd_design.certificates.kernel.finding import Effort, Stated
from wspd_design.certificates.records import Problem
from wspd_design.certificates.search.budget import budget
from wspd_design.certificates.search.slip_band.chain import Sought
from wspd_design.certificates.search.slip_band.search import alone, exactly
from wspd_design.certificates.search.slip_band.way_in import SHARES, plan, powers_of
from wspd_design.certificates.search.slip_band.ways_in import ways
from wspd_design.certificates.theorems.from_rolling import ways_in
from wspd_design.certificates.theorems.slip_band.friction import Parts
from wspd_design.certificates.theorems.slip_band.proof import write as write_band
from wspd_design.certificates.theorems.slip_band.statement import law_of
from wspd_design.certificates.theorems.slip_band.way_in import around, asked_of, asks_of, write
from wspd_design.certificates.theorems.way_in import SLIP_WAY_IN, STRIPS
from wspd_design.controllers.protection import Protection

IN_CELLS = tuple(map(Fraction, ("1/8", "1/4", "3/8", "1/2")))
"""Shares of the ranges of the other numbers, each way from their nominal values, that are sought in cells."""
OTHERS = tuple(map(Fraction, ("1/16", "1/20", "1/30", "1/50", "1/100", "1/200", "0")))
"""Such shares in strips."""
NOISES = tuple(map(Fraction, ("0.002", "0.001", "0.0005", "0.0001", "0")))
"""Noise of measured speeds that a band may bear [m/s]: the more, the larger are the ellipsoids that wheels get into."""


def search(problem: Problem) -> Mapping[str, Stated]:
    """Find cells that get into a band; or choose strips whose outer ones hold and do. The checker follows all of them.

    All of the friction counts more than a larger share of the other numbers.
    """
    law, effort = cast(Protection, problem.controller), budget().effort
    stated, friction = bounded_friction(around(problem), SLIP_WAY_IN.obligations(problem))
    cells = None if friction is None else _in_cells(problem, law, friction, effort)
    if cells is not None:
        return stated | {STRIPS: Stated(proof=cells)}
    tried = [(1.0, each) for each in OTHERS] + [(each, OTHERS[-1]) for each in SHARES[1:]]
    powers = cache(partial(powers_of, problem, law))
    for of_friction, others in tried:
        near = around(problem, others)
        band = None if friction is None else _band(near, law, friction)
        asked = None if band is None else asked_of(near, band)
        rows = plan(near, law, effort, asked, powers(of_friction), of_friction)
        if rows is not None:
            return stated | {STRIPS: Stated(proof=write(rows, others, band))}
    return stated | {STRIPS: Stated(effort=Effort(undecided=1.0, cut=True))}


def _in_cells(
    problem: Problem, law: Protection, friction: tuple[Parts, ...], effort: float
) -> dict[str, Any] | None:
    """Find cells for the largest share of the ranges before the first one that the effort is not enough for."""
    largest = None
    for share in IN_CELLS if not ways_in.speaks_about(problem) else ():
        near = around(problem, share)
        band = _band(near, law, friction)
        found = None if band is None else ways(near, share, asks_of(near, band), effort)
        if found is None or band is None:
            break
        largest = ways_in.write(found, band)
    return largest


def _band(problem: Problem, law: Protection, friction: tuple[Parts, ...]) -> dict[str, Any] | None:
    """Find a band in one cell, which is the whole box around the nominal numbers."""
    numbers = law_of(law)
    exact = exactly(problem, numbers)
    for noise in NOISES:
        conditions = exact._replace(noise=noise)
        sought = Sought(problem=problem, law=numbers, friction=friction, conditions=conditions)
        found = alone(sought, Fraction(1))
        if found is not None:
            return write_band(found)
    return None


CHECK = Check(theorem=SLIP_WAY_IN, search=search)
