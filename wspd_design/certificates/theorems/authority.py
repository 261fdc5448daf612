"""Theorem about the limits of the brake: the torque u* that holds the surface lies between 0 and T_max."""

from collections.abc import Mapping, Sequence
from fractions import Fraction

from wspd_design.certificates.kernel.claim import Claim, Relation
from wspd_design.certificates.kernel.finding import Finding
from wspd_design.certificates.kernel.obligation import Inequality, Obligation, OnPart
from wspd_design.certificates.quantities import AXLE
from wspd_design.certificates.records import Certificate, Point, Problem, Status
from wspd_design.certificates.setting.adhesion_edges import Ranges, adhesion_edges
from wspd_design.certificates.setting.assumptions import ALL, OF_VALVES
from wspd_design.certificates.setting.plant import (
    AXLE_PLANT,
    Values,
    place,
    plant_dynamics,
    plant_forces,
    plant_variables,
)
from wspd_design.certificates.theorems.edges import of_key, on_edges, together
from wspd_design.certificates.theorems.scope import scope
from wspd_design.certificates.theorems.sliding import MEASURED, reserve
from wspd_design.certificates.theorems.theorem import (
    ORDER,
    Findings,
    Theorem,
    all_of,
    hypothesis,
    left_open,
)
from wspd_design.certificates.theorems.whom import surface_of, with_surface
from wspd_design.model.generated import sliding_surface
from wspd_design.model.number import Number
from wspd_design.parameters.units import KMH

TORQUES = (*AXLE_PLANT, "max torque")


def torque_limits(problem: Problem) -> tuple[float, float]:
    """Return the range of T_max [N m]."""
    return problem.span("max torque")


def torque_claim(
    problem: Problem,
    relation: Relation,
    bound: float,
    ranges: Ranges,
    *,
    uses: Sequence[str] = AXLE_PLANT,
    holding: bool = False,
) -> Claim:
    """Return a claim about the ideal torque u* with the reserve eta/g taken from it (>=) or added to it (<=).

    With ``holding`` it is about the torque that holds a slip where it is, which needs no surface: u* at the reference.

    Parameters
    ----------
    problem : Problem
        Plant and domain, and the surface of the law unless ``holding``.
    relation : {"<=", ">="}
        Of torque and bound.
    bound : float
        In N m per wheelset.
    ranges : mapping
        Other ranges of the quantities, as in :func:`plant_variables`.
    uses : sequence of str
        Quantities of every axle, or of the one at static load.
    holding : bool
        Whether the slip is held where it is: neither surface nor reserve count.
    """
    rate, reference, eta = 0.0, problem.slip, 0.0
    if not holding:
        rate, reference = surface_of(problem).surface_rate, surface_of(problem).slip_reference
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
        slowing = (1.0 - slip) * (inertia * forces.deceleration - 2.0 * speed * x["wheel damping"])
        surface = inertia * (rate * speed * error + eta)
        return forces.creep_force * x["wheel radius"] * 2.0 + (slowing + surface) / x["wheel radius"]

    name = "T" if holding else "u* + eta/g" if relation == "<=" else "u* - eta/g"
    return Claim(
        name=name,
        variables=plant_variables(problem, uses=uses, hold=MEASURED, ranges=ranges),
        expression=torque,
        form=arranged,
        relation=relation,
        bound=Fraction(bound),
        unit="N m",
    )


def torque_obligations(problem: Problem, ranges: Ranges | None = None) -> tuple[Inequality, ...]:
    """Return the claims that u* stays inside the limits of the brake by eta/g: 0, and the smallest T_max.

    u* rises with the adhesion.

    Parameters
    ----------
    problem : Problem
        Plant, domain and law.
    ranges : mapping, optional
        Other ranges than those of the domain.
    """
    other, least = dict(ranges or {}), torque_limits(problem)[0]

    def release(edge: Ranges) -> Claim:
        return torque_claim(problem, ">=", 0.0, {**edge, **other})

    def apply(edge: Ranges) -> Claim:
        return torque_claim(problem, "<=", least, {**edge, **other})

    return (
        *on_edges("release", problem, release, most=False, axle=True),
        *on_edges("apply", problem, apply, most=True, axle=True),
    )


def torque_findings(findings: Findings) -> tuple[Finding, Finding]:
    """Return what is known of u* - eta/g and of u* + eta/g on the domain."""
    low, high = (together(of_key(findings.items(), key)) for key in ("release", "apply"))
    return low, high


def out_of_reach(problem: Problem, *, axle: bool = True) -> tuple[Inequality, ...]:
    """Return the claims that the largest T_max is below u* at the reference, so that no slip ever gets there.

    Where the slip is at its reference, it cannot rise under T <= T_max <= u*. With ``axle`` false they speak about the
    nominal vehicle and rail.
    """
    most = torque_limits(problem)[1] if axle else problem.nominal("max torque")

    def claimed(edge: Ranges) -> Claim:
        held = {**edge, "slip": problem.slip}
        uses = AXLE_PLANT if axle else tuple(name for name in AXLE_PLANT if name not in AXLE)
        return torque_claim(problem, ">=", most, held, uses=uses, holding=True)

    if axle:
        return on_edges("out of reach", problem, claimed, most=False, axle=True)
    nominal = {name: problem.nominal(name) for name in AXLE_PLANT if name not in ("slip", "speed", *AXLE)}
    return (Inequality(key="out of reach, nominal", claim=claimed(nominal)),)


