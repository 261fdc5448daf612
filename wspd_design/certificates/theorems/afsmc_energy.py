"""Theorem about the energy of the adaptive fuzzy law: bounds from the repaired V, or that of the paper refuted."""

from fractions import Fraction

from wspd_design.certificates.kernel.arb import above
from wspd_design.certificates.kernel.claim import Claim
from wspd_design.certificates.kernel.finding import Finding
from wspd_design.certificates.kernel.obligation import Inequality, Obligation
from wspd_design.certificates.records import Certificate, Point, Problem, Status
from wspd_design.certificates.setting import domain
from wspd_design.certificates.setting.adhesion_edges import Ranges
from wspd_design.certificates.setting.assumptions import ALL, OF_VALVES
from wspd_design.certificates.setting.plant import place, plant_dynamics, plant_forces, plant_variables
from wspd_design.certificates.theorems.adaptive_energy import (
    adaptation_conditions,
    energy,
    rounded_up,
    smallest_gain,
)
from wspd_design.certificates.theorems.authority import (
    TORQUES,
    torque_findings,
    torque_limits,
    torque_obligations,
)
from wspd_design.certificates.theorems.edges import of_key, on_edges, together
from wspd_design.certificates.theorems.printed_energy import printed_obligations, tell_printed
from wspd_design.certificates.theorems.scope import scope
from wspd_design.certificates.theorems.sliding import MEASURED, reserve
from wspd_design.certificates.theorems.theorem import (
    Findings,
    Theorem,
    following_from,
    hypothesis,
    smallest_margin,
)
from wspd_design.certificates.theorems.whom import adaptive, adaptive_law
from wspd_design.parameters.units import KMH

CONTINUOUS = "T = u inside the limits of the brake: no valve lag, no sampling, continuous adaptation"


def braking_obligations(problem: Problem) -> tuple[Inequality, ...]:
    """Return the claim that a train with wheels at static load decelerates, a >= 0."""

    def claimed(ranges: Ranges) -> Claim:
        return Claim(
            name="deceleration",
            variables=plant_variables(problem, ranges=ranges),
            expression=lambda x: plant_dynamics(problem, x).deceleration,
            form=lambda x: plant_forces(problem, x).deceleration,
            relation=">=",
            bound=Fraction(0),
            unit="m/s2",
        )

    return on_edges("braking", problem, claimed, most=False, axle=False)


def _obligations(problem: Problem) -> tuple[Obligation, ...]:
    domain.box(problem)
    gains = adaptive_law(problem).gains
    if not gains.dead_zone:
        return printed_obligations(problem)
    return (
        *torque_obligations(problem),
        *braking_obligations(problem),
        *adaptation_conditions(gains, scheduled=False),
    )


def conditional(findings: Findings, others: tuple[Finding, ...]) -> Status:
    """Return the status of bounds that follow from u* inside the limits, which is claimed with them.

    A torque outside the limits refutes the claim; another condition that fails leaves it open.
    """
    low, high = torque_findings(findings)
    if Status.REFUTED in (low.status, high.status):
        return Status.REFUTED if all(each.status is Status.PROVED for each in others) else Status.UNDECIDED
    return following_from(low, high, *others)


def limit_witness(findings: Findings, names: tuple[str, ...]) -> tuple[Point, ...]:
    """Return a point at which u* does not lie inside the limits by eta/g."""
    low, high = torque_findings(findings)
    if low.status is Status.REFUTED:
        found, value = low, Point(name="u* - eta/g", value=low.high, unit="N m")
    elif high.status is Status.REFUTED:
        found, value = high, Point(name="u* + eta/g", value=high.low, unit="N m")
    else:
        return ()
    return (*place(found.values, tuple(name for name in names if name in found.values)), value)


