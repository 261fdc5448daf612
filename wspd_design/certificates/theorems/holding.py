"""Theorem about the torque that holds the reference, for every law: a vented brake lets the wheel recover."""

from wspd_design.certificates.kernel.claim import Claim
from wspd_design.certificates.kernel.finding import Finding
from wspd_design.certificates.kernel.obligation import Inequality
from wspd_design.certificates.records import Certificate, Point, Problem, Status
from wspd_design.certificates.setting.adhesion_edges import Ranges
from wspd_design.certificates.setting.assumptions import ALL, OF_VALVES
from wspd_design.certificates.setting.plant import place
from wspd_design.certificates.theorems.authority import TORQUES, out_of_reach, torque_claim, torque_limits
from wspd_design.certificates.theorems.edges import of_key, on_edges, together
from wspd_design.certificates.theorems.scope import scope
from wspd_design.certificates.theorems.sliding import MEASURED
from wspd_design.certificates.theorems.theorem import Findings, Theorem, all_of, hypothesis, left_open
from wspd_design.certificates.theorems.whom import every_law
from wspd_design.parameters.units import KMH


def sides(problem: Problem) -> tuple[Inequality, ...]:
    """Return the claims that no slip from the reference on grows at a vented brake, and that T_max reaches it."""
    least = torque_limits(problem)[0]

    def release(edge: Ranges) -> Claim:
        return torque_claim(
            problem, ">=", 0.0, {**edge, "slip": (problem.slip, problem.slips[1])}, holding=True
        )

    def apply(edge: Ranges) -> Claim:
        return torque_claim(problem, "<=", least, {**edge, "slip": problem.slip}, holding=True)

    return (
        *on_edges("release", problem, release, most=False, axle=True),
        *on_edges("apply", problem, apply, most=True, axle=True),
    )


def _obligations(problem: Problem) -> tuple[Inequality, ...]:
    return (*sides(problem), *out_of_reach(problem))


def _tell(problem: Problem, findings: Findings) -> Certificate:
    release, apply = (together(of_key(findings.items(), key)) for key in ("release", "apply"))
    never = of_key(findings.items(), "out of reach")
    status = Status.VACUOUS if all_of(*never) is Status.PROVED else release.status
    said = scope(problem, [name for name in TORQUES if name != "slip"], MEASURED)
    known = tuple(name for name in ("slip", *said.names) if name in release.values)
    where = place(release.values, known) if known else ()
    least, most = torque_limits(problem)
    hypotheses = [hypothesis(f"T >= 0 at every slip from {problem.slip:g} to {problem.slips[1]:g}", release)]
    if status is Status.VACUOUS:
        hypotheses.append(
            hypothesis(f"T >= {most / 1e3:g} kN m, the largest T_max, at slip {problem.slip:g}", *never)
        )
    return Certificate(
        claim=f"With a vented brake no slip from {problem.slip:g} to {problem.slips[1]:g} grows: the torque T that "
        f"holds it is nowhere below 0, {said.text}.",
        status=status,
        explanation=f"The brake never reaches the reference: even T_max = {most / 1e3:g} kN m is less than what holds "
        f"slip {problem.slip:g}, so that the slip stays below it and the protection is idle."
        if status is Status.VACUOUS
        else f"{_lower_side(release)} {_upper_side(apply, least, problem.slip)}",
        margin=release.margin,
        worst_point=where,
        witness=(*where, Point(name="T", value=release.high, unit="N m")) if status is Status.REFUTED else (),
        hypotheses=tuple(hypotheses),
        assumptions=("T = u: no valve lag, no sampling",),
        domain=said.domain,
        varied=said.varied,
        held=said.held,
        method="interval branch and bound on the edges of the box where the adhesion is extreme, replayed by the "
        "independent checker",
        reference="eq. (19); docs/theory.md#holding",
    )


def _lower_side(release: Finding) -> str:
    match release.status:
        case Status.PROVED:
            return "A vented brake always lets the wheel recover."
        case Status.REFUTED:
            return f"At slip {release.values['slip']:.3f} and {release.values['speed'] * KMH:.3g} km/h it does not."
        case _:
            return f"Whether a vented brake lets the wheel recover is open: {left_open([release])}."


def _upper_side(apply: Finding, limit: float, slip: float) -> str:
    """Say how much torque holds the reference, and that too little of it is no fault."""
    if apply.status is Status.PROVED:
        most = f"{apply.high / 1e3:.4g} kN m, {100.0 * apply.high / limit:.0f} % of the least T_max"
        return f"Holding slip {slip:g} takes at most {most}."
    if apply.status is not Status.REFUTED:
        reason = left_open([apply]) or "it comes within the tolerance"
        return f"Whether T_max suffices to hold slip {slip:g} is open: {reason}."
    most = f"{apply.low / 1e3:.4g} kN m, {100.0 * apply.low / limit:.0f} % of the least T_max"
    return (
        f"Holding slip {slip:g} takes up to {most}, at {apply.values['speed'] * KMH:.3g} km/h: where the brake has "
        "less, the slip stays below the reference by itself and the protection is idle."
    )


HOLDING_TORQUE = Theorem(
    name="holding_torque",
    title="Torque that holds the reference",
    claim="With a vented brake no slip from the reference on grows.",
    speaks_about=every_law,
    obligations=_obligations,
    tell=_tell,
    assumes=ALL - OF_VALVES,
)