def up_to_friction(problem: Problem) -> tuple[OnPart, ...]:
    """Return the claims that T_max suffices up to some mu0: the range of mu0 is part of the finding."""
    least = torque_limits(problem)[0]

    def part(name: str, edge: Ranges) -> OnPart:
        return OnPart(
            key=f"until, {name}",
            claim=lambda mu0: torque_claim(problem, "<=", least, {**edge, "mu0": mu0}),
            quantity="mu0",
            within=problem.span("mu0"),
        )

    low, high = problem.span("mu0")
    if not low < high:
        return ()
    return tuple(part(*edge) for edge in adhesion_edges(problem, most=True, axle=True).items())


def _obligations(problem: Problem) -> tuple[Obligation, ...]:
    return (*torque_obligations(problem), *up_to_friction(problem), *out_of_reach(problem))


def _tell(problem: Problem, findings: Findings) -> Certificate:
    least, most = torque_limits(problem)
    release, apply = torque_findings(findings)
    until, never = (of_key(findings.items(), key) for key in ("until", "out of reach"))
    status = Status.VACUOUS if all_of(*never) is Status.PROVED else all_of(release, apply)
    said = scope(problem, TORQUES, MEASURED)
    tight = _decisive(release, apply)
    known = tuple(name for name in said.names if name in tight.values)
    where = place(tight.values, known) if known else ()
    upper = f"{least / 1e3:g} kN m"
    hypotheses = [
        hypothesis("u* >= eta/g on the domain", release),
        hypothesis(f"u* + eta/g <= {upper}, the least T_max, on the domain", apply),
    ]
    friction = _friction(until)
    if friction is not None:
        hypotheses.append(
            hypothesis(f"u* + eta/g <= {upper} for mu0 from {friction[0]:.3g} to {friction[1]:.3g}", *until)
        )
    return Certificate(
        claim="The torque u* that holds the surface lies inside the limits of the brake with a reserve, "
        f"eta/g <= u* <= T_max - eta/g, eta = {reserve(problem):.3g} m/s2 and g = R/(2 I), {said.text}.",
        status=status,
        explanation="The brake never reaches the reference: even T_max = "
        f"{most / 1e3:g} kN m is less than u* at slip {problem.slip:g}, so that the slip stays below it."
        if status is Status.VACUOUS
        else f"{_lower_side(release)} {_upper_side(apply, friction, least)}",
        margin=tight.margin,
        worst_point=where,
        witness=(*where, Point(name=_name(tight), value=_attained(tight), unit="N m"))
        if status is Status.REFUTED
        else (),
        hypotheses=tuple(hypotheses),
        assumptions=("T = u: no valve lag, no sampling", "slip reference constant"),
        domain=said.domain,
        varied=said.varied,
        held=said.held,
        method="interval branch and bound on the edges of the box where the adhesion is extreme, replayed by the "
        "independent checker",
        reference="eqs. (23), (27); docs/theory.md#existence",
    )


def _decisive(release: Finding, apply: Finding) -> Finding:
    """Return the side that margin, tightest point and witness speak about: the weaker, or the one with less room.

    Where both are refuted it is the side to release, since a wheel that a vented brake does not let recover locks.
    """

    def rank(side: Finding) -> tuple[int, float]:
        room = side.margin.low if side.status is Status.PROVED and side.margin.low is not None else 0.0
        return ORDER.index(side.status), room

    return min((release, apply), key=rank)


def _friction(until: Sequence[Finding]) -> tuple[float, float] | None:
    """Return the range of mu0 on which T_max is proved to suffice."""
    if not until or all_of(*until) is not Status.PROVED:
        return None
    parts = [each.part for each in until if each.part is not None]
    return max(low for low, _ in parts), min(high for _, high in parts)


def _name(finding: Finding) -> str:
    return "u* + eta/g" if finding.relation == "<=" else "u* - eta/g"


def _attained(finding: Finding) -> float:
    return finding.low if finding.relation == "<=" else finding.high


def _spot(values: Mapping[str, float]) -> str:
    return f"slip {values['slip']:.3f} and {values['speed'] * KMH:.3g} km/h"


def _lower_side(release: Finding) -> str:
    match release.status:
        case Status.PROVED:
            return "A vented brake always lets the wheel recover."
        case Status.REFUTED:
            return (
                f"At {_spot(release.values)} even a vented brake does not bring the slip back as fast as the surface "
                "demands."
            )
        case _:
            return f"Whether a vented brake lets the wheel recover is open: {left_open([release])}."


def _upper_side(apply: Finding, friction: tuple[float, float] | None, limit: float) -> str:
    """Say where the brake is the limit, and up to which friction it is not."""
    if apply.status is Status.PROVED:
        needed = f"{apply.high / 1e3:.4g} kN m"
        return f"The brake is never the limit: at most {needed} are needed, at {_spot(apply.values)}."
    if apply.status is not Status.REFUTED:
        return f"Whether the brake is ever the limit is open: {left_open([apply]) or 'it comes within the tolerance'}."
    least = "that it never is, is shown for no friction of the domain"
    if friction is not None:
        least = f"it never is for mu0 from {friction[0]:.3g} to {friction[1]:.3g}"
    return (
        f"Brake-limited at points such as {_spot(apply.values)}, where {apply.low / 1e3:.4g} kN m would be needed of "
        f"{limit / 1e3:g}; {least}. Such a point is benign: the slip stays below its reference, and the brake is fully "
        "applied. But the surface does not exist there."
    )


SLIDING_EXISTS = Theorem(
    name="sliding_exists",
    title="Authority of the brake",
    claim="The torque that holds the surface lies inside the limits of the brake.",
    speaks_about=with_surface,
    obligations=_obligations,
    tell=_tell,
    assumes=ALL - OF_VALVES,
)
