"""On the surface the slip error decays: e' + c e = 0 with c = K_I / K_P > 0."""

import math
from fractions import Fraction

from wspd_design.certificates.checks.frame import certified, enclosure
from wspd_design.certificates.kernel import exact
from wspd_design.certificates.kernel.exact import Positive
from wspd_design.certificates.records import Certificate, Point, Problem, Status
from wspd_design.certificates.setting import laws
from wspd_design.controllers.sliding_mode import SlidingMode

NAME, TITLE = "surface_hurwitz", "Sliding surface"


def claims(law: laws.SlipLaw) -> tuple[Positive, ...]:
    """Return the claim that c is positive; none if the gains define no surface."""
    numerator, denominator = _gains(law)
    if not (math.isfinite(numerator) and math.isfinite(denominator) and denominator != 0.0):
        return ()
    rate = Fraction(numerator) / Fraction(denominator)
    return (Positive(quantity="c = K_I/K_P", value=rate, unit="1/s"),)


@certified(name=NAME, title=TITLE)
def check(problem: Problem) -> Certificate:
    """Decide the sign of c in exact arithmetic on the gains as they are stored."""
    law = problem.controller
    if not isinstance(law, laws.SlipLaw):
        return laws.no_surface(problem, NAME, "e' + c e = 0 is stable.")
    numerator, denominator = _gains(law)
    gains = (
        Point(name="K_I", value=numerator, unit="1/s"),
        Point(name="K_P", value=denominator, unit="-"),
    )
    if not (claimed := claims(law)):
        return Certificate(
            name=NAME,
            title=TITLE,
            claim="e' + c e = 0 with c = K_I/K_P is stable.",
            status=Status.REFUTED,
            explanation="The two gains define no surface: both must be finite and K_P must not be 0.",
            witness=gains,
            method="exact rational arithmetic",
            reference="eqs. (21), (22)",
        )
    proof, rate = exact.prove(claimed[0]), claimed[0].value
    halving = math.log(2.0) / float(rate) if float(rate) > 0.0 else math.inf  # c may underflow
    return Certificate(
        name=NAME,
        title=TITLE,
        claim=f"On the surface e' + c e = 0 with c = K_I/K_P = {float(rate):.4g} 1/s the slip error decays.",
        status=Status.REFUTED if proof is None else Status.PROVED,
        explanation=(
            "The error does not decay on the surface: K_I and K_P must have the same sign."
            if proof is None
            else f"The error halves every {halving:.3g} s while the state stays on the surface."
        ),
        margin=enclosure(rate, rate, "1/s"),
        witness=gains if proof is None else (),
        hypotheses=(exact.hypothesis(claimed[0], proof),),
        assumptions=("the state is on the surface",),
        method="exact rational arithmetic on the stored gains",
        resolution="exact",
        reference="eqs. (21), (22), (28) with the error in place of the slip; docs/theory.md#layer",
        proofs=() if proof is None else (proof,),
    )


def _gains(law: laws.SlipLaw) -> tuple[float, float]:
    """Return K_I and K_P; a sliding mode is scaled so that K_P = 1."""
    if isinstance(law, SlidingMode):
        return law.gains.surface_rate, 1.0
    return law.gains.integral_gain, law.gains.proportional_gain
