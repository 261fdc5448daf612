"""A brake between 0 and T_max can hold the slip on the surface: eta/g <= u* <= T_max - eta/g."""

from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING

from wspd_design.certificates.checks import verdict
from wspd_design.certificates.checks.frame import certified, level, series
from wspd_design.certificates.checks.margin_map import margin_map
from wspd_design.certificates.checks.sliding.reaching import reserve
from wspd_design.certificates.kernel.claim import Claim, Relation
from wspd_design.certificates.kernel.subdomain import with_part
from wspd_design.certificates.records import Certificate, Hypothesis, Point, Problem, Proof, Series, Status
from wspd_design.certificates.search.prover import prove
from wspd_design.certificates.search.settle import Finding, enclose, engine, settle
from wspd_design.certificates.setting import domain, laws
from wspd_design.certificates.setting.domain import KMH, SLIP, SPEED
from wspd_design.certificates.setting.plant import (
    Values,
    place,
    plant_dynamics,
    plant_forces,
    plant_variables,
)
from wspd_design.controllers.adaptive_fuzzy import AdaptiveFuzzy
from wspd_design.controllers.sliding_mode import SlidingMode
from wspd_design.model.generated import sliding_surface
from wspd_design.model.number import Number
from wspd_design.model.slip import slip_dynamics

if TYPE_CHECKING:
    from wspd_design.certificates.setting.domain import Array

NAME, TITLE = "sliding_exists", "Authority of the brake"
TOLERANCE = 10.0  # N m, of the enclosed torques
PLOT_SPEEDS = 60
HALVINGS = 9  # of the friction at which the brake begins to limit


def torque_claim(
    problem: Problem,
    law: laws.SlipLaw,
    relation: Relation,
    bound: float,
    **ranges: float | tuple[float, float],
) -> Claim:
    """Return a claim about the ideal torque u* with the reserve eta/g taken from it (>=) or added to it (<=).

    Parameters
    ----------
    problem : Problem
        Plant and domain.
    law : SlipLaw
        Its surface.
    relation : {"<=", ">="}
        Of torque and bound.
    bound : float
        In N m per wheelset.
    **ranges : float or tuple of float
        Other ranges of the quantities, as in :func:`plant_variables`.
    """
    rate, reference = laws.surface_rate(law), law.gains.slip_reference
    eta = reserve(problem) if relation == "<=" else -reserve(problem)

    def torque(x: Values) -> Number:
        plant = plant_dynamics(problem, x)
        error = sliding_surface.slip_error(reference, x["slip"])
        ideal = sliding_surface.equivalent_torque(plant.drift, plant.gain, 0.0, error, rate)
        return ideal + eta / (plant.gain * x["speed"])

    def arranged(x: Values) -> Number:
        forces = plant_forces(problem, x)
        slip, speed, inertia = x["slip"], x["speed"], x["wheelset inertia"]
        error = sliding_surface.slip_error(reference, slip)
        slowing = (1.0 - slip) * (inertia * forces.deceleration - 2.0 * speed * x["wheel_damping"])
        surface = inertia * (rate * speed * error + eta)
        return forces.creep_force * x["wheel_radius"] * 2.0 + (slowing + surface) / x["wheel_radius"]

    return Claim(
        name="u* + eta/g" if relation == "<=" else "u* - eta/g",
        variables=plant_variables(problem, **ranges),
        expression=torque,
        form=arranged,
        relation=relation,
        bound=Fraction(bound),
        unit="N m",
    )


@certified(name=NAME, title=TITLE)
def check(problem: Problem) -> Certificate:
    """Decide whether a vented brake lets the wheel recover, and where the brake is the limit."""
    law = problem.controller
    if not isinstance(law, (AdaptiveFuzzy, SlidingMode)):
        return laws.no_surface(problem, NAME, "The brake can hold the slip on its surface.")
    limit = problem.vehicle.brake.max_torque
    release = settle(torque_claim(problem, law, ">=", 0.0), tolerance=TOLERANCE)
    force = enclose(torque_claim(problem, law, "<=", limit), tolerance=TOLERANCE)
    until = None if force.ends[1] <= limit else _unlimited(problem, law, limit)
    lacking = settle(least_demand(problem, law), tolerance=TOLERANCE)
    never_enough = lacking.status is Status.PROVED
    status = release.status
    if status is Status.PROVED and never_enough:
        status = Status.VACUOUS
    where = place(release.place)
    refuted = release.status is Status.REFUTED
    lower = {
        Status.PROVED: "A vented brake always lets the wheel recover.",
        Status.REFUTED: f"At {_spot(release)} even a vented brake does not bring the slip back as fast as the "
        "surface demands.",
        Status.UNDECIDED: f"Open: {release.reason}.",
    }[release.status]
    return Certificate(
        name=NAME,
        title=TITLE,
        claim="The torque u* that holds the surface leaves room to release, u* >= eta/g with eta = "
        f"{reserve(problem):.3g} m/s2 and g = R/(2 I), and room to apply, u* <= {limit / 1e3:g} kN m - eta/g, except "
        f"where the operation is brake-limited; on {domain.described(problem)}.",
        status=status,
        explanation=f"{lower} {_upper_side(force, until, limit, never_enough=never_enough)}",
        margin=release.margin,
        worst_point=where,
        witness=(*where, Point(name="u* - eta/g", value=release.ends[1], unit="N m")) if refuted else (),
        hypotheses=(
            verdict.hypothesis("u* >= eta/g on the domain", release),
            Hypothesis(
                text=f"u* + eta/g <= {force.ends[1] / 1e3:.4g} kN m on the domain",
                status=force.status,
            ),
            *(
                ()
                if until is None
                else (verdict.hypothesis(f"u* + eta/g <= {limit / 1e3:g} kN m for {_span(until)}", until),)
            ),
        ),
        assumptions=("T = u: no valve lag, no sampling", "slip reference constant"),
        method="interval branch and bound, replayed by the independent checker",
        resolution=f"{release.boxes + force.boxes} boxes; torques within {TOLERANCE:g} N m",
        reference="eqs. (23), (27); docs/theory.md#existence",
        undecided=verdict.undecided(release, force),
        engine=engine(),
        proofs=(
            *verdict.proofs(release, force, *((lacking,) if never_enough else ())),
            *(() if until is None else _until(until)),
        ),
        series=_plots(problem, laws.surface_rate(law)),
        maps=margin_map(
            "room to release",
            "room to release u* - eta/g [kN m]",
            lambda points: _released(problem, law, points) / 1e3,
            domain.box(problem),
            over=SLIP,
            limit=0.0,
            worst=release.place,
            largest=False,
        ),
    )


