"""The energy of the adaptive fuzzy law: bounds from the repaired V, or that of the paper refuted."""

from wspd_design.certificates.checks import verdict
from wspd_design.certificates.checks.adaptive.adaptive_energy import (
    DECELERATION_TOLERANCE,
    TORQUE_TOLERANCE,
    energy,
    inside,
    rounded_up,
    smallest_gain,
)
from wspd_design.certificates.checks.adaptive.printed_energy import refutation
from wspd_design.certificates.checks.frame import certified
from wspd_design.certificates.checks.sliding.reaching import deceleration_claim, reserve
from wspd_design.certificates.checks.sliding.sliding_exists import torque_claim
from wspd_design.certificates.kernel.arb import above
from wspd_design.certificates.kernel.claim import Claim
from wspd_design.certificates.records import Certificate, Hypothesis, Point, Problem, Status
from wspd_design.certificates.search.settle import enclose, engine, settle
from wspd_design.certificates.setting import domain, laws
from wspd_design.certificates.setting.domain import KMH
from wspd_design.controllers.adaptive_fuzzy import AdaptiveFuzzy

NAME, TITLE = "afsmc_energy", "Energy of the adaptive law"
LIMITS = 5  # hypotheses that hold without limits of the brake; the others speak about those


@certified(name=NAME, title=TITLE)
def check(problem: Problem) -> Certificate:
    """Bound what the repaired law does, or refute the printed argument at a point."""
    law = problem.controller
    if not isinstance(law, AdaptiveFuzzy):
        return laws.not_applicable(
            problem, NAME, "V does not rise and bounds error and weights.", "is not the adaptive fuzzy law"
        )
    domain.box(problem)
    return _bounds(problem, law) if law.gains.dead_zone else refutation(problem, law)


def _bounds(problem: Problem, law: AdaptiveFuzzy) -> Certificate:
    """Theorem for the repaired law."""
    gains, limit = law.gains, problem.vehicle.brake.max_torque
    eta = reserve(problem)
    least, most, deceleration = claims(problem, law)
    low, high = enclose(least, tolerance=TORQUE_TOLERANCE), enclose(most, tolerance=TORQUE_TOLERANCE)
    braking = settle(deceleration, tolerance=DECELERATION_TOLERANCE)
    enclosed = verdict.status(low, high)
    signs = smallest_gain(gains)
    hypotheses = (
        verdict.condition("K_P, K_I, Phi and both adaptation rates are positive", signs > 0.0),
        verdict.condition("the adaptation rates do not depend on the speed", not gains.scheduled_rates),
        Hypothesis(text="G > 0 on the domain: a quotient of positive numbers", status=Status.PROVED),
        verdict.hypothesis("the train decelerates, a >= 0, on the domain", braking),
        Hypothesis(text="psi >= abs(u* - beta) + eta/g on the domain", status=enclosed),
        Hypothesis(
            text=f"eta/g <= u* <= {limit / 1e3:g} kN m - eta/g on the domain",
            status=inside(low, high, limit),
        ),
        verdict.condition(
            "the adaptation is held while the command pushes beyond the brake", gains.hold_when_saturated
        ),
    )
    status = laws.of_theorem(hypotheses)
    where: tuple[Point, ...] = ()
    if signs > 0.0 and enclosed is Status.PROVED:
        found = energy(
            problem, gains, float(low.claim.bound), float(high.claim.bound), eta, problem.speeds[1]
        )
        integral, error, top = (above(x) for x in (found.integral, found.weight_error, found.highest_bound))
        numbers = f"the integral of abs(s_D) is at most {rounded_up(integral)} s, the weights stay within "
        numbers += f"{rounded_up(error / 1e3)} kN m of {found.weight / 1e3:.3g} kN m, and psi_hat below "
        numbers += f"{rounded_up(top / 1e3)} kN m"
        where = (
            Point(name="V(0)", value=above(found.start), unit="N m s"),
            Point(name="bound of the integral of abs(s_D)", value=integral, unit="s"),
            Point(name="bound of the distance of the weights", value=error, unit="N m"),
            Point(name="bound of psi_hat", value=top, unit="N m"),
            Point(name="psi", value=found.bound, unit="N m"),
        )
        layer = gains.boundary_layer / gains.proportional_gain
        seconds = integral / layer
        meaning = (
            f"The surface is more than one further layer, {layer:.3g}, away for at most "
            f"{rounded_up(seconds)} s in all."
        )
    else:
        numbers, meaning = "V bounds error and weights", "There is no bound to state."
    open_ones = [each.text for each in hypotheses if each.status is not Status.PROVED]
    unlimited = laws.of_theorem(hypotheses[:LIMITS]) is Status.PROVED
    return Certificate(
        name=NAME,
        title=TITLE,
        claim=f"From a slip below the reference at {problem.speeds[1] * KMH:.3g} km/h on, without an integral of the "
        f"error yet and as long as the slip stays on {domain.described(problem)}, {numbers}.",
        status=status,
        explanation=f"{meaning} "
        + (f"Not shown: {'; '.join(open_ones)}." if open_ones else "All that it needs is proved.")
        + (" Without limits of the brake the bounds are proved." if open_ones and unlimited else ""),
        margin=verdict.margin(low, high),
        worst_point=where,
        hypotheses=hypotheses,
        assumptions=(
            "T = u inside the limits of the brake: no valve lag, no sampling, continuous adaptation",
            "slip reference constant",
            "the slip stays in the range of the domain",
        ),
        method="repaired Lyapunov function V; torques and deceleration enclosed by interval branch and bound and "
        "replayed by the checker; the rest in balls",
        resolution=f"{low.boxes + high.boxes + braking.boxes} boxes; torques within {TORQUE_TOLERANCE:g} N m",
        reference="eqs. (39)-(44) repaired; docs/theory.md#energy",
        undecided=verdict.undecided(low, high, braking),
        engine=engine(),
        proofs=verdict.proofs(low, high, braking),
    )


def claims(problem: Problem, law: AdaptiveFuzzy) -> tuple[Claim, Claim, Claim]:
    """Claims about u* - eta/g, u* + eta/g and the deceleration on the domain."""
    limit = problem.vehicle.brake.max_torque
    return (
        torque_claim(problem, law, ">=", 0.0),
        torque_claim(problem, law, "<=", limit),
        deceleration_claim(problem, ">=", 0.0),
    )
