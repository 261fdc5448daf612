"""Theorems about the sliding surface: it is approached, and the layer around it bounds the slip error.

With Psi = v F and rho = (inertia of the design model) / (true inertia) the sliding-mode law makes
v sbar' = r - rho W0 sat(sbar / layer), r = (1 - rho) v c e - Psi + rho Psi_hat at a constant reference. If
abs(r) + eta <= rho W0, then in sigma = integral of dt/v the distance abs(s_D) to the layer falls with eta, wherever the
slip is in its range. In sigma the speed falls with at most a_max v.
"""

import math
from collections.abc import Sequence
from fractions import Fraction

from wspd_design.certificates.kernel.arb import above, below, point
from wspd_design.certificates.kernel.claim import Claim
from wspd_design.certificates.kernel.obligation import Condition, Inequality, Obligation
from wspd_design.certificates.outside import OutsideModel
from wspd_design.certificates.quantities import AXLE
from wspd_design.certificates.records import Certificate, Point, Problem, Range, Status
from wspd_design.certificates.setting import domain
from wspd_design.certificates.setting.adhesion_edges import Ranges
from wspd_design.certificates.setting.assumptions import ALL, OF_VALVES, Assumption
from wspd_design.certificates.setting.model_error import (
    inertia_ratio,
    residual,
    residual_over_ratio,
    variables,
)
from wspd_design.certificates.setting.plant import AXLE_PLANT, Values, place
from wspd_design.certificates.theorems.edges import of_key, on_edges, together
from wspd_design.certificates.theorems.scope import scope
from wspd_design.certificates.theorems.theorem import (
    Findings,
    Theorem,
    all_of,
    following_from,
    hypothesis,
    left_open,
)
from wspd_design.certificates.theorems.whom import sliding_law, sliding_mode
from wspd_design.model.number import Number
from wspd_design.parameters.units import KMH

MEASURED = ("wheel radius",)
"""Held: the law works out its slip from it."""

SETTLED = Fraction(1, 10)  # of the bound: what is left of the transient

ANY_AXLE = ALL - OF_VALVES - {Assumption.EQUAL_BRAKES, Assumption.EQUAL_LOADS}
"""The claims are about each axle by itself, on its own load and with any torque that the law asks for, at once."""

ASSUMED = ("T = u: no valve lag, no sampling, no limit of the brake torque", "slip reference constant")


def reserve(problem: Problem) -> float:
    """Reaching rate eta that brings a wheel from rolling to the surface above the lowest speed [m/s2].

    In sigma = integral of dt / v the distance to the surface shrinks with eta, and the speed falls no faster
    than v0 exp(-a_max sigma), with a_max of :func:`largest_deceleration`.
    """
    domain.box(problem)
    low, high = problem.speeds
    if not low < high:
        raise OutsideModel(f"the speeds {low:g} to {high:g} m/s are one speed, which leaves no time to reach")
    return largest_deceleration(problem) * problem.slip / math.log(high / low)


def largest_deceleration(problem: Problem) -> float:
    """Return a_max: the friction under the weight of the train and its largest resistance [m/s2]."""
    return domain.span(problem, AXLE[1])[1]


def gain_claims(problem: Problem, *, uses: Sequence[str] = AXLE_PLANT) -> tuple[Inequality, ...]:
    """Return the claims that the switching gain outweighs the model error with the reserve eta.

    r rises with the adhesion, so that r is tightest where that is largest, and -r where it is smallest.

    Parameters
    ----------
    problem : Problem
        Plant, domain and law.
    uses : sequence of str
        Quantities of the plant, those of every axle or of the one at static load.
    """
    law, eta = sliding_law(problem), reserve(problem)

    def claimed(ranges: Ranges, *, sign: float) -> Claim:
        def needed(x: Values) -> Number:
            ratio = inertia_ratio(x)
            return residual(problem, law, x) * sign / ratio + eta / ratio

        def arranged(x: Values) -> Number:
            inverse = x["wheelset inertia"] / x["model wheelset inertia"]
            return residual_over_ratio(problem, law, x) * sign + eta * inverse

        return Claim(
            name="(r + eta)/rho" if sign > 0.0 else "(eta - r)/rho",
            variables=variables(problem, law, uses=uses, hold=MEASURED, ranges=ranges),
            expression=needed,
            form=arranged,
            relation="<=",
            bound=Fraction(law.gains.switching_gain),
            unit="m/s2",
        )

    axle = set(AXLE) <= set(uses)
    return (
        *on_edges("-r", problem, lambda ranges: claimed(ranges, sign=-1.0), most=False, axle=axle),
        *on_edges("r", problem, lambda ranges: claimed(ranges, sign=1.0), most=True, axle=axle),
    )


