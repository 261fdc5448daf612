"""A brake between 0 and T_max can hold the slip on the surface: eta/g <= u* <= T_max - eta/g."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from wspd_design.certificates.checks.frame import Check, Figures, level, series
from wspd_design.certificates.checks.margin_map import margin_map
from wspd_design.certificates.kernel.finding import Place, Stated
from wspd_design.certificates.kernel.obligation import Inequality, OnPart
from wspd_design.certificates.records import Certificate, Problem
from wspd_design.certificates.search.settle import settle
from wspd_design.certificates.search.together import settle_together
from wspd_design.certificates.setting import domain
from wspd_design.certificates.setting.domain import BASIC, SLIP, SPEED
from wspd_design.certificates.setting.plant import dynamics_at
from wspd_design.certificates.theorems.authority import (
    SLIDING_EXISTS,
    out_of_reach,
    torque_findings,
    torque_obligations,
    up_to_friction,
)
from wspd_design.certificates.theorems.sliding import reserve
from wspd_design.certificates.theorems.whom import surface_of
from wspd_design.model.generated import sliding_surface
from wspd_design.model.slip import slip_dynamics
from wspd_design.parameters.units import KMH

if TYPE_CHECKING:
    from wspd_design.certificates.setting.domain import Array

TOLERANCE = 50.0  # N m, of the enclosed torques
PLOT_SPEEDS = 60
SHRINK = (0.998, 0.99, 0.97, 0.9)  # of the friction at which the tightest point becomes limited by the brake


def search(problem: Problem) -> Mapping[str, Stated]:
    """Enclose u* on both sides; say how far the brake suffices, or that it never reaches the reference."""
    stated = torques(torque_obligations(problem))
    apply = {key: each for key, each in stated.items() if key.startswith("apply")}
    return {**stated, **_friction(problem, apply), **never(out_of_reach(problem))}


def torques(obligations: Sequence[Inequality]) -> Mapping[str, Stated]:
    """Enclose u* - eta/g and u* + eta/g on the edges of the domain."""
    lower, upper = ([o for o in obligations if o.claim.relation == relation] for relation in (">=", "<="))
    return {
        **settle_together(lower, tolerance=TOLERANCE),
        **settle_together(upper, tolerance=TOLERANCE),
    }


def never(claims: Sequence[Inequality]) -> Mapping[str, Stated]:
    """Prove that the brake never reaches the reference, if it does not in the middle of the domain."""
    for each in claims:
        at = {v.name: float(v.low + v.high) / 2.0 for v in each.claim.variables}
        if not each.claim.expression(at) >= each.claim.bound:
            return {}
    return {each.key: settle(each.claim, tolerance=TOLERANCE) for each in claims}


def _friction(problem: Problem, apply: Mapping[str, Stated]) -> Mapping[str, Stated]:
    """Prove that the brake suffices up to a friction, where it does not on the whole domain."""
    parts = up_to_friction(problem)
    wanted = {each.key.removeprefix("until, "): each for each in parts}
    places = {key.removeprefix("apply, "): each.place for key, each in apply.items()}
    low = problem.span("mu0")[0]
    limit = min(
        (_suffices(problem, wanted[name], at) for name, at in places.items() if name in wanted), default=low
    )
    if not low < limit < problem.span("mu0")[1]:
        return {}
    for share in SHRINK:
        span = low, low + share * (limit - low)
        found = {each.key: settle(each.claim(span), tolerance=TOLERANCE) for each in parts}
        if all(_proves(each.proof, wanted) for each in found.values()):
            return found
    return {}


def _proves(proof: Mapping[str, object] | None, wanted: Mapping[str, OnPart]) -> bool:
    """Whether a proof shows the bound that is asked for."""
    from fractions import Fraction

    if proof is None:
        return False
    statement = proof["statement"]
    assert isinstance(statement, Mapping)
    (part, *_) = wanted.values()
    return Fraction(statement["bound"]) <= part.claim(part.within).bound


def _suffices(problem: Problem, part: OnPart, at: Place) -> float:
    """Return the largest mu0 at which the brake suffices at the tightest place of an edge, other numbers alike."""
    from scipy.optimize import brentq

    low, high = problem.span("mu0")
    claim = part.claim((low, high))
    values = {v.name: at.get(v.name, float(v.low)) for v in claim.variables}

    def excess(mu0: float) -> float:
        return float(claim.expression({**values, "mu0": mu0})) - float(claim.bound)

    if excess(low) >= 0.0 or excess(high) <= 0.0:
        return low if excess(low) >= 0.0 else high
    return float(brentq(excess, low, high))


def figures(problem: Problem, certificate: Certificate) -> Figures:
    """Ideal torque over speed beside the brake's limit, and the room to release over slip and speed."""
    import numpy as np

    law, eta = surface_of(problem), reserve(problem)
    release, _ = torque_findings(certificate.findings)
    at = release.values or {name: sum(domain.span(problem, name)) / 2.0 for name in BASIC}

    def released(points: "Array") -> "Array":
        """Ideal torque less the reserve, u* - eta/g [kN m]."""
        plant = dynamics_at(problem, points, held=at)
        error = sliding_surface.slip_error(law.slip_reference, points[:, SLIP])
        ideal = sliding_surface.equivalent_torque(plant.drift, plant.gain, 0.0, error, law.surface_rate)
        left: Array = (ideal - eta / (plant.gain * points[:, SPEED])) / 1e3
        return left

    speeds = np.geomspace(*problem.speeds, PLOT_SPEEDS)
    plant = slip_dynamics(problem.vehicle, problem.rail, problem.slip, speeds)
    ideal = sliding_surface.equivalent_torque(plant.drift, plant.gain, 0.0, 0.0, law.surface_rate)
    axes = ("speed [km/h]", "torque per wheelset [kN m]")
    return Figures(
        series=(
            series("u* at the slip reference", *axes, speeds * KMH, ideal / 1e3),
            level("T_max", *axes, speeds * KMH, problem.nominal("max torque") / 1e3),
        ),
        maps=margin_map(
            "room to release",
            "room to release u* - eta/g [kN m]",
            released,
            domain.box(problem),
            over=SLIP,
            limit=0.0,
            worst=at,
            largest=False,
        ),
    )


CHECK = Check(theorem=SLIDING_EXISTS, search=search, figures=figures)
