"""Quadratic functions for all speeds: a proof for laws that feed back the braking torque."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from fractions import Fraction
from itertools import product
from typing import TYPE_CHECKING

from wspd_design.certificates.checks.frame import Check, Figures, level, series
from wspd_design.certificates.kernel.checker import Refused
from wspd_design.certificates.kernel.claim import Claim
from wspd_design.certificates.kernel.finding import Stated
from wspd_design.certificates.kernel.obligation import Inequality, Obligation
from wspd_design.certificates.records import Certificate, Problem
from wspd_design.certificates.search.budget import Budget, budget, within
from wspd_design.certificates.search.prover import extreme, prove
from wspd_design.certificates.search.quadratic import search as find
from wspd_design.certificates.search.settle import finding, stated_of
from wspd_design.certificates.setting import creep_slope
from wspd_design.certificates.setting.plant import plant_with
from wspd_design.certificates.setting.pulsed_valve import Times, sample_of
from wspd_design.certificates.theorems import equilibrium
from wspd_design.certificates.theorems.quadratic import law_of, one_sample, proof_of, ranges_of
from wspd_design.certificates.theorems.region import (
    FASTEST,
    FUNCTION,
    LPV_LYAPUNOV,
    SLOWEST,
    loop_ranges,
    slopes,
)
from wspd_design.model.slip import slip_dynamics
from wspd_design.parameters.units import KMH

if TYPE_CHECKING:
    from wspd_design.certificates.setting.domain import Array

SLACKS = (
    0.5,
    2.0,
    8.0,
)  # 1/s, between what p - a/v attains and the bound that is proved; the first that succeeds
FIRST_LOOK = 0.02  # of the effort, to find what is attained
SPEEDS = 25


def search(problem: Problem) -> Mapping[str, Stated]:
    """Enclose the slope of the creep force, search functions, and look where the loop rests."""
    wanted = {each.key: each for each in LPV_LYAPUNOV.obligations(problem)}
    stated = {key: _slope(problem, _claim(wanted[key])) for key in (SLOWEST, FASTEST)}
    proved = slopes({key: finding(wanted[key], each) for key, each in stated.items()})
    functions = None
    if proved is not None:
        low, high = creep_slope.poles(problem, problem.near, *proved)
        functions = find(law_of(problem), ranges_of(problem, (Fraction(low), Fraction(high))))
    stated[FUNCTION] = (
        Stated(proof=proof_of(functions)) if functions else _first(wanted[FUNCTION], _places(problem))
    )
    return stated | _equilibrium(problem, wanted)


def _slope(problem: Problem, claim: Claim) -> Stated:
    """Prove a bound on the slope close to the largest value that a short search attains."""
    per_pole = 1.0 / _poles_per_slope(problem)
    with within(Budget(effort=FIRST_LOOK * budget().effort)):
        looked = extreme(claim, tolerance=SLACKS[0] * per_pole)
    upwards = claim.relation == "<="
    attained = looked.low if upwards else looked.high
    for slack in SLACKS:
        bound = attained + (slack if upwards else -slack) * per_pole
        bounded = replace(claim, bound=Fraction(bound))
        found = prove(bounded)
        if found.tree:
            return stated_of(bounded, found)
    return stated_of(claim, looked)


def _poles_per_slope(problem: Problem) -> float:
    """Largest mu0 N, by which q changes with the slope."""
    without, one = (creep_slope.poles(problem, problem.near, 0.0, most)[1] for most in (0.0, 1.0))
    return one - without


def _claim(obligation: Obligation) -> Claim:
    assert isinstance(obligation, Inequality)
    return obligation.claim


def _equilibrium(problem: Problem, wanted: Mapping[str, Obligation]) -> dict[str, Stated]:
    """Decide about both ends of the tolerance; where one fails, ask whether no slip within it will do."""
    stated, places = {}, []
    names = equilibrium.free(problem)
    for key in (equilibrium.ABOVE, equilibrium.BELOW):
        claim = _claim(wanted[key])
        found = prove(claim)
        stated[key] = stated_of(claim, found)
        places.append({name: at for name, at in stated[key].place.items() if name in names})
    return stated | {equilibrium.NOWHERE: _first(wanted[equilibrium.NOWHERE], places)}


def _first(obligation: Obligation, places: Iterable[Mapping[str, float]]) -> Stated:
    """Return the first place that denies a statement."""
    for each in places:
        stated = Stated(place=each)
        try:
            finding(obligation, stated)
        except Refused:
            continue
        return stated
    return Stated()


def _places(problem: Problem) -> Iterator[Mapping[str, float]]:
    """Places where the loop may be unstable: nominal numbers over speed, and the corners of valve and inertia."""
    import numpy as np

    ranges = loop_ranges(problem)
    nominal = {name: problem.nominal(name) for name in ranges if name not in ("slip", "speed")}
    narrow = ("fill time", "vent time", "max torque", "wheelset inertia")
    corners = [
        dict(zip(narrow, ends, strict=True)) for ends in product(*(problem.span(name) for name in narrow))
    ]
    for changed in ({}, *corners):
        shown = {name: each for name, each in changed.items() if name in nominal}
        for speed in np.geomspace(*problem.speeds, SPEEDS)[:: 1 if not changed else 4]:
            yield {**nominal, **shown, "slip": problem.slip, "speed": float(speed)}


def figures(problem: Problem, certificate: Certificate) -> Figures:  # noqa: ARG001 - samples of the nominal loop
    """Largest eigenvalue of the sampled loop over speed with nominal numbers, and p - a/v."""
    import numpy as np

    speeds = np.geomspace(*problem.speeds, SPEEDS)
    plant = slip_dynamics(*plant_with(problem, {}), problem.slip, speeds)
    poles = plant.pole - plant.deceleration / speeds
    sizes = np.array([_radius(problem, float(q)) for q in poles])
    axes = ("speed [km/h]", "eigenvalue [-]")
    return Figures(
        series=(
            series("largest of the sampled loop, nominal", *axes, speeds * KMH, sizes),
            level("limit", *axes, speeds * KMH, 1.0),
            series("nominal", "speed [km/h]", "p - a/v [1/s]", speeds * KMH, poles),
        ),
        remark=f"The largest eigenvalue of the nominal sampled loop is {sizes.max():.3g}, at frozen speeds.",
    )


def _radius(problem: Problem, pole: float) -> float:
    """Largest eigenvalue of the nominal sampled loop, at a duty of one half."""
    import numpy as np

    law = law_of(problem)
    fill, vent, top, inertia = (
        Fraction(problem.nominal(name))
        for name in ("fill time", "vent time", "max torque", "wheelset inertia")
    )
    half = Fraction(1, 2)
    q = Fraction(pole)
    sample = sample_of(Times((fill, fill), (vent, vent)), (q, q), law.sample_time, (half, half))
    matrix = one_sample(sample, law.slide * top / inertia, law.torque * top)
    found: Array = np.abs(np.linalg.eigvals(np.array([[float(each) for each in row] for row in matrix])))
    return float(found.max())


CHECK = Check(theorem=LPV_LYAPUNOV, search=search, figures=figures)