def largest_friction(problem: Problem, law: laws.SlipLaw) -> tuple[float, float] | None:
    """Enclose the largest mu0 up to which T_max suffices on the whole domain, by the prover.

    Returns
    -------
    tuple of float or None
        T_max suffices at the first and does not at the second [-]; None if it does not even at the smallest mu0
        of the domain. If it suffices throughout the domain, both are its largest mu0.
    """
    limit = problem.vehicle.brake.max_torque

    def suffices(mu0: float) -> bool:
        return bool(prove(torque_claim(problem, law, "<=", limit, mu0=mu0)).tree)

    low, high = problem.mu0_bounds
    if suffices(high):
        return high, high
    if not suffices(low):
        return None
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if suffices(middle) else (low, middle)
    return low, high


def least_demand(problem: Problem, law: laws.SlipLaw) -> Claim:
    """Claim that the brake never suffices: u* + eta/g >= T_max everywhere."""
    return replace(torque_claim(problem, law, "<=", problem.vehicle.brake.max_torque), relation=">=")


def _unlimited(problem: Problem, law: laws.SlipLaw, limit: float) -> Finding | None:
    """Prove that the brake is not the limit up to the largest friction for which that is true."""
    friction = largest_friction(problem, law)
    if friction is None:
        return None
    span = problem.mu0_bounds[0], friction[0]
    return settle(torque_claim(problem, law, "<=", limit, mu0=span), tolerance=TOLERANCE)


def _until(finding: Finding) -> tuple[Proof, ...]:
    """Return the proof on the part of the domain that was searched."""
    (mu0,) = (v for v in finding.claim.variables if v.name == "mu0")
    ends = float(mu0.low), float(mu0.high)
    return tuple(with_part(proof, "mu0", ends) for proof in verdict.proofs(finding))


def _span(finding: Finding) -> str:
    (mu0,) = (v for v in finding.claim.variables if v.name == "mu0")
    return f"mu0 from {float(mu0.low):.3g} to {float(mu0.high):.3g}"


def _upper_side(force: Finding, until: Finding | None, limit: float, *, never_enough: bool) -> str:
    """Say where the brake is the limit, and up to which friction it is not."""
    if never_enough:
        return (
            "The operation is brake-limited everywhere: the brake never reaches the adhesion of this rail, so "
            "nothing has to slide."
        )
    needed, most = force.ends
    if most <= limit and force.status is Status.PROVED:
        return f"The brake is never the limit: at most {most / 1e3:.4g} kN m are needed, at {_spot(force)}."
    if needed <= limit:
        return (
            f"Whether the brake is ever the limit is open: {force.reason or 'it comes within the tolerance'}."
        )
    least = "that it never is, is shown for no friction of the domain"
    if until is not None and until.status is Status.PROVED:
        least = f"it never is for {_span(until)}"
    return (
        f"Brake-limited at points such as {_spot(force)}, where {needed / 1e3:.4g} kN m would be needed; {least}. "
        "That is benign: the slip stays below its reference, and the brake is fully applied."
    )


def _spot(finding: Finding) -> str:
    return f"slip {finding.place['slip']:.3f} and {finding.place['speed'] * KMH:.3g} km/h"


def _released(problem: Problem, law: laws.SlipLaw, points: "Array") -> "Array":
    """Ideal torque less the reserve, u* - eta/g, at points of the domain [N m]."""
    plant = domain.dynamics(problem, points)
    error = sliding_surface.slip_error(law.gains.slip_reference, points[:, SLIP])
    ideal = sliding_surface.equivalent_torque(plant.drift, plant.gain, 0.0, error, laws.surface_rate(law))
    left: Array = ideal - reserve(problem) / (plant.gain * points[:, SPEED])
    return left


def _plots(problem: Problem, rate: float) -> tuple[Series, ...]:
    """Ideal torque at the slip reference over speed, with nominal parameters, beside the brake's limit."""
    import numpy as np

    speeds = np.geomspace(*problem.speeds, PLOT_SPEEDS)
    plant = slip_dynamics(problem.vehicle, problem.rail, problem.slip, speeds)
    ideal = sliding_surface.equivalent_torque(plant.drift, plant.gain, 0.0, 0.0, rate)
    axes = ("speed [km/h]", "torque per wheelset [kN m]")
    return (
        series("u* at the slip reference", *axes, speeds * KMH, ideal / 1e3),
        level("T_max", *axes, speeds * KMH, problem.vehicle.brake.max_torque / 1e3),
    )
