"""On the surface the slip error decays: e' + c e = 0 with c = K_I / K_P > 0."""

import math
from fractions import Fraction

from wspd_design.certificates import laws
from wspd_design.certificates.checking import certified, enclosure
from wspd_design.certificates.records import Certificate, Point, Problem, Status
from wspd_design.controllers.adaptive_fuzzy import AdaptiveFuzzy
from wspd_design.controllers.sliding_mode import SlidingMode

NAME, TITLE = "surface_hurwitz", "Sliding surface"


@certified(name=NAME, title=TITLE)
def check(problem: Problem) -> Certificate:
    """Decide the sign of c in exact arithmetic on the gains as they are stored."""
    law = problem.controller
    if isinstance(law, SlidingMode):
        numerator, denominator = law.gains.surface_rate, 1.0
    elif isinstance(law, AdaptiveFuzzy):
        numerator, denominator = law.gains.integral_gain, law.gains.proportional_gain
    else:
        return laws.no_surface(problem, NAME, "e' + c e = 0 is stable.")
    gains = (
        Point(name="K_I", value=numerator, unit="1/s"),
        Point(name="K_P", value=denominator, unit="-"),
    )
    exists = math.isfinite(numerator) and math.isfinite(denominator) and denominator != 0.0
    if not exists:
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
    rate = Fraction(numerator) / Fraction(denominator)
    proved = rate > 0
    halving = math.log(2.0) / float(rate) if float(rate) > 0.0 else math.inf  # c may underflow
    return Certificate(
        name=NAME,
        title=TITLE,
        claim=f"On the surface e' + c e = 0 with c = K_I/K_P = {float(rate):.4g} 1/s the slip error decays.",
        status=Status.PROVED if proved else Status.REFUTED,
        explanation=(
            f"The error halves every {halving:.3g} s while the state stays on the surface."
            if proved
            else "The error does not decay on the surface: K_I and K_P must have the same sign."
        ),
        margin=enclosure(rate, rate, "1/s"),
        witness=() if proved else gains,
        assumptions=("the state is on the surface",),
        method="exact rational arithmetic on the stored gains",
        resolution="exact",
        reference="eqs. (21), (22), (28) with the error in place of the slip",
    )