def _reaching_obligations(problem: Problem) -> tuple[Obligation, ...]:
    law = sliding_law(problem)
    return (
        *gain_claims(problem),
        Condition(
            key="radius",
            text=f"the law works out the slip with the wheel radius of the vehicle, {law.vehicle.wheel_radius:g} m",
            holds=law.vehicle.wheel_radius == problem.vehicle.wheel_radius,
        ),
    )


def _between(low: float, high: float) -> str:
    """Say where an acceleration lies; a search without effort leaves an end open."""
    if math.isfinite(low) and math.isfinite(high):
        return f"lies between {low:.7g} and {high:.7g} m/s2"
    if math.isfinite(low):
        return f"is at least {low:.7g} m/s2"
    return f"is at most {high:.7g} m/s2" if math.isfinite(high) else "is not known"


def _tell_reaching(problem: Problem, findings: Findings) -> Certificate:
    law = sliding_law(problem)
    eta, gain, most = reserve(problem), law.gains.switching_gain, largest_deceleration(problem)
    edges = {key: of_key(findings.items(), key) for key in ("r", "-r")}
    needed, radius = together([each for found in edges.values() for each in found]), findings["radius"]
    # A law that measures another slip is another law: nothing follows for it.
    status = all_of(needed, radius) if radius.proved else following_from(needed, radius)
    said = scope(problem, AXLE_PLANT, MEASURED)
    low, high = problem.speeds
    distance = problem.slip - problem.slips[0]
    left = high * math.exp(-most * distance / eta)
    where = place(needed.values, said.names) if needed.values else ()
    return Certificate(
        claim=f"While the slip stays between {problem.slips[0]:g} and {problem.slips[1]:g} and the speed above "
        f"{low * KMH:.3g} km/h, abs(s_D) falls in sigma = integral of dt/v with at least eta = {eta:.3g} m/s2: "
        f"W0 = {gain:.4g} m/s2 outweighs the model error, abs(r) + eta <= rho W0, {said.text}.",
        status=status,
        explanation=f"The smallest W0 that does {_between(needed.low, needed.high)}. "
        + {
            Status.PROVED: "The surface is reached where v0 exp(-a_max abs(sbar0)/eta) is above the lowest speed, with "
            f"a_max = {most:.4g} m/s2: from slip {problem.slips[0]:g} without an integral at {high * KMH:.3g} km/h "
            f"above {left * KMH:.3g} km/h. Nothing is said about a slip outside the range, not even that it returns.",
            Status.REFUTED: "There the torque can drive the slip away from its surface: a larger W0 or a better "
            "friction model is needed.",
            Status.UNDECIDED: f"Open: {left_open(findings.values()) or 'see what it needs'}.",
        }[status],
        method="interval branch and bound on the edges of the box where the adhesion is extreme, replayed by the "
        "independent checker",
        margin=needed.margin,
        worst_point=where,
        witness=(*where, Point(name="(abs(r) + eta)/rho", value=needed.low, unit="m/s2"))
        if status is Status.REFUTED
        else (),
        hypotheses=(
            hypothesis(f"(r + eta)/rho <= W0 = {gain:.4g} m/s2", *edges["r"]),
            hypothesis(f"(eta - r)/rho <= W0 = {gain:.4g} m/s2", *edges["-r"]),
            hypothesis(radius.asked, radius),
        ),
        assumptions=(*ASSUMED, "slip and speed measured exactly"),
        domain=said.domain,
        varied=said.varied,
        held=said.held,
        reference="eqs. (20), (23)-(25) with W = W0/v; docs/theory.md#reaching",
    )


def layer_conditions(problem: Problem) -> tuple[Condition, ...]:
    """Return what the bound inside the layer asks of the gains, beside the reaching condition."""
    law = sliding_law(problem)
    low, reference, high = map(Fraction, (problem.slips[0], problem.slip, problem.slips[1]))
    band = 2 * Fraction(law.gains.boundary_layer)
    return (
        Condition(key="width", text="the layer has a width, Phi/K_P > 0", holds=band > 0),
        Condition(
            key="surface", text="the surface is stable, c = K_I/K_P > 0", holds=law.gains.surface_rate > 0.0
        ),
        Condition(
            key="band",
            text=f"the band of 2 Phi/K_P = {float(band):g} around the reference lies inside the range of slip",
            holds=band < min(reference - low, high - reference),
        ),
    )


