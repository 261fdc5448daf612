"""Theorem about Barbalat's lemma (45)-(48): it applies in sigma = integral of dt/v, or says nothing about a stop.

A stop ends after some seconds, but not in sigma: dv/d sigma = -a v, so that v >= v0 exp(-a_max sigma) stays positive
while the train comes to a standstill. There V = s_D^2/(2 g) + abs(b~)^2/(2 alpha1) + psi~^2/(2 alpha2) has no term of
G', and with rates alpha/v in time its rate is dV/d sigma = s_D (u* - b*'w) - psi abs(s_D) <= -(eta/g) abs(s_D). Hence
the integral of abs(s_D) d sigma is at most V(0) g/eta. As abs(ds_D/d sigma) = g abs(u* - T) is bounded, s_D is
uniformly continuous, and Barbalat's lemma says that it tends to zero.

In time there is no t to infinity: the train stops.
"""

from fractions import Fraction

from wspd_design.certificates.kernel.arb import above, point
from wspd_design.certificates.kernel.claim import Claim
from wspd_design.certificates.kernel.finding import Finding
from wspd_design.certificates.kernel.obligation import Inequality, Obligation, Sampled
from wspd_design.certificates.quantities import PLANT
from wspd_design.certificates.records import Certificate, Hypothesis, Point, Problem, Range, Status
from wspd_design.certificates.setting import domain
from wspd_design.certificates.setting.adhesion_edges import Ranges
from wspd_design.certificates.setting.assumptions import ALL, OF_VALVES
from wspd_design.certificates.setting.plant import plant_dynamics, plant_forces, plant_variables
from wspd_design.certificates.theorems.adaptive_energy import (
    adaptation_conditions,
    energy,
    rounded_up,
    smallest_gain,
)
from wspd_design.certificates.theorems.afsmc_energy import CONTINUOUS, conditional, limit_witness
from wspd_design.certificates.theorems.authority import (
    TORQUES,
    torque_findings,
    torque_limits,
    torque_obligations,
)
from wspd_design.certificates.theorems.edges import of_key, on_edges, together
from wspd_design.certificates.theorems.ideal_loop import ASSUMPTIONS
from wspd_design.certificates.theorems.scope import scope
from wspd_design.certificates.theorems.sliding import MEASURED, largest_deceleration, reserve
from wspd_design.certificates.theorems.theorem import Findings, Theorem, hypothesis, smallest_margin
from wspd_design.certificates.theorems.whom import adaptive, adaptive_law, with_surface
from wspd_design.parameters.loading import constants
from wspd_design.parameters.units import KMH

QUADRATURE_TOLERANCE = 1e-3  # of the bound: trapezoids between the solver's instants
INTEGRAL = ("end", "integral", "bound")


def in_sigma(problem: Problem) -> bool:
    """Whether the rates of adaptation let the lemma apply in sigma."""
    return not adaptive(problem) and adaptive_law(problem).gains.scheduled_rates


def to_standstill(problem: Problem) -> Ranges:
    """Return the range of speeds of the claims in sigma."""
    return {"speed": (0.0, problem.speeds[1])}


def slowing_obligations(problem: Problem) -> tuple[Inequality, ...]:
    """Return the claim that the train comes to its lowest speed within the time that any stop may take."""
    least = problem.speeds[1] / constants().time_limit

    def claimed(ranges: Ranges) -> Claim:
        return Claim(
            name="deceleration",
            variables=plant_variables(problem, ranges=ranges),
            expression=lambda x: plant_dynamics(problem, x).deceleration,
            form=lambda x: plant_forces(problem, x).deceleration,
            relation=">=",
            bound=Fraction(least),
            unit="m/s2",
        )

    return on_edges("slowing", problem, claimed, most=False, axle=False)


