"""Inside the boundary layer the slip error has an ultimate bound: abs(e) <= 2 Phi/K_P plus what decays."""

import math
from fractions import Fraction

from wspd_design.certificates.checks.frame import certified, level, series
from wspd_design.certificates.checks.sliding import reaching
from wspd_design.certificates.checks.verdict import condition
from wspd_design.certificates.kernel.arb import above, below, point
from wspd_design.certificates.records import Certificate, Hypothesis, Point, Problem, Range, Series, Status
from wspd_design.certificates.setting import domain, laws
from wspd_design.certificates.setting.domain import KMH
from wspd_design.controllers.adaptive_fuzzy import AdaptiveFuzzy
from wspd_design.controllers.sliding_mode import SlidingMode

NAME, TITLE = "boundary_layer", "Slip error inside the layer"
SETTLED = 0.1  # of the bound: what is left of the transient
PLOT_TIMES = 121


@certified(name=NAME, title=TITLE)
def check(problem: Problem) -> Certificate:
    """Derive the bound from the width of the layer, and examine what it needs.

    With E the integral of e, sbar = e + c E, so that E' + c E = sbar. Once abs(sbar) <= Phi/K_P =: phi for good,
    abs(E) <= abs(E1) exp(-c t) + phi/c, with E1 the integral at the entry and t the time since, and
    abs(e) = abs(sbar - c E) <= 2 phi + c abs(E1) exp(-c t). At the entry c E1 = sbar - e, so that c abs(E1) is at
    most phi + the largest error of the domain. The layer is kept because of the reaching condition on its edge.
    """
    law = problem.controller
    claim = "After the layer is reached, abs(e) <= 2 Phi/K_P plus a transient that decays as exp(-c t)."
    if not isinstance(law, SlidingMode):
        reason = (
            "has no reaching condition that keeps it in its layer; afsmc_energy bounds an integral in its place"
            if isinstance(law, AdaptiveFuzzy)
            else "decides by what it measures, without a sliding surface"
        )
        return laws.not_applicable(problem, NAME, claim, reason)
    domain.box(problem)
    width, rate = Fraction(law.gains.boundary_layer), Fraction(law.gains.surface_rate)
    reference = Fraction(problem.slip)
    low, high = (Fraction(slip) for slip in problem.slips)
    room = min(reference - low, high - reference)
    largest = max(reference - low, high - reference)
    ultimate, transient = 2 * width, width + largest
    reached = reaching.check(problem)
    hypotheses = (
        condition("the layer has a width, Phi/K_P > 0", width > 0),
        condition("the surface is stable, c = K_I/K_P > 0", rate > 0),
        condition(
            f"the band of 2 Phi/K_P = {float(ultimate):g} around the reference lies inside the domain",
            ultimate < room,
        ),
        Hypothesis(
            text="the layer is reached and kept: the reaching condition holds on the domain",
            status=reached.status,
        ),
    )
    status = laws.of_theorem(hypotheses)
    settling = math.inf
    if rate > 0 and width > 0:
        settling = math.log(float(transient / (Fraction(SETTLED) * ultimate))) / float(rate)
    lowest = below(point(room - ultimate))
    where = (
        Point(name="bound of abs(e)", value=above(point(ultimate)), unit="-"),
        Point(name="transient at the entry", value=above(point(transient)), unit="-"),
        Point(name="c", value=law.gains.surface_rate, unit="1/s"),
    )
    explanation = {
        Status.PROVED: "All that the bound needs is proved.",
        Status.EVIDENCE: "What the bound needs holds wherever it was tried.",
    }.get(status, "The argument does not hold here: see what it needs.")
    if settling < math.inf:
        explanation += (
            f" The transient is at most {float(transient):.3g} at the entry and falls below {SETTLED:.0%} of the "
            f"bound within {settling:.3g} s."
        )
    refuted = [each.text for each in hypotheses if each.status is Status.REFUTED]
    if refuted:
        explanation += f" Violated: {'; '.join(refuted)}."
    return Certificate(
        name=NAME,
        title=TITLE,
        claim=f"Once the layer is reached, the slip error satisfies abs(e) <= 2 Phi/K_P + c abs(E1) exp(-c t), "
        f"2 Phi/K_P = {float(ultimate):.3g}, on {domain.described(problem)}.",
        status=status,
        explanation=explanation,
        margin=Range(low=lowest, high=above(point(room - ultimate)), unit="-"),
        worst_point=where,
        hypotheses=hypotheses,
        assumptions=(
            "T = u: no valve lag, no sampling, no limit of the brake torque; routh_lag and margins speak about those",
            "slip reference constant",
            "the layer is entered inside the slip range of the domain and the transient does not leave it",
            f"it is entered above {problem.speeds[0] * KMH:.3g} km/h",
        ),
        method="exact rational arithmetic on the gains as they are stored; the reaching condition as its own check",
        resolution=f"exact; reaching: {reached.resolution}",
        reference="eqs. (21), (22), (25), (37); docs/theory.md#layer",
        engine=reached.engine,
        proofs=reached.proofs,
        series=_plots(float(ultimate), float(transient), float(rate)),
    )


def _plots(ultimate: float, transient: float, rate: float) -> tuple[Series, ...]:
    """Bound of the error over time since the entry."""
    import numpy as np

    if rate <= 0.0:
        return ()
    times = np.linspace(0.0, 5.0 / rate, PLOT_TIMES)
    axes = ("time since the entry [s]", "slip error [-]")
    return (
        series("bound", *axes, times, ultimate + transient * np.exp(-rate * times)),
        level("2 Phi/K_P", *axes, times, ultimate),
    )
