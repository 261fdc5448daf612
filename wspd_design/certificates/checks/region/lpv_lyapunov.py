"""Quadratic functions for all speeds: a proof for laws that feed back the braking torque."""

from collections.abc import Iterator, Mapping
from fractions import Fraction
from itertools import product
from typing import TYPE_CHECKING

from wspd_design.certificates.checks.frame import Check, Figures, level, series
from wspd_design.certificates.kernel.claim import Claim
from wspd_design.certificates.kernel.finding import Stated
from wspd_design.certificates.kernel.obligation import Inequality
from wspd_design.certificates.records import Certificate, Problem, Status
from wspd_design.certificates.search.prover import extreme
from wspd_design.certificates.search.quadratic import search as find
from wspd_design.certificates.search.settle import enclose, finding, settle
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

POLE_TOLERANCE = 0.25  # 1/s, of the ends of p - a/v
RATE_TOLERANCE = 0.05  # 1/s
SPEEDS = 25


def search(problem: Problem) -> Mapping[str, Stated]:
    """Enclose the slope of the creep force, search functions, and look where the loop rests."""
    wanted = {each.key: each for each in LPV_LYAPUNOV.obligations(problem)}
    stated: dict[str, Stated] = {}
    least = creep_slope.poles(problem, problem.near, 0.0, 1.0)[1] - creep_slope.poles(problem, problem.near, 0.0, 0.0)[1]
    for key in (SLOWEST, FASTEST):
        stated[key] = enclose(_claim(wanted[key]), tolerance=POLE_TOLERANCE / least)
    found = {key: finding(wanted[key], stated[key]) for key in (SLOWEST, FASTEST)}
    proved = slopes(found)
    if proved is not None:
        poles = creep_slope.poles(problem, problem.near, *proved)
        functions = find(law_of(problem), ranges_of(problem, (Fraction(poles[0]), Fraction(poles[1]))))
        stated[FUNCTION] = Stated() if functions is None else Stated(proof=proof_of(functions))
    if stated.get(FUNCTION, Stated()).proof is None:
        stated[FUNCTION] = _first(wanted[FUNCTION], _places(problem))
    return stated | _equilibrium(problem, wanted)


def _claim(obligation: object) -> Claim:
    assert isinstance(obligation, Inequality)
    return obligation.claim


def _equilibrium(problem: Problem, wanted: Mapping[str, object]) -> dict[str, Stated]:
    """Decide about both ends of the tolerance; where one fails, ask whether no slip within it will do."""
    stated, places = {}, []
    for key in (equilibrium.ABOVE, equilibrium.BELOW):
        claim = _claim(wanted[key])
        stated[key] = settle(claim, tolerance=RATE_TOLERANCE)
        if finding(wanted[key], stated[key]).status is Status.REFUTED:  # type: ignore[arg-type]
            places.append(dict(stated[key].place))
            stated[key] = Stated(place=stated[key].place, effort=stated[key].effort)
    names = equilibrium.free(problem)
    chosen = ({name: each[name] for name in names} for each in places)
    return stated | {equilibrium.NOWHERE: _first(wanted[equilibrium.NOWHERE], chosen)}


def _first(obligation: object, places: "Iterator[Mapping[str, float]]") -> Stated:
    """Return the first place that denies a statement."""
    from wspd_design.certificates.kernel.checker import Refused

    for each in places:
        stated = Stated(place=each)
        try:
            finding(obligation, stated)  # type: ignore[arg-type]
        except Refused:
            continue
        return stated
    return Stated()


def _places(problem: Problem) -> Iterator[Mapping[str, float]]:
    """Places where the loop may be unstable: nominal numbers over speed, the corners of the valve, the worst slope."""
    import numpy as np

    ranges = loop_ranges(problem)
    nominal = {name: problem.nominal(name) for name in ranges if name not in ("slip", "speed")}
    narrow = ("fill time", "vent time", "max torque", "wheelset inertia")
    corners = [dict(zip(narrow, ends, strict=True)) for ends in product(*(problem.span(name) for name in narrow))]
    worst = _worst(problem)
    for changed in ({}, *corners):
        shown = {name: each for name, each in changed.items() if name in nominal}
        for speed in np.geomspace(*problem.speeds, SPEEDS)[:: 1 if not changed else 4]:
            yield {**nominal, **shown, "slip": problem.slip, "speed": float(speed)}
        yield {**worst, **shown}


def _worst(problem: Problem) -> dict[str, float]:
    """Where p - a/v seems largest, by a search that starts from the corners."""
    from wspd_design.certificates.kernel.claim import Claim as AClaim
    from wspd_design.certificates.setting.plant import plant_dynamics, plant_forces, plant_variables

    claim = AClaim(
        name="p - a/v",
        variables=plant_variables(problem, ranges={"slip": problem.near}),
        expression=lambda x: plant_dynamics(problem, x).pole - plant_dynamics(problem, x).deceleration / x["speed"],
        form=lambda x: plant_forces(problem, x).pole - plant_forces(problem, x).deceleration / x["speed"],
        relation="<=",
        bound=Fraction(0),
        unit="1/s",
    )
    found = extreme(claim, tolerance=POLE_TOLERANCE).point
    ranges = loop_ranges(problem)
    return {name: float(found[name]) if name in found else problem.nominal(name) for name in ranges}


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
        Fraction(problem.nominal(name)) for name in ("fill time", "vent time", "max torque", "wheelset inertia")
    )
    half = Fraction(1, 2)
    q = Fraction(pole)
    sample = sample_of(Times((fill, fill), (vent, vent)), (q, q), law.sample_time, (half, half))
    matrix = one_sample(sample, law.slide * top / inertia, law.torque * top)
    found: Array = np.abs(np.linalg.eigvals(np.array([[float(each) for each in row] for row in matrix])))
    return float(found.max())


CHECK = Check(theorem=LPV_LYAPUNOV, search=search, figures=figures)