def _obligations(problem: Problem) -> tuple[Obligation, ...]:
    domain.box(problem)
    if in_sigma(problem):
        gains = adaptive_law(problem).gains
        return (
            *torque_obligations(problem, to_standstill(problem)),
            *adaptation_conditions(gains, scheduled=True),
        )
    return (
        *slowing_obligations(problem),
        Sampled(
            key="integral",
            text="the integral of abs(s_D) is at most what V(0) allows",
            names=INTEGRAL,
            holds=lambda numbers: numbers["integral"] <= numbers["bound"] * (1.0 + QUADRATURE_TOLERANCE),
        ),
        Sampled(
            key="continuity",
            text="s_D is Lipschitz continuous",
            names=("constant",),
            holds=lambda numbers: numbers["constant"] >= 0.0,
        ),
    )


def _tell(problem: Problem, findings: Findings) -> Certificate:
    return _convergence(problem, findings) if in_sigma(problem) else _vacuous(problem, findings)


def _convergence(problem: Problem, findings: Findings) -> Certificate:
    """Tell what the lemma says in sigma."""
    gains, limit, eta = adaptive_law(problem).gains, torque_limits(problem)[0], reserve(problem)
    low, high = torque_findings(findings)
    conditions = adaptation_conditions(gains, scheduled=True)
    status = conditional(findings, tuple(findings[each.key] for each in conditions))
    said = scope(problem, TORQUES, MEASURED)
    open_ones = [each.asked for each in (findings[c.key] for c in conditions) if not each.proved]
    open_ones += [each.asked for each in (low, high) if each.status is not Status.PROVED]
    where: tuple[Point, ...] = ()
    told = "There is no bound on the integral to state"
    if smallest_gain(gains) > 0.0 and low.proved and high.proved:
        found = energy(problem, gains, low.low, high.high, eta, 1.0)
        lightest, radius = point(problem.span("wheelset inertia")[0]), point(problem.vehicle.wheel_radius)
        steepest = (
            radius
            / lightest
            * point(max(Fraction(high.high), Fraction(torque_limits(problem)[1]) - Fraction(low.low)))
        )
        where = (
            Point(name="V(0) in sigma", value=above(found.start), unit="N s2"),
            Point(name="bound on the integral of abs(s_D) d sigma", value=above(found.integral), unit="s2/m"),
            Point(name="Lipschitz constant of s_D in sigma", value=above(steepest), unit="m/s2"),
        )
        told = (
            f"The integral of abs(s_D) d sigma is at most {rounded_up(above(found.integral))} s2/m and s_D changes by "
            f"at most {rounded_up(above(steepest))} m/s2 per unit of sigma"
        )
    return Certificate(
        claim=f"While the slip stays between {problem.slips[0]:g} and {problem.slips[1]:g} down to standstill, and "
        "with T = u inside the limits of the brake, u* stays inside them by eta/g, eta/g <= u* <= T_max - eta/g with "
        f"T_max at least {limit / 1e3:g} kN m. Therefore s_D tends to zero as the train comes to a standstill from "
        f"{problem.speeds[1] * KMH:.3g} km/h: in sigma = integral of dt/v the run has no end, the integral of abs(s_D) "
        f"is finite and s_D uniformly continuous; {said.text}, all speeds down to standstill.",
        status=status,
        explanation=f"{told}. "
        + (f"Not shown: {'; '.join(open_ones)}." if open_ones else "Every hypothesis is proved.")
        + " It says that the error enters the boundary layer at standstill at the latest, not how soon. A stop begins "
        f"with slip 0: nothing is said before the slip is in its range, {problem.slips[0]:g} and above.",
        margin=smallest_margin(low, high),
        worst_point=where,
        witness=limit_witness(findings, said.names) if status is Status.REFUTED else (),
        hypotheses=(
            hypothesis("eta/g <= u* at all speeds above 0", low),
            hypothesis(f"u* <= {limit / 1e3:g} kN m - eta/g at all speeds above 0", high),
            Hypothesis(
                text=f"sigma has no end: a <= a_max = {largest_deceleration(problem):.4g} m/s2, the friction under the "
                "weight of the train and its resistance",
                status=Status.PROVED,
            ),
            *(hypothesis(each.text, findings[each.key]) for each in conditions),
        ),
        assumptions=(
            CONTINUOUS,
            "slip reference constant",
            "slip and speed measured exactly",
            "the model of the slip and the rates alpha/v hold down to standstill; both are limited below "
            f"{constants().slip_regularization_speed:g} m/s",
        ),
        domain=said.domain,
        varied=said.varied,
        held=said.held,
        method="repaired Lyapunov function in sigma; torques enclosed by interval branch and bound and replayed by the "
        "checker; the rest in balls",
        reference="eqs. (41)-(48) with rates alpha/v; docs/theory.md#barbalat",
    )