def _tell(problem: Problem, findings: Findings) -> Certificate:
    law = adaptive_law(problem)
    if not law.gains.dead_zone:
        return tell_printed(problem, findings)
    gains, limit, eta = law.gains, torque_limits(problem)[0], reserve(problem)
    low, high = torque_findings(findings)
    braking = together(of_key(findings.items(), "braking"))
    conditions = adaptation_conditions(gains, scheduled=False)
    status = conditional(findings, (braking, *(findings[each.key] for each in conditions)))
    said = scope(problem, TORQUES, MEASURED)
    where: tuple[Point, ...] = ()
    numbers, meaning = "V bounds error and weights", "There is no bound to state."
    if smallest_gain(gains) > 0.0 and low.proved and high.proved:
        found = energy(problem, gains, low.low, high.high, eta, problem.speeds[1])
        integral, error, top = (above(x) for x in (found.integral, found.weight_error, found.highest_bound))
        numbers = (
            f"the integral of abs(s_D) is at most {rounded_up(integral)} s, the weights stay within "
            f"{rounded_up(error / 1e3)} kN m of {found.weight / 1e3:.3g} kN m, and psi_hat below "
            f"{rounded_up(top / 1e3)} kN m"
        )
        where = (
            Point(name="V(0)", value=above(found.start), unit="N m s"),
            Point(name="bound on the integral of abs(s_D)", value=integral, unit="s"),
            Point(name="bound on the distance of the weights", value=error, unit="N m"),
            Point(name="bound on psi_hat", value=top, unit="N m"),
            Point(name="psi", value=found.bound, unit="N m"),
        )
        layer = gains.boundary_layer / gains.proportional_gain
        seconds = rounded_up(integral / layer)
        meaning = f"abs(s_D) exceeds one layer width, {layer:.3g}, for at most {seconds} s in total."
    open_ones = [each.asked for each in (findings[c.key] for c in conditions) if not each.proved]
    if status is Status.REFUTED:
        meaning = (
            "At the witness u* leaves the limits of the brake. With T at that limit V may rise there, whatever is "
            "adapted: V' = s_D (u* - T) - a s_D^2/(2 g)."
        )
    return Certificate(
        claim=f"While the slip stays between {problem.slips[0]:g} and {problem.slips[1]:g} and the speed above "
        f"{problem.speeds[0] * KMH:.3g} km/h, and with T = u inside the limits of the brake, u* stays inside them by "
        f"eta/g, eta/g <= u* <= T_max - eta/g with T_max at least {limit / 1e3:g} kN m. Therefore, from a slip below "
        f"the reference at {problem.speeds[1] * KMH:.3g} km/h on, without an integral of the error yet, {numbers}; "
        f"{said.text}.",
        status=status,
        explanation=f"{meaning} "
        + (f"Not shown: {'; '.join(open_ones)}. " if open_ones else "")
        + ("Every hypothesis is proved. " if status is Status.PROVED else "")
        + f"A stop begins with slip 0: nothing is said before the slip is in its range, from {problem.slips[0]:g} "
        "on.",
        margin=smallest_margin(low, high),
        worst_point=where,
        witness=limit_witness(findings, said.names) if status is Status.REFUTED else (),
        hypotheses=(
            hypothesis("eta/g <= u* on the domain", low),
            hypothesis(f"u* <= {limit / 1e3:g} kN m - eta/g on the domain", high),
            hypothesis("the train decelerates, a >= 0, on the domain", braking),
            *(hypothesis(each.text, findings[each.key]) for each in conditions),
        ),
        assumptions=(CONTINUOUS, "slip reference constant", "slip and speed measured exactly"),
        domain=said.domain,
        varied=said.varied,
        held=said.held,
        method="repaired Lyapunov function V; torques and deceleration enclosed by interval branch and bound and "
        "replayed by the checker; the rest in balls",
        reference="eqs. (39)-(44) repaired; docs/theory.md#energy",
    )


AFSMC_ENERGY = Theorem(
    name="afsmc_energy",
    title="Energy of the adaptive law",
    claim="V does not rise and bounds error and weights.",
    speaks_about=adaptive,
    obligations=_obligations,
    tell=_tell,
    assumes=ALL - OF_VALVES,
)