def _tell_layer(problem: Problem, findings: Findings) -> Certificate:
    """Derive the bound from the width of the layer.

    With E the integral of e, sbar = e + c E, so that E' + c E = sbar. Once abs(sbar) <= Phi/K_P =: phi for good,
    abs(E) <= abs(E1) exp(-c t) + phi/c, with E1 the integral at the entry and t the time since, and
    abs(e) = abs(sbar - c E) <= 2 phi + c abs(E1) exp(-c t). At the entry c E1 = sbar - e, so that c abs(E1) is at
    most phi + the largest error of the domain. The layer is kept because of the reaching condition on its edge.
    """
    law = sliding_law(problem)
    width, rate = Fraction(law.gains.boundary_layer), Fraction(law.gains.surface_rate)
    low, reference, high = map(Fraction, (problem.slips[0], problem.slip, problem.slips[1]))
    room, largest = min(reference - low, high - reference), max(reference - low, high - reference)
    ultimate, transient = 2 * width, width + largest
    kept = [findings[each.key] for each in _reaching_obligations(problem)]
    conditions = layer_conditions(problem)
    status = following_from(*findings.values())
    violated = [each.asked for each in findings.values() if each.status is Status.REFUTED]
    said = scope(problem, AXLE_PLANT, MEASURED)
    explanation = (
        "Every hypothesis is proved."
        if status is Status.PROVED
        else "The argument does not hold here: see what it needs."
    )
    if rate > 0 and width > 0:
        settling = math.log(float(transient / (SETTLED * ultimate))) / float(rate)
        explanation += (
            f" The transient is at most {float(transient):.3g} at the entry and falls below {float(SETTLED):.0%} of "
            f"the bound within {settling:.3g} s."
        )
    if violated:
        explanation += f" Violated: {'; '.join(violated)}."
    distance = point(room - ultimate)
    return Certificate(
        claim="Once the layer is entered, and while the slip stays between "
        f"{problem.slips[0]:g} and {problem.slips[1]:g} and the speed above {problem.speeds[0] * KMH:.3g} km/h, "
        "abs(e) <= 2 Phi/K_P + c abs(E1) exp(-c t), with t the time since the entry and E1 the integral of the error "
        f"there, 2 Phi/K_P = {float(ultimate):.3g}, {said.text}.",
        status=status,
        explanation=explanation,
        method="exact rational arithmetic on the gains as they are stored; the reaching condition by interval branch "
        "and bound, replayed by the independent checker",
        margin=Range(low=below(distance), high=above(distance), unit="-"),
        worst_point=(
            Point(name="bound on abs(e)", value=above(point(ultimate)), unit="-"),
            Point(name="transient at the entry", value=above(point(transient)), unit="-"),
            Point(name="c", value=law.gains.surface_rate, unit="1/s"),
        ),
        hypotheses=(
            *(hypothesis(each.text, findings[each.key]) for each in conditions),
            hypothesis("the layer is kept: the reaching condition holds on the domain", *kept),
        ),
        assumptions=(*ASSUMED, "slip and speed measured exactly"),
        domain=said.domain,
        varied=said.varied,
        held=said.held,
        reference="eqs. (21), (22), (25), (37); docs/theory.md#layer",
    )


REACHING = Theorem(
    name="reaching",
    title="Reaching the sliding surface",
    claim="abs(r) + eta <= rho W0 for a law with a friction model and a switching gain W0.",
    speaks_about=sliding_mode,
    obligations=_reaching_obligations,
    tell=_tell_reaching,
    assumes=ANY_AXLE,
)

BOUNDARY_LAYER = Theorem(
    name="boundary_layer",
    title="Slip error inside the layer",
    claim="After the layer is entered, abs(e) <= 2 Phi/K_P plus a transient that decays as exp(-c t).",
    speaks_about=sliding_mode,
    obligations=lambda problem: (*_reaching_obligations(problem), *layer_conditions(problem)),
    tell=_tell_layer,
    assumes=ANY_AXLE,
)