def _vacuous(problem: Problem, findings: Findings) -> Certificate:
    """Tell that the stop ends, which a positive deceleration shows."""
    slowing: Finding = together(of_key(findings.items(), "slowing"))
    integral, continuity = findings["integral"], findings["continuity"]
    proved = slowing.status is Status.PROVED
    numbers, law_adapts = integral.numbers, not adaptive(problem)
    seconds = (problem.speeds[1] - problem.speeds[0]) / slowing.low if proved else 0.0
    seen = (
        f" In its place stands the integral of abs(s_D), in a run {numbers['integral']:.3g} s against a bound of "
        f"{numbers['bound']:.3g} s."
        if numbers
        else ""
    )
    sigma = (
        "In sigma = integral of dt/v the lemma asks for adaptation rates alpha/v; those of this law are constant."
        if law_adapts
        else "In sigma = integral of dt/v no lemma is needed: where the reaching condition holds, the surface is "
        "reached at a finite sigma."
    )
    said = scope(problem, PLANT)
    return Certificate(
        claim="s tends to 0 as t tends to infinity, because the integral of abs(s_D) is finite and s_D is uniformly "
        f"continuous, {said.text}.",
        status=Status.VACUOUS if proved else Status.UNDECIDED,
        explanation=(
            f"There is no t to infinity in a stop, and a limit says nothing about the error at its end: while the slip "
            f"stays in its range, the train slows down to {problem.speeds[0] * KMH:.3g} km/h within "
            f"{seconds:.3g} s. {sigma}{seen}"
            if proved
            else f"That the train slows down to its lowest speed within {constants().time_limit:g} s is not shown."
        ),
        margin=Range(low=None, high=numbers["bound"] - numbers["integral"], unit="s") if numbers else None,
        worst_point=(
            Point(name="end of the run", value=numbers["end"], unit="s"),
            Point(name="integral of abs(s_D)", value=numbers["integral"], unit="s"),
            Point(name="bound on the integral", value=numbers["bound"], unit="s"),
        )
        if numbers
        else (),
        hypotheses=(
            Hypothesis(
                text="the run goes on for ever", status=Status.REFUTED if proved else Status.UNDECIDED
            ),
            Hypothesis(
                text="in sigma = integral of dt/v, which has no end, the adaptation rates are alpha/v",
                status=Status.REFUTED if law_adapts else Status.NOT_APPLICABLE,
            ),
            hypothesis(integral.asked, integral),
            hypothesis(continuity.asked, continuity),
        ),
        assumptions=ASSUMPTIONS,
        domain=said.domain,
        varied=said.varied,
        held=said.held,
        method="a positive deceleration by interval branch and bound, replayed by the independent checker; a run with "
        "the Rosenbrock method RODAS, trapezoids between its instants",
        reference="eqs. (45)-(48); docs/theory.md#barbalat",
    )


BARBALAT = Theorem(
    name="barbalat",
    title="Convergence after Barbalat",
    claim="s tends to 0 as t tends to infinity.",
    speaks_about=with_surface,
    obligations=_obligations,
    tell=_tell,
    assumes=ALL - OF_VALVES,
)
