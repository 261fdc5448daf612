"""A sampled law with observer keeps its slip in a band: ellipsoids that no sample leads out of."""

import math
from collections.abc import Mapping, Sequence
from fractions import Fraction
from itertools import product

from wspd_design.certificates.checks.frame import Check
from wspd_design.certificates.checks.region.slip_band_figures import figures
from wspd_design.certificates.kernel.finding import Effort, Place, Stated
from wspd_design.certificates.kernel.obligation import Inequality, Obligation
from wspd_design.certificates.records import Problem
from wspd_design.certificates.search.budget import budget
from wspd_design.certificates.search.settle import enclose, finding
from wspd_design.certificates.search.slip_band.chain import Sought
from wspd_design.certificates.search.slip_band.disturbed import latest, noisiest
from wspd_design.certificates.search.slip_band.search import (
    exactly,
    largest_share,
    with_reserve,
)
from wspd_design.certificates.theorems.band import (
    CELLS,
    DEPARTURE,
    DIRECTIONS,
    LATE,
    NOISY,
    RESERVED,
    SLIP_BAND,
    contact_held,
    key,
    proved_friction,
)
from wspd_design.certificates.theorems.slip_band.attempt import effort_of
from wspd_design.certificates.theorems.slip_band.departure import corners, lock, missing_torque
from wspd_design.certificates.theorems.slip_band.friction import NAMES, PARTS, Parts
from wspd_design.certificates.theorems.slip_band.proof import Proof, write
from wspd_design.certificates.theorems.slip_band.statement import law_of, windows_of
from wspd_design.controllers.protection import Protection

TOLERANCES = {"slope": 1e-3, "level": 2e-3, "fading": 5e-4}  # s/m, -, s/m
SOUGHT = 600  # ellipsoids for each share of the box, with an effort of 1


def search(problem: Problem) -> Mapping[str, Stated]:
    """Bound the friction in each window, then cover the box with cells that have ellipsoids."""
    stated, friction = bounded_friction(problem, SLIP_BAND.obligations(problem))
    if friction is None:
        return stated | {
            **dict.fromkeys((CELLS, RESERVED, LATE, NOISY), Stated()),
            DEPARTURE: _departure(problem),
        }
    law = law_of(problem.controller)
    sought = Sought(
        problem=contact_held(problem), law=law, friction=friction, conditions=exactly(problem, law)
    )
    found, failed = largest_share(sought, SOUGHT * budget().effort)
    effort = effort_of(problem, failed, proved=found.share if found else Fraction(0)) if failed else Effort()
    if found is None:
        others = {
            RESERVED: _reserved(sought),
            LATE: Stated(),
            NOISY: Stated(),
            DEPARTURE: _departure(problem),
        }
        return stated | others | {CELLS: Stated(effort=effort)}
    # What is shown on the whole box needs no look for what would deny it.
    away = Stated() if found.share == 1 else _departure(problem)
    reserved = Stated() if found.share == 1 else _reserved(sought)
    others = _disturbed(sought, found) | {RESERVED: reserved, DEPARTURE: away}
    return stated | others | {CELLS: Stated(proof=write(found), effort=effort)}


def bounded_friction(
    problem: Problem, obligations: Sequence[Obligation]
) -> tuple[dict[str, Stated], tuple[Parts, ...] | None]:
    """Bound the friction in each window; none if one is open."""
    wanted = {each.key: each for each in obligations}
    stated = {}
    for k, part, name, relation in product(range(len(windows_of(problem))), range(PARTS), NAMES, DIRECTIONS):
        obligation = wanted[key(name, part, k, relation)]
        assert isinstance(obligation, Inequality)
        stated[obligation.key] = enclose(obligation.claim, tolerance=TOLERANCES[name.split()[0]])
    found = {name: finding(wanted[name], each) for name, each in stated.items()}
    return stated, proved_friction(problem, found)


def _reserved(sought: Sought) -> Stated:
    """Look for the whole box with a reserve of the brake, if more than the usual effort is wanted."""
    if budget().effort <= 1.0:
        return Stated()
    found = with_reserve(sought, SOUGHT * budget().effort)
    return Stated(proof=write(found) if found else None)


def _disturbed(sought: Sought, found: Proof) -> dict[str, Stated]:
    """Look for what else the band bears, unless less than the usual effort is wanted."""
    if budget().effort < 1.0:
        return {LATE: Stated(), NOISY: Stated()}
    # A law of a user is compared with what it declares for speeds without noise.
    noisy = noisiest(sought, found) if isinstance(sought.problem.controller, Protection) else None
    borne = {LATE: latest(sought, found), NOISY: noisy}
    return {name: Stated(proof=write(each) if each else None) for name, each in borne.items()}


def _departure(problem: Problem) -> Stated:
    """Look for a corner of the box where the brake is the limit, then for one from which wheels lock."""
    places: list[Place] = list(corners(problem))
    for each in places:
        for speed in problem.speeds:
            if missing_torque(problem, {**each, "speed": speed}):
                return Stated(place={**each, "speed": speed})
    low, high = problem.speeds
    tried = places[: max(1, round(len(places) * min(budget().effort, 1.0)))]
    for each in tried:
        middle = {**each, "speed": math.sqrt(low * high)}
        if lock(problem, middle):
            return Stated(place=middle)
    return Stated(effort=Effort(boxes=len(tried), undecided=1.0, cut=len(tried) < len(places)))


CHECK = Check(theorem=SLIP_BAND, search=search, figures=figures)
